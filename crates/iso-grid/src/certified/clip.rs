//! The part of a ray inside the region, with its ends enclosed.

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
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let mut outer = Span { start: 0.0, end: f64::INFINITY };
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
        (outer.start <= outer.end && outer.end.is_finite()).then_some(Self { outer, inner })
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
