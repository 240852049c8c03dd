//! The certified method on surfaces whose roots have closed forms.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{Ast, Decoration, Engine, Interpreter, Interval, Operation, Program, Scratch};
use iso_grid::{
    Accuracy, Certified, Hit, Outcome, Outcomes, Ray, Region, Span, Surface, Tile, Tracer, Workspace,
};

const X: DVec3 = DVec3::X;

fn certified(formula: &str, half_side: f64) -> Certified {
    let value = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
    let surface = Surface::new(Arc::new(Interpreter), value);
    let corner = DVec3::splat(half_side);
    Certified::new(&surface, Region::new(-corner, corner).unwrap()).unwrap()
}

fn trace(tracer: &Certified, rays: &[Ray]) -> Vec<Outcome> {
    let mut outcomes = Outcomes::default();
    tracer.trace(&mut Workspace::default(), rays, &mut outcomes);
    outcomes.iter().collect()
}

fn end(formula: &str, half_side: f64, origin: DVec3, direction: DVec3) -> Outcome {
    trace(&certified(formula, half_side), &[Ray { origin, direction }])[0]
}

/// Asserts a hit at `t`, which is known to a few roundings.
fn assert_hit(outcome: Outcome, t: f64) {
    assert_hit_within(8.0 * f64::EPSILON * t.abs().max(1.0), outcome, t);
}

/// Asserts a hit at `t`, which is known up to `slack`.
fn assert_hit_within(slack: f64, outcome: Outcome, t: f64) {
    let Outcome::Hit(Hit { t: found, bracket }) = outcome else {
        panic!("expected a hit at {t}, not {outcome:?}")
    };
    assert!(bracket.start <= t + slack && t - slack <= bracket.end, "{bracket:?} does not hold {t}");
    assert!(bracket.start <= found && found <= bracket.end, "{found} lies outside {bracket:?}");
    assert!(bracket.end - bracket.start <= 1e-12 * t.abs().max(1.0), "{bracket:?} is too wide");
}

#[test]
fn a_sphere_is_hit_where_its_quadratic_says() {
    let tracer = certified("x^2+y^2+z^2-1", 1.5);
    let mut random = Random::new(1);
    let mut number = || random.between(-1.0, 1.0);
    let rays: Vec<Ray> = (0..2000)
        .map(|_| {
            let origin = DVec3::new(5.0 + number(), number(), number());
            let target = 1.2 * DVec3::new(number(), number(), number());
            Ray { origin, direction: (target - origin) * (2.0 + number()) }
        })
        .collect();
    for (ray, outcome) in rays.iter().zip(trace(&tracer, &rays)) {
        let (o, d) = (ray.origin, ray.direction);
        let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
        let discriminant = b * b - a * c;
        if discriminant.abs() < 1e-3 * b * b {
            continue;
        }
        if discriminant < 0.0 {
            assert_eq!(outcome, Outcome::Miss);
        } else {
            // Rounding of the discriminant moves the root by this part of it.
            let condition = b * b / discriminant;
            let t = c / (-b + discriminant.sqrt());
            assert_hit_within(4.0 * f64::EPSILON * condition * t, outcome, t);
        }
    }
}

#[test]
fn a_squared_sphere_is_touched() {
    for formula in ["(x^2+y^2+z^2-1)^2", "x^4+2*x^2*(y^2+z^2)+(y^2+z^2)^2-2*x^2-2*(y^2+z^2)+1"] {
        let outcome = end(formula, 1.5, DVec3::new(-3.0, 0.3, 0.2), X);
        let t = 3.0 - (1.0_f64 - 0.09 - 0.04).sqrt();
        let Outcome::Touch(Hit { t: found, bracket }) = outcome else { panic!("{formula}: {outcome:?}") };
        assert!(bracket.start <= t + 1e-15 && (found - t).abs() < 1e-14, "{formula}: {outcome:?}, not {t}");
    }
}

