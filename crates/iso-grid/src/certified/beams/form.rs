//! What F is over a stretch of a beam: the mean value form, or an affine one.

use glam::DVec3;
use iso_expr::interval::round_up;
use iso_expr::{Decorated, Decoration, Interval};

use super::beam::Beam;
use super::spread::Spread;
use crate::Span;
use crate::area::Area;
use crate::batch::Affine;

/// A few roundings, relative to what is rounded: more than any sum here takes.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// F counts as constant where it changes so many times less than what is not known of it.
const FLAT: f64 = 8.0;

/// How far slopes are from their middle at most when they are much alike, as part of it.
const UNEVEN: f64 = 0.6;

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
        let (lo, hi) = (0.5 * interval.lo, 0.5 * interval.hi);
        Self { middle: lo + hi, radius: hi - lo }.widened(f64::MIN_POSITIVE)
    }

    /// The numbers of an affine form.
    pub(super) fn of(form: &Affine) -> Self {
        let radius = form.slopes.abs().element_sum() + form.rest;
        Self { middle: form.middle, radius }.widened(f64::MIN_POSITIVE)
    }

    pub(super) fn magnitude(self) -> f64 {
        (1.0 + ROUNDING) * (self.middle.abs() + self.radius)
    }

    /// Whether zero is certainly not one of the numbers.
    pub(super) fn excludes_zero(self) -> bool {
        self.middle.abs() > self.radius && self.radius < f64::INFINITY
    }

    /// Whether the numbers are much alike, as slopes are by which rays can be followed each for its own.
    fn is_even(self) -> bool {
        self.radius < UNEVEN * self.middle.abs()
    }

    /// The numbers as an interval.
    pub(super) fn interval(self) -> Interval {
        Interval::point(self.middle).minus(Interval { lo: -self.radius, hi: self.radius })
    }

    fn widened(self, by: f64) -> Self {
        Self { radius: (1.0 + ROUNDING) * (self.radius + by + ROUNDING * self.middle.abs()), ..self }
    }
}

/// The products of vectors, whose components are numbers of affine forms, and the directions of a beam.
pub(super) fn along(directions: &Spread, gradient: &[Affine]) -> Affine {
    let direction = directions.middle.to_array();
    let (mut middle, mut slopes, mut rest, mut size) = (0.0, DVec3::ZERO, 0.0, 0.0);
    for (axis, partial) in gradient.iter().enumerate() {
        middle += direction[axis] * partial.middle;
        slopes += direction[axis] * partial.slopes;
        rest += direction[axis].abs() * partial.rest;
        let magnitude = partial.middle.abs() + partial.slopes.abs().element_sum() + partial.rest;
        rest += directions.radius[axis] * magnitude;
        size += direction[axis].abs() * magnitude;
    }
    Affine { middle, slopes, rest: rest + ROUNDING * size }
}

/// All gradients of F over a box, or over several: vectors no farther from `middle` than `radius`, component by component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient {
    lo: DVec3,
    hi: DVec3,
    middle: DVec3,
    radius: DVec3,
}

impl Gradient {
    /// `None` when the mean value theorem does not hold over a box with this `course`: F and its derivatives.
    pub(super) fn new([over_all, partials @ ..]: [Decorated; 4]) -> Option<Self> {
        let is_smooth = over_all.decoration >= Decoration::Continuous
            && partials.iter().all(|partial| partial.decoration >= Decoration::Defined);
        let lo = DVec3::from_array(partials.map(|partial| partial.interval.lo));
        let hi = DVec3::from_array(partials.map(|partial| partial.interval.hi));
        is_smooth.then(|| Self::between(lo, hi))
    }

    fn between(lo: DVec3, hi: DVec3) -> Self {
        let (half_lo, half_hi) = (0.5 * lo, 0.5 * hi);
        let (middle, radius) = (half_lo + half_hi, half_hi - half_lo);
        // Enough for the products, too.
        let rounding = 4.0 * ROUNDING * (middle.abs() + radius) + DVec3::splat(f64::MIN_POSITIVE);
        Self { lo, hi, middle, radius: radius + rounding }
    }

