//! The paper's methods at the limits of their input: settings out of range, functions without a value, regions very small
//! and very far, and what the methods are documented to get wrong.

use glam::DVec3;

use crate::testing::{Function, normal, surface, surface_without_gradient, trace};
use crate::{
    Direct, Grid, GridError, GridSettings, Octree, Outcome, Ray, Region, RootFinding, Surface, Tracer,
};

fn methods(surface: &Surface, region: Region, settings: &GridSettings) -> Vec<Box<dyn Tracer>> {
    vec![
        Box::new(Direct::new(surface, region, settings.step, settings.roots).unwrap()),
        Box::new(Grid::new(surface, region, settings).unwrap()),
        Box::new(Octree::new(surface, region, settings).unwrap()),
    ]
}

fn cube(half_side: f64) -> Region {
    Region::new(DVec3::splat(-half_side), DVec3::splat(half_side)).unwrap()
}

/// What each method says of one ray along x through a cube of side 2, a little off its axis.
fn outcomes_along_x(function: Function, cells: u32) -> Vec<Outcome> {
    let surface = surface_without_gradient(function);
    let ray = Ray { origin: DVec3::new(-2.0, 0.01, 0.02), direction: DVec3::X };
    let methods = methods(&surface, cube(1.0), &GridSettings::new([cells; 3]));
    methods.iter().map(|method| trace(&**method, ray)).collect()
}

#[test]
fn settings_out_of_range_are_refused() {
    let surface = surface_without_gradient(|p| p.x);
    let good = GridSettings::new([4, 30, 4]);
    assert_eq!(good.refinement, [3, 2, 3]);
    let refused = |settings: GridSettings| {
        let octree = Octree::new(&surface, cube(1.0), &settings).err().map(|error| error.to_string());
        let grid = Grid::new(&surface, cube(1.0), &settings).err().unwrap();
        assert_eq!(octree, Some(grid.to_string()));
        grid
    };
    for cells in [0, GridSettings::MOST_CELLS + 1, u32::MAX] {
        let error = refused(GridSettings { cells: [4, cells, 4], ..good });
        assert!(matches!(error, GridError::Cells { axis: 'y', given, .. } if given == cells));
    }
    for parts in [0, 65, u32::MAX] {
        let error = refused(GridSettings { refinement: [2, 2, parts], ..good });
        assert!(matches!(error, GridError::Refinement { axis: 'z', given, allowed: 64 } if given == parts));
    }
    for tolerance in [-1e-9, 1.5, f64::NAN, f64::INFINITY] {
        let roots = RootFinding { tolerance, ..good.roots };
        assert!(matches!(refused(GridSettings { roots, ..good }), GridError::Tolerance { .. }));
        let direct = Direct::new(&surface, cube(1.0), good.step, roots);
        assert!(matches!(direct, Err(GridError::Tolerance { .. })));
    }
    for step in [0.0, -0.05, 1e-7, 1.5, f64::NAN, f64::INFINITY] {
        let error = refused(GridSettings { step, ..good });
        assert!(matches!(error, GridError::Step { .. }));
        assert!(matches!(Direct::new(&surface, cube(1.0), step, good.roots), Err(GridError::Step { .. })));
    }
    let huge = GridSettings::new([60_000; 3]);
    let given = 60_000_u64.pow(3);
    assert!(
        matches!(Grid::new(&surface, cube(1.0), &huge), Err(GridError::TooManyCells { given: g, .. }) if g == given)
    );
}

#[test]
fn an_octree_that_would_fill_memory_is_refused() {
    let everywhere_zero = surface_without_gradient(|_| 0.0);
    let error = Octree::new(&everywhere_zero, cube(1.0), &GridSettings::new([1_408; 3])).err().unwrap();
    assert!(matches!(error, GridError::TooManyCells { method: "octree", .. }), "{error}");
}

#[test]
fn functions_without_a_value_are_missed() {
    for function in [(|_| f64::NAN) as Function, |_| f64::INFINITY, |_| f64::NEG_INFINITY, |_| 1.0] {
        assert_eq!(outcomes_along_x(function, 6), [Outcome::Miss; 3]);
    }
}

#[test]
fn a_surface_that_fills_the_region_is_touched_where_the_ray_enters() {
    for outcome in outcomes_along_x(|_| 0.0, 6) {
        assert!(matches!(outcome, Outcome::Touch(hit) if hit.t == 1.0), "{outcome:?}");
    }
}

#[test]
fn a_plateau_is_touched_where_it_begins() {
    for outcome in outcomes_along_x(|p| (p.x - 0.234).max(0.0) - (p.x + 0.345).min(0.0), 6) {
        assert!(matches!(outcome, Outcome::Touch(hit) if (hit.t - 1.655).abs() < 1e-15), "{outcome:?}");
    }
}

#[test]
fn a_zero_between_unlike_signs_is_a_hit_and_between_like_signs_a_touch() {
    // Both zeros are sampled by every method: the cells are 0.5 long, and 20 samples fall on each.
    for outcome in outcomes_along_x(|p| p.x - 0.25, 4) {
        assert!(matches!(outcome, Outcome::Hit(hit) if hit.t == 2.25), "{outcome:?}");
    }
    for outcome in &outcomes_along_x(|p| (p.x - 0.5).powi(2), 4)[1..] {
        assert!(matches!(outcome, Outcome::Touch(hit) if hit.t == 2.5), "{outcome:?}");
    }
}

