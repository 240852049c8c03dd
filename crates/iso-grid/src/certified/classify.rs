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

#[cfg(test)]
mod tests {
    use iso_expr::Decorated;

    use super::*;

    fn interval(lo: f64, hi: f64) -> Interval {
        Interval::new(lo, hi).unwrap()
    }

    fn course(value: Interval, slope: Interval) -> Course {
        let continuous = |interval| Decorated { interval, decoration: Decoration::Common };
        Course { value: continuous(value), slope: continuous(slope) }
    }

    const STRETCH: Span = Span { start: 1.0, end: 2.0 };

    #[test]
    fn a_stretch_without_zero_is_free() {
        let course = course(interval(0.1, 3.0), interval(-1.0, 1.0));
        assert_eq!(classify(STRETCH, course, interval(1.0, 1.0), interval(1.0, 1.0)), None);
    }

    #[test]
    fn a_slope_too_flat_to_reach_zero_leaves_a_stretch_free() {
        // From 1 at both ends, zero is 1.25 away; the ends are 1 apart.
        let course = course(interval(-1.0, 3.0), interval(-0.8, 0.8));
        assert_eq!(classify(STRETCH, course, interval(1.0, 1.0), interval(1.0, 1.0)), None);
    }

    #[test]
    fn a_change_of_sign_with_a_slope_is_a_crossing() {
        let course = course(interval(-2.0, 2.0), interval(1.5, 4.0));
        let Some((rest, Finding::Crossing)) =
            classify(STRETCH, course, interval(-1.0, -1.0), interval(1.0, 1.0))
        else {
            panic!("no crossing");
        };
        assert!((rest.start - 1.25).abs() < 1e-15 && (rest.end - 1.75).abs() < 1e-15, "{rest:?}");
    }

    #[test]
    fn a_change_of_sign_over_a_pole_is_no_crossing() {
        let mut course = course(Interval::ENTIRE, Interval::ENTIRE);
        course.value.decoration = Decoration::Trivial;
        let found = classify(STRETCH, course, interval(-1.0, -1.0), interval(1.0, 1.0));
        assert_eq!(found, Some((STRETCH, Finding::Open)));
    }

    #[test]
    fn zero_all_over_is_a_plateau() {
        let zero = Interval::point(0.0);
        assert_eq!(classify(STRETCH, course(zero, zero), zero, zero), Some((STRETCH, Finding::Plateau)));
    }

    #[test]
    fn values_lost_in_rounding_are_flat() {
        let rounding = interval(-1e-16, 1e-16);
        let found = classify(STRETCH, course(interval(-1.0, 1.0), rounding), rounding, rounding);
        assert_eq!(found, Some((STRETCH, Finding::Flat)));
    }
}
