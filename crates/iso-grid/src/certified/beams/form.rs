//! The mean value form of F over a stretch of a beam.

use glam::DVec3;
use iso_expr::interval::round_up;
use iso_expr::{Decorated, Decoration, Interval};

use super::bundle::Beam;
use crate::Span;

/// A few roundings, relative to what is rounded: more than any sum here takes.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Numbers no farther from `middle` than `radius`, rounding included. A NaN or an infinite radius says nothing, and every
/// comparison is written such that nothing follows from it.
///
/// Middle and radius are computed in doubles rounded to nearest, and the radius is enlarged by a bound of all roundings
/// (Rump, Fast and parallel interval arithmetic, BIT 39, 1999).
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) middle: f64,
    pub(super) radius: f64,
}

impl Ball {
    pub(super) fn around(interval: Interval) -> Self {
        Self { middle: interval.midpoint(), radius: interval.radius() }
    }

    pub(super) fn magnitude(self) -> f64 {
        (1.0 + ROUNDING) * (self.middle.abs() + self.radius)
    }

    /// Whether zero is certainly not one of the numbers.
    pub(super) fn excludes_zero(self) -> bool {
        self.middle.abs() > self.radius && self.radius < f64::INFINITY
    }

    /// The numbers as an interval.
    pub(super) fn interval(self) -> Interval {
        Interval::point(self.middle).minus(Interval { lo: -self.radius, hi: self.radius })
    }

    fn widened(self, by: f64) -> Self {
        Self { radius: (1.0 + ROUNDING) * (self.radius + by + ROUNDING * self.middle.abs()), ..self }
    }
}

/// All gradients of F over a box.
struct Gradient {
    middle: DVec3,
    radius: DVec3,
}

impl Gradient {
    fn new(partials: [Interval; 3]) -> Self {
        let balls = partials.map(Ball::around);
        Self {
            middle: DVec3::from_array(balls.map(|ball| ball.middle)),
            radius: DVec3::from_array(balls.map(|ball| ball.radius)),
        }
    }

    /// The products with `vector`.
    fn along(&self, vector: DVec3) -> Ball {
        let size = vector.abs();
        let rounding = ROUNDING * self.middle.abs().dot(size) + f64::MIN_POSITIVE;
        Ball {
            middle: self.middle.dot(vector),
            radius: (1.0 + ROUNDING) * (self.radius.dot(size) + rounding),
        }
    }

    /// How large products with vectors no longer than `size`, component by component, may be.
    fn magnitude_along(&self, size: DVec3) -> f64 {
        (1.0 + ROUNDING) * (self.middle.abs() + self.radius).dot(size) + f64::MIN_POSITIVE
    }
}

/// F near a point of a beam: for the ray that is a columns and b rows off its middle, and for every t of the stretch,
/// F = `value` + a·`by_column` + b·`by_row` + (t − `t`)·`slope` up to `rest`, for some numbers of these balls.
///
/// This is the mean value theorem: F is continuous on a convex set that holds the points, and its generalised gradients
/// there are enclosed (Neumaier, Interval Methods for Systems of Equations, 1990, section 2.3).
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) t: f64,
    pub(super) value: Ball,
    pub(super) by_column: Ball,
    pub(super) by_row: Ball,
    /// The derivative of F along every ray of the beam.
    pub(super) slope: Ball,
    /// What no sum of columns, rows and the rest exceeds.
    across: f64,
    /// The stretch on which it holds.
    pub(super) reach: Span,
}

impl Form {
    /// The form around `center`, a point of the convex set over which `course` was enclosed, where `value` encloses F. `None`
    /// when the mean value theorem does not hold.
    pub(super) fn new(
        beam: &Beam,
        reach: Span,
        center: DVec3,
        value: Interval,
        course: [Decorated; 4],
    ) -> Option<Self> {
        let [over_all, partials @ ..] = course;
        let is_smooth = over_all.decoration >= Decoration::Continuous
            && partials.iter().all(|partial| partial.decoration >= Decoration::Defined);
        if !is_smooth {
            return None;
        }
        let gradient = Gradient::new(partials.map(|partial| partial.interval));
        let t = 0.5 * (reach.start + reach.end);
        let (o, d) = (&beam.origins, &beam.directions);
        let [column_radius, row_radius] = beam.radii;
        // From the center to the point at `t` on a ray: `shift` + a·column + b·row, and the rest.
        let [column, row] = beam.across(t);
        let shift = (o.middle - center) + t * d.middle;
        let size = |spread: &super::bundle::Spread| spread.middle.abs() + spread.radius;
        let rounding = ROUNDING * (size(o) + t * size(d) + center.abs());
        let rest = gradient.magnitude_along(o.rest + t * d.rest + rounding);

        let [by_column, by_row, offset] = [column, row, shift].map(|vector| gradient.along(vector));
        let value = Ball::around(value);
        let spread = gradient.magnitude_along(d.radius);
        let across = by_column.magnitude() * column_radius + by_row.magnitude() * row_radius + rest;
        let form = Self {
            t,
            value: Ball { middle: value.middle + offset.middle, ..value }.widened(offset.radius),
            by_column,
            by_row,
            slope: gradient.along(d.middle).widened(spread),
            across: (1.0 + ROUNDING) * across,
            reach,
        };
        let is_finite =
            [form.value.radius, form.slope.radius, form.across].iter().all(|radius| radius.is_finite());
        is_finite.then_some(form)
    }

    /// Whether F is certainly nowhere zero.
    pub(super) fn excludes_zero(&self) -> bool {
        let along = round_up(self.reach.end - self.t).max(round_up(self.t - self.reach.start));
        self.value.widened(self.across + self.slope.magnitude() * along).excludes_zero()
    }

    /// Whether F certainly rises along every ray, or falls along every ray.
    pub(super) fn is_monotone(&self) -> bool {
        self.slope.excludes_zero()
    }

    /// How far the slope is from that of its middle, as part of it.
    pub(super) fn unevenness(&self) -> f64 {
        self.slope.radius / self.slope.middle.abs()
    }

    /// Where all roots lie, if F is monotone.
    pub(super) fn roots(&self) -> Interval {
        let value = self.value.widened(self.across).interval();
        Interval::point(self.t).minus(value.over(self.slope.interval()))
    }

    /// About where the root is on the ray that is `across` columns and `along` rows off the middle.
    pub(super) fn estimate(&self, across: f64, along: f64) -> f64 {
        let value = self.value.middle + across * self.by_column.middle + along * self.by_row.middle;
        self.t - value / self.slope.middle
    }
}
