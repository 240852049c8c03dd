//! On which side of zero a function lies, and for how long.

use iso_expr::Interval;
use iso_expr::interval::round_down;

/// On which side of zero all of an interval lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
}

impl Side {
    /// The sign of numbers there.
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Below => -1.0,
            Self::Above => 1.0,
        }
    }
}

/// The side of zero of all of `interval`; `None` when it holds zero or nothing.
pub(super) fn side(interval: Interval) -> Option<Side> {
    if interval.lo > 0.0 {
        Some(Side::Above)
    } else if interval.hi < 0.0 {
        Some(Side::Below)
    } else {
        None
    }
}

/// How far from a point with a function value in `value` the function certainly keeps its sign, when its slope on the
/// way lies in `slope`. Zero when the sign at the point itself is open.
pub(super) fn reach(value: Interval, slope: Interval) -> f64 {
    let (height, fall) = match side(value) {
        Some(Side::Above) => (value.lo, -slope.lo),
        Some(Side::Below) => (-value.hi, slope.hi),
        None => return 0.0,
    };
    if fall <= 0.0 { f64::INFINITY } else { round_down(height / fall).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(lo: f64, hi: f64) -> Interval {
        Interval::new(lo, hi).expect("the ends are in order")
    }

    #[test]
    fn zero_belongs_to_no_side() {
        assert_eq!(side(interval(0.5, 2.0)), Some(Side::Above));
        assert_eq!(side(interval(-0.5, -0.1)), Some(Side::Below));
        for open in [interval(0.0, 1.0), interval(-1.0, 0.0), interval(-1.0, 1.0), Interval::EMPTY] {
            assert_eq!(side(open), None);
        }
    }

    #[test]
    fn a_function_keeps_its_sign_as_long_as_its_steepest_fall_allows() {
        let near = |given: f64, expected: f64| given <= expected && expected - given <= 1e-15;
        assert!(near(reach(interval(1.0, 2.0), interval(-4.0, 1.0)), 0.25));
        assert!(near(reach(interval(-2.0, -1.0), interval(-1.0, 4.0)), 0.25));
        assert_eq!(reach(interval(1.0, 2.0), interval(0.0, 1.0)), f64::INFINITY);
        assert_eq!(reach(interval(1.0, 2.0), Interval::ENTIRE), 0.0);
        assert_eq!(reach(interval(-1.0, 2.0), interval(0.0, 1.0)), 0.0);
        assert_eq!(reach(interval(1.0, 2.0), Interval::EMPTY), 0.0);
    }
}
