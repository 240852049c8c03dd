//! F along one ray: a function of t, enclosed over stretches of the ray.

use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decorated, Decoration, Interval, Scratch};

use super::classify::free_of_zero;
use super::kernels::{BATCH, Bounds, Jet, Kernels, NOTHING_KNOWN};
use crate::roots::Sample;
use crate::{Kernel, Ray, Span};

/// F along a ray. All enclosures hold for every real t of a stretch and every point o + t·d exactly.
pub(super) struct Line<'a> {
    pub(super) kernels: &'a Kernels,
    /// Kernels that hold on a part of the ray.
    pub(super) local: &'a Kernels,
    /// Those of the two that are asked: all that is concluded from several enclosures is concluded of one function.
    pub(super) asked: &'a Kernels,
    pub(super) scratch: &'a mut Scratch,
    pub(super) ray: Ray,
    /// How many boxes were enclosed along this ray.
    pub(super) evaluations: u64,
    /// At how many points F was computed in doubles.
    pub(super) points: u64,
    /// How many operations all that took.
    pub(super) operations: u64,
}

/// F over a stretch of the ray, and its derivative by t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) value: Decorated,
    /// The derivative, and at kinks all generalised ones; it says nothing unless it is defined.
    pub(super) slope: Decorated,
}

impl<'a> Line<'a> {
    /// From now on asks the shortest kernels that hold on a stretch, on which all is to lie until this is called again.
    pub(super) fn enter(&mut self, stretch: Span) {
        self.asked = if self.local.cover(&self.bounds(stretch)) { self.local } else { self.kernels };
    }

    /// Encloses F over each of the stretches; what stands behind their number means nothing.
    pub(super) fn values(&mut self, stretches: &[Span]) -> [Decorated; BATCH] {
        self.evaluations += stretches.len() as u64;
        let boxes = self.boxes(stretches);
        let boxes = &boxes[..stretches.len()];
        self.operations += self.asked.charge(Kernel::ValueEnclosures, boxes.len());
        self.asked.enclosures(self.scratch, boxes)
    }

    /// Encloses F at `t`.
    pub(super) fn value_at(&mut self, t: f64) -> Interval {
        self.values(&[Span { start: t, end: t }])[0].interval
    }

    /// F at the places `ts`, in doubles.
    pub(super) fn samples<const N: usize>(&mut self, ts: [f64; N]) -> [Sample; N] {
        self.points += N as u64;
        self.operations += self.asked.charge(Kernel::Values, N);
        let mut values = [0.0; N];
        let points = ts.map(|t| self.ray.at(t));
        let [x, y, z] = [0, 1, 2].map(|axis| points.map(|point| point[axis]));
        self.asked.over_points(Kernel::Values).evaluate(self.scratch, &[&x, &y, &z], &mut values);
        std::array::from_fn(|place| Sample { t: ts[place], value: values[place] })
    }

    /// The first of some places at which F may be zero.
    pub(super) fn first_contact(&mut self, ts: &[f64]) -> Option<f64> {
        ts.iter().copied().find(|t| !free_of_zero(self.value_at(*t)))
    }

    /// Encloses F and its gradient at the points of doubles that computing o + t·d gives, one for each `t`; what stands behind their number means
    /// nothing. A point of the ray itself is known up to roundings only, and there a quotient of tiny numbers, as z/z, seems to take many values.
    pub(super) fn jets_beside(&mut self, ts: &[f64]) -> [Jet; BATCH] {
        self.evaluations += ts.len() as u64;
        let mut boxes = [[Interval::EMPTY; 3]; BATCH];
        for (bounds, t) in boxes.iter_mut().zip(ts) {
            *bounds = self.ray.at(*t).to_array().map(Interval::point);
        }
        self.jets(&boxes[..ts.len()])
    }

    /// Encloses F and its slope over each of the stretches; what stands behind their number means nothing.
    pub(super) fn courses(&mut self, stretches: &[Span]) -> [Course; BATCH] {
        self.evaluations += stretches.len() as u64;
        let boxes = self.boxes(stretches);
        let jets = self.jets(&boxes[..stretches.len()]);
        let mut courses = [Course { value: NOTHING_KNOWN, slope: NOTHING_KNOWN }; BATCH];
        for (course, Jet { value, gradient }) in courses.iter_mut().zip(jets).take(stretches.len()) {
            *course = Course { value, slope: self.slope(gradient) };
        }
        courses
    }

