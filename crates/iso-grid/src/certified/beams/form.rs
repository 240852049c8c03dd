//! What F is over a stretch of a beam: the mean value form, or an affine one.

use glam::DVec3;
use iso_expr::interval::round_up;
use iso_expr::{Decorated, Decoration, Interval};

use super::beam::Beam;
use super::spread::Spread;
use crate::Span;
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
    /// How the slope changes with t, about; 0 where that is not known.
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
        self.slope.radius < UNEVEN * self.slope.middle.abs()
    }

    /// Where all roots lie, if F is monotone.
    pub(super) fn roots(&self) -> Interval {
        let value = self.value.widened(self.across).interval();
        Interval::point(self.t).minus(value.over(self.incline.interval()))
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
mod tests {
    use iso_expr::Scratch;
    use iso_expr::random::Random;

    use super::*;
    use crate::area::Area;
    use crate::batch::{FormBatch, PointBatch};
    use crate::testing::surface_of;
    use crate::{Kernel, Raster, Surface, Tile};

    const FORMULAS: [&str; 5] = [
        "(x^2 + 2y^2 + z^2 - 1)^3 - x^2*z^3 - y^2*z^3/9",
        "1/(x^2 + y^2 + 1) - exp(-(x - z)^2) + 0.3",
        "sin(2x)cos(y) + sin(y)cos(3z) + sin(z)cos(x)",
        "sqrt(x^2 + y^2 + 0.1)*z - abs(x - y)",
        "max(x^2 + y*z - 1, x - z, min(y, x*z))",
    ];

    fn raster(random: &mut Random, is_parallel: bool) -> Raster {
        let mut vector = || DVec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)));
        let (middle, forward, up) = (3.0 * vector(), vector().normalize(), vector());
        let right = 0.01 * forward.cross(up).normalize();
        let down = forward.cross(right);
        match is_parallel {
            true => Raster::Parallel { middle, right, down, direction: 0.8 * forward },
            false => Raster::Spreading { eye: middle, forward, right, down },
        }
    }

    /// The forms of F and its slope along the rays of a beam, all in the same `direction` if it is given.
    fn forms_of(
        surface: &Surface,
        (beam, direction): (&Beam, Option<DVec3>),
        arguments: &[Affine; 3],
    ) -> Option<[Affine; 2]> {
        let mut forms = FormBatch::default();
        forms.push(arguments);
        let kind = if direction.is_some() { Kernel::ParallelForms } else { Kernel::Forms };
        forms.evaluate(&**surface.over_points(kind).unwrap(), direction, &mut Scratch::default());
        if direction.is_some() {
            return forms.found(0);
        }
        let [value, gradient @ ..]: [Affine; 4] = forms.found(0)?;
        Some([value, along(&beam.directions, &gradient)])
    }

    /// F at points of rays of a part, and its slope along them, are what the form of the part says.
    #[test]
    fn values_and_slopes_are_what_affine_forms_say() {
        let mut random = Random::new(21);
        let mut scratch = Scratch::default();
        let mut closest: [f64; 2] = [0.0; 2];
        for round in 0..600 {
            let surface = surface_of(FORMULAS[round % FORMULAS.len()]);
            let raster = raster(&mut random, round % 2 == 0);
            let tile = Tile::of(&raster, [random.between(-20.0, 20.0), 3.5], 64, 64);
            let side = 1 << random.below(6);
            let area = Area { column: random.below(30), row: random.below(30), width: side, height: side };
            let beam = Beam::new(&tile, area);
            let start = random.between(0.0, 3.0);
            let reach = Span { start, end: start + random.between(0.0, 0.02 * side as f64) };
            let (arguments, (t, unit)) = beam.forms(reach);
            let found = forms_of(&surface, (&beam, tile.direction()), &arguments);
            let Some([value, slope]) = found else { continue };
            let form = Form::affine(&beam, reach, (t, unit), &value, &slope);
            let gradients = surface.over_points(Kernel::Gradients).unwrap();
            for _ in 0..20 {
                let (column, row) = (area.column + random.below(side), area.row + random.below(side));
                let ray = tile.ray(column, row);
                let at = reach.start + random.between(0.0, 1.0) * (reach.end - reach.start);
                let mut points = PointBatch::default();
                points.push(ray.at(at));
                let [value, x, y, z] = points.evaluate(&**gradients, &mut scratch, 4) else {
                    unreachable!("F and its gradient are four outputs")
                };
                let (a, b) = area.offset(column, row);
                let line = form.value.middle + a * form.by_column + b * form.by_row;
                let off = (value - (line + (at - form.t) * form.incline.middle)).abs();
                let slope = DVec3::new(*x, *y, *z).dot(ray.direction);
                let turn = (slope - form.slope.middle).abs();
                let slack = 1e-12;
                let radius = form.value.radius + unit * form.incline.radius;
                assert!(off <= radius + slack && turn <= form.slope.radius + slack, "{off} {turn} {form:?}");
                closest = [closest[0].max(off / radius), closest[1].max(turn / form.slope.radius)];
            }
        }
        assert!(closest.iter().all(|closest| *closest > 0.7), "forms hold far more: {closest:?}");
    }

    /// By second derivatives along the ray in the middle, found by hand.
    #[test]
    fn slopes_turn_as_second_derivatives_say() {
        let mut random = Random::new(22);
        for is_parallel in [true, false] {
            let raster = raster(&mut random, is_parallel);
            let tile = Tile::of(&raster, [0.0, 0.0], 2, 2);
            let beam = Beam::new(&tile, Area { column: 0, row: 0, width: 2, height: 2 });
            let DVec3 { x: dx, y: dy, z: dz } = beam.directions.middle;
            let (arguments, (t, unit)) = beam.forms(Span { start: 1.0, end: 1.001 });
            let at = beam.origins.middle + t * beam.directions.middle;
            for (formula, turn) in [
                ("x^2 + 3y*z", 2.0 * dx * dx + 6.0 * dy * dz),
                ("x^3 - y", 6.0 * at.x * dx * dx),
                ("exp(z)", at.z.exp() * dz * dz),
                ("x + 2y - z", 0.0),
            ] {
                let [value, slope] =
                    forms_of(&surface_of(formula), (&beam, tile.direction()), &arguments).unwrap();
                let reach = Span { start: 1.0, end: 1.001 };
                let form = Form::affine(&beam, reach, (t, unit), &value, &slope);
                // Directions that differ count as uneven.
                let is_even = form.sway <= 1e-2 * form.slope.radius + 1e-12;
                assert!(is_even || !is_parallel, "{formula}: {form:?}");
                let off = (form.turn - turn).abs();
                assert!(off <= 1e-2 * turn.abs() + 1e-12, "{formula}: {} {turn}", form.turn);
            }
        }
    }
}
