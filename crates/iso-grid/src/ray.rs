//! Rays and stretches of them.

use glam::DVec3;

/// The points `origin + t·direction`. The direction may have any length but zero; t is in units of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ray {
    /// Where t = 0.
    pub origin: DVec3,
    /// How far the point moves as t grows by 1.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// A stretch of a ray, from `start` to `end`, both included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Span {
    /// The smallest t.
    pub start: f64,
    /// The largest t, not below `start`.
    pub end: f64,
}
