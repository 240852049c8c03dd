//! Rays that look for spheres, and planes.

use glam::DVec3;
use iso_expr::{Ast, Engine, Interpreter};
use pulp::{Arch, Scalar};

use super::*;
use crate::Raster;
use crate::certified::beams::form::Model;
use crate::certified::beams::sheaf::{Sheaf, Start};

/// Where the ray of a place meets the sphere.
fn root_of(place: usize) -> f64 {
    let [x, y] = [place % 8, place / 8].map(|at| 0.05 * (at as f64 - 3.5));
    5.0 - (1.0 - x * x - y * y).sqrt()
}

/// How rays end, and the normals that were found on the way.
type Ends = (Vec<(usize, Result<Hit, Span>)>, Vec<DVec3>);

/// Where rays parallel to z end that look for the unit sphere, by what processors do that `run` chooses.
fn ends_on_a_sphere(with_normals: bool, run: impl Fn(Pursuit<'_>) -> Taken) -> Ends {
    let program = Ast::parse("x^2 + y^2 + z^2").unwrap().lower(&[]).unwrap().minus_level(1.0);
    let raster = Raster::Parallel {
        middle: DVec3::new(0.0, 0.0, 5.0),
        right: DVec3::new(0.05, 0.0, 0.0),
        down: DVec3::new(0.0, 0.05, 0.0),
        direction: DVec3::NEG_Z,
    };
    let tile = Tile::of(&raster, [-3.5, -3.5], 8, 8);
    let model = Model { t: 4.1, by_column: 0.0, by_row: 0.0, uncertainty: 0.2 };
    let sight = Sight { inverse: -0.5, turn: 2.0, unevenness: 0.3, bend: 0.5, blur: 1e-15, tolerance: 1e-12 };
    let start = Start::new(&model, (3.5, 3.5), Span { start: 4.0, end: 4.4 });
    let mut sheaf = Sheaf::default();
    (0..8).for_each(|row| sheaf.add((0, row), &[true; 8], &start));
    let bundles = sheaf.take([Span::default(); 2]);
    for bundle in &mut *bundles {
        bundle.clip(|column, row| {
            // The last row's roots lie before what is wanted, the fifth's before where F may be looked at, and the sixth's right
            // before that.
            let from = if row == 7 { 4.3 } else { 3.9 };
            let wanted = Span { start: from, end: 4.6 };
            let begin = match row {
                5 => 4.1,
                6 => root_of(8 * row + column) + 1e-13,
                _ => from,
            };
            let reach = Span { start: begin, end: 4.7 };
            ((row, column) != (2, 3)).then_some([wanted, reach])
        });
    }
    let [values, slopes, gradients] = [program.clone(), program.with_slope(), program.with_gradient()]
        .map(|program| Interpreter.batch(&program.simplified()).unwrap());
    let mut normals = vec![DVec3::NAN; tile.len()];
    let last = if with_normals { Last::Gradient(&*gradients, &mut normals) } else { Last::Value(&*values) };
    let (mut points, mut scratch) = (PointBatch::default(), Scratch::default());
    let taken = run(Pursuit {
        tile: &tile,
        start: &start,
        bundles,
        sight: &sight,
        slopes: &*slopes,
        last,
        points: &mut points,
        scratch: &mut scratch,
    });
    // All rays are looked at, and those of five rows meet the sphere.
    assert!((2 * 64..=3 * 64).contains(&taken.slopes), "{taken:?}");
    assert!((40..=64).contains(&taken.last), "{taken:?}");
    let hits = bundles.iter().flat_map(Bundle::hits).map(|(place, hit)| (place, Ok(hit)));
    let lost = bundles.iter().flat_map(Bundle::lost).map(|(place, stretch)| (place, Err(stretch)));
    (hits.chain(lost).collect(), normals)
}

#[test]
fn normals_are_those_of_gradients_next_to_the_hit_alone() {
    let simd = Scalar::new();
    let (wanted, reach) = (Span { start: 0.5, end: 1.5 }, Span { start: 0.0, end: 2.0 });
    let mut sheaf = Sheaf::default();
    let model = Model { t: 1.0, by_column: 0.0, by_row: 0.0, uncertainty: 0.1 };
    let start = Start::new(&model, (0.0, 0.0), wanted);
    sheaf.add((1, 0), &[true], &start);
    let [bundle] = sheaf.take([wanted, reach]) else { panic!("one ray is one bundle") };
    bundle.places[0] = 1;
    // F is t − 1, and was not taken near its root.
    (bundle.t[0], bundle.inverse[0]) = (1.0 + 1e-6, 1.0);
    let sight = Sight { inverse: 1.0, turn: 0.0, unevenness: 1e-9, bend: 1e-9, blur: 0.0, tolerance: 1e-12 };
    let (x, yz) = ([2.0; ROW], [0.0; ROW]);
    let mut normals = [DVec3::NAN; 3];
    for expected in [DVec3::NAN, DVec3::X] {
        let value = [bundle.t[0] - 1.0; ROW];
        assert_eq!(bundle.conclude(simd, &value, &sight), Need::Nothing, "the root is proven");
        bundle.put_normals(simd, ([&x, &yz, &yz], sight.tolerance), &mut normals);
        assert_eq!(normals[1].to_array().map(f64::to_bits), expected.to_array().map(f64::to_bits));
    }
    assert!(normals[0].is_nan() && normals[2].is_nan());
}

#[test]
fn rays_end_where_they_meet_the_sphere_on_any_processor() {
    let (found, normals) = ends_on_a_sphere(true, |pursuit| Arch::new().dispatch(pursuit));
    let (alone, none) = ends_on_a_sphere(false, |pursuit| Arch::new().dispatch(pursuit));
    assert_eq!(found, alone, "normals change nothing");
    assert!(none.iter().all(|normal| normal.is_nan()));
    let bits = |normals: &[DVec3]| {
        normals.iter().map(|normal| normal.to_array().map(f64::to_bits)).collect::<Vec<_>>()
    };
    let is_the_same = |(others, other_normals): Ends| {
        assert_eq!((&found, bits(&normals)), (&others, bits(&other_normals)));
    };
    is_the_same(ends_on_a_sphere(true, |pursuit| pursuit.with_simd(Scalar::new())));
    #[cfg(target_arch = "x86_64")]
    if let Some(processor) = pulp::x86::V3::try_new() {
        is_the_same(ends_on_a_sphere(true, |pursuit| Simd::vectorize(processor, pursuit)));
    }
    assert_eq!(found.len(), 64 - 8 - 1, "the last row is free, and one lane has no ray");
    for (place, hit) in found.iter().copied() {
        let root = root_of(place);
        let [x, y] = [place % 8, place / 8].map(|at| 0.05 * (at as f64 - 3.5));
        let normal = DVec3::new(x, y, 5.0 - root);
        assert_eq!(hit.is_ok(), normals[place].distance(normal) < 1e-12, "{place}");
        match hit {
            Ok(Hit { t, bracket: Span { start, end } }) => {
                assert!(start <= t && t <= end && end - start <= 1e-12, "{place}");
                // The closed form is rounded, too.
                assert!(start - 1e-15 <= root && root <= end + 1e-15, "{place}");
                assert!(place / 8 < 5, "{place}");
            }
            Err(stretch) => {
                assert!(place / 8 >= 5, "{place}");
                assert_eq!(stretch, Span { start: 3.9, end: 4.6 }, "what is wanted is as before");
            }
        }
    }
}