/// Intervals cannot tell these roots at x = 2 and 2.0001 from touches, for they do not see what cancels. Between them F is certainly not
/// zero.
#[test]
fn a_touch_is_where_f_may_be_zero() {
    for scale in ["1e5", "1e6"] {
        let cancels = format!("{scale}*((x + 1)^3 - x^3 - 3*x^2 - 3*x - 1)");
        let formula = format!("1000*x^2 - 4000.1*x + 4000.2 + {cancels}");
        let Outcome::Touch(Hit { t, bracket }) = end(&formula, 3.0, DVec3::new(0.3, 1.9, 2.1), X) else {
            panic!("{formula} is touched");
        };
        assert!((t - 1.7).abs() < 2e-6 && bracket.end - bracket.start < 4e-6, "{formula}: {t}, {bracket:?}");
    }
}

#[test]
fn a_fifth_power_is_touched_for_its_crossing_is_not_simple() {
    let outcome = end("(x^2+y^2+z^2-1)^5", 1.5, DVec3::new(-3.0, 0.3, 0.2), X);
    let t = 3.0 - (1.0_f64 - 0.09 - 0.04).sqrt();
    assert!(matches!(outcome, Outcome::Touch(hit) if (hit.t - t).abs() < 1e-12), "{outcome:?}, not {t}");
}

#[test]
fn a_plateau_is_touched_where_it_starts() {
    let outcome = end("max(0, x^2+y^2+z^2-1)", 1.5, DVec3::new(-3.0, 0.0, 0.0), X);
    assert!(matches!(outcome, Outcome::Touch(hit) if (hit.t - 2.0).abs() < 1e-12), "{outcome:?}");
    assert!(
        matches!(end("0*x", 1.0, DVec3::new(-3.0, 0.0, 0.0), X), Outcome::Touch(hit) if (hit.t - 2.0).abs() < 1e-12)
    );
}

/// Where z is the greatest of all, F is z − z, which no enclosure over a stretch tells to be zero. The rays come to where that begins at z = 1, in the
/// face of the box, and at z = x, from where z is less.
#[test]
fn t_of_a_touch_is_where_a_plateau_begins() {
    for (formula, origin, direction, t) in [
        ("max(x, z) - max(y, z)", DVec3::new(0.1, -0.2, 3.0), DVec3::NEG_Z, 2.0),
        ("(max(x, z) - max(y, z))^2", DVec3::new(0.1, -0.2, -3.0), DVec3::Z, 3.1),
        ("abs(max(x, z) - max(y, z))", DVec3::new(0.1, -0.2, -3.0), DVec3::Z, 3.1),
        ("(max(x, z) - max(y, z))^2", DVec3::new(0.5, -0.2, -3.0), DVec3::new(-0.1, 0.0, 1.0), 3.5 / 1.1),
    ] {
        let outcome = end(formula, 1.0, origin, direction);
        let Outcome::Touch(Hit { t: found, bracket }) = outcome else { panic!("{formula}: {outcome:?}") };
        assert!((found - t).abs() < 1e-14, "{formula}: {outcome:?}, not {t}");
        assert!(bracket.start <= found && found <= bracket.end, "{formula}: {outcome:?}");
    }
}

/// F falls until z = x, is zero as far as z = y, and rises behind that.
#[test]
fn t_of_a_touch_is_where_the_flat_bottom_of_a_valley_begins() {
    let origin = DVec3::new(3.5, -3.5, -0.05);
    let outcome = end("(max(x, z) - max(y, z))^2", 1.0, origin, DVec3::new(-1.0, 1.0, 0.1));
    let Outcome::Touch(Hit { t, bracket }) = outcome else { panic!("{outcome:?}") };
    assert!((t - 3.55 / 1.1).abs() < 1e-14, "{outcome:?}");
    assert!(bracket.start <= t && t <= bracket.end, "{outcome:?}");
}

#[test]
fn the_poles_of_a_tangent_are_passed() {
    let tracer = certified("tan(x) - y", 4.0);
    for y in [-3.5, -0.7, 0.1, 2.0] {
        for first in [-4.0, -2.0, 0.0, 1.0, 1.5] {
            let origin = DVec3::new(first, y, 0.3);
            let expected =
                (-2..3).map(|turn| f64::from(turn) * PI + y.atan()).find(|root| *root > first).unwrap()
                    - first;
            let outcome = trace(&tracer, &[Ray { origin, direction: X }])[0];
            if first + expected < 4.0 {
                assert_hit(outcome, expected)
            } else {
                assert_eq!(outcome, Outcome::Miss)
            }
        }
    }
}