#[test]
fn poles_are_taken_for_roots() {
    for outcome in outcomes_along_x(|p| 1.0 / (p.x - 0.1), 6) {
        assert!(matches!(outcome, Outcome::Hit(hit) if (hit.t - 2.1).abs() < 1e-15), "{outcome:?}");
    }
}

#[test]
fn an_undefined_stretch_between_signs_is_no_root_and_does_not_end_the_search() {
    let function: Function =
        |p| if (p.x + 0.2).abs() < 1e-4 { f64::NAN } else { (p.x + 0.2) * (p.x - 0.612) };
    for outcome in outcomes_along_x(function, 6) {
        assert!(matches!(outcome, Outcome::Hit(hit) if (hit.t - 2.612).abs() < 1e-15), "{outcome:?}");
    }
}

#[test]
fn one_cell_is_a_grid() {
    for outcome in outcomes_along_x(|p| p.x - 0.3, 1) {
        assert!(matches!(outcome, Outcome::Hit(hit) if (hit.t - 2.3).abs() < 1e-15), "{outcome:?}");
    }
}

#[test]
fn regions_may_be_tiny_or_far_away() {
    for (center, radius) in [(0.0, 1e-9), (0.0, 1e-150), (1e12, 1.0), (-1e12, 1e9), (0.0, 1e150)] {
        let region =
            Region::new(DVec3::splat(center - 1.3 * radius), DVec3::splat(center + 1.3 * radius)).unwrap();
        // A plane needs no more digits than the region has.
        let surface = surface_without_gradient(match center {
            1e12 => |p| p.x - 1e12,
            -1e12 => |p| p.x + 1e12,
            _ => |p| p.x,
        });
        for method in methods(&surface, region, &GridSettings::new([7; 3])) {
            let origin = DVec3::new(center - 4.0 * radius, center, center);
            let outcome = trace(&*method, Ray { origin, direction: DVec3::new(radius / 8.0, 0.0, 0.0) });
            assert!(
                matches!(outcome, Outcome::Hit(hit) if (hit.t - 32.0).abs() < 1e-3),
                "{center} {radius} {outcome:?}"
            );
        }
    }
}

#[test]
fn rays_that_are_no_rays_are_missed() {
    let surface = surface_without_gradient(|p| p.x);
    for method in methods(&surface, cube(1.0), &GridSettings::new([5; 3])) {
        for number in [f64::NAN, f64::INFINITY, 0.0] {
            let direction = DVec3::new(number, 0.0, 0.0);
            assert_eq!(trace(&*method, Ray { origin: DVec3::ZERO, direction }), Outcome::Miss);
        }
        for number in [f64::NAN, f64::INFINITY, f64::MAX] {
            let origin = DVec3::new(number, 0.0, 0.0);
            assert_eq!(trace(&*method, Ray { origin, direction: DVec3::X }), Outcome::Miss);
        }
    }
}

/// The normal where a ray along x from x = −2 meets a surface.
fn normal_along_x(value: Function, gradient: fn(DVec3) -> DVec3, outcome: Outcome) -> DVec3 {
    let ray = Ray { origin: DVec3::new(-2.0, 0.0, 0.0), direction: DVec3::X };
    normal(&surface(value, gradient), ray, outcome)
}

#[test]
fn normals_have_unit_length_whatever_the_gradient_s() {
    let outcome = outcomes_along_x(|p| p.x, 6)[0];
    let expected = DVec3::new(3.0, -4.0, 12.0) / 13.0;
    for gradient in [
        (|_| DVec3::new(3e-200, -4e-200, 12e-200)) as fn(DVec3) -> DVec3,
        |_| DVec3::new(3e300, -4e300, 12e300),
        |_| DVec3::new(3.0, -4.0, 12.0) * 5e-324,
        |_| DVec3::new(3.0, -4.0, 12.0) * 2_f64.powi(1020),
    ] {
        assert!(normal_along_x(|p| p.x, gradient, outcome).distance(expected) < 1e-15);
    }
}

#[test]
fn a_double_root_has_the_normal_of_the_side_that_is_seen() {
    let squared: Function = |p| (p.length_squared() - 1.0).powi(2);
    let gradient: fn(DVec3) -> DVec3 = |p| 4.0 * (p.length_squared() - 1.0) * p;
    let at = |t: f64| Outcome::Touch(crate::Hit { t, bracket: crate::Span { start: t, end: t } });
    assert!(normal_along_x(squared, gradient, at(1.0)).distance(DVec3::NEG_X) < 1e-10);
    assert!(normal_along_x(squared, gradient, at(3.0)).distance(DVec3::NEG_X) < 1e-10);
    assert!(normal_along_x(|_| 0.0, |_| DVec3::ZERO, at(1.0)).is_nan());
    assert!(normal_along_x(|_| 0.0, |_| DVec3::NAN, at(1.0)).is_nan());
    assert!(normal_along_x(squared, gradient, Outcome::Miss).is_nan());
}
