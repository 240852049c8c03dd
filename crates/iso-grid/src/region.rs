//! The box in which the surface is looked for.

use glam::DVec3;
use thiserror::Error;

use crate::{Ray, Span};

/// An axis-parallel box with finite ends and a positive extent along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

/// Why two corners make no [`Region`].
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum RegionError {
    /// An end is infinite or NaN, or the extent overflows.
    #[error(
        "the box must have finite ends and a finite length along {axis}, but runs from {from:?} to {to:?}"
    )]
    NotFinite {
        /// The axis's name.
        axis: char,
        /// Its lower end as given.
        from: f64,
        /// Its upper end as given.
        to: f64,
    },
    /// An upper end does not lie above its lower end.
    #[error("the box must end above where it begins along {axis}, but runs from {from:?} to {to:?}")]
    Empty {
        /// The axis's name.
        axis: char,
        /// Its lower end as given.
        from: f64,
        /// Its upper end as given.
        to: f64,
    },
}

impl Region {
    /// The box from `min` to `max`.
    ///
    /// # Errors
    /// When an end is not finite or the box has no extent along an axis.
    pub fn new(min: DVec3, max: DVec3) -> Result<Self, RegionError> {
        for (axis, from, to) in [('x', min.x, max.x), ('y', min.y, max.y), ('z', min.z, max.z)] {
            if !(from.is_finite() && to.is_finite() && (to - from).is_finite()) {
                return Err(RegionError::NotFinite { axis, from, to });
            }
            if from >= to {
                return Err(RegionError::Empty { axis, from, to });
            }
        }
        Ok(Self { min, max })
    }

    /// The corner with the smallest coordinates.
    pub fn min(&self) -> DVec3 {
        self.min
    }

    /// The corner with the largest coordinates.
    pub fn max(&self) -> DVec3 {
        self.max
    }

    /// The least box that holds this one and `other`.
    ///
    /// # Errors
    /// When its extent overflows.
    pub fn hull(&self, other: &Self) -> Result<Self, RegionError> {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// The middle.
    pub fn center(&self) -> DVec3 {
        self.min + 0.5 * self.extent()
    }

    /// The lengths of the sides.
    pub fn extent(&self) -> DVec3 {
        self.max - self.min
    }

    /// The part of `ray` with t ≥ 0 inside the box, by the slab method (Kay and Kajiya 1986), in doubles rounded to
    /// nearest. `None` when the ray misses the box or only touches it, and when a component of it is infinite or NaN.
    pub fn clip(&self, ray: &Ray) -> Option<Span> {
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        // A ray may be too slow to leave the box at any double.
        let (mut start, mut end) = (0.0_f64, f64::MAX);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let (lo, hi) = (self.min[axis], self.max[axis]);
            if direction == 0.0 {
                if !(lo <= origin && origin <= hi) {
                    return None;
                }
                continue;
            }
            let (a, b) = ((lo - origin) / direction, (hi - origin) / direction);
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        (start < end && ray.direction != DVec3::ZERO).then_some(Span { start, end })
    }
}