#[test]
fn nothing_but_a_root_is_a_root() {
    for formula in [
        "1/(x-0.1)",
        "1/(x-0.1)^2 + 1",
        "floor(x) + 0.5",
        "sign(x - 0.1) + 0.2",
        "if(x < 0.3, 1, -1)",
        "round(3x) - 0.5",
        "mod(x, 1) + 1e-3",
        "atan2(x - 0.1, -1)",
        "sqrt(x - 0.3) + 1e-3",
        "ln(x)^2 + 1e-3",
        "tan(x) / tan(x) + 1",
        "asin(x) + 2",
    ] {
        let origin = DVec3::new(-3.0, 0.11, 0.07);
        let outcome = end(formula, 1.5, origin, DVec3::new(1.0, 0.01, 0.003));
        assert_eq!(outcome, Outcome::Miss, "{formula}");
    }
}

/// Beside 0/0 enclosures of quotients are wide however small the stretch is. F is −1, −1/2, −1 and 3.2 there.
#[test]
fn beside_an_undefined_quotient_nothing_is_touched() {
    for formula in ["x/x - 2", "sin(x)/x - 1.5", "(exp(x)-1)/x - 2", "(x^2-1e-2)/(x-0.1) + 3"] {
        let outcome = end(formula, 1.5, DVec3::new(-1.1, 0.3, 0.3), DVec3::new(1.0, 0.1, 0.0));
        assert!(matches!(outcome, Outcome::Miss | Outcome::Undecided(_)), "{formula}: {outcome:?}");
    }
}

/// A ray's points are known up to roundings, over which such quotients take all values; in each point they are constant but for roundings. F is
/// 3/10, π/4 − 1 or −3π/4 − 1, 3/10, and −1/2 there.
#[test]
fn beside_a_plane_of_undefined_quotients_nothing_is_touched() {
    let mut random = Random::new(7);
    let mut number = || random.between(-1.0, 1.0);
    let rays: Vec<Ray> = (0..500)
        .map(|_| {
            let origin = DVec3::new(3.0 * number(), 3.0 * number(), 4.0 + number());
            let target = DVec3::new(number(), number(), 0.0);
            Ray { origin, direction: (target - origin).normalize() }
        })
        .collect();
    for formula in ["z/z - 0.7", "atan2(z, z) - 1", "sin(z)/z - 0.7", "z^3/z^3 - 1.5"] {
        for outcome in trace(&certified(formula, 1.0), &rays) {
            assert!(matches!(outcome, Outcome::Miss | Outcome::Undecided(_)), "{formula}: {outcome:?}");
        }
    }
}

/// Points of these rays lie beside the plane by roundings.
#[test]
fn a_ray_in_a_plane_that_is_nowhere_crossed_touches_it() {
    let mut random = Random::new(8);
    for _ in 0..500 {
        let mut number = || random.between(0.5, 1.0);
        let (u, v) = (number(), number());
        let ray = Ray { origin: DVec3::new(u + 0.25, u, 0.3), direction: DVec3::new(v, v, -1.0) };
        for formula in ["abs(x - y - 0.25)", "(x - y - 0.25)^2", "(x - y - 0.25)^8"] {
            let outcome = trace(&certified(formula, 4.0), &[ray])[0];
            assert!(matches!(outcome, Outcome::Touch(_)), "{formula}: {outcome:?} along {ray:?}");
        }
    }
}

#[test]
fn a_root_behind_jumps_poles_and_edges_is_found() {
    for (formula, t) in [
        ("(x - 0.75)/(x + 0.25)", 3.75),
        ("floor(2x) + x - 1.6", 3.6),
        ("sqrt(x) - 0.5", 3.25),
        ("ln(x)", 4.0),
        ("if(x < 0.5, 3, x - 1.25)", 4.25),
        ("mod(x, 1) - 0.25", 2.25),
    ] {
        assert_hit(end(formula, 1.5, DVec3::new(-3.0, 0.1, 0.2), X), t);
    }
}

#[test]
fn a_shell_a_millionth_thick_is_hit_outside() {
    let outcome = end("(x^2+y^2+z^2-1)^2 - 1e-12", 1.5, DVec3::new(-3.0, 0.0, 0.0), X);
    assert_hit(outcome, 3.0 - (1.0_f64 + 1e-6).sqrt());
}

