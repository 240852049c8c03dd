//! The one simple root of a stretch, by the interval Newton method, and the extremum of a stretch, by bisection.

use iso_expr::Interval;

use super::line::Line;
use super::side::{Side, side};
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
            if width <= tolerance {
                break;
            }
            let slope = self.course(root).slope.interval;
            let middle = root.start + 0.5 * width;
            let value = self.value_at(middle);
            root = newton_step(root, middle, value, slope);
            let stalled = root.end - root.start > 0.75 * width;
            if stalled {
                break;
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

/// The part of `root` that may hold the zero of a monotone function: `value` encloses it at `middle`, `slope` its
/// derivative over all of `root`.
fn newton_step(root: Span, middle: f64, value: Interval, slope: Interval) -> Span {
    let Some(direction) = side(slope) else { return root };
    let newton = Interval::point(middle).minus(value.over(slope));
    let mut next = Span { start: root.start.max(newton.lo), end: root.end.min(newton.hi) };
    match side(value) {
        Some(Side::Above) if direction == Side::Above => next.end = next.end.min(middle),
        Some(Side::Below) if direction == Side::Below => next.end = next.end.min(middle),
        Some(_) => next.start = next.start.max(middle),
        None => {}
    }
    if next.start <= next.end { next } else { root }
}
