//! Points gathered for one call of a kernel.

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch, engine::Points};

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
            kernel.evaluate(scratch, Points { x: &self.x, y: &self.y, z: &self.z }, &mut self.values);
        }
        &self.values
    }
}
