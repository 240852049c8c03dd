//! What is proven of a surface's cells is kept from picture to picture, and changes no bit of them.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Interpreter};
use iso_grid::{Counters, Method, Outcomes, Ray, Region, Surface, Workspace};

fn surface(formula: &str) -> Surface {
    let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
    Surface::new(Arc::new(Interpreter), program)
}

/// Rays from around the region into it, from another side for another `view`.
fn rays(view: u32) -> Vec<Ray> {
    let (sin, cos) = (0.7 + 0.4 * f64::from(view)).sin_cos();
    let forward = DVec3::new(sin, cos, -0.3).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let offset = |place: u32| (f64::from(place) - 11.5) / 8.0;
    (0..24 * 24)
        .map(|ray| Ray {
            origin: offset(ray % 24) * right + offset(ray / 24) * up - 6.0 * forward,
            direction: forward,
        })
        .collect()
}

fn follow(surface: &Surface, region: Region, rays: &[Ray]) -> (Outcomes, Counters) {
    let tracer = Method::CERTIFIED.prepare(surface, region).unwrap();
    let mut workspace = Workspace::default();
    let mut outcomes = Outcomes::default();
    tracer.trace(&mut workspace, rays, &mut outcomes);
    (outcomes, workspace.counters)
}

#[test]
fn a_moved_camera_spares_what_is_proven_of_cells() {
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    for formula in ["(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2", "min(x^2+y^2+z^2, (x-1)^2+y^2) = 0.1"] {
        let kept = surface(formula);
        let (_, first) = follow(&kept, region, &rays(0));
        for view in [1, 2] {
            let (anew, from_nothing) = follow(&surface(formula), region, &rays(view));
            let (again, spared) = follow(&kept, region, &rays(view));
            assert_eq!(anew, again, "{formula}");
            let saved = from_nothing.box_evaluations - spared.box_evaluations;
            assert!(saved > from_nothing.box_evaluations / 20, "{formula}: {saved} of {from_nothing:?}");
        }
        // All that the first picture found out of cells is known now.
        let (_, same_view) = follow(&kept, region, &rays(0));
        assert!(same_view.box_evaluations < first.box_evaluations);
    }
}

#[test]
fn cells_of_another_region_are_others() {
    let formula = "x^2 + y^2 + z^2 = 1";
    let (near, far) = (
        Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap(),
        Region::new(DVec3::splat(0.0), DVec3::splat(4.0)).unwrap(),
    );
    let kept = surface(formula);
    for region in [near, far, near] {
        let (outcomes, _) = follow(&kept, region, &rays(0));
        assert_eq!(outcomes, follow(&surface(formula), region, &rays(0)).0, "{region:?}");
    }
}
