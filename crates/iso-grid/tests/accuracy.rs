//! Roots are enclosed as narrowly as is asked for.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Interpreter};
use iso_grid::{
    Accuracy, Certified, Hit, Outcome, Outcomes, Raster, Ray, Region, Span, Surface, Tile, Tracer, Workspace,
};

const SIDE: usize = 48;

/// How far apart neighbouring rays are, where the picture's middle is at distance 1 if they spread.
const PIXEL: f64 = 0.03;

fn rasters() -> [Raster; 2] {
    let (forward, eye) = (DVec3::Z, -4.0 * DVec3::Z);
    // Wide pixels: the narrower way counts.
    let [right, down] = [1.5 * PIXEL * DVec3::X, -PIXEL * DVec3::Y];
    [
        Raster::Parallel { middle: eye, right, down, direction: 0.5 * forward },
        Raster::Spreading { eye, forward, right: 0.3 * right, down: 0.3 * down },
    ]
}

/// The rays that meet the unit sphere, and where.
fn hits(tile: Tile<'_>, accuracy: Accuracy) -> Vec<(Ray, Hit)> {
    let program =
        Ast::parse("x^2 + y^2 + z^2 - 1").unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
    let surface = Surface::new(Arc::new(Interpreter), program);
    let region = Region::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    let certified = Certified::new(&surface, region).unwrap().with_accuracy(accuracy);
    let mut outcomes = Outcomes::default();
    certified.trace_tile(&mut Workspace::default(), tile, &mut outcomes, None);
    let hits = tile.rays().zip(outcomes.iter()).filter_map(|(ray, outcome)| match outcome {
        Outcome::Hit(hit) => Some((ray, hit)),
        _ => None,
    });
    hits.collect()
}

/// The first root of x² + y² + z² = 1 along a ray.
fn root(Ray { origin, direction }: Ray) -> f64 {
    let (a, b, c) = (direction.dot(direction), origin.dot(direction), origin.dot(origin) - 1.0);
    (-b - (b * b - a * c).sqrt()) / a
}

/// The widest of some brackets that hold the roots, as part of how wide they may be at t.
fn widest(hits: &[(Ray, Hit)], most: impl Fn(f64) -> f64) -> f64 {
    assert!(hits.len() > 500, "{} hits", hits.len());
    let share = |(ray, Hit { t, bracket: Span { start, end } }): &(Ray, Hit)| {
        let expected = root(*ray);
        assert!(start - 1e-14 <= expected && expected <= end + 1e-14, "{expected} in {start}..{end}");
        assert!(start <= t && t <= end);
        (end - start) / most(*t)
    };
    hits.iter().map(share).fold(0.0, f64::max)
}

#[test]
fn pictures_take_a_share_of_a_pixel_and_numbers_less() {
    for raster in rasters() {
        let tile = Tile::of(&raster, [0.5 - 0.5 * SIDE as f64; 2], SIDE, SIDE);
        let share = |t: f64| {
            Accuracy::SHARE_OF_PIXEL
                * match raster {
                    Raster::Parallel { .. } => PIXEL / 0.5,
                    Raster::Spreading { .. } => 0.3 * PIXEL * t,
                }
        };
        let of_pixels = widest(&hits(tile, Accuracy::Pixels), share);
        assert!((0.1..1.0).contains(&of_pixels), "{of_pixels} of what counts, {raster:?}");
        let rays: Vec<_> = tile.rays().collect();
        for (tile, accuracy) in [(tile, Accuracy::NARROW), (Tile::listed(&rays, SIDE), Accuracy::Pixels)] {
            let of_narrow = widest(&hits(tile, accuracy), |t| 1e-12 * t);
            assert!(of_narrow <= 1.0, "{of_narrow} of what is narrow, {accuracy:?}");
        }
    }
}
