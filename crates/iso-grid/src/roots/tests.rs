//! Root finders against roots in closed form, and against functions that mislead them.

use std::f64::consts::PI;

use super::*;

/// A function, its derivative, an interval with one change of sign, and where that is.
struct Case {
    name: &'static str,
    value: fn(f64) -> f64,
    slope: fn(f64) -> f64,
    ends: [f64; 2],
    root: f64,
}

/// Functions that are smooth around a simple root.
const SMOOTH: [Case; 6] = [
    Case { name: "line", value: |t| 3.0 * t - 1.0, slope: |_| 3.0, ends: [0.0, 1.0], root: 1.0 / 3.0 },
    Case {
        name: "parabola",
        value: |t| t * t - 2.0,
        slope: |t| 2.0 * t,
        ends: [1.0, 2.0],
        root: std::f64::consts::SQRT_2,
    },
    Case { name: "cubic", value: |t| 27.0 - t * t * t, slope: |t| -3.0 * t * t, ends: [0.5, 7.0], root: 3.0 },
    Case { name: "sine", value: f64::sin, slope: f64::cos, ends: [3.0, 3.3], root: PI },
    Case {
        name: "exponential",
        value: |t| t.exp() - 5.0,
        slope: f64::exp,
        ends: [1.0, 2.0],
        root: 1.609_437_912_434_100_3,
    },
    Case { name: "tiny", value: |t| 1e-200 * (t - 0.7), slope: |_| 1e-200, ends: [0.0, 1.0], root: 0.7 },
];

/// Functions that change sign where no slope or straight line says so.
const HARD: [Case; 8] = [
    Case {
        name: "step",
        value: |t| if t < 0.3 { -1.0 } else { 1.0 },
        slope: |_| 0.0,
        ends: [0.0, 1.0],
        root: 0.3,
    },
    Case {
        name: "flat root",
        value: |t| (t - 0.3).powi(9),
        slope: |t| 9.0 * (t - 0.3).powi(8),
        ends: [0.0, 1.0],
        root: 0.3,
    },
    Case {
        name: "cliff",
        value: |t| (100.0 * (t - 0.3)).exp() - 1.0,
        slope: |t| 100.0 * (100.0 * (t - 0.3)).exp(),
        ends: [0.0, 1.0],
        root: 0.3,
    },
    Case {
        name: "cube root",
        value: |t| (t - 0.3).cbrt(),
        slope: |t| (t - 0.3).cbrt().powi(-2) / 3.0,
        ends: [0.0, 1.0],
        root: 0.3,
    },
    Case { name: "wrong slope", value: |t| t - 0.3, slope: |_| -1e-3, ends: [0.0, 1.0], root: 0.3 },
    Case { name: "no slope", value: |t| t - 0.3, slope: |_| f64::NAN, ends: [0.0, 1.0], root: 0.3 },
    Case {
        name: "plateau",
        value: |t| (t - 0.3).min(0.0),
        slope: |t| f64::from(u8::from(t < 0.3)),
        ends: [0.0, 1.0],
        root: 0.3,
    },
    Case {
        name: "near overflow",
        value: |t| 1.7e308 * (t - 0.3).signum(),
        slope: |_| f64::INFINITY,
        ends: [0.0, 1.0],
        root: 0.3,
    },
];

/// The bracket at last, and how many points it took.
fn narrowed(case: &Case, roots: RootFinding) -> (Bracket, usize) {
    let sample = |t: f64| Sample { t, value: (case.value)(t) };
    let mut narrowing =
        Narrowing::new(roots, Bracket { before: sample(case.ends[0]), after: sample(case.ends[1]) });
    let mut points = 0;
    while let Some(t) = narrowing.next() {
        let bracket = narrowing.bracket();
        assert!(bracket.before.t < t && t < bracket.after.t, "{}: {t} outside of {bracket:?}", case.name);
        assert!(narrowing.take(sample(t), (case.slope)(t)));
        points += 1;
        assert!(points < 1000, "{}: {roots:?} does not end", case.name);
    }
    (narrowing.bracket(), points)
}

#[test]
fn roots_are_between_neighbouring_doubles() {
    for case in SMOOTH.iter().chain(&HARD) {
        for finder in RootFinder::ALL {
            let (bracket, _) = narrowed(case, RootFinding { finder, tolerance: 0.0 });
            assert_eq!(bracket.after.t, bracket.before.t.next_up(), "{}: {finder:?}", case.name);
            assert!(
                (bracket.hit().t - case.root).abs() <= 4.0 * f64::EPSILON * case.root,
                "{}: {finder:?} {bracket:?}",
                case.name
            );
        }
    }
}

#[test]
fn intervals_are_as_narrow_as_asked_for_and_hold_the_root() {
    for case in SMOOTH.iter().chain(&HARD) {
        for finder in RootFinder::ALL {
            for tolerance in [1.0, 1e-2, 1e-6, 1e-12, 1e-300] {
                let (bracket, _) = narrowed(case, RootFinding { finder, tolerance });
                let allowed =
                    (tolerance * bracket.after.t).max(bracket.before.t.next_up() - bracket.before.t);
                assert!(bracket.width() <= allowed, "{}: {finder:?} {tolerance} {bracket:?}", case.name);
                let slack = 4.0 * f64::EPSILON * case.root;
                assert!(bracket.before.t - slack <= case.root && case.root <= bracket.after.t + slack);
            }
        }
    }
}

/// ITP takes at most one point more than bisection, as its authors prove, and one or two more where rounding moves the goal.
#[test]
fn itp_is_never_much_slower_than_bisection() {
    for case in SMOOTH.iter().chain(&HARD) {
        for tolerance in [0.0, 1e-3, 1e-9] {
            let points = |finder| narrowed(case, RootFinding { finder, tolerance }).1;
            let (itp, bisection) = (points(RootFinder::Itp), points(RootFinder::Bisection));
            assert!(itp <= bisection + 3, "{}: {itp} points, bisection {bisection}", case.name);
        }
    }
}

/// Newton's method bisects at least every third point.
#[test]
fn newton_is_never_much_slower_than_bisection() {
    for case in SMOOTH.iter().chain(&HARD) {
        let points = |finder| narrowed(case, RootFinding { finder, tolerance: 0.0 }).1;
        let (newton, bisection) = (points(RootFinder::Newton), points(RootFinder::Bisection));
        assert!(newton <= 3 * bisection + 3, "{}: {newton} points, bisection {bisection}", case.name);
    }
}

#[test]
fn smooth_functions_take_few_points() {
    for case in &SMOOTH {
        let points = RootFinder::ALL.map(|finder| narrowed(case, RootFinding { finder, tolerance: 0.0 }).1);
        let [bisection, itp, newton] = points;
        assert!(bisection > 45 && itp <= 13 && newton <= 11, "{}: {points:?}", case.name);
    }
}

#[test]
fn a_point_without_a_value_moves_no_end() {
    let sample = |t: f64, value: f64| Sample { t, value };
    let bracket = Bracket { before: sample(0.0, -1.0), after: sample(1.0, 1.0) };
    let mut narrowing = Narrowing::new(RootFinding::PAPER, bracket);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!narrowing.take(sample(0.5, value), f64::NAN));
        assert_eq!((narrowing.bracket().before.t, narrowing.bracket().after.t), (0.0, 1.0));
    }
}
