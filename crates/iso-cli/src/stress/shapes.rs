//! Surfaces that a ray meets where a closed form says.

use glam::DVec3;
use iso_grid::Ray;
use serde::Deserialize;

/// A surface whose points on a ray are known.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Shape {
    /// Centre x, y, z and radius.
    Sphere([f64; 4]),
    /// Centre x, y, z and half axes along x, y and z; with an infinite one it is a cylinder.
    Ellipsoid([f64; 6]),
    /// a, b, c, d of ax + by + cz = d.
    Plane([f64; 4]),
}

/// a, b, c, d of the points where ax + by + cz > d.
pub(crate) type HalfSpace = [f64; 4];

/// A point of a shape on a ray, as exactly as doubles tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// Where it is.
    pub(crate) t: f64,
    /// How far from there it may be.
    pub(crate) slack: f64,
    /// Whether it is certain that there is a crossing: a ray may pass a sphere by so closely that doubles cannot tell.
    pub(crate) is_certain: bool,
}

/// A few roundings, as part of the numbers that are rounded.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

impl Shape {
    /// The points of the shape on the line of a ray.
    pub(crate) fn crossings(&self, ray: &Ray) -> Vec<Crossing> {
        match *self {
            Self::Sphere([x, y, z, r]) => ellipsoid(ray, DVec3::new(x, y, z), DVec3::splat(r)),
            Self::Ellipsoid([x, y, z, a, b, c]) => ellipsoid(ray, DVec3::new(x, y, z), DVec3::new(a, b, c)),
            Self::Plane([a, b, c, d]) => plane(ray, [a, b, c, d]).into_iter().collect(),
        }
    }
}

/// In units of the half axes, with the point nearest to the centre as the origin, so that little cancels.
fn ellipsoid(ray: &Ray, center: DVec3, half_axes: DVec3) -> Vec<Crossing> {
    let (origin, direction) = ((ray.origin - center) / half_axes, ray.direction / half_axes);
    let speed = direction.length();
    let forward = direction / speed;
    let middle = -origin.dot(forward);
    let nearest = origin + middle * forward;
    let error = ROUNDINGS * (origin.length() + ((ray.origin.abs() + center.abs()) / half_axes).max_element());
    let (square, square_error) = (1.0 - nearest.length_squared(), 4.0 * error);
    if speed == 0.0 || square < -square_error {
        return Vec::new();
    }
    let half = square.max(0.0).sqrt();
    let slack = (error + square_error / half.max(square_error.sqrt())) / speed;
    let is_certain = square > square_error;
    [-half, half].map(|offset| Crossing { t: (middle + offset) / speed, slack, is_certain }).to_vec()
}

fn plane(ray: &Ray, [a, b, c, d]: [f64; 4]) -> Option<Crossing> {
    let normal = DVec3::new(a, b, c);
    let speed = normal.dot(ray.direction);
    let t = (d - normal.dot(ray.origin)) / speed;
    let error = ROUNDINGS * (d.abs() + normal.abs().dot(ray.origin.abs() + (t * ray.direction).abs()));
    let is_certain = speed.abs() > ROUNDINGS * normal.abs().dot(ray.direction.abs());
    t.is_finite().then_some(Crossing { t, slack: error / speed.abs(), is_certain })
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAY: Ray = Ray { origin: DVec3::new(-3.0, 0.0, 0.0), direction: DVec3::new(2.0, 0.0, 0.0) };

    fn places(shape: Shape, ray: &Ray) -> Vec<f64> {
        shape.crossings(ray).iter().map(|crossing| crossing.t).collect()
    }

    #[test]
    fn known_crossings() {
        assert_eq!(places(Shape::Sphere([0.0, 0.0, 0.0, 1.0]), &RAY), [1.0, 2.0]);
        assert_eq!(places(Shape::Ellipsoid([1.0, 0.0, 0.0, 2.0, f64::INFINITY, 1.0]), &RAY), [1.0, 3.0]);
        assert_eq!(places(Shape::Plane([1.0, 1.0, 0.0, 1.0]), &RAY), [2.0]);
        assert!(places(Shape::Plane([0.0, 1.0, 0.0, 1.0]), &RAY).is_empty());
        assert!(places(Shape::Sphere([0.0, 2.0, 0.0, 1.0]), &RAY).is_empty());
    }

    #[test]
    fn a_grazing_ray_is_not_certain() {
        let crossings = Shape::Sphere([0.0, 1.0, 0.0, 1.0]).crossings(&RAY);
        assert!(crossings.iter().all(|crossing| !crossing.is_certain), "{crossings:?}");
    }
}
