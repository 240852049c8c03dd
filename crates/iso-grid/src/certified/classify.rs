//! What enclosures over a stretch of a ray prove about its roots.

use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decoration, Interval};

use super::line::Course;
use super::side::{reach, side};
use crate::Span;

/// What is known of a stretch that may hold roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Finding {
    /// Nothing yet.
    Open,
    /// F is continuous and strictly monotone and its sign changes: there is just one root, a simple one.
    Crossing,
    /// F is zero on all of it.
    Plateau,
    /// F is continuous and nowhere larger than a few of its rounding errors.
    Flat,
}

/// Whether no number in `interval` is zero.
pub(super) fn free_of_zero(interval: Interval) -> bool {
    interval.is_empty() || side(interval).is_some()
}

/// The part of `stretch` that may hold roots, and what is known of it; `None` when there is none. `at_start` and `at_end`
/// enclose F at the ends.
///
/// From an end where the sign of F is known, the extreme slope bounds how soon F can reach zero: this is the interval
/// Newton method started from the ends, which discards a stretch whenever the linear boundary value form would
/// (Neumaier, Interval Methods for Systems of Equations, 1990, section 2.4).
pub(super) fn classify(
    stretch: Span,
    course: Course,
    at_start: Interval,
    at_end: Interval,
) -> Option<(Span, Finding)> {
    let Course { value, slope } = course;
    if free_of_zero(value.interval) {
        return None;
    }
    if value.decoration >= Decoration::Defined && value.interval == Interval::point(0.0) {
        return Some((stretch, Finding::Plateau));
    }
    if value.decoration < Decoration::Continuous || slope.decoration < Decoration::Defined {
        return Some((stretch, Finding::Open));
    }
    let rest = Span {
        start: round_down(stretch.start + reach(at_start, slope.interval)).max(stretch.start),
        end: round_up(stretch.end - reach(at_end, slope.interval.negated())).min(stretch.end),
    };
    if rest.start > rest.end {
        return None;
    }
    let (before, after) = (side(at_start), side(at_end));
    let finding = if before.is_some() && after.is_some() && before != after && side(slope.interval).is_some()
    {
        Finding::Crossing
    } else if before.is_none() && after.is_none() && is_flat(stretch, course, at_start, at_end) {
        Finding::Flat
    } else {
        Finding::Open
    };
    Some((rest, finding))
}

/// How many rounding errors of F count as a few.
const ROUNDINGS: f64 = 4.0;

/// Whether F, by its values at the ends and its slope, stays within a few of the rounding errors of its values.
fn is_flat(stretch: Span, course: Course, at_start: Interval, at_end: Interval) -> bool {
    let length = Interval { lo: 0.0, hi: round_up(stretch.end - stretch.start) };
    let rise = length.times(course.slope.interval);
    let bounds = [course.value.interval, at_start.plus(rise), at_end.minus(rise)];
    let bound = bounds.into_iter().map(Interval::magnitude).fold(f64::INFINITY, f64::min);
    let rounding = at_start.width().max(at_end.width());
    rounding.is_finite() && bound <= ROUNDINGS * rounding
}
