//! Rays that look for spheres, and planes.

use glam::DVec3;
use iso_expr::{Ast, Engine, Interpreter, Scratch};
use pulp::{Arch, Scalar, WithSimd};

use super::*;
use crate::Raster;
use crate::area::Area;
use crate::certified::beams::form::Model;
use crate::certified::beams::pursuit::{Last, Pursuit, Taken};
use crate::certified::beams::sheaf::{Sheaf, Start};
use crate::point_rows::PointRows;

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
    let sight = Sight {
        inverse: -0.5,
        turn: 2.0,
        unevenness: 0.3,
        bend: 0.5,
        sway: 0.5,
        blur: 1e-15,
        tolerance: 1e-12,
    };
    let start = Start::new(&model, (3.5, 3.5), Span { start: 4.0, end: 4.4 });
    let mut sheaf = Sheaf::default();
    (0..8).for_each(|row| sheaf.add((0, row), 0xff));
    let bundles = sheaf.take();
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
    let (mut points, mut scratch) = (PointRows::default(), Scratch::default());
    let taken = run(Pursuit {
        tile: &tile,
        area: Area { column: 0, row: 0, width: 8, height: 8 },
        start: &start,
        bundles,
        common: None,
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
    sheaf.add((1, 0), 1);
    let [bundle] = sheaf.take() else { panic!("one ray is one bundle") };
    bundle.look_along([wanted, reach]);
    bundle.places[0] = 1;
    bundle.inverse[0] = 1.0;
    let sight = Sight {
        inverse: 1.0,
        turn: 0.0,
        unevenness: 1e-9,
        bend: 1e-9,
        sway: 1e-9,
        blur: 0.0,
        tolerance: 1e-12,
    };
    let (x, yz) = ([2.0; ROW], [0.0; ROW]);
    let mut normals = [DVec3::NAN; 3];
    // F is t − 1, and is not taken near its root at first.
    for (t, expected) in [(1.0 + 1e-6, DVec3::NAN), (1.0 + 1e-13, DVec3::X)] {
        (bundle.t[0], bundle.state[0]) = (t, state::OPEN);
        let value = [t - 1.0; ROW];
        assert_eq!(bundle.conclude(simd, &value, (&sight, true)), Need::Nothing, "the root is proven");
        bundle.put_normals(simd, ([&x, &yz, &yz], sight.tolerance), &mut normals);
        assert_eq!(normals[1].to_array().map(f64::to_bits), expected.to_array().map(f64::to_bits));
    }
    assert!(normals[0].is_nan() && normals[2].is_nan());
    // For other rays F is taken again, where this one was decided before, and not near its root.
    let found: Vec<_> = bundle.hits().collect();
    bundle.t[0] = 1.0 + 1e-6;
    bundle.conclude(simd, &[2e-6; ROW], (&sight, false));
    bundle.put_normals(simd, ([&yz, &x, &yz], sight.tolerance), &mut normals);
    assert_eq!(normals[1], DVec3::X);
    assert!(found.len() == 1 && bundle.hits().eq(found));
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

#[test]
fn the_first_step_bends_as_slopes_do_where_that_is_known() {
    let (wanted, reach) = (Span { start: 0.5, end: 1.5 }, Span { start: 0.0, end: 2.0 });
    // F is (t − 1) + (t − 1)²/2, taken at 1.1.
    let [value, slope] = [0.105, 1.1].map(|number| [number; ROW]);
    let newton = 1.1 - 0.105 / 1.1;
    let unknown = [0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|turn| (turn, newton, 1e-15));
    for (turn, expected, most) in [(1.0, 1.0, 1e-6)].into_iter().chain(unknown) {
        let mut sheaf = Sheaf::default();
        sheaf.add((0, 0), 1);
        let [bundle] = sheaf.take() else { panic!("one ray is one bundle") };
        bundle.look_along([wanted, reach]);
        (bundle.t, bundle.step) = ([1.1; ROW], [f64::INFINITY; ROW]);
        let sight = Sight {
            inverse: 1.0,
            turn,
            unevenness: 0.5,
            bend: 0.25,
            sway: 0.25,
            blur: 0.0,
            tolerance: 1e-12,
        };
        let need = bundle.approach(Scalar::new(), [&value, &slope], (&sight, true));
        assert_eq!(need, Need::Slopes);
        assert!((bundle.t[0] - expected).abs() <= most, "{turn}: {}", bundle.t[0]);
        assert_eq!(
            (bundle.state[0], bundle.wanted, bundle.reach),
            (state::OPEN, [[0.5; ROW], [1.5; ROW]], [[0.0; ROW], [2.0; ROW]])
        );
    }
}

/// One step ends at the root of a parabola, and another is asked for where slopes are known to be no nearer to even.
#[test]
fn slopes_that_sway_ask_for_another_step() {
    let (wanted, reach) = (Span { start: 0.5, end: 1.5 }, Span { start: 0.0, end: 2.0 });
    // F is (t − 1) + (t − 1)²/2, taken at 1.001.
    let [value, slope] = [0.0010005, 1.001].map(|number| [number; ROW]);
    for (sway, expected) in
        [(0.0, Need::Last), (1e-6, Need::Last), (0.25, Need::Slopes), (f64::NAN, Need::Slopes)]
    {
        let mut sheaf = Sheaf::default();
        sheaf.add((0, 0), 1);
        let [bundle] = sheaf.take() else { panic!("one ray is one bundle") };
        bundle.look_along([wanted, reach]);
        (bundle.t, bundle.step) = ([1.001; ROW], [f64::INFINITY; ROW]);
        let sight =
            Sight { inverse: 1.0, turn: 1.0, unevenness: 0.5, bend: 0.25, sway, blur: 0.0, tolerance: 1e-12 };
        assert_eq!(bundle.approach(Scalar::new(), [&value, &slope], (&sight, true)), expected, "{sway}");
        assert!((bundle.t[0] - 1.0).abs() < 1e-15, "{}", bundle.t[0]);
    }
}

/// Where the model is as good as what is wanted. Nothing is left of rays that the bundle held before.
#[test]
fn the_last_look_may_be_the_first() {
    let program = Ast::parse("(6 - z)^2/4").unwrap().lower(&[]).unwrap().minus_level(1.0);
    let (right, down) = (0.1 * DVec3::X, 0.1 * DVec3::Y);
    let raster = Raster::Parallel { middle: 5.0 * DVec3::Z, right, down, direction: DVec3::NEG_Z };
    let tile = Tile::of(&raster, [0.0, 0.0], 1, 1);
    let model = Model { t: 1.01, by_column: 0.0, by_row: 0.0, uncertainty: 0.02 };
    let sight =
        Sight { inverse: 1.0, turn: 0.5, unevenness: 0.1, bend: 0.1, sway: 0.1, blur: 1e-15, tolerance: 0.1 };
    let [wanted, reach] = [Span { start: 0.5, end: 1.5 }, Span { start: 0.4, end: 1.6 }];
    let start = Start::new(&model, (0.0, 0.0), wanted);
    let [values, slopes] = [program.clone(), program.with_slope()]
        .map(|program| Interpreter.batch(&program.simplified()).unwrap());
    for before in [0.0, 7.0, f64::NAN] {
        let mut sheaf = Sheaf::default();
        sheaf.add((0, 0), 1);
        let bundles = sheaf.take();
        let bundle = &mut bundles[0];
        (bundle.value, bundle.inverse, bundle.step) = ([before; ROW], [before; ROW], [before; ROW]);
        let taken = Pursuit {
            tile: &tile,
            area: Area { column: 0, row: 0, width: 1, height: 1 },
            start: &start,
            bundles,
            common: Some([wanted, reach]),
            sight: &sight,
            slopes: &*slopes,
            last: Last::Value(&*values),
            points: &mut PointRows::default(),
            scratch: &mut Scratch::default(),
        }
        .with_simd(Scalar::new());
        assert_eq!((taken.slopes, taken.last), (0, ROW));
        let [(0, hit)] = bundles[0].hits().collect::<Vec<_>>()[..] else { panic!("the ray has a root") };
        // F is (1 + t)²/4 − 1, with a slope of 1 where it is zero.
        assert!((hit.t - 1.0).abs() < 1e-4, "{before}: {hit:?}");
        assert!(hit.bracket.start <= 1.0 && 1.0 <= hit.bracket.end);
    }
}

/// Whichever of its slopes F has, and however far its value is off.
#[test]
fn what_encloses_a_root_holds_all_that_there_may_be() {
    let concluded = |[t, value]: [f64; 2], [unevenness, blur]: [f64; 2], wanted: Span| {
        let mut sheaf = Sheaf::default();
        sheaf.add((0, 0), 1);
        let [bundle] = sheaf.take() else { panic!("one bundle") };
        bundle.look_along([wanted, Span { start: 0.5, end: 1.5 }]);
        (bundle.t, bundle.inverse) = ([t; ROW], [1.0; ROW]);
        let sight = Sight { inverse: 1.0, turn: 0.0, unevenness, bend: 0.1, sway: 0.1, blur, tolerance: 0.1 };
        bundle.conclude(Scalar::new(), &[value; ROW], (&sight, true));
        (bundle.hits().next().map(|(_, hit)| hit.bracket), bundle.state[0])
    };
    for (taken, errors, [first, last]) in [
        // Slopes from 0.8 to 1.2, a value that is off, and a root between two doubles.
        ([1.1, 0.02], [0.25, 0.0], [1.1 - 0.02 / 0.8, 1.1 - 0.02 / 1.2]),
        ([1.1, 0.02], [0.0, 1e-3], [1.079, 1.081]),
        ([1.0, 2_f64.powi(-60)], [0.0, 0.0], [1.0 - f64::EPSILON, 1.0]),
    ] {
        let found = |start, end| concluded(taken, errors, Span { start, end });
        for (start, end) in [(0.6, 1.4), (0.6, first), (last, 1.4)] {
            let (Some(bracket), state::HIT) = found(start, end) else { panic!("{taken:?}, {start}, {end}") };
            assert!(bracket.start <= first && last <= bracket.end, "{bracket:?}");
        }
        assert_eq!([found(0.6, first - 0.01), found(last + 0.01, 1.4)], [(None, state::FREE); 2]);
    }
}
