//! Sizes and middles of intervals (IEEE 1788-2015, clause 10.5.9).

use super::Interval;
use super::rounding::{greater, round_up};

impl Interval {
    /// hi − lo, rounded up; +∞ when unbounded, NaN when empty.
    #[inline]
    pub fn width(self) -> f64 {
        self.minus(self).hi + 0.0
    }

    /// The double nearest to the middle; the greatest or least double if only one end is infinite, 0 if both are, NaN when
    /// empty. Always inside.
    #[inline]
    pub fn midpoint(self) -> f64 {
        match (self.lo == f64::NEG_INFINITY, self.hi == f64::INFINITY) {
            (false, false) => self.lo.midpoint(self.hi) + 0.0,
            (false, true) => f64::MAX,
            (true, false) => f64::MIN,
            (true, true) => 0.0,
        }
    }

    /// The distance from [`midpoint`](Self::midpoint) to the farther end, rounded up; NaN when empty.
    #[inline]
    pub fn radius(self) -> f64 {
        let middle = self.midpoint();
        if self.is_point() { 0.0 } else { round_up(greater(middle - self.lo, self.hi - middle)) }
    }

    /// The greatest absolute value inside; NaN when empty.
    #[inline]
    pub fn magnitude(self) -> f64 {
        greater(self.lo.abs(), self.hi.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFINITY: f64 = f64::INFINITY;
    const TINY: f64 = f64::from_bits(1);

    fn interval(lo: f64, hi: f64) -> Interval {
        Interval::new(lo, hi).expect("the ends are in order")
    }

    #[test]
    fn sizes_of_known_intervals() {
        // interval, width, midpoint, magnitude
        let cases = [
            (interval(1.0, 1.0), 0.0, 1.0, 1.0),
            (interval(-2.0, -2.0), 0.0, -2.0, 2.0),
            (interval(0.0, 0.0), 0.0, 0.0, 0.0),
            (interval(TINY, TINY), 0.0, TINY, TINY),
            (interval(-1.0, 3.0), 4.0f64.next_up(), 1.0, 3.0),
            (interval(-3.0, -1.0), 2.0f64.next_up(), -2.0, 3.0),
            (interval(f64::MIN, f64::MAX), INFINITY, 0.0, f64::MAX),
            (interval(5.0, INFINITY), INFINITY, f64::MAX, INFINITY),
            (interval(-INFINITY, 5.0), INFINITY, f64::MIN, INFINITY),
            (Interval::ENTIRE, INFINITY, 0.0, INFINITY),
        ];
        for (given, width, midpoint, magnitude) in cases {
            assert_eq!(given.width(), width, "width of {given}");
            assert_eq!(given.midpoint(), midpoint, "midpoint of {given}");
            assert_eq!(given.magnitude(), magnitude, "magnitude of {given}");
        }
        let empty = Interval::EMPTY;
        for value in [empty.width(), empty.midpoint(), empty.radius(), empty.magnitude()] {
            assert!(value.is_nan());
        }
    }

    #[test]
    fn the_radius_reaches_both_ends() {
        for given in [interval(0.1, 0.7), interval(-1e300, 1e-300), interval(1.0, 1.0f64.next_up())] {
            let (middle, radius) = (given.midpoint(), given.radius());
            assert!(given.contains(middle));
            assert!(middle - radius <= given.lo && given.hi <= middle + radius, "{given}");
            assert!(radius <= given.width());
        }
    }
}
