use iso_expr::Scratch;
use iso_expr::random::Random;

use super::*;
use crate::area::Area;
use crate::batch::{BoxBatch, FormBatch, PointBatch};
use crate::testing::surface_of;
use crate::{Kernel, Raster, Ray, Surface, Tile};

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

/// F and its slope at a point of a ray.
fn value_and_slope(surface: &Surface, ray: &Ray, t: f64) -> (f64, f64) {
    let mut points = PointBatch::default();
    points.push(ray.at(t));
    let gradients = surface.over_points(Kernel::Gradients).unwrap();
    let [value, x, y, z] = points.evaluate(&**gradients, &mut Scratch::default(), 4) else {
        unreachable!("F and its gradient are four outputs")
    };
    (*value, DVec3::new(*x, *y, *z).dot(ray.direction))
}

/// F at points of rays of a part, and its slope along them, are what the form of the part says.
#[test]
fn values_and_slopes_are_what_affine_forms_say() {
    let mut random = Random::new(21);
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
        for _ in 0..20 {
            let (column, row) = (area.column + random.below(side), area.row + random.below(side));
            let ray = tile.ray(column, row);
            let at = reach.start + random.between(0.0, 1.0) * (reach.end - reach.start);
            let (value, slope) = value_and_slope(&surface, &ray, at);
            let (a, b) = area.offset(column, row);
            let line = form.value.middle + a * form.by_column + b * form.by_row;
            let off = (value - (line + (at - form.t) * form.incline.middle)).abs();
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

/// The form of F and of its gradient over a box around the rays of a beam.
fn by_gradients(surface: &Surface, beam: &Beam, reach: Span) -> Option<Form> {
    let (mut boxes, mut scratch) = (BoxBatch::default(), Scratch::default());
    let t = 0.5 * (reach.start + reach.end);
    let middle = beam.origins.middle + t * beam.directions.middle;
    boxes.replace([beam.bounds_in_space(reach), (middle, middle)].into_iter());
    boxes.evaluate(&**surface.over_boxes(Kernel::GradientEnclosures).unwrap(), &mut scratch, 4);
    let gradient = Gradient::new([0, 1, 2, 3].map(|output| boxes.decorated(output, 0)))?;
    Some(Form::new(beam, reach, (t, middle), boxes.interval(0, 1), &gradient))
}

/// F and its slope along a ray in a quarter of a beam are what is said of that quarter, and the place where F is as it is there is among those said to
/// be.
#[test]
fn forms_say_less_of_more_and_more_of_quarters() {
    let mut random = Random::new(23);
    let (mut narrowest, mut checked): ([f64; 2], usize) = ([f64::INFINITY; 2], 0);
    for round in 0..600 {
        let surface = surface_of(FORMULAS[round % FORMULAS.len()]);
        let raster = raster(&mut random, round % 2 == 0);
        let tile = Tile::of(&raster, [random.between(-20.0, 20.0), 3.5], 64, 64);
        let [width, height] = [(); 2].map(|()| 1 + random.below(24));
        let area = Area { column: random.below(30), row: random.below(30), width, height };
        let beam = Beam::new(&tile, area);
        let start = random.between(0.0, 3.0);
        let reach = Span { start, end: start + random.between(0.0, 0.01 * area.side() as f64) };
        let (arguments, units) = beam.forms(reach);
        let found = forms_of(&surface, (&beam, tile.direction()), &arguments);
        let affine = found.map(|[value, slope]| Form::affine(&beam, reach, units, &value, &slope));
        for form in [affine, by_gradients(&surface, &beam, reach)].into_iter().flatten() {
            for quarter in area.quarters() {
                let there = form.on(&beam, quarter);
                let (column, row) = (
                    quarter.column + random.below(quarter.width),
                    quarter.row + random.below(quarter.height),
                );
                let ray = tile.ray(column, row);
                let t = reach.start + random.between(0.0, 1.0) * (reach.end - reach.start);
                let (value, slope) = value_and_slope(&surface, &ray, t);
                let slack = 1e-12;
                assert!(
                    (slope - there.slope.middle).abs() <= there.slope.radius + slack,
                    "{slope} {there:?}"
                );
                let around = Ball { middle: there.value.middle - value, radius: there.value.radius + slack };
                let moved = Form { value: around, ..there };
                let roots = moved.roots();
                assert!(roots.lo <= t && t <= roots.hi && !moved.excludes_zero(), "{t} {roots:?} {there:?}");
                let quotient = there.value.widened(there.across).interval().over(there.incline.interval());
                let [expected, roots_there] = [Interval::point(there.t).minus(quotient), there.roots()];
                if !there.incline.interval().contains_zero() {
                    let size = 1e-12 * (expected.lo.abs() + expected.hi.abs());
                    let off = (roots_there.lo - expected.lo).abs().max((roots_there.hi - expected.hi).abs());
                    assert!(off <= size, "{roots_there:?} {expected:?}");
                }
                checked += 1;
                if roots.hi - roots.lo < reach.end - reach.start {
                    narrowest[0] = narrowest[0].min((t - roots.lo).min(roots.hi - t) / (roots.hi - roots.lo));
                }
                let off = (slope - there.slope.middle).abs() / there.slope.radius;
                narrowest[1] = narrowest[1].min(1.0 - off);
            }
        }
    }
    assert!(checked > 3000, "{checked} quarters");
    assert!(narrowest.iter().all(|room| *room < 0.1), "forms hold far more: {narrowest:?}");
}
