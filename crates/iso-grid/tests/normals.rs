//! Normals are those of the whole formula, whatever is left of it where they are asked for.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Interpreter};
use iso_grid::{Certified, Outcome, Raster, Region, Surface, Tile, Tracer, Workspace, normals};

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
    let mut outcomes = vec![Outcome::Miss; tile.len()];
    tracer.trace_tile(&mut workspace, tile, &mut outcomes);
    let mut found = |tracer: Option<&dyn Tracer>| {
        let mut found = vec![DVec3::ZERO; tile.len()];
        normals(&surface, tracer, &mut workspace, tile, &outcomes, &mut found).unwrap();
        found
    };
    let (here, everywhere) = (found(Some(&tracer)), found(None));
    let bits = |normal: &DVec3| normal.to_array().map(f64::to_bits);
    assert!(here.iter().map(bits).eq(everywhere.iter().map(bits)));
    let hits = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Hit(_))).count();
    assert_eq!(here.iter().filter(|normal| (normal.length() - 1.0).abs() < 1e-12).count(), hits);
    assert!(hits > tile.len() / 4, "{hits} hits");
}
