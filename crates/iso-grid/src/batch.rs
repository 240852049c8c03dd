//! Points, or boxes, gathered for one call of a kernel.

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BatchKernel, BoxKernel, Decorated, Decoration, Interval, Program, Scratch};

use crate::Ray;

/// Points coordinate by coordinate, and room for what a kernel says of them.
#[derive(Debug, Default)]
pub(crate) struct PointBatch {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    values: Vec<f64>,
}

impl PointBatch {
    pub(crate) fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
    }

    pub(crate) fn push(&mut self, point: DVec3) {
        self.x.push(point.x);
        self.y.push(point.y);
        self.z.push(point.z);
    }

    /// Adds the points of a ray at these places.
    pub(crate) fn push_along(&mut self, ray: &Ray, places: &[f64]) {
        let coordinates = [&mut self.x, &mut self.y, &mut self.z];
        for (axis, coordinates) in coordinates.into_iter().enumerate() {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            coordinates.extend(places.iter().map(|t| origin + t * direction));
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.x.len()
    }

    /// All `outputs` of the kernel at all points: output `k` at point `i` stands at `k·len + i`.
    pub(crate) fn evaluate(
        &mut self,
        kernel: &dyn BatchKernel,
        scratch: &mut Scratch,
        outputs: usize,
    ) -> &[f64] {
        self.values.resize(outputs * self.len(), f64::NAN);
        if self.len() > 0 {
            kernel.evaluate(scratch, &[&self.x, &self.y, &self.z], &mut self.values);
        }
        &self.values
    }
}

/// An affine form: the numbers middle + ∑ slopeᵢ·eᵢ + r for the same eᵢ from −1 to 1, and |r| ≤ rest. Nothing is known where a part is
/// not finite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Affine {
    pub(crate) middle: f64,
    pub(crate) slopes: DVec3,
    pub(crate) rest: f64,
}

impl Affine {
    #[inline]
    fn of([middle, a, b, c, rest]: [f64; Program::FORM]) -> Self {
        Self { middle, slopes: DVec3::new(a, b, c), rest }
    }
}

/// Sets of points, each by the affine forms of x, y and z, and what a kernel says of F and its derivatives there.
#[derive(Debug, Default)]
pub(crate) struct FormBatch {
    arguments: [Vec<f64>; 3 * Program::FORM],
    direction: [Vec<f64>; 3],
    found: Vec<f64>,
}

impl FormBatch {
    pub(crate) fn clear(&mut self) {
        self.arguments.iter_mut().for_each(Vec::clear);
    }

    pub(crate) fn push(&mut self, forms: &[Affine; 3]) {
        for (form, arguments) in forms.iter().zip(self.arguments.as_chunks_mut().0) {
            let [middle, a, b, c, rest]: &mut [Vec<f64>; Program::FORM] = arguments;
            middle.push(form.middle);
            a.push(form.slopes.x);
            b.push(form.slopes.y);
            c.push(form.slopes.z);
            rest.push(form.rest);
        }
    }

    fn len(&self) -> usize {
        self.arguments[0].len()
    }

    /// Finds the forms of F and its gradient by their kernel, or of F and its slope by one that takes the direction of all rays.
    pub(crate) fn evaluate(
        &mut self,
        kernel: &dyn BatchKernel,
        direction: Option<DVec3>,
        scratch: &mut Scratch,
    ) {
        let count = self.len();
        let outputs = if direction.is_some() { 2 } else { 4 };
        self.found.resize(outputs * Program::FORM * count, f64::NAN);
        if count == 0 {
            return;
        }
        for (component, axis) in self.direction.iter_mut().zip(0..3) {
            component.clear();
            component.resize(count, direction.map_or(0.0, |direction| direction[axis]));
        }
        let all: [&[f64]; Program::MOST_ARGUMENTS] =
            std::array::from_fn(|place| match self.arguments.get(place) {
                Some(argument) => &argument[..],
                None => &self.direction[place - self.arguments.len()],
            });
        let taken = if direction.is_some() { all.len() } else { self.arguments.len() };
        kernel.evaluate(scratch, &all[..taken], &mut self.found);
    }

    /// The forms of F and its derivatives on a set of points; `None` where nothing is known.
    pub(crate) fn found<const N: usize>(&self, number: usize) -> Option<[Affine; N]> {
        let count = self.len();
        let part = |form: usize, part: usize| self.found[(Program::FORM * form + part) * count + number];
        let forms: [[f64; Program::FORM]; N] =
            std::array::from_fn(|form| std::array::from_fn(|place| part(form, place)));
        // Whatever is not finite is not finite in the sum either.
        let is_known = forms.as_flattened().iter().map(|part| part.abs()).sum::<f64>().is_finite();
        is_known.then(|| forms.map(Affine::of))
    }
}

/// Boxes end by end, and what a kernel says of them: output `k` over box `i` of n stands at `k·n + i`.
#[derive(Debug, Default)]
pub(crate) struct BoxBatch {
    lo: [Vec<f64>; 3],
    hi: [Vec<f64>; 3],
    found_lo: Vec<f64>,
    found_hi: Vec<f64>,
    decoration: Vec<Decoration>,
}

impl BoxBatch {
    /// The boxes with these lower and upper corners, in place of all others.
    #[inline]
    pub(crate) fn replace(&mut self, corners: impl Iterator<Item = (DVec3, DVec3)>) {
        self.lo.iter_mut().chain(&mut self.hi).for_each(Vec::clear);
        for (lo, hi) in corners {
            for axis in 0..3 {
                self.lo[axis].push(lo[axis]);
                self.hi[axis].push(hi[axis]);
            }
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.lo[0].len()
    }

    /// Encloses all `outputs` of the kernel over all boxes.
    pub(crate) fn evaluate(&mut self, kernel: &dyn BoxKernel, scratch: &mut Scratch, outputs: usize) {
        let room = outputs * self.len();
        if self.decoration.len() < room {
            self.found_lo.resize(room, f64::NAN);
            self.found_hi.resize(room, f64::NAN);
            self.decoration.resize(room, Decoration::Trivial);
        }
        if room > 0 {
            let boxes = Boxes {
                lo: self.lo.each_ref().map(Vec::as_slice),
                hi: self.hi.each_ref().map(Vec::as_slice),
            };
            let enclosures = Enclosures {
                lo: &mut self.found_lo[..room],
                hi: &mut self.found_hi[..room],
                decoration: &mut self.decoration[..room],
            };
            kernel.evaluate(scratch, boxes, enclosures);
        }
    }

    /// What was found for an output over a box.
    pub(crate) fn interval(&self, output: usize, number: usize) -> Interval {
        let place = output * self.len() + number;
        Interval { lo: self.found_lo[place], hi: self.found_hi[place] }
    }

    /// The same with its decoration.
    pub(crate) fn decorated(&self, output: usize, number: usize) -> Decorated {
        let decoration = self.decoration[output * self.len() + number];
        Decorated { interval: self.interval(output, number), decoration }
    }
}
