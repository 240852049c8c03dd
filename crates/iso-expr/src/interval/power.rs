//! Powers and roots.

use super::elementary::rising;
use super::rounding::{greater, lesser, round_down, round_up};
use super::{Decorated, Decoration, Interval};
use crate::operation::by_squaring;

impl Interval {
    /// The squares of this interval's numbers. At most one ulp wider at each end than the tightest.
    #[inline]
    pub fn squared(self) -> Self {
        self.to_the(2)
    }

    /// The powers of this interval's numbers, never negative when `exponent` is even.
    ///
    /// Each end is multiplied out in the order of the operation's value with every product rounded outwards, so that it is
    /// at most 3(n − 1) ulps off the exact power; one ulp wider than the tightest for n = 2.
    #[inline]
    pub fn to_the(self, exponent: u32) -> Self {
        if exponent.is_multiple_of(2) {
            let Self { lo, hi } = self.absolute();
            return Self::from_ends(power_down(lo, exponent), power_up(hi, exponent));
        }
        let Self { lo, hi } = self;
        Self {
            lo: if lo < 0.0 { -power_up(-lo, exponent) } else { power_down(lo, exponent) },
            hi: if hi > 0.0 { power_up(hi, exponent) } else { -power_down(-hi, exponent) },
        }
    }

    /// The square roots of this interval's numbers that have one. At most one ulp wider at each end than the tightest.
    #[inline]
    pub fn square_root(self) -> Self {
        if self.hi < 0.0 {
            return Self::EMPTY;
        }
        let lo = if self.lo <= 0.0 { 0.0 } else { round_down(self.lo.sqrt()) };
        Self { lo, hi: round_up(self.hi.sqrt()) }
    }
}

/// A lower bound of a power of a number that is not negative.
#[inline]
fn power_down(base: f64, exponent: u32) -> f64 {
    power_rounded(base, exponent, round_down)
}

/// An upper bound of a power of a number that is not negative.
#[inline]
fn power_up(base: f64, exponent: u32) -> f64 {
    if (base == 0.0) & (exponent > 0) { 0.0 } else { power_rounded(base, exponent, round_up) }
}

/// `base` multiplied by itself in the order of the operation's value.
#[inline]
fn power_rounded(base: f64, exponent: u32, round: impl Fn(f64) -> f64) -> f64 {
    by_squaring(base, exponent, |a, b| round(a * b.unwrap_or(a))).unwrap_or(1.0)
}

/// The second operand is a constant, a positive integer.
#[inline]
pub(crate) fn integer_power(a: Decorated, exponent: Decorated) -> Decorated {
    if a.interval.is_empty() | exponent.interval.is_empty() {
        return Decorated::EMPTY;
    }
    Decorated::enclosing(a.interval.to_the(exponent.interval.lo as u32), a.decoration)
}

/// Undefined below zero.
#[inline]
pub(crate) fn square_root(a: Decorated) -> Decorated {
    Decorated::enclosing(a.interval.square_root(), a.decoration).trivial_unless(a.interval.lo >= 0.0)
}

#[inline]
pub(crate) fn cube_root(a: Decorated) -> Decorated {
    rising(a, core_math::cbrt)
}

/// Rises with the absolute values of both operands.
#[inline]
pub(crate) fn hypotenuse(a: Decorated, b: Decorated) -> Decorated {
    let (u, v) = (a.interval.absolute(), b.interval.absolute());
    if u.is_empty() | v.is_empty() {
        return Decorated::EMPTY;
    }
    let (lo, hi) = (round_down(core_math::hypot(u.lo, v.lo)), round_up(core_math::hypot(u.hi, v.hi)));
    Decorated::enclosing(Interval { lo, hi }, a.decoration.min(b.decoration))
}

/// Defined for a > 0, for a = 0 where b > 0, and 0⁰ = 1, from which it jumps as b grows.
pub(crate) fn power(a: Decorated, b: Decorated) -> Decorated {
    let (base, exponent) = (a.interval, b.interval);
    if base.is_empty() | exponent.is_empty() | (base.hi < 0.0) {
        return Decorated::EMPTY;
    }
    let interval = if base.hi == 0.0 { power_of_zero(exponent) } else { power_of_positive(base, exponent) };
    let defined = (base.lo > 0.0) | ((base.lo == 0.0) & (exponent.lo >= 0.0));
    let known = if (base.lo > 0.0) | (exponent.lo > 0.0) {
        Decoration::Common
    } else if exponent.is_point() {
        Decoration::Continuous
    } else {
        Decoration::Defined
    };
    let decoration = a.decoration.min(b.decoration).min(known);
    Decorated::enclosing(interval, decoration).trivial_unless(defined)
}

/// The powers of zero: 0 to positive exponents, 1 to the exponent zero.
fn power_of_zero(exponent: Interval) -> Interval {
    if exponent.hi < 0.0 {
        return Interval::EMPTY;
    }
    let lo = if exponent.hi > 0.0 { 0.0 } else { 1.0 };
    let hi = if exponent.contains_zero() { 1.0 } else { 0.0 };
    Interval::from_ends(lo, hi)
}

/// The powers of the numbers that are not negative in a `base` that reaches above zero.
///
/// ln(aᵇ) = b·ln a is linear in b and in ln a, so that the extremes are at the corners; there the C function has the
/// limits at zero and infinity.
fn power_of_positive(base: Interval, exponent: Interval) -> Interval {
    let least_base = if base.lo > 0.0 { base.lo } else { 0.0 };
    let at = |exponent| (core_math::pow(least_base, exponent), core_math::pow(base.hi, exponent));
    let (p, q) = at(exponent.lo);
    let (r, s) = if exponent.is_point() { (p, q) } else { at(exponent.hi) };
    let (lo, hi) = (lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s)));
    Interval { lo: round_down(lo), hi: round_up(hi) }
}
