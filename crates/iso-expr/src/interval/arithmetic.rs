//! The four operations and those of the order: negation, absolute value, minimum and maximum.
//!
//! Native code repeats these in lanes; the recipe stands in the module `rounding`.

use super::rounding::{greater, lesser, round_down, round_down_least};
use super::{Decorated, Interval};

impl Interval {
    /// All sums of a number of this interval and one of `other`. At most one ulp wider at each end than the tightest.
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        Self { lo: round_down(self.lo + other.lo), hi: -round_down(-self.hi - other.hi) }
    }

    /// All differences of a number of this interval and one of `other`. At most one ulp wider at each end than the
    /// tightest.
    #[inline]
    pub fn minus(self, other: Self) -> Self {
        Self { lo: round_down(self.lo - other.hi), hi: -round_down(other.lo - self.hi) }
    }

    /// All products of a number of this interval and one of `other`. At most one ulp wider at each end than the tightest.
    #[inline]
    pub fn times(self, other: Self) -> Self {
        if self.is_empty() | other.is_empty() {
            return Self::EMPTY;
        }
        let Self { lo, hi } = self;
        Self {
            lo: round_down_least(pairs(lo, hi, other, product)),
            hi: -round_down_least(pairs(-lo, -hi, other, product)),
        }
    }

    /// All quotients of a number of this interval and a nonzero one of `other`, in one interval. At most one ulp wider at
    /// each end than the tightest.
    #[inline]
    pub fn over(self, other: Self) -> Self {
        if self.is_empty() | other.is_empty() | ((other.lo == 0.0) & (other.hi == 0.0)) {
            return Self::EMPTY;
        }
        if (other.lo < 0.0) & (other.hi > 0.0) & ((self.lo < 0.0) | (self.hi > 0.0)) {
            return Self::ENTIRE;
        }
        // 1/+0 and 1/−0 are the limits at a zero end, as zeros point inwards.
        let divisor = Self::from_ends(other.lo, other.hi);
        let Self { lo, hi } = self;
        Self {
            lo: round_down_least(pairs(lo, hi, divisor, quotient)),
            hi: -round_down_least(pairs(-lo, -hi, divisor, quotient)),
        }
    }

    /// All numbers of this interval with the other sign. Exact.
    #[inline]
    pub fn negated(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo }
    }

    /// The absolute values of this interval's numbers. Exact.
    #[inline]
    pub fn absolute(self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let lo = if self.lo > 0.0 {
            self.lo
        } else if self.hi < 0.0 {
            -self.hi
        } else {
            0.0
        };
        Self { lo, hi: greater(-self.lo, self.hi) }
    }
}

/// `combine` of each of two ends with each end of an interval.
#[inline]
fn pairs(lo: f64, hi: f64, other: Interval, combine: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    [combine(lo, other.lo), combine(lo, other.hi), combine(hi, other.lo), combine(hi, other.hi)]
}

/// A product in which zero times anything is exactly zero: an infinite end only says that there is no bound.
#[inline]
fn product(u: f64, v: f64) -> f64 {
    if (u == 0.0) | (v == 0.0) { 0.0 } else { u * v }
}

/// A quotient in which zero over anything is exactly zero, and so is infinity over infinity: whatever number is divided,
/// the quotients have the limit zero as the divisor grows.
#[inline]
fn quotient(u: f64, v: f64) -> f64 {
    let quotient = u / v;
    if (u == 0.0) | quotient.is_nan() { 0.0 } else { quotient }
}

#[inline]
pub(crate) fn add(a: Decorated, b: Decorated) -> Decorated {
    Decorated::enclosing(a.interval.plus(b.interval), a.decoration.min(b.decoration))
}

#[inline]
pub(crate) fn subtract(a: Decorated, b: Decorated) -> Decorated {
    Decorated::enclosing(a.interval.minus(b.interval), a.decoration.min(b.decoration))
}

#[inline]
pub(crate) fn multiply(a: Decorated, b: Decorated) -> Decorated {
    Decorated::enclosing(a.interval.times(b.interval), a.decoration.min(b.decoration))
}

/// Undefined where the divisor is zero.
#[inline]
pub(crate) fn divide(a: Decorated, b: Decorated) -> Decorated {
    Decorated::enclosing(a.interval.over(b.interval), a.decoration.min(b.decoration))
        .trivial_unless(!b.interval.contains_zero())
}

#[inline]
pub(crate) fn negate(a: Decorated) -> Decorated {
    Decorated { interval: a.interval.negated(), decoration: a.decoration }
}

#[inline]
pub(crate) fn absolute(a: Decorated) -> Decorated {
    Decorated { interval: a.interval.absolute(), decoration: a.decoration }
}

#[inline]
pub(crate) fn minimum(a: Decorated, b: Decorated) -> Decorated {
    end_by_end(a, b, lesser)
}

#[inline]
pub(crate) fn maximum(a: Decorated, b: Decorated) -> Decorated {
    end_by_end(a, b, greater)
}

/// A continuous function that rises with both operands and is exact.
#[inline]
fn end_by_end(a: Decorated, b: Decorated, choose: impl Fn(f64, f64) -> f64) -> Decorated {
    let (u, v) = (a.interval, b.interval);
    if u.is_empty() | v.is_empty() {
        return Decorated::EMPTY;
    }
    let interval = Interval { lo: choose(u.lo, v.lo), hi: choose(u.hi, v.hi) };
    Decorated { interval, decoration: a.decoration.min(b.decoration) }
}