#[test]
fn a_tiny_sphere_is_hit_and_missed() {
    let tracer = certified("x^2+y^2+z^2-1e-8", 2.0);
    let at = |y: f64| trace(&tracer, &[Ray { origin: DVec3::new(-3.0, y, 0.0), direction: X }])[0];
    assert_hit(at(0.0), 3.0 - 1e-4);
    assert_hit(at(0.999e-4), 3.0 - 1e-4 * (1.0_f64 - 0.999 * 0.999).sqrt());
    assert_eq!(at(1.001e-4), Outcome::Miss);
}

#[test]
fn a_root_on_a_face_of_the_region_is_undecided() {
    let outcome = end("abs(x) - 1.5", 1.5, DVec3::new(-3.0, 0.1, 0.2), DVec3::new(0.7, 0.0, 0.0));
    assert!(
        matches!(outcome, Outcome::Undecided(Span { start, end }) if start <= 1.5 / 0.7 && 1.5 / 0.7 <= end)
    );
}

/// To see whether it is simple, a root at the origin is looked at from both sides; what is said of it lies on the ray.
#[test]
fn a_root_where_the_ray_begins_lies_on_the_ray() {
    for formula in
        ["x - 0.5", "(x - 0.5)^2", "(x - 0.5)^3", "x^2 - 0.25", "max(x - 0.5, 0)", "1e-320*(x - 0.5)"]
    {
        for origin in [DVec3::new(0.5, 0.1, 0.2), DVec3::new(0.5, 0.0, 0.0)] {
            for direction in [X, -X, DVec3::new(1e-300, 1.0, 0.0), DVec3::new(-3.0, 1e-9, 0.2)] {
                let outcome = end(formula, 1.5, origin, direction);
                let start = match outcome {
                    Outcome::Hit(hit) | Outcome::Touch(hit) => hit.bracket.start,
                    Outcome::Undecided(span) => span.start,
                    Outcome::Miss => panic!("{formula} has a root at 0 along {direction}"),
                };
                assert!(start == 0.0, "{formula} along {direction}: {outcome:?}");
            }
        }
    }
}

#[test]
fn a_root_outside_the_region_is_none() {
    assert_eq!(end("x - 1.6", 1.5, DVec3::new(-3.0, 0.1, 0.2), X), Outcome::Miss);
    assert_eq!(end("x + 2", 1.5, DVec3::new(-3.0, 0.1, 0.2), X), Outcome::Miss);
    assert_eq!(end("x", 1.5, DVec3::new(0.5, 0.1, 0.2), X), Outcome::Miss);
    assert_eq!(end("x", 1.5, DVec3::new(-3.0, 1.6, 0.2), X), Outcome::Miss);
}

#[test]
fn what_is_no_ray_misses() {
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(end("x", 1.5, DVec3::new(-1.0, 0.0, 0.0), direction), Outcome::Miss);
    }
}

#[test]
fn work_without_end_is_given_up() {
    let outcome = end("sin(1e8x)*sin(1e8x + 1) + 0.3", 1.5, DVec3::new(-3.0, 0.1, 0.2), X);
    assert!(matches!(outcome, Outcome::Undecided(_)), "{outcome:?}");
}

#[test]
fn a_coarser_accuracy_gives_a_wider_enclosure_that_holds_the_root() {
    let tracer = certified("x^3 + x - 0.3", 1.5).with_accuracy(Accuracy::Relative(1e-3));
    let Outcome::Hit(coarse) = trace(&tracer, &[Ray { origin: -3.0 * X, direction: X }])[0] else { panic!() };
    let Outcome::Hit(fine) = end("x^3 + x - 0.3", 1.5, -3.0 * X, X) else { panic!() };
    assert!(coarse.bracket.start <= fine.bracket.start && fine.bracket.end <= coarse.bracket.end);
}

#[test]
fn an_accuracy_beyond_rounding_gives_what_rounding_allows() {
    for accuracy in [1e-300, 0.0, -1.0, f64::NAN] {
        let tracer = certified("x^3 + x - 0.3", 1.5).with_accuracy(Accuracy::Relative(accuracy));
        let (rays, mut outcomes) = ([Ray { origin: -3.0 * X, direction: X }; 64], Outcomes::default());
        tracer.trace_tile(&mut Workspace::default(), Tile::listed(&rays, 8), &mut outcomes, None);
        for outcome in trace(&tracer, &rays[..1]).into_iter().chain(outcomes.iter()) {
            let Outcome::Hit(Hit { bracket: Span { start, end }, .. }) = outcome else {
                panic!("{accuracy}: {outcome:?}")
            };
            assert!(end - start <= 64.0 * f64::EPSILON * end, "{accuracy}: {outcome:?}");
        }
    }
}

