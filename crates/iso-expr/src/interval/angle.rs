//! The angle of a point in the plane.

use std::f64::consts::PI;

use super::rounding::{round_down, round_up};
use super::{Decorated, Decoration, Interval};

/// From just below −π to just above π.
const FULL_TURN: Interval = Interval { lo: -PI.next_up(), hi: PI.next_up() };

/// The angle of the points (x, y) with y in `a` and x in `b`, from −π to π.
///
/// Undefined at the origin. On the negative x axis it is π; across that axis it jumps (IEEE 1788-2015, table 9.1).
pub(crate) fn atan2(a: Decorated, b: Decorated) -> Decorated {
    let (y, x) = (a.interval, b.interval);
    if y.is_empty() | x.is_empty() {
        return Decorated::EMPTY;
    }
    let touches_axis = y.contains_zero() & (x.lo < 0.0);
    let interval = if touches_axis & (y.lo < 0.0) {
        FULL_TURN
    } else if y.lo >= 0.0 {
        angle_above(y, x)
    } else if y.hi <= 0.0 {
        angle_above(y.negated(), x).negated()
    } else {
        Interval { lo: round_down(core_math::atan2(y.lo, x.lo)), hi: round_up(core_math::atan2(y.hi, x.lo)) }
    };
    let decoration = if y.contains_zero() & x.contains_zero() {
        Decoration::Trivial
    } else if !touches_axis {
        Decoration::Common
    } else if y.lo < 0.0 {
        Decoration::Defined
    } else {
        Decoration::Continuous
    };
    Decorated { interval, decoration: decoration.min(a.decoration).min(b.decoration) }
}

/// The angle where no y is negative. It falls with x; with y it rises where x > 0 and falls where x < 0.
fn angle_above(y: Interval, x: Interval) -> Interval {
    // The angle on a zero end is that of a zero with a positive sign, here and after negation.
    let (least_y, most_y) = (y.lo + 0.0, y.hi + 0.0);
    if most_y == 0.0 {
        return angle_on_axis(x);
    }
    let least = core_math::atan2(if x.hi > 0.0 { least_y } else { most_y }, x.hi);
    let most = core_math::atan2(if x.lo < 0.0 { least_y } else { most_y }, x.lo);
    Interval { lo: round_down(least), hi: round_up(most) }
}

/// The angle where y = 0: 0 to the right of the origin, π to the left.
fn angle_on_axis(x: Interval) -> Interval {
    let lo = if x.hi > 0.0 { 0.0 } else { PI };
    let hi = if x.lo < 0.0 { PI.next_up() } else { 0.0 };
    if x == Interval::point(0.0) { Interval::EMPTY } else { Interval::from_ends(lo, hi) }
}
