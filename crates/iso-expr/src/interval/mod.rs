//! Intervals of real numbers, rounded outwards and decorated as in IEEE 1788-2015.

pub(crate) mod extension;

pub use extension::Extension;

/// A closed interval of real numbers. Infinite ends stand for unbounded intervals; NaN ends for the empty set.
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

    /// The one real number `value`; empty when it is infinite or NaN, which are no real numbers.
    pub fn point(value: f64) -> Self {
        if value.is_finite() { Self { lo: value, hi: value } } else { Self::EMPTY }
    }

    /// Whether no real number is inside.
    pub fn is_empty(self) -> bool {
        self.lo.is_nan()
    }

    /// Whether `value` is inside.
    pub fn contains(self, value: f64) -> bool {
        value.is_finite() && self.lo <= value && value <= self.hi
    }
}

/// What is known of a function on the box over which it was enclosed, weakest first (IEEE 1788-2015, clause 11.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Decoration {
    /// Nothing: it may be undefined on some of the box.
    Trivial = 0,
    /// It is defined on the whole box.
    Defined = 1,
    /// It is defined and continuous on the whole box.
    Continuous = 2,
    /// It is defined and continuous on the whole box, which is bounded, and so is the enclosure.
    Common = 3,
}

/// An interval with what is known of the function that it encloses.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Decorated {
    /// The enclosure.
    pub interval: Interval,
    /// What is known of the function.
    pub decoration: Decoration,
}

impl Decorated {
    /// The empty set, of which nothing is known.
    pub const EMPTY: Self = Self { interval: Interval::EMPTY, decoration: Decoration::Trivial };

    /// An argument that runs from `lo` to `hi`: common where that is bounded, continuous where it is not. It is empty when
    /// no real number lies between the ends, as when one of them is NaN.
    pub fn argument(lo: f64, hi: f64) -> Self {
        if !(lo <= hi && lo < f64::INFINITY && hi > f64::NEG_INFINITY) {
            return Self::EMPTY;
        }
        let is_bounded = lo.is_finite() && hi.is_finite();
        let decoration = if is_bounded { Decoration::Common } else { Decoration::Continuous };
        Self { interval: Interval { lo, hi }, decoration }
    }

    /// A constant that lies in `enclosure`.
    pub fn constant(enclosure: Interval) -> Self {
        Self::argument(enclosure.lo, enclosure.hi)
    }
}
