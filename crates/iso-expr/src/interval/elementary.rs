//! Exponentials, logarithms, hyperbolic and inverse functions.
//!
//! The functions of CORE-MATH are correctly rounded, so the neighbours of their values at the ends enclose the range of
//! a monotone function, at most one ulp wider at each end than the tightest. Odd functions keep the sign of a zero, and
//! with it an exact zero end.

use super::rounding::{greater, lesser, round_down, round_up};
use super::{Decorated, Interval};

/// A rising function that is continuous on all of `a`, or that is limited by the caller's decoration.
#[inline]
pub(super) fn rising(a: Decorated, function: impl Fn(f64) -> f64) -> Decorated {
    let Interval { lo, hi } = a.interval;
    rising_by_ends(a, [function(lo), function(hi)])
}

/// The same, given its correctly rounded values at the lower and the upper end.
#[inline]
pub(super) fn rising_by_ends(a: Decorated, [lo, hi]: [f64; 2]) -> Decorated {
    Decorated::enclosing(Interval { lo: round_down(lo), hi: round_up(hi) }, a.decoration)
}

/// The part of `a` from −1 to 1, of which nothing is known if that is not all of it.
#[inline]
fn clipped_to_one(a: Decorated) -> Decorated {
    let interval = a.interval.intersection(Interval { lo: -1.0, hi: 1.0 });
    Decorated { interval, decoration: a.decoration }.trivial_unless(interval == a.interval)
}

/// A rising logarithm, which falls to −∞ at `pole` and is undefined from there on down.
#[inline]
fn logarithm(a: Decorated, pole: f64, function: impl Fn(f64) -> f64) -> Decorated {
    let Interval { lo, hi } = a.interval;
    logarithm_by_ends(a, pole, [function(lo), function(hi)])
}

/// The same, given its correctly rounded values at the lower and the upper end; what it is where it is undefined is not read.
#[inline]
pub(super) fn logarithm_by_ends(a: Decorated, pole: f64, [at_lo, at_hi]: [f64; 2]) -> Decorated {
    let Interval { lo, hi } = a.interval;
    if hi <= pole {
        return Decorated::EMPTY;
    }
    let at_lo = if lo <= pole { f64::NEG_INFINITY } else { at_lo };
    rising_by_ends(a, [at_lo, at_hi]).trivial_unless(lo > pole)
}

#[inline]
pub(crate) fn exp(a: Decorated) -> Decorated {
    rising(a, core_math::exp)
}

#[inline]
pub(crate) fn exp2(a: Decorated) -> Decorated {
    rising(a, core_math::exp2)
}

/// Never below −1.
#[inline]
pub(crate) fn exp_m1(a: Decorated) -> Decorated {
    let Decorated { interval, decoration } = rising(a, core_math::expm1);
    Decorated { interval: Interval { lo: greater(-1.0, interval.lo), hi: interval.hi }, decoration }
}

#[inline]
pub(crate) fn ln(a: Decorated) -> Decorated {
    logarithm(a, 0.0, core_math::log)
}

#[inline]
pub(crate) fn log2(a: Decorated) -> Decorated {
    logarithm(a, 0.0, core_math::log2)
}

#[inline]
pub(crate) fn log10(a: Decorated) -> Decorated {
    logarithm(a, 0.0, core_math::log10)
}

#[inline]
pub(crate) fn ln_1p(a: Decorated) -> Decorated {
    logarithm(a, -1.0, core_math::log1p)
}

#[inline]
pub(crate) fn sinh(a: Decorated) -> Decorated {
    rising(a, core_math::sinh)
}

/// Rises with the absolute value, from 1.
#[inline]
pub(crate) fn cosh(a: Decorated) -> Decorated {
    let interval = a.interval.absolute();
    let Decorated { interval, decoration } = rising(Decorated { interval, ..a }, core_math::cosh);
    Decorated { interval: Interval { lo: greater(1.0, interval.lo), hi: interval.hi }, decoration }
}

/// Never outside [−1, 1].
#[inline]
pub(crate) fn tanh(a: Decorated) -> Decorated {
    let Decorated { interval: Interval { lo, hi }, decoration } = rising(a, core_math::tanh);
    Decorated { interval: Interval { lo: greater(-1.0, lo), hi: lesser(1.0, hi) }, decoration }
}

#[inline]
pub(crate) fn asinh(a: Decorated) -> Decorated {
    rising(a, core_math::asinh)
}

/// Undefined below 1.
#[inline]
pub(crate) fn acosh(a: Decorated) -> Decorated {
    let Interval { lo, hi } = a.interval;
    if hi < 1.0 {
        return Decorated::EMPTY;
    }
    let interval = Interval { lo: greater(1.0, lo), hi };
    rising(Decorated { interval, ..a }, core_math::acosh).trivial_unless(lo >= 1.0)
}

/// Undefined at −1 and 1, where it is unbounded, and beyond.
#[inline]
pub(crate) fn atanh(a: Decorated) -> Decorated {
    let Interval { lo, hi } = a.interval;
    if (hi <= -1.0) | (lo >= 1.0) {
        return Decorated::EMPTY;
    }
    rising(clipped_to_one(a), core_math::atanh).trivial_unless((lo > -1.0) & (hi < 1.0))
}

/// Undefined outside [−1, 1].
#[inline]
pub(crate) fn asin(a: Decorated) -> Decorated {
    rising(clipped_to_one(a), core_math::asin)
}

/// Undefined outside [−1, 1]; falls.
#[inline]
pub(crate) fn acos(a: Decorated) -> Decorated {
    let Decorated { interval: Interval { lo, hi }, decoration } = clipped_to_one(a);
    let interval = Interval { lo: round_down(core_math::acos(hi)), hi: round_up(core_math::acos(lo)) };
    Decorated::enclosing(interval, decoration)
}

#[inline]
pub(crate) fn atan(a: Decorated) -> Decorated {
    rising(a, core_math::atan)
}
