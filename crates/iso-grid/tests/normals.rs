//! Normals are those of the whole formula, whatever is left of it where they are asked for.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Interpreter};
use iso_grid::{
    Certified, Hit, Outcome, OutcomeKind, Outcomes, Raster, Ray, Region, Span, Surface, Tile, Traced, Tracer,
    Workspace, normals,
};

#[test]
fn what_is_left_of_a_formula_has_the_normals_of_all_of_it() {
    let ball = |number: usize| {
        let (sin, cos) = (0.9 * number as f64).sin_cos();
        format!("(x - {cos})^2 + (y - {sin})^2 + (z - {})^2 - 0.2", 0.1 * number as f64 - 1.0)
    };
    let balls: Vec<_> = (0..20).map(ball).collect();
    let formula = format!("max(min({}), abs(x) - 1.1)", balls.join(", "));
    let program = Ast::parse(&formula).unwrap().lower(&[]).unwrap().program().simplified();
    let surface = Surface::new(Arc::new(Interpreter), program);
    let region = Region::new(DVec3::splat(-1.6), DVec3::splat(1.6)).unwrap();
    let tracer = Certified::new(&surface, region).unwrap();
    assert!(tracer.gradients_on(DVec3::new(0.2, 0.8, -0.9), DVec3::new(0.3, 0.9, -0.8)).is_some());

    let raster = Raster::Parallel {
        middle: DVec3::new(0.0, 0.0, 5.0),
        right: DVec3::new(0.04, 0.0, 0.0),
        down: DVec3::new(0.0, -0.04, 0.01),
        direction: DVec3::new(0.05, 0.1, -1.0),
    };
    let tile = Tile::of(&raster, [-31.5, -31.5], 61, 64);
    let mut workspace = Workspace::default();
    let mut outcomes = Outcomes::default();
    tracer.trace_tile(&mut workspace, tile, &mut outcomes, None);
    let mut found = |tracer: Option<&dyn Tracer>| {
        let mut found = vec![DVec3::NAN; tile.len()];
        normals(&surface, tracer, &mut workspace, tile, &outcomes, &mut found).unwrap();
        found
    };
    let (here, everywhere) = (found(Some(&tracer)), found(None));
    let bits = |normal: &DVec3| normal.to_array().map(f64::to_bits);
    assert!(here.iter().map(bits).eq(everywhere.iter().map(bits)));
    let hits = outcomes.kinds().iter().filter(|kind| **kind == OutcomeKind::Hit).count();
    assert_eq!(here.iter().filter(|normal| (normal.length() - 1.0).abs() < 1e-12).count(), hits);
    assert!(hits > tile.len() / 4, "{hits} hits");
}

/// Rays in the plane that cuts a sphere meet it where its margin is zero: there the root of the margin has no derivative.
#[test]
fn hits_on_the_edge_of_a_cut_have_the_normals_of_what_is_cut() {
    let program =
        Ast::parse("x^2 + y^2 + z^2 = 1 where x <= 0").unwrap().lower(&[]).unwrap().program().simplified();
    let surface = Surface::new(Arc::new(Interpreter), program);
    let tracer =
        Certified::new(&surface, Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap()).unwrap();
    let raster = Raster::Parallel {
        middle: DVec3::new(0.0, -3.0, 0.0),
        right: DVec3::new(0.1, 0.0, 0.0),
        down: DVec3::new(0.0, 0.0, 0.1),
        direction: DVec3::Y,
    };
    let tile = Tile::of(&raster, [0.0, -9.0], 1, 19);
    let (_, outcomes, mut found) = traced(&tracer, tile);
    normals(&surface, Some(&tracer), &mut Workspace::default(), tile, &outcomes, &mut found).unwrap();
    for (row, normal) in (-9..).zip(found) {
        let z = 0.1 * f64::from(row);
        let expected = DVec3::new(0.0, -(1.0 - z * z).sqrt(), z);
        assert!(normal.distance(expected) < 1e-9, "{normal} instead of {expected}");
    }
}

/// A surface z = w(u) along which a term that overflows in derivatives, but is less than 1e-300 itself, adds nothing to F.
struct Waves {
    formula: &'static str,
    half_side: f64,
    /// The slope of w at a point.
    slope: fn(DVec3) -> DVec3,
    /// Where a derivative is no number.
    overflows: fn(DVec3) -> bool,
    /// How near normals are to those of the surface: at touches F is a square, whose slopes are lost in rounding.
    slack: f64,
}

const ALONG_X: Waves = Waves {
    formula: "z - sin(20x)/5 - 1/cosh(800x)",
    half_side: 1.6,
    slope: |p| 4.0 * (20.0 * p.x).cos() * DVec3::X,
    overflows: |p| p.x.abs() > 0.9,
    slack: 1e-6,
};

