//! The one simple root of a stretch, by the interval Newton method, and the extremum of a stretch, by bisection.

use iso_expr::Interval;

use super::line::Line;
use super::side::side;
use crate::roots::{Bracket, Narrowing};
use crate::{RootFinder, RootFinding, Span};

/// More steps than bisection alone would need to pass all doubles.
const STEPS: u32 = 2100;

impl Line<'_> {
    /// Narrows `stretch`, on which F is strictly monotone and continuous and has a root, around that root: until it is
    /// no wider than `tolerance`, or until rounding hides on which side of a point the root lies.
    pub(super) fn enclose_root(&mut self, stretch: Span, tolerance: f64) -> Span {
        let mut root = self.narrowed_by_doubles(stretch, tolerance);
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

    /// A part of `stretch` no longer than `tolerance` around where doubles have its root, if F certainly has unlike signs at both ends; else all of
    /// it.
    fn narrowed_by_doubles(&mut self, stretch: Span, tolerance: f64) -> Span {
        let tolerance = tolerance.max(0.0);
        let root = self.likely_root(stretch, tolerance);
        let start = (root - 0.5 * tolerance).max(stretch.start);
        let end = (root + 0.5 * tolerance).min(stretch.end);
        let [before, after, ..] = self.values(&[start, end].map(|t| Span { start: t, end: t }));
        let [before, after] = [before, after].map(|value| side(value.interval));
        let is_there = before.is_some() && after.is_some() && before != after;
        if is_there { Span { start, end } } else { stretch }
    }

    /// About where F is zero in `stretch`, at whose ends it has unlike signs, by its values in doubles: nothing is proven of it.
    fn likely_root(&mut self, stretch: Span, tolerance: f64) -> f64 {
        let [before, after] = self.samples([stretch.start, stretch.end]);
        let roots = RootFinding { finder: RootFinder::Itp, tolerance: tolerance / stretch.end };
        let mut narrowing = Narrowing::new(roots, Bracket { before, after });
        while let Some(t) = narrowing.next() {
            let [sample] = self.samples([t]);
            if !narrowing.take(sample, f64::NAN) {
                break;
            }
        }
        narrowing.bracket().secant()
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

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use iso_expr::Scratch;

    use super::*;
    use crate::Ray;
    use crate::certified::kernels::Kernels;
    use crate::testing::surface_of;

    /// What encloses the root of a formula between two places on the x axis, and how many boxes that took.
    fn enclosed(formula: &str, [start, end]: [f64; 2], tolerance: f64) -> (Span, u64) {
        let kernels = &Kernels::of(&surface_of(formula)).unwrap();
        let (ray, scratch) = (Ray { origin: DVec3::ZERO, direction: DVec3::X }, &mut Scratch::default());
        let (local, asked) = (kernels, kernels);
        let mut line = Line { kernels, local, asked, scratch, ray, evaluations: 0, points: 0, operations: 0 };
        (line.enclose_root(Span { start, end }, tolerance), line.evaluations)
    }

    #[test]
    fn a_root_is_enclosed_around_where_doubles_have_it() {
        for (formula, ends, root) in [
            ("exp(x) - 5", [1.0, 2.0], 1.609_437_912_434_100_3),
            ("tanh(200(x - 1.25))", [1.0, 2.0], 1.25),
            ("x^9 - 0.001953125", [0.1, 1.1], 0.5),
            ("1/x - 4", [0.1, 1.0], 0.25),
            // It overflows at one end.
            ("exp(800(x - 0.5)) - 1", [0.25, 1.75], 0.5),
        ] {
            let (bracket, evaluations) = enclosed(formula, ends, 1e-12);
            assert!(bracket.start <= root && root <= bracket.end, "{formula}: {bracket:?}");
            assert!(bracket.end - bracket.start <= 1e-14, "{formula}: {bracket:?}");
            assert!(evaluations <= 5, "{formula}: {evaluations} boxes");
        }
    }

    /// As where nothing is wanted but what roundings leave, or those hide F farther than is wanted.
    #[test]
    fn a_root_that_doubles_do_not_tell_is_enclosed_all_the_same() {
        for (formula, ends, root, tolerance, most) in [
            ("exp(x) - 5", [1.0, 2.0], 1.609_437_912_434_100_3, 0.0, 1e-14),
            ("(1e8 + x) - (1e8 + 1.5)", [1.0, 2.0], 1.5, 1e-12, 1e-7),
        ] {
            let (bracket, evaluations) = enclosed(formula, ends, tolerance);
            assert!(bracket.start <= root && root <= bracket.end, "{formula}: {bracket:?}");
            assert!(bracket.end - bracket.start <= most, "{formula}: {bracket:?}");
            assert!(evaluations > 5, "{formula}: {evaluations} boxes");
        }
    }
}
