//! Many rays that look for a sphere, about where a few have found it.

use iso_expr::{Ast, Engine, Interpreter};
use pulp::Scalar;

use super::*;
use crate::Raster;
use crate::certified::beams::form::Model;
use crate::certified::beams::sheaf::Sheaf;

/// How far apart neighbouring rays are.
const PIXEL: f64 = 0.001;

/// How far roots may be from where the model has them.
const VAGUE: f64 = 0.05;

/// Where the ray in a column and a row meets the unit sphere.
fn root(column: f64, row: f64) -> f64 {
    let [x, y] = [column + 500.0, row + 300.0].map(|at| PIXEL * at);
    5.0 - (1.0 - x * x - y * y).sqrt()
}

/// How many points are taken to find all rays of an area whose roots are in a stretch, to within some tolerance.
fn taken(area: Area, stretch: Span, (tolerance, uncertainty): (f64, f64), as_list: bool) -> Taken {
    let program = Ast::parse("x^2 + y^2 + z^2").unwrap().lower(&[]).unwrap().minus_level(1.0);
    let [values, slopes] = [program.clone(), program.with_slope()]
        .map(|program| Interpreter.batch(&program.simplified()).unwrap());
    let (right, down) = (PIXEL * DVec3::X, PIXEL * DVec3::Y);
    let raster = Raster::Parallel { middle: 5.0 * DVec3::Z, right, down, direction: DVec3::NEG_Z };
    let of_raster = Tile::of(&raster, [500.0, 300.0], 64, 64);
    let rays: Vec<_> = of_raster.rays().collect();
    let tile = if as_list { Tile::listed(&rays, 64) } else { of_raster };
    let middle = area.offset_of_first();
    let by = |across: f64, along: f64| root(middle.0 + across, middle.1 + along);
    let [by_column, by_row] = [by(1.0, 0.0) - by(-1.0, 0.0), by(0.0, 1.0) - by(0.0, -1.0)].map(|by| 0.5 * by);
    let model = Model { t: by(0.0, 0.0), by_column, by_row, uncertainty };
    let start = Start::new(&model, middle, stretch);
    let mut sheaf = Sheaf::default();
    let mut expected = Vec::new();
    for row in area.rows() {
        let is_met = |column: &usize| {
            let t = root(*column as f64, row as f64);
            stretch.start <= t && t <= stretch.end
        };
        for column in area.columns().filter(is_met).take(sheaf.room()) {
            sheaf.add((column, row), 1);
            expected.push((row * 64 + column, root(column as f64, row as f64)));
        }
    }
    let bundles = sheaf.take();
    let reach = Span { start: stretch.start - 0.1, end: stretch.end + 0.1 };
    let taken = Pursuit {
        tile: &tile,
        area,
        start: &start,
        bundles,
        common: Some([reach, reach]),
        sight: &Sight {
            inverse: -0.64,
            turn: 2.0,
            unevenness: 0.3,
            bend: 0.5,
            sway: 0.5,
            blur: 1e-15,
            tolerance,
        },
        slopes: &*slopes,
        last: Last::Value(&*values),
        points: &mut PointRows::default(),
        scratch: &mut Scratch::default(),
    }
    .with_simd(Scalar::new());
    let found: Vec<_> = bundles.iter().flat_map(Bundle::hits).collect();
    assert_eq!(found.len(), expected.len());
    for ((place, hit), (expected_place, root)) in found.into_iter().zip(&expected) {
        assert_eq!(place, *expected_place);
        assert!(hit.bracket.start - 1e-14 <= *root && *root <= hit.bracket.end + 1e-14);
        assert!(hit.bracket.end - hit.bracket.start <= tolerance);
    }
    assert!(expected.len() > MANY * ROW, "{} rays", expected.len());
    Taken { slopes: taken.slopes, last: taken.last - expected.len().next_multiple_of(ROW) }
}

#[test]
fn a_few_rays_tell_where_the_others_roots_are() {
    let everywhere = Span { start: 4.0, end: 4.4 };
    let square = Area { column: 16, row: 20, width: 16, height: 16 };
    // Some slopes of the few, and next to nothing but the last values of the others.
    let Taken { slopes, last } = taken(square, everywhere, (4e-6, VAGUE), false);
    assert!((2 * ROW..=6 * ROW).contains(&slopes) && last == 0, "{slopes}, {last} more");
    // Of numbers, one slope of each ray.
    let Taken { slopes, last } = taken(square, everywhere, (1e-12, VAGUE), false);
    assert!((256 + 2 * ROW..=256 + 6 * ROW).contains(&slopes) && last == 0, "{slopes}, {last} more");
    // Each ray takes two from where the model has its root, if that is said to be nearer than the cubic.
    let Taken { slopes, .. } = taken(square, everywhere, (1e-12, 2e-12), false);
    assert!((2 * 256 + 2 * ROW..=2 * 256 + 6 * ROW).contains(&slopes), "{slopes}");
    // Rays that are no picture's have none between them.
    let Taken { slopes, .. } = taken(square, everywhere, (1e-12, VAGUE), true);
    assert_eq!(slopes, 2 * 256);
}

#[test]
fn where_rays_meet_a_part_in_a_band_the_few_are_in_it() {
    let wide = Area { column: 0, row: 0, width: 64, height: 64 };
    let band = Span { start: 4.215, end: 4.225 };
    let Taken { slopes, last } = taken(wide, band, (4e-6, VAGUE), false);
    assert!((2 * ROW..=6 * ROW).contains(&slopes) && last == 0, "{slopes}, {last} more");
}
