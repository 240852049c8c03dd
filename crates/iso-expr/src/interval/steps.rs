//! Functions that are constant between jumps: roundings, signs, comparisons; and the choice by a condition.
//!
//! Where a jump lies inside, they are no more than defined. Where the box only touches one, so that the function is
//! constant on the box, its restriction to the box is continuous, which is what [`Decoration::Continuous`] says and what
//! a proof about the box needs; but it is not continuous at that point, as [`Decoration::Common`] would say.

use super::{Decorated, Decoration, Interval};

/// A rising step function, exact. `touches` says whether a jump is at an end of the interval.
#[inline]
fn steps(a: Decorated, function: impl Fn(f64) -> f64, touches: impl Fn(Interval) -> bool) -> Decorated {
    let interval = Interval::from_ends(function(a.interval.lo), function(a.interval.hi));
    let known = if interval.lo < interval.hi {
        Decoration::Defined
    } else if touches(a.interval) {
        Decoration::Continuous
    } else {
        Decoration::Common
    };
    Decorated { interval, decoration: a.decoration.min(known) }
}

/// Jumps at zero, to it and from it.
#[inline]
pub(crate) fn sign(a: Decorated) -> Decorated {
    let sign = |x: f64| if x == 0.0 || x.is_nan() { x } else { x.signum() };
    steps(a, sign, |a| a.contains_zero())
}

/// Jumps up to each integer.
#[inline]
pub(crate) fn floor(a: Decorated) -> Decorated {
    steps(a, f64::floor, |a| a.lo == a.lo.floor())
}

/// Jumps up from each integer.
#[inline]
pub(crate) fn ceil(a: Decorated) -> Decorated {
    steps(a, f64::ceil, |a| a.hi == a.hi.ceil())
}

/// Jumps half-way between integers.
#[inline]
pub(crate) fn round(a: Decorated) -> Decorated {
    let is_half_way = |x: f64| (x - x.floor()) == 0.5;
    steps(a, f64::round_ties_even, |a| is_half_way(a.lo) | is_half_way(a.hi))
}

/// Jumps up to each positive integer and up from each negative one.
#[inline]
pub(crate) fn truncate(a: Decorated) -> Decorated {
    steps(a, f64::trunc, |a| ((a.lo > 0.0) & (a.lo == a.lo.floor())) | ((a.hi < 0.0) & (a.hi == a.hi.ceil())))
}

/// What is certain of a comparison on a box.
enum Verdict {
    Never,
    /// Never, but beside some point of the box.
    JustNever,
    Sometimes,
    /// Always, but not beside some point of the box.
    JustAlways,
    Always,
}

/// The truth values that a comparison of `a` and `b` takes.
#[inline]
fn comparison(a: Decorated, b: Decorated, verdict: impl Fn(Interval, Interval) -> Verdict) -> Decorated {
    if a.interval.is_empty() | b.interval.is_empty() {
        return Decorated::EMPTY;
    }
    let (lo, hi, known) = match verdict(a.interval, b.interval) {
        Verdict::Never => (0.0, 0.0, Decoration::Common),
        Verdict::JustNever => (0.0, 0.0, Decoration::Continuous),
        Verdict::Sometimes => (0.0, 1.0, Decoration::Defined),
        Verdict::JustAlways => (1.0, 1.0, Decoration::Continuous),
        Verdict::Always => (1.0, 1.0, Decoration::Common),
    };
    Decorated { interval: Interval::from_ends(lo, hi), decoration: a.decoration.min(b.decoration).min(known) }
}

#[inline]
pub(crate) fn less(a: Decorated, b: Decorated) -> Decorated {
    comparison(a, b, |a, b| {
        if a.hi < b.lo {
            Verdict::Always
        } else if a.lo > b.hi {
            Verdict::Never
        } else if a.lo == b.hi {
            Verdict::JustNever
        } else {
            Verdict::Sometimes
        }
    })
}

#[inline]
pub(crate) fn less_or_equal(a: Decorated, b: Decorated) -> Decorated {
    comparison(a, b, |a, b| {
        if a.hi < b.lo {
            Verdict::Always
        } else if a.hi == b.lo {
            Verdict::JustAlways
        } else if a.lo > b.hi {
            Verdict::Never
        } else {
            Verdict::Sometimes
        }
    })
}

#[inline]
pub(crate) fn equal(a: Decorated, b: Decorated) -> Decorated {
    comparison(a, b, |a, b| {
        if (a.hi < b.lo) | (b.hi < a.lo) {
            Verdict::Never
        } else if a.is_point() & (a == b) {
            Verdict::JustAlways
        } else {
            Verdict::Sometimes
        }
    })
}

/// b where the condition a is not zero, c where it is.
///
/// The condition is a truth: a number that is zero on the box alone would have to be called no more than continuous there.
///
/// Where the condition is certain, only the branch taken counts: a jump of the condition between nonzero values does
/// not show. But unless the condition is [`Decoration::Common`] it may be another one right beside the box.
#[inline]
pub(crate) fn select(a: Decorated, b: Decorated, c: Decorated) -> Decorated {
    let condition = a.interval;
    if condition.is_empty() {
        return Decorated::EMPTY;
    }
    let enclosure = if !condition.contains_zero() {
        b
    } else if condition.is_point() {
        c
    } else {
        let interval = b.interval.hull(c.interval);
        Decorated { interval, decoration: b.decoration.min(c.decoration).min(Decoration::Defined) }
    };
    let limit = match a.decoration {
        Decoration::Common => Decoration::Common,
        Decoration::Continuous | Decoration::Defined => Decoration::Continuous,
        Decoration::Trivial => Decoration::Trivial,
    };
    enclosure.at_most(limit)
}
