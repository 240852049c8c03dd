//! The part of a ray inside the region, with its ends enclosed.

use glam::DVec3;
use iso_expr::interval::{round_down, round_up};

use crate::{Ray, Region, Span};

/// The part of a ray with t ≥ 0 inside the region, whose ends are quotients that no double may equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clip {
    /// Holds all of it.
    pub(super) outer: Span,
    /// Lies inside it; it ends before it starts where the part is a few roundings long.
    pub(super) inner: Span,
}

impl Clip {
    /// The slab method (Kay and Kajiya 1986) with quotients rounded outwards. `None` when the ray certainly misses the
    /// region, or is no ray since it stands still or has an end that is not finite.
    pub(super) fn new(region: &Region, ray: &Ray) -> Option<Self> {
        if !(ray.origin.is_finite() && ray.direction.is_finite()) || ray.direction == DVec3::ZERO {
            return None;
        }
        // No double is larger, although the region may reach farther.
        let mut outer = Span { start: 0.0, end: f64::MAX };
        let mut inner = outer;
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let (lo, hi) = (region.min()[axis], region.max()[axis]);
            if direction == 0.0 {
                if !(lo <= origin && origin <= hi) {
                    return None;
                }
                continue;
            }
            let (near, far) = if direction > 0.0 { (lo, hi) } else { (hi, lo) };
            let (entry, exit) = (crossing(near, origin, direction), crossing(far, origin, direction));
            outer = Span { start: outer.start.max(entry.start), end: outer.end.min(exit.end) };
            inner = Span { start: inner.start.max(entry.end), end: inner.end.min(exit.start) };
        }
        (outer.start <= outer.end).then_some(Self { outer, inner })
    }
}

/// Encloses (face − origin) / direction.
fn crossing(face: f64, origin: f64, direction: f64) -> Span {
    if face == origin {
        return Span { start: 0.0, end: 0.0 };
    }
    let distance = face - origin;
    let (a, b) = (round_down(distance) / direction, round_up(distance) / direction);
    Span { start: round_down(a.min(b)), end: round_up(a.max(b)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(origin: [f64; 3], direction: [f64; 3]) -> Option<Clip> {
        let region = Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        Clip::new(&region, &Ray { origin: origin.into(), direction: direction.into() })
    }

    #[test]
    fn ends_are_enclosed() {
        // From −2 at 0.7 a second, the box is entered at 1/0.7 and left at 3/0.7, which are no doubles.
        let Clip { outer, inner } = clip([-2.0, 0.1, 0.2], [0.7, 0.0, 0.0]).unwrap();
        for (end, quotient) in [(outer.start, 1.0 / 0.7), (inner.start, 1.0 / 0.7), (outer.end, 3.0 / 0.7)] {
            assert!((end - quotient).abs() < 1e-14, "{end} is not {quotient}");
        }
        assert!(outer.start < inner.start && inner.end < outer.end);
    }

    #[test]
    fn a_ray_begins_at_its_origin() {
        let Clip { outer, inner } = clip([0.5, 0.0, 0.0], [1.0, 0.0, 0.0]).unwrap();
        assert_eq!((outer.start, inner.start), (0.0, 0.0));
        assert!(inner.end <= 0.5 && 0.5 <= outer.end);
    }

    #[test]
    fn rays_past_the_region_miss_it() {
        assert_eq!(clip([-2.0, 1.1, 0.0], [1.0, 0.0, 0.0]), None);
        assert_eq!(clip([2.0, 0.0, 0.0], [1.0, 0.0, 0.0]), None);
        assert_eq!(clip([-3.0, 0.0, 0.0], [1.0, 1.0, 0.0]), None);
        assert_eq!(clip([0.0; 3], [0.0; 3]), None);
        assert_eq!(clip([f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0]), None);
    }

    /// It leaves the region after more units of time than any double counts.
    #[test]
    fn a_ray_may_be_too_slow_to_leave_the_region() {
        let Clip { outer, inner } = clip([-2.0, 0.1, 0.1], [1e-308, 0.0, 0.0]).unwrap();
        assert!(outer.start <= 1e308 && 1e308 <= inner.start, "{outer:?}, {inner:?}");
        assert_eq!((outer.end, inner.end), (f64::MAX, f64::MAX));
    }

    #[test]
    fn a_ray_along_a_face_is_in_the_region() {
        assert!(clip([-2.0, 1.0, 0.0], [1.0, 0.0, 0.0]).is_some());
    }
}