/// The first of `steps` equal parts of the region's part of the ray in which the sign of F certainly changes and F is
/// continuous.
fn first_certain_crossing(program: &Program, ray: &Ray, span: Span, steps: usize) -> Option<Span> {
    let kernel = Interpreter.boxes(program).unwrap();
    let enclose = |part: Span| {
        let ends = [0, 1, 2].map(|axis| {
            let (o, d) = (Interval::point(ray.origin[axis]), Interval::point(ray.direction[axis]));
            o.plus(Interval::new(part.start, part.end).unwrap().times(d))
        });
        let (lo, hi) = (ends.map(|end| [end.lo]), ends.map(|end| [end.hi]));
        let boxes = Boxes { lo: lo.each_ref().map(|end| &end[..]), hi: hi.each_ref().map(|end| &end[..]) };
        let (mut lo, mut hi, mut decoration) = ([0.0], [0.0], [Decoration::Trivial]);
        let enclosures = Enclosures { lo: &mut lo, hi: &mut hi, decoration: &mut decoration };
        kernel.evaluate(&mut Scratch::default(), boxes, enclosures);
        (Interval { lo: lo[0], hi: hi[0] }, decoration[0])
    };
    let at = |step: usize| span.start + (span.end - span.start) * step as f64 / steps as f64;
    let sign = |t: f64| {
        let value = enclose(Span { start: t, end: t }).0;
        if value.lo > 0.0 {
            1
        } else if value.hi < 0.0 {
            -1
        } else {
            0
        }
    };
    let parts = (0..steps).map(|step| Span { start: at(step), end: at(step + 1) });
    parts
        .into_iter()
        .find(|part| sign(part.start) * sign(part.end) < 0 && enclose(*part).1 >= Decoration::Continuous)
}

#[test]
fn no_crossing_of_a_random_program_is_passed() {
    let operations: Vec<_> = Operation::all().collect();
    assert_no_crossing_is_passed(5, &operations, 2000);
}

#[test]
fn no_crossing_of_a_random_polynomial_is_passed() {
    use Operation::{Add, IntegerPower, Multiply, Negate, Subtract};
    assert_no_crossing_is_passed(
        6,
        &[Add, Subtract, Subtract, Multiply, Multiply, Negate, IntegerPower],
        1000,
    );
}

fn assert_no_crossing_is_passed(seed: u64, allowed: &[Operation], programs: usize) {
    const STEPS: usize = 200;
    let mut random = Random::new(seed);
    let region = Region::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
    let (mut crossings, mut hits) = (0, 0);
    for number in 0..programs {
        let operations = 1 + random.below(12);
        let program = random.program_of(operations, allowed).simplified();
        let surface = Surface::new(Arc::new(Interpreter), program.clone());
        let tracer = Certified::new(&surface, region).unwrap();
        let mut corner = || DVec3::new(random.coordinate(), random.coordinate(), random.coordinate());
        let (origin, target) = (2.0 * corner(), corner());
        let ray = Ray { origin, direction: target - origin };
        let Some(span) = region.clip(&ray) else { continue };
        let outcome = trace(&tracer, &[ray])[0];
        let Some(crossing) = first_certain_crossing(&program, &ray, span, STEPS) else { continue };
        crossings += 1;
        let start = match outcome {
            Outcome::Miss => f64::INFINITY,
            Outcome::Hit(hit) | Outcome::Touch(hit) => hit.bracket.start,
            Outcome::Undecided(stretch) => stretch.start,
        };
        hits += usize::from(matches!(outcome, Outcome::Hit(_)));
        assert!(
            start <= crossing.end,
            "program {number} crosses in {crossing:?}: {outcome:?}\n{ray:?}\n{program}"
        );
    }
    assert!(crossings > 100 && hits > crossings / 2, "{crossings} crossings, {hits} hits");
}
