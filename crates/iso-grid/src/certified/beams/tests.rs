//! Rays that stand side by side end as they do one by one.

use std::sync::Arc;

use glam::DVec3;
use pulp::Arch;

use super::sheaf::Sheaf;
use super::subdivision::{Known, KnownAlong, Subdivision};
use crate::testing::surface_of;
use crate::{
    Certified, Outcome, OutcomeKind, Outcomes, Raster, Region, Span, Tile, Traced, Tracer, Workspace,
};

/// Silhouettes, edges of unions and of intersections, one that is cut, and a limb.
const FORMULAS: [&str; 5] = [
    "x^2 + y^2 + z^2 - 1",
    "min((x - 0.4)^2 + y^2 + z^2 - 0.5, (x + 0.4)^2 + y^2 + z^2 - 0.4)",
    "max(x^2 + y^2 + z^2 - 1, 0.3 - x^2 - y^2, z - x/3 - 0.4)",
    "min(max(x^2 + z^2 - 0.4, abs(y) - 0.8), x^2 + y^2 + z^2 - 0.6)",
    "(x - clamp(x, -0.5, 0.7))^2 + y^2 + (z + x/3)^2 - 0.15",
];

/// How the rays of a tile end, and their normals' bits.
fn ends(formula: &str, arch: Arch) -> (Outcomes, Vec<[u64; 3]>) {
    let surface = surface_of(formula);
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let certified = Certified::new(&surface, region).unwrap();
    let raster = Raster::Parallel {
        middle: DVec3::new(0.3, 0.2, 4.0),
        right: DVec3::new(0.04, 0.0, 0.01),
        down: DVec3::new(0.002, 0.04, -0.008),
        direction: DVec3::new(-0.25, 0.2, -1.0),
    };
    let tile = Tile::of(&raster, [-12.0, -32.0], 64, 64);
    let mut workspace = Workspace { arch, ..Workspace::default() };
    let mut outcomes = Outcomes::default();
    let mut normals = vec![DVec3::NAN; tile.len()];
    certified.trace_tile(&mut workspace, tile, &mut outcomes, Some(&mut normals));
    (outcomes, normals.iter().map(|normal| normal.to_array().map(f64::to_bits)).collect())
}

#[test]
fn rays_end_alike_whatever_the_processor_computes_with_at_once() {
    for formula in FORMULAS {
        let (found, one_by_one) = (ends(formula, Arch::new()), ends(formula, Arch::Scalar));
        assert_eq!(found, one_by_one, "{formula}");
        let hits = found.0.kinds().iter().filter(|kind| **kind == OutcomeKind::Hit).count();
        assert!((300..3500).contains(&hits), "{formula}: {hits}");
    }
}

/// A plane is followed along all rays of such a row at once, for which a sheaf has no room.
#[test]
fn rows_may_be_longer_than_a_sheaf() {
    let surface = surface_of("z - x/10 = 0.05");
    let region = Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
    let certified = Certified::new(&surface, region).unwrap();
    let width = 2 * Sheaf::MOST + 88;
    let raster = Raster::Parallel {
        middle: DVec3::new(0.0, 0.0, 4.0),
        right: DVec3::new(1.8 / width as f64, 0.0, 0.0),
        down: DVec3::new(0.0, 0.01, 0.0),
        direction: DVec3::NEG_Z,
    };
    let tile = Tile::of(&raster, [-0.5 * width as f64, 0.0], width, 3);
    let (mut workspace, mut outcomes) = (Workspace::default(), Outcomes::default());
    assert_eq!(certified.trace_tile(&mut workspace, tile, &mut outcomes, None), Traced::Outcomes);
    for (ray, outcome) in tile.rays().zip(outcomes.iter()) {
        let Outcome::Hit(hit) = outcome else { panic!("{outcome:?}") };
        assert!((4.0 - hit.t - ray.origin.x / 10.0 - 0.05).abs() < 1e-11, "{hit:?}");
    }
    // Once on each ray, and on none for its own.
    let taken = workspace.counters.trace_evaluations;
    assert!(taken < tile.len() as u64 + 64, "{taken}");
}

/// Kernels of the same function on the same box are known by their number, but not where less is left of them: that holds on a slab alone.
#[test]
fn what_is_left_on_a_slab_is_not_known_elsewhere() {
    let surface = surface_of(FORMULAS[1]);
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let certified = Certified::new(&surface, region).unwrap();
    let rays = [crate::Ray { origin: 4.0 * DVec3::Z, direction: DVec3::NEG_Z }];
    let (mut workspace, mut outcomes) = (Workspace::default(), Outcomes::default());
    let ends = (&mut outcomes, None);
    let mut subdivision = Subdivision::new(&certified, &mut workspace, rays[..].into(), ends).unwrap();

    let place = certified.places.kernels(DVec3::splat(1.1), DVec3::splat(1.2));
    let number_of =
        |subdivision: &mut Subdivision<'_>, other| subdivision.known_number_of(Arc::clone(&place), other);
    let first = number_of(&mut subdivision, 0);
    assert!(first > 0, "less is left there than everywhere");
    assert_eq!(number_of(&mut subdivision, 0), first, "the last one is known");
    let left = subdivision.number_of(Arc::clone(subdivision.kernels(first)));
    subdivision.faces[left as usize] = Known::OnSlab(None);
    assert_eq!(number_of(&mut subdivision, first), first, "and the other one");
    let again = number_of(&mut subdivision, left);
    assert!(again != left && !subdivision.is_narrowed(again));
}

/// Of two planes, the nearer one is met wherever the farther one alone is not known to be F. A third one is left out in any place.
#[test]
fn a_ray_is_searched_by_what_is_known_along_it_where_that_is_all_of_the_stretch() {
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let certified = Certified::new(&surface_of("min(0.7 - z, 0.2 - z + x/9, y + 3)"), region).unwrap();
    let other = Certified::new(&surface_of("0.7 - z"), region).unwrap();
    let rays = [crate::Ray { origin: DVec3::new(0.1, 0.2, -1.25), direction: DVec3::Z }];
    let found = |stretch: Span, known: Option<Span>| {
        let (mut workspace, mut outcomes) = (Workspace::default(), Outcomes::default());
        let ends = (&mut outcomes, None);
        let mut subdivision = Subdivision::new(&certified, &mut workspace, rays[..].into(), ends).unwrap();
        let kernels = subdivision.number_of(Arc::clone(&other.kernels));
        subdivision.search_one((0, 0), stretch, known.map(|span| KnownAlong { kernels, span }));
        let Some(Outcome::Hit(hit)) = outcomes.iter().next() else { panic!("no hit") };
        (hit.t, workspace.counters.operations)
    };
    let (nearer, farther) = (1.45 + 0.1 / 9.0, 1.95);
    let stretch = Span { start: 1.4, end: 2.0 };
    let [all, less] = [stretch, Span { end: 1.98, ..stretch }];
    for (known, expected) in [(None, nearer), (Some(less), nearer), (Some(all), farther)] {
        let (t, _) = found(stretch, known);
        assert!((t - expected).abs() < 1e-9, "{known:?}: {t}");
    }
    assert_eq!(found(stretch, Some(less)), found(stretch, None), "by what is left in the place");
}
