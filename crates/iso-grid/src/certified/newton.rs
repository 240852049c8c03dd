//! The one simple root of a stretch, by the interval Newton method, and the extremum of a stretch, by bisection.

use iso_expr::Interval;

use super::line::Line;
use super::side::side;
use crate::Span;

/// More steps than bisection alone would need to pass all doubles.
const STEPS: u32 = 2100;

impl Line<'_> {
    /// Narrows `stretch`, on which F is strictly monotone and continuous and has a root, around that root: until it is
    /// no wider than `tolerance`, or until rounding hides on which side of a point the root lies.
    pub(super) fn enclose_root(&mut self, stretch: Span, tolerance: f64) -> Span {
        let mut root = stretch;
        for _ in 0..STEPS {
            let width = root.end - root.start;
            let slope = self.course(root).slope.interval;
            root = self.newton_step(root, slope);
            let stalled = root.end - root.start > 0.75 * width;
            if stalled || root.end - root.start <= tolerance {
                // The slope of a narrow stretch is all but a number: one more value gives all the digits there are.
                return self.newton_step(root, slope);
            }
        }
        root
    }

    /// The part of `root` that may hold the zero of F, which is monotone there with a derivative in `slope`.
    fn newton_step(&mut self, root: Span, slope: Interval) -> Span {
        let middle = root.start + 0.5 * (root.end - root.start);
        let value = self.value_at(middle);
        let Some(direction) = side(slope) else { return root };
        let newton = Interval::point(middle).minus(value.over(slope));
        let mut next = Span { start: root.start.max(newton.lo), end: root.end.min(newton.hi) };
        match side(value) {
            Some(height) if height == direction => next.end = next.end.min(middle),
            Some(_) => next.start = next.start.max(middle),
            None => {}
        }
        if next.start <= next.end { next } else { root }
    }

    /// A point of `stretch` where the slope, which has unlike signs at its ends, is zero or lost in rounding.
    pub(super) fn extremum(&mut self, stretch: Span) -> f64 {
        let Span { mut start, mut end } = stretch;
        let slope_at = |line: &mut Self, t| side(line.course(Span { start: t, end: t }).slope.interval);
        let before = slope_at(self, start);
        loop {
            let middle = start + 0.5 * (end - start);
            let here = slope_at(self, middle);
            if here.is_none() || middle <= start || middle >= end {
                return middle;
            }
            if here == before { start = middle } else { end = middle }
        }
    }
}
