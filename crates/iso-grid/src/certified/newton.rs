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
            let middle = middle_of(root);
            // Two boxes take no longer than one.
            let [over_all, at_middle, ..] = self.courses(&[root, Span { start: middle, end: middle }]);
            let slope = over_all.slope.interval;
            root = newton_step(root, (middle, at_middle.value.interval), slope);
            let stalled = root.end - root.start > 0.75 * width;
            if stalled || root.end - root.start <= tolerance {
                // The slope of a narrow stretch is all but a number: one more value gives all the digits there are.
                let middle = middle_of(root);
                return newton_step(root, (middle, self.value_at(middle)), slope);
            }
        }
        root
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

fn middle_of(root: Span) -> f64 {
    root.start + 0.5 * (root.end - root.start)
}

/// The part of `root` that may hold the zero of F, which is monotone there with a derivative in `slope` and in `value` at `middle`.
fn newton_step(root: Span, (middle, value): (f64, Interval), slope: Interval) -> Span {
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