    /// The gradients of both.
    pub(super) fn hull(&self, other: &Self) -> Self {
        Self::between(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// The products with `vector`.
    fn along(&self, vector: DVec3) -> Ball {
        Ball { middle: self.middle.dot(vector), radius: self.radius.dot(vector.abs()) + f64::MIN_POSITIVE }
    }

    /// How large products with vectors no longer than `size`, component by component, may be.
    fn magnitude_along(&self, size: DVec3) -> f64 {
        (self.middle.abs() + self.radius).dot(size) + f64::MIN_POSITIVE
    }
}

/// F near a point of a beam: for the ray that is a columns and b rows off its middle, and for every t of the stretch,
/// F = `value` + a·`by_column` + b·`by_row` + (t − `t`)·`incline` up to `rest`, for some numbers of the balls; and F is continuous.
///
/// Either this is an affine form of F, or the mean value theorem: F is continuous on a convex set that holds the points, and its
/// generalised gradients there are enclosed (Neumaier, Interval Methods for Systems of Equations, 1990, section 2.3).
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    t: f64,
    value: Ball,
    by_column: f64,
    by_row: f64,
    incline: Ball,
    /// The derivative of F along every ray of the beam.
    pub(super) slope: Ball,
    /// How the slope changes with column and row, 0 where that is not known.
    slope_across: [f64; 2],
    /// How the slope changes with t, likewise.
    pub(super) turn: f64,
    /// How far slopes may be from changing evenly with column, row and t, about.
    pub(super) sway: f64,
    /// What no sum of columns, rows and the rest exceeds.
    across: f64,
    /// The stretch on which it holds.
    pub(super) reach: Span,
}

impl Form {
    /// The form around `center`, near to where the middle of the beam is at `t`, where `value` encloses F. The point and the
    /// stretch `reach` of the beam lie in a convex set on which `gradient` holds.
    pub(super) fn new(
        beam: &Beam,
        reach: Span,
        (t, center): (f64, DVec3),
        value: Interval,
        gradient: &Gradient,
    ) -> Self {
        let (o, d) = (&beam.origins, &beam.directions);
        let [column_radius, row_radius] = beam.radii;
        // From the center to the point at `t` on a ray: `shift` + a·column + b·row, and the rest.
        let [column, row] = beam.across(t);
        let shift = (o.middle - center) + t * d.middle;
        let rounding = ROUNDING * (o.size + t * d.size + center.abs());
        let rest = gradient.magnitude_along(o.rest + t * d.rest + rounding);
        let [by_column, by_row, offset] = [column, row, shift].map(|vector| gradient.along(vector));
        let value = Ball::around(value);
        let vague = by_column.radius * column_radius + by_row.radius * row_radius + rest;
        let known = by_column.middle.abs() * column_radius + by_row.middle.abs() * row_radius;
        let slope = gradient.along(d.middle).widened(gradient.magnitude_along(d.radius));
        let form = Self {
            t,
            value: Ball { middle: value.middle + offset.middle, ..value }.widened(offset.radius),
            by_column: by_column.middle,
            by_row: by_row.middle,
            incline: slope,
            slope,
            slope_across: [0.0; 2],
            turn: 0.0,
            sway: slope.radius,
            across: (1.0 + ROUNDING) * (known + vague),
            reach,
        };
        form.if_finite()
    }

    /// What the affine form of F says, which holds for the [forms](Beam::forms) of a stretch `reach` of the beam around `t`, in a unit
    /// of t, with that of the derivative of F along all rays.
    pub(super) fn affine(
        beam: &Beam,
        reach: Span,
        (t, unit): (f64, f64),
        value: &Affine,
        slope: &Affine,
    ) -> Self {
        // A beam of one column has no other.
        let each = |slope: f64, radius: f64| if radius > 0.0 { slope / radius } else { 0.0 };
        let across = value.slopes.x.abs() + value.slopes.y.abs();
        let form = Self {
            t,
            value: Ball { middle: value.middle, radius: value.rest }
                .widened(ROUNDING * across + f64::MIN_POSITIVE),
            by_column: each(value.slopes.x, beam.radii[0]),
            by_row: each(value.slopes.y, beam.radii[1]),
            // The quotient may underflow, and then is multiplied by as much as the stretch is long.
            incline: Ball { middle: value.slopes.z / unit, radius: 0.0 }.widened(f64::MIN_POSITIVE),
            slope: Ball::of(slope),
            slope_across: [each(slope.slopes.x, beam.radii[0]), each(slope.slopes.y, beam.radii[1])],
            turn: slope.slopes.z / unit,
            sway: slope.rest,
            across: (1.0 + ROUNDING) * across,
            reach,
        };
        form.if_finite()
    }

    fn if_finite(self) -> Self {
        let radii = [self.value.radius, self.incline.radius, self.slope.radius, self.across];
        if radii.iter().all(|radius| radius.is_finite()) { self } else { Self::unknown(self.reach) }
    }

    /// A form that says nothing.
    pub(super) fn unknown(reach: Span) -> Self {
        let nothing = Ball { middle: 0.0, radius: f64::INFINITY };
        Self {
            t: 0.0,
            value: nothing,
            by_column: 0.0,
            by_row: 0.0,
            incline: nothing,
            slope: nothing,
            slope_across: [0.0; 2],
            turn: 0.0,
            sway: f64::INFINITY,
            across: f64::INFINITY,
            reach,
        }
    }

    /// Whether it says anything.
    pub(super) fn is_known(&self) -> bool {
        self.slope.radius.is_finite()
    }

    /// How far the ends of the stretch are from `t`.
    fn length(&self) -> f64 {
        round_up(self.reach.end - self.t).max(round_up(self.t - self.reach.start))
    }

    /// Whether F is certainly nowhere zero.
    pub(super) fn excludes_zero(&self) -> bool {
        self.sign().is_some()
    }

    /// Whether F may have either sign, but hardly because it changes with column, row or t.
    pub(super) fn is_vague(&self) -> bool {
        let change = self.across + self.incline.magnitude() * self.length();
        self.value.middle.abs() <= self.value.radius && FLAT * change <= self.value.radius
    }

