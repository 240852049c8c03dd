//! Intervals of real numbers, rounded outwards and decorated as in IEEE 1788-2015.
//!
//! [`Interval`] is a set of real numbers, [`Decorated`] adds what is known of the function whose range it encloses. The
//! extension of every operation is reached through [`Operation::extension`](crate::Operation::extension).

mod angle;
mod arithmetic;
mod decoration;
mod display;
mod elementary;
pub(crate) mod extension;
mod measure;
mod modulo;
mod periodic;
mod power;
mod rounding;
mod steps;
#[cfg(test)]
mod tests;

pub use decoration::{Decorated, Decoration};
pub use extension::{ByEnds, Extension};
pub use periodic::sine_and_cosine_by_ends;
pub use rounding::{round_down, round_up};

/// A closed interval of real numbers. Infinite ends stand for unbounded intervals; NaN ends for the empty set.
///
/// Two intervals are equal when they hold the same numbers, whatever the signs of their zeros. In those that this module
/// makes, a lower end of zero is +0 and an upper one −0; the module `rounding` says why.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Interval {
    /// The lower end: a double or −∞, or NaN when empty.
    pub lo: f64,
    /// The upper end: a double or +∞, or NaN when empty.
    pub hi: f64,
}

impl Interval {
    /// The empty set.
    pub const EMPTY: Self = Self { lo: f64::NAN, hi: f64::NAN };
    /// All real numbers.
    pub const ENTIRE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// The real numbers from `lo` to `hi`. None when there are none: an end is NaN, `lo` is above `hi`, `lo` is +∞ or
    /// `hi` is −∞.
    #[inline]
    pub fn new(lo: f64, hi: f64) -> Option<Self> {
        let holds_numbers = (lo <= hi) & (lo < f64::INFINITY) & (hi > f64::NEG_INFINITY);
        holds_numbers.then(|| Self::from_ends(lo, hi))
    }

    /// The one real number `value`; empty when it is infinite or NaN, which are no real numbers.
    #[inline]
    pub fn point(value: f64) -> Self {
        if value.is_finite() { Self::from_ends(value, value) } else { Self::EMPTY }
    }

    /// Ends that are in order, or both NaN; zeros are made to point inwards.
    #[inline]
    pub(crate) fn from_ends(lo: f64, hi: f64) -> Self {
        Self { lo: lo + 0.0, hi: -(0.0 - hi) }
    }

    /// Whether no real number is inside.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.lo.is_nan()
    }

    /// Whether it is neither empty nor unbounded.
    #[inline]
    pub fn is_bounded(self) -> bool {
        (self.lo > f64::NEG_INFINITY) & (self.hi < f64::INFINITY)
    }

    /// Whether exactly one real number is inside.
    #[inline]
    pub fn is_point(self) -> bool {
        self.lo == self.hi
    }

    /// Whether `value` is inside.
    #[inline]
    pub fn contains(self, value: f64) -> bool {
        value.is_finite() && self.lo <= value && value <= self.hi
    }

    /// Whether zero is inside.
    #[inline]
    pub fn contains_zero(self) -> bool {
        (self.lo <= 0.0) & (self.hi >= 0.0)
    }

    /// Whether every number of this interval is in `other`.
    #[inline]
    pub fn is_subset_of(self, other: Self) -> bool {
        self.is_empty() | ((other.lo <= self.lo) & (self.hi <= other.hi))
    }

    /// The numbers that are in both.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        let (lo, hi) = (rounding::greater(self.lo, other.lo), rounding::lesser(self.hi, other.hi));
        if self.is_empty() | other.is_empty() | (lo > hi) { Self::EMPTY } else { Self { lo, hi } }
    }

    /// The least interval that holds both.
    #[inline]
    pub fn hull(self, other: Self) -> Self {
        if self.is_empty() {
            other
        } else if other.is_empty() {
            self
        } else {
            Self { lo: rounding::lesser(self.lo, other.lo), hi: rounding::greater(self.hi, other.hi) }
        }
    }
}

impl PartialEq for Interval {
    fn eq(&self, other: &Self) -> bool {
        (self.is_empty() && other.is_empty()) || (self.lo == other.lo && self.hi == other.hi)
    }
}
