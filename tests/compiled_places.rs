//! What is asked for seldom, and what a formula comes to in some places, is compiled after a while, which changes no bit.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Engine, Interpreter};
use iso_grid::{
    Certified, Kernel, Outcome, OutcomeKind, Outcomes, Raster, Region, Surface, Tile, Tracer, Workspace,
};
use iso_jit::Jit;

/// A quartic inside a ball: in most places one of both decides. To the second a term is added that has no affine form, so that it is
/// enclosed over boxes, and its ball has no squares in common with it.
const SMOOTH: &str = "max(x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.3, x^2 + y^2 + z^2 - 1.2)";
const WITHOUT_FORM: &str = "max(x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.3 + 0.01atan(x), (x - 0.1)^2 + (y + 0.1)^2 + (z - 0.2)^2 - 1.2)";

/// Columns and rows of the picture.
const SIDE: usize = 64;

/// So many pictures ask often enough for what the formula comes to.
const PICTURES: usize = 150;

fn surface(engine: Arc<dyn Engine>, formula: &str) -> Surface {
    let value = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
    Surface::new(engine, value)
}

/// The certified method for a surface.
fn of_surface(surface: &Surface) -> Certified {
    let region = Region::new(DVec3::splat(-1.3), DVec3::splat(1.3)).unwrap();
    Certified::new(surface, region).unwrap()
}

/// The certified method for the surface of a formula.
fn certified(engine: Arc<dyn Engine>, formula: &str) -> Certified {
    of_surface(&surface(engine, formula))
}

/// How the rays end in so many pictures.
fn pictures(tracer: &Certified, count: usize, workspace: &mut Workspace) -> Vec<Outcomes> {
    let spacing = 2.6 / SIDE as f64;
    let raster = Raster::Parallel {
        middle: DVec3::new(0.9, -2.8, 0.6),
        right: spacing * DVec3::new(0.96, 0.28, 0.0),
        down: spacing * DVec3::new(0.0, 0.0, -1.0),
        direction: DVec3::new(-0.28, 0.94, -0.2),
    };
    let first = 0.5 - 0.5 * SIDE as f64;
    let picture = |_| {
        let mut outcomes = Outcomes::default();
        tracer.trace_tile(workspace, Tile::of(&raster, [first, first], SIDE, SIDE), &mut outcomes, None);
        outcomes
    };
    (0..count).map(picture).collect()
}

#[test]
fn compiled_places_end_rays_as_interpreted_ones_do() {
    for formula in [SMOOTH, WITHOUT_FORM] {
        let mut workspace = Workspace::default();
        let native = pictures(&certified(Arc::new(Jit::new().unwrap()), formula), PICTURES, &mut workspace);
        let operations = workspace.counters.operations;
        assert!(operations > 1 << 25, "{operations} operations are too few for anything to be compiled");
        let interpreted = pictures(&certified(Arc::new(Interpreter), formula), 1, &mut workspace);
        let hits = interpreted[0].kinds().iter().filter(|kind| **kind == OutcomeKind::Hit).count();
        assert!(hits > 500, "{hits} rays hit");
        for outcomes in native {
            assert_eq!(outcomes, interpreted[0], "{formula}");
        }
    }
}

/// A waist near which F is not monotone, so that what forms say too little of is asked for often. For the last term this is no difference
/// of cubes.
const HEART: &str = "(x^2 + 2.25y^2 + z^2 - 1)^3 - x^2 z^3 - 0.1125y^2 z^3 - 1e-9";

#[test]
fn kernels_that_are_asked_for_seldom_are_compiled_when_they_were_asked_for_often() {
    let surface = surface(Arc::new(Jit::new().unwrap()), HEART);
    let seldom = [Kernel::GradientEnclosures, Kernel::RoundingBounds];
    let tracer = of_surface(&surface);
    let mut workspace = Workspace::default();
    let first = pictures(&tracer, 1, &mut workspace);
    assert_eq!(seldom.map(|kernel| surface.is_compiled(kernel)), [false; 2]);
    let later = pictures(&tracer, 2 * PICTURES, &mut workspace);
    assert_eq!(seldom.map(|kernel| surface.is_compiled(kernel)), [true; 2]);
    assert!(later.iter().all(|outcomes| *outcomes == first[0]));
}

/// Balls beside each other, one or two of which are near to any place.
fn balls() -> String {
    let places = || [-0.9, -0.3, 0.3, 0.9].into_iter();
    let centers = places().flat_map(|x| places().flat_map(move |y| places().map(move |z| (x, y, z))));
    let balls = centers.map(|(x, y, z)| format!("(x - {x})^2 + (y - {y})^2 + (z - {z})^2 - 0.05"));
    format!("min({})", balls.collect::<Vec<_>>().join(", "))
}

#[test]
fn places_take_fewer_operations_and_prove_the_same() {
    let (formula, mut workspace) = (balls(), Workspace::default());
    let in_places = pictures(&certified(Arc::new(Interpreter), &formula), 1, &mut workspace);
    let operations = std::mem::take(&mut workspace.counters).operations;
    let whole = certified(Arc::new(Interpreter), &formula).with_whole_formula();
    let everywhere = pictures(&whole, 1, &mut workspace);
    let by_whole = workspace.counters.operations;
    assert!(2 * operations < by_whole, "{operations} operations in places, {by_whole} by the whole formula");
    for (a, b) in in_places[0].iter().zip(everywhere[0].iter()) {
        let agree = match (a, b) {
            (Outcome::Hit(a), Outcome::Hit(b)) => {
                a.bracket.start <= b.bracket.end && b.bracket.start <= a.bracket.end
            }
            (Outcome::Miss, Outcome::Miss) => true,
            _ => false,
        };
        assert!(agree, "{a:?} in places, {b:?} by the whole formula");
    }
}