/// Seen from a distance of 60, its slope turns by a thousandth in 2⁻²⁵ of the way.
const ALONG_Y: Waves = Waves {
    formula: "z - sin(200y)/50 - 1/sinh(1/y^2)",
    half_side: 0.5,
    slope: |p| 4.0 * (200.0 * p.y).cos() * DVec3::Y,
    overflows: |p| p.y.abs() < 0.037,
    ..ALONG_X
};

const TOUCHED: Waves = Waves { formula: "(z - sin(20x)/5 - 1/cosh(800x))^2", slack: 1e-4, ..ALONG_X };

/// Of tiles and of single rays.
#[test]
fn where_derivatives_overflow_normals_are_those_of_mean_slopes() {
    let raster = Raster::Spreading {
        eye: DVec3::new(3.0, -40.0, 45.0),
        forward: DVec3::new(-3.0, 40.0, -45.0).normalize(),
        right: DVec3::new(5e-4, 0.0, 0.0),
        down: DVec3::new(0.0, -4e-4, -3e-4),
    };
    let tile = Tile::of(&raster, [-31.5, -31.5], 64, 64);
    let rays: Vec<_> = tile.rays().collect();
    for Waves { formula, half_side, slope, overflows, slack } in [ALONG_X, ALONG_Y, TOUCHED] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let region = Region::new(DVec3::splat(-half_side), DVec3::splat(half_side)).unwrap();
        let tracer = Certified::new(&surface, region).unwrap();
        let (_, of_tile, on_the_way) = traced(&tracer, tile);
        let mut of_rays = Outcomes::default();
        tracer.trace(&mut Workspace::default(), &rays, &mut of_rays);
        for (outcomes, mut found) in [(of_tile, on_the_way), (of_rays, vec![DVec3::NAN; rays.len()])] {
            normals(&surface, None, &mut Workspace::default(), tile, &outcomes, &mut found).unwrap();
            let mut overflowing = 0;
            for ((outcome, ray), normal) in outcomes.iter().zip(&rays).zip(found) {
                let (Outcome::Hit(Hit { t, .. }) | Outcome::Touch(Hit { t, .. })) = outcome else { continue };
                let point = ray.at(t);
                if overflows(point) {
                    overflowing += 1;
                    let upwards = (DVec3::Z - slope(point)).normalize();
                    // Of what is squared, the larger side is the one that is seen.
                    let is_below = formula.ends_with("^2") && upwards.dot(ray.direction) > 0.0;
                    let expected = if is_below { -upwards } else { upwards };
                    assert!(
                        normal.distance(expected) < slack,
                        "{formula}: {normal} at {point}, not {expected}"
                    );
                }
            }
            assert!(overflowing > 50, "{formula}: {overflowing}");
        }
    }
}

/// Along rays in the plane x = 0 the gradient is infinite everywhere.
#[test]
fn an_infinite_gradient_gives_the_normal_across_it() {
    let program = Ast::parse("z = cbrt(x)").unwrap().lower(&[]).unwrap().program().simplified();
    let surface = Surface::new(Arc::new(Interpreter), program);
    let rays = [Ray { origin: DVec3::new(0.0, 0.1, 3.0), direction: DVec3::NEG_Z }];
    let bracket = Span { start: 3.0, end: 3.0 };
    let outcomes: Outcomes = [Outcome::Hit(Hit { t: 3.0, bracket })].into_iter().collect();
    let mut found = [DVec3::NAN];
    normals(&surface, None, &mut Workspace::default(), rays[..].into(), &outcomes, &mut found).unwrap();
    assert!(found[0].distance(DVec3::NEG_X) < 1e-5, "{}", found[0]);
}

/// What comes of a tile: where a tracer says that its rays meet the surface, and the normals that it comes by on the way.
fn traced(tracer: &Certified, tile: Tile<'_>) -> (Traced, Outcomes, Vec<DVec3>) {
    let mut outcomes = Outcomes::default();
    let mut normals = vec![DVec3::NAN; tile.len()];
    let traced = tracer.trace_tile(&mut Workspace::default(), tile, &mut outcomes, Some(&mut normals));
    let are_met = outcomes.kinds().iter().map(|kind| matches!(kind, OutcomeKind::Hit | OutcomeKind::Touch));
    let is_lacking = are_met.zip(&normals).any(|(is_met, normal)| is_met && normal.is_nan());
    assert!(traced != Traced::OutcomesAndNormals || !is_lacking, "each hit and touch has its normal");
    (traced, outcomes, normals)
}