    /// The sign of F, if it is the same everywhere.
    pub(super) fn sign(&self) -> Option<f64> {
        let values = self.value.widened(self.across + self.incline.magnitude() * self.length());
        values.excludes_zero().then(|| values.middle.signum())
    }

    /// Whether F certainly rises along every ray, or falls along every ray.
    pub(super) fn is_monotone(&self) -> bool {
        self.slope.excludes_zero()
    }

    /// Whether F is monotone with slopes so alike that the beam's rays can be followed each for its own.
    pub(super) fn is_even(&self) -> bool {
        self.slope.is_even()
    }

    /// Whether slopes are likely to be found so alike in a span.
    pub(super) fn is_even_within(&self, span: Span) -> bool {
        let (middle, half) = (0.5 * (span.start + span.end) - self.t, 0.5 * (span.end - span.start));
        let Ball { middle: slope, radius } = self.slope;
        let turn = self.turn.abs() * (self.length() - half);
        Ball { middle: slope + middle * self.turn, radius: radius - turn }.is_even()
    }

    /// Where all roots lie.
    pub(super) fn roots(&self) -> Interval {
        let (value, incline) = (self.value.widened(self.across), self.incline);
        let size = incline.middle.abs();
        let least = size - incline.radius;
        if least <= 0.0 {
            return Interval::ENTIRE;
        }
        // How far from t they are, to the side on which the middle one is.
        let far = (value.middle.abs() + value.radius) / least;
        let near = value.middle.abs() - value.radius;
        let near = near / if near < 0.0 { least } else { size + incline.radius };
        let rounding = ROUNDING * (self.t + far);
        let (near, far) = (near - rounding, far + rounding);
        match (value.middle < 0.0) == (incline.middle < 0.0) {
            true => Interval { lo: self.t - far, hi: self.t - near },
            false => Interval { lo: self.t + near, hi: self.t + far },
        }
    }

    /// What is left of a stretch where roots may lie; `None` where none do.
    pub(super) fn narrow(&self, stretch: Span) -> Option<Span> {
        let roots = self.roots();
        // Where quotients overflow these may be no numbers, and nothing is left out.
        let left = Span { start: stretch.start.max(roots.lo), end: stretch.end.min(roots.hi) };
        (left.start <= left.end && !self.excludes_zero()).then_some(left)
    }

    /// What it says of the rays in a part of its beam.
    pub(super) fn on(&self, beam: &Beam, area: Area) -> Self {
        let (there, middle) = (area.offset_of_first(), beam.area.offset_of_first());
        let offset = [there.0 - middle.0, there.1 - middle.1];
        let sum = |by: [f64; 2], of: [f64; 2]| by[0] * of[0] + by[1] * of[1];
        let (value_across, slope_across) = ([self.by_column, self.by_row], self.slope_across);
        let less = [beam.radii[0] - area.radii()[0], beam.radii[1] - area.radii()[1]];
        let fewer = |across: [f64; 2]| sum(across.map(f64::abs), less);
        let value = Ball { middle: self.value.middle + sum(value_across, offset), ..self.value };
        let slope = Ball {
            middle: self.slope.middle + sum(slope_across, offset),
            radius: self.slope.radius - fewer(slope_across),
        };
        Self {
            value: value.widened(ROUNDING * self.across),
            slope: slope.widened(ROUNDING * self.slope.radius),
            across: (1.0 + ROUNDING) * self.across - fewer(value_across),
            ..*self
        }
    }

    /// About where the roots are on the rays of its beam.
    pub(super) fn model(&self, beam: &Beam) -> Model {
        let incline = self.incline.middle;
        let [t, by_column, by_row] =
            [self.value.middle, self.by_column, self.by_row].map(|middle| -middle / incline);
        // From 0 = value + a·by_column + b·by_row + rest + (root − t)·incline for numbers of the balls.
        let [across, along] = beam.radii;
        let known = self.by_column.abs() * across + self.by_row.abs() * along;
        let off = self.value.radius + (self.across - known) + self.incline.radius * self.length();
        let rounded = ROUNDING * (self.value.middle.abs() + self.across + self.t * incline.abs());
        Model {
            t: self.t + t,
            by_column,
            by_row,
            uncertainty: (1.0 + ROUNDING) * (off + rounded) / incline.abs(),
        }
    }
}

/// About where the root of a ray is that is a columns and b rows off the middle of a beam: at `t` + a·`by_column` +
/// b·`by_row`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Model {
    pub(super) t: f64,
    pub(super) by_column: f64,
    pub(super) by_row: f64,
    /// How far from there a root may be in the stretch on which the form holds.
    pub(super) uncertainty: f64,
}

impl Model {
    /// Between which t of the model roots lie that are in a stretch.
    pub(super) fn around(&self, stretch: Span) -> [f64; 2] {
        [stretch.start - self.uncertainty, stretch.end + self.uncertainty]
    }

    pub(super) fn at(&self, across: f64, along: f64) -> f64 {
        self.t + (across * self.by_column + along * self.by_row)
    }
}

#[cfg(test)]
mod tests;