    /// Encloses F and its slope over a stretch.
    pub(super) fn course(&mut self, stretch: Span) -> Course {
        self.evaluations += 1;
        let [Jet { value, gradient }, ..] = self.jets(&[self.bounds(stretch)]);
        Course { value, slope: self.slope(gradient) }
    }

    fn jets(&mut self, boxes: &[Bounds]) -> [Jet; BATCH] {
        self.operations += self.asked.charge(Kernel::GradientEnclosures, boxes.len());
        self.asked.jets(self.scratch, boxes)
    }

    /// The box around a stretch of the ray.
    pub(super) fn bounds(&self, stretch: Span) -> Bounds {
        bounds_along(&self.ray, stretch)
    }

    fn boxes(&self, stretches: &[Span]) -> [Bounds; BATCH] {
        let mut boxes = [[Interval::EMPTY; 3]; BATCH];
        for (bounds, stretch) in boxes.iter_mut().zip(stretches) {
            *bounds = self.bounds(*stretch);
        }
        boxes
    }

    /// ∇F·d. Derivatives across the ray do not matter, not even whether they exist.
    fn slope(&self, gradient: [Decorated; 3]) -> Decorated {
        let mut slope = Decorated { interval: Interval::point(0.0), decoration: Decoration::Common };
        for (axis, partial) in gradient.into_iter().enumerate() {
            let direction = self.ray.direction[axis];
            if direction != 0.0 {
                slope.interval = slope.interval.plus(scaled(partial.interval, direction));
                slope.decoration = slope.decoration.min(partial.decoration);
            }
        }
        slope
    }
}

/// The box around a stretch of a ray.
pub(super) fn bounds_along(ray: &Ray, stretch: Span) -> Bounds {
    [0, 1, 2].map(|axis| {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction == 0.0 {
            return Interval::point(origin);
        }
        let (near, far) =
            if direction > 0.0 { (stretch.start, stretch.end) } else { (stretch.end, stretch.start) };
        Interval {
            lo: round_down(origin + round_down(near * direction)),
            hi: round_up(origin + round_up(far * direction)),
        }
    })
}

/// Encloses the products of the finite `factor`, which is not zero, and the numbers of `interval`.
fn scaled(interval: Interval, factor: f64) -> Interval {
    let (a, b) = (interval.lo * factor, interval.hi * factor);
    if factor > 0.0 {
        Interval { lo: round_down(a), hi: round_up(b) }
    } else {
        Interval { lo: round_down(b), hi: round_up(a) }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use iso_expr::{Ast, Interpreter};

    use super::*;
    use crate::Surface;
    use crate::certified::formula::Formulas;

    /// Where y is positive x is left of a minimum, which has its sign but not its values.
    #[test]
    fn a_stretch_that_leaves_a_place_is_judged_by_the_whole_formula_all_along() {
        let formula = Ast::parse("min(x, y)").unwrap().lower(&[]).unwrap();
        let surface = Surface::new(Arc::new(Interpreter), formula.program().simplified());
        let whole = Kernels::of(&surface).unwrap();
        let place = [(-4.0, 4.0), (0.5, 1.5), (-1.0, 1.0)].map(|(lo, hi)| Interval { lo, hi });
        let local = whole.shortened(&Formulas::default(), place).unwrap();
        let ray = Ray { origin: DVec3::Y, direction: DVec3::X };
        let scratch = &mut Scratch::default();
        let (kernels, asked) = (&whole, &whole);
        let mut line =
            Line { kernels, local: &local, asked, scratch, ray, evaluations: 0, points: 0, operations: 0 };
        for (end, expected) in [(3.0, 2.0), (5.0, 1.0), (3.5, 2.0)] {
            line.enter(Span { start: 0.0, end });
            let found = [line.value_at(2.0), line.course(Span { start: 2.0, end: 2.0 }).value.interval];
            assert!(found.iter().all(|value| value.contains(expected)), "up to {end}: {found:?}");
            assert!(found.iter().all(|value| value.width() < 0.5), "up to {end}: {found:?}");
        }
    }
}