#[test]
fn normals_found_on_the_way_are_those_of_the_hits_and_change_no_outcome() {
    let formulas = [
        "x^2 + y^2 + z^2 = 1",
        "sin(3x) * cos(3y) + sin(3y) * cos(3z) + sin(3z) * cos(3x) = 0",
        "x^2 + y^2 + z^2 = 0.7 + abs(z) / 2",
        "exp(x) + y^2 = z + 1",
        "min((x - 0.4)^2 + y^2 + z^2 - 0.5, (x + 0.4)^2 + y^2 + z^2 - 0.4) = 0",
        "max(x^2 + y^2 + z^2 - 1, 0.1 - x^2 - y^2, z - x/3 - 0.4) = 0",
    ];
    let [right, down] = [DVec3::new(0.02, 0.0, 0.0), DVec3::new(0.0, -0.02, 0.005)];
    let middle = DVec3::new(0.0, 0.0, 5.0);
    let rasters = [
        Raster::Parallel { middle, right, down, direction: DVec3::new(0.05, 0.1, -1.0) },
        Raster::Spreading { eye: middle, forward: DVec3::NEG_Z, right: 0.2 * right, down: 0.2 * down },
    ];
    for formula in formulas {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let region = Region::new(DVec3::splat(-1.6), DVec3::splat(1.6)).unwrap();
        let tracer = Certified::new(&surface, region).unwrap();
        for raster in &rasters {
            let tile = Tile::of(raster, [-31.5, -31.5], 64, 64);
            let (traced, outcomes, on_the_way) = traced(&tracer, tile);
            assert_eq!(traced, Traced::OutcomesAndNormals, "{formula}");
            let (mut alone, mut all) = (Outcomes::default(), vec![DVec3::NAN; tile.len()]);
            let mut workspace = Workspace::default();
            assert_eq!(tracer.trace_tile(&mut workspace, tile, &mut alone, None), Traced::Outcomes);
            assert_eq!(outcomes, alone, "{formula}");
            normals(&surface, None, &mut workspace, tile, &outcomes, &mut all).unwrap();

            let (mut hits, mut found) = (0, 0);
            for ((outcome, normal), expected) in outcomes.iter().zip(&on_the_way).zip(&all) {
                hits += i32::from(matches!(outcome, Outcome::Hit(_)));
                if !normal.is_nan() {
                    found += 1;
                    assert!(matches!(outcome, Outcome::Hit(_)), "{formula}");
                    assert!(normal.distance(*expected) < 1e-10, "{formula}: {normal} for {expected}");
                }
            }
            assert!(hits > 200 && found == hits, "{formula}: {found} of {hits}");
        }
    }
}

/// Of touches normals are looked for afterwards, and of hits where the gradient is infinite; of rays that are not decided there are none.
#[test]
fn tiles_say_what_came_of_them() {
    let tile_at = |x: f64| Raster::Parallel {
        middle: DVec3::new(x, 0.0, 5.0),
        right: DVec3::new(0.05, 0.0, 0.0),
        down: DVec3::new(0.0, -0.05, 0.0),
        direction: DVec3::NEG_Z,
    };
    for (formula, x, expected) in [
        ("x^2 + y^2 + z^2 = 1", 0.0, Traced::OutcomesAndNormals),
        ("x^2 + y^2 + z^2 = 1", 10.0, Traced::Nothing),
        ("(x^2 + y^2 + z^2 - 1)^2 = 0", 0.0, Traced::Outcomes),
        ("z = cbrt(x)", 0.025, Traced::Outcomes),
        ("sign(z - x/9) = 0", 0.0, Traced::OutcomesAndNormals),
    ] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let region = Region::new(DVec3::splat(-1.6), DVec3::splat(1.6)).unwrap();
        let tracer = Certified::new(&surface, region).unwrap();
        let (traced, outcomes, _) = traced(&tracer, Tile::of(&tile_at(x), [-7.5, -7.5], 16, 16));
        assert_eq!(traced, expected, "{formula}");
        let is_missed = outcomes.kinds().iter().all(|kind| *kind == OutcomeKind::Miss);
        assert_eq!(is_missed, expected == Traced::Nothing, "{formula}");
    }
}

#[test]
fn no_rays_have_no_normals() {
    let program = Ast::parse("x^2 + y^2 + z^2 = 1").unwrap().lower(&[]).unwrap().program().simplified();
    let surface = Surface::new(Arc::new(Interpreter), program);
    let raster =
        Raster::Parallel { middle: DVec3::ZERO, right: DVec3::X, down: DVec3::Y, direction: DVec3::Z };
    for (width, height) in [(0, 0), (0, 3), (3, 0)] {
        let tile = Tile::of(&raster, [0.0, 0.0], width, height);
        normals(&surface, None, &mut Workspace::default(), tile, &Outcomes::default(), &mut []).unwrap();
    }
}
