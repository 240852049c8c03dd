use crate::random::Random;
use crate::{Ast, Interval, Program};

fn program(formula: &str) -> Program {
    Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified()
}

fn cube(lo: f64, hi: f64) -> [Interval; 3] {
    [Interval::new(lo, hi).unwrap(); 3]
}

/// The operations that are left of a formula on the cube from `lo` to `hi`.
fn operations_left(formula: &str, lo: f64, hi: f64) -> Option<usize> {
    Some(program(formula).shortened(cube(lo, hi))?.operations())
}

#[test]
fn branches_that_are_never_taken_are_left_out() {
    let cases = [
        ("min(x^2 + 1, sin(y) - 2)", 2),
        ("max(x^2 + 1, sin(y) - 2)", 2),
        ("min(x, min(y + 7, min(z + 8, x*y + 9)))", 0),
        ("max(abs(x + 3), exp(-y) - 9)", 1),
        ("max(abs(x - 3), exp(-y) - 9)", 2),
        ("if(x < 5, y, exp(z))", 0),
        ("if(x > 5, exp(z), y)", 0),
        ("y * sign(x - 3)", 1),
        ("y + floor(2.5 + x/4) * exp(x)", 3),
        ("sqrt(max(x - 4, 0)^2 + max(y - 4, 0)^2) + z", 1),
    ];
    for (formula, operations) in cases {
        let left = operations_left(formula, 0.25, 1.0);
        assert!(left.is_some_and(|left| left <= operations), "{formula}: {left:?}");
    }
}

#[test]
fn what_is_open_or_may_be_undefined_stays() {
    let cases = [
        // Both branches are taken.
        "min(x, y)",
        "abs(x - 0.5)",
        "if(x < 0.5, y, exp(z))",
        // The branch not taken is undefined on a part of the box, and with it the minimum.
        "min(x, 9 + sqrt(y - 0.5))",
        "min(x, 9 + 1/(y - 0.5)^2)",
        // It overflows on its way.
        "max(x, -1 - 1/exp(exp(exp(7 + x))))",
        // The condition may be undefined.
        "if(sqrt(x - 0.5) < 5, y, exp(z))",
        // A zero whose sign is open.
        "1 / floor(x - 0.25)",
    ];
    for formula in cases {
        assert_eq!(operations_left(formula, 0.25, 1.0), None, "{formula}");
    }
}

#[test]
fn what_is_zero_is_left_out_over_boxes() {
    let program = program("if(x < 5, 0, exp(z)) * exp(y) + y");
    let short = program.shortened_over_boxes(cube(0.25, 1.0)).unwrap();
    assert_eq!(short.operations(), 0, "{short}");
}

/// Random programs on random boxes compute the same doubles as what they come to there, and enclosures of that are no wider.
#[test]
fn shortened_programs_compute_the_same() {
    let mut random = Random::new(5);
    let mut shortened = 0;
    for _ in 0..40_000 {
        let program = random.program(1 + shortened % 24).simplified();
        let domain = [(); 3].map(|()| {
            let (center, radius) = (random.between(-3.0, 3.0), 10f64.powf(random.between(-4.0, 0.5)));
            Interval::new(center - radius, center + radius).unwrap()
        });
        let Some(short) = program.shortened(domain) else { continue };
        shortened += 1;
        for _ in 0..16 {
            let point = domain.map(|side| random.inside(side));
            let (expected, found) = (program.evaluate(point), short.evaluate(point));
            for (expected, found) in expected.iter().zip(&found) {
                let is_same = expected.to_bits() == found.to_bits() || expected.is_nan() && found.is_nan();
                assert!(
                    is_same,
                    "{found:?} instead of {expected:?} at {point:?} in {domain:?}\n{program}\n{short}"
                );
            }
        }
    }
    assert!(shortened > 1000, "only {shortened} were shortened");
}
