use crate::random::Random;
use crate::{Ast, Interval, Operation, Program};

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

/// Asserts that no more than so many operations are left of each formula.
fn assert_left(cases: &[(&str, usize)]) {
    for (formula, operations) in cases {
        let left = operations_left(formula, 0.25, 1.0);
        assert!(left.is_some_and(|left| left <= *operations), "{formula}: {left:?}");
    }
}

#[test]
fn branches_that_are_never_taken_are_left_out() {
    assert_left(&[
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
    ]);
}

#[test]
fn branches_that_do_not_matter_to_the_sign_are_left_out() {
    assert_left(&[
        ("min(x - 0.5, y)", 1),
        ("max(x - 0.5, -y)", 1),
        ("-min(x - 0.5, y + z)", 2),
        ("max(-min(x - 0.5, y * z), z - 2)", 2),
        // The lesser of two that are positive.
        ("min(x, y)", 0),
        // F is negative, whatever z - 0.5 is.
        ("min(z - 0.5, x - 3)", 1),
        ("min(x, y + 0.5) = 0.6", 1),
        ("max(x, y - 0.5) + -0.6", 1),
        ("min(x, y + 0.5) = -0.1", 1),
        ("0.6 - min(x, y + 0.5)", 1),
        // It may be undefined, which is for the other to say.
        ("min(x, 9 + sqrt(y - 0.5))", 3),
    ]);
}

#[test]
fn what_is_open_or_may_be_undefined_stays() {
    let cases = [
        // Both branches are taken.
        "min(x - 0.5, y - 0.5)",
        "abs(x - 0.5)",
        "if(x < 0.5, y, exp(z))",
        // Its value matters, here and beside its sign.
        "exp(min(x - 0.5, y - 0.25))",
        "max(min(x - 0.5, y - 0.25), exp(min(x - 0.5, y - 0.25)) - 1)",
        "min(min(4*x, 1.55 + exp(sin(cos(exp(sin(y)))))^3) - 1.5, min(4*x, 1.55 + exp(sin(cos(exp(sin(y)))))^3)^2 - 5*z)",
        // Two sides of it matter.
        "max(min(x - 0.3, y - 0.1), min(x - 0.3, y - 0.1) - 0.5)",
        // It matters on which side of a number other than zero the minimum lies.
        "-min(x - 0.9, y - 1.5) = 0.6",
        // The differences of two signs are not those of the numbers.
        "min(x, y) - z",
        // The branch not taken is undefined on a part of the box, and with it the minimum.
        "min(x - 0.5, 9 + sqrt(y - 0.5))",
        "min(x - 0.5, 9 + 1/(y - 0.5)^2)",
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

/// As `(m + 1/2) + 3/10 > 0` is not `m + 1/2 > 0`.
#[test]
fn sums_of_sums_keep_their_terms() {
    let formula = "-(min(x - 0.6, y - 0.5) + 0.5) + 0.3";
    let as_it_stands = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().clone();
    assert_eq!(as_it_stands.shortened(cube(0.25, 1.0)).map(|short| short.operations()), None);
}

/// Where a formula is cut, it only matters on which side of zero it lies, if it is a number at all.
#[test]
fn what_is_cut_is_shortened_as_the_whole_is() {
    assert_left(&[
        ("min(x - 0.5, y) where z < 0.7", 5),
        ("max(x - 0.5, exp(-y z) - 9 - sin(x)*cos(y + z)^2*exp(x + y)) where z < 0.7 or y > x", 7),
        // There is nothing in all of the box.
        ("min(x - 0.5, y) where z > 2", 5),
    ]);
    for formula in
        ["exp(min(x - 0.5, y - 0.25)) - 1 where z < 0.7", "min(x - 0.5, y) + sin(9z) where z < 0.7"]
    {
        assert_eq!(operations_left(formula, 0.25, 1.0), None, "{formula}");
    }
}

/// The same program, nothing where one of its values is negative.
fn cut(mut program: Program, random: &mut Random) -> Program {
    let ids: Vec<_> = program.iter().map(|(id, _)| id).collect();
    let root = program.apply(Operation::SquareRoot, &[random.choose(&ids)]);
    let zero = program.literal(0.0);
    let nothing = program.apply(Operation::Multiply, &[zero, root]);
    let output = program.apply(Operation::Add, &[program.outputs[0], nothing]);
    program.set_outputs(vec![output]);
    program
}

/// What random programs come to on random boxes has their signs there, in doubles, and is undefined where they are.
#[test]
fn shortened_programs_have_the_same_signs() {
    let mut random = Random::new(5);
    let (mut shortened, mut differ) = (0, 0);
    for _ in 0..40_000 {
        let program = random.program(1 + shortened % 24);
        let program = if random.below(3) == 0 { cut(program, &mut random) } else { program }.simplified();
        let domain = [(); 3].map(|()| {
            let (center, radius) = (random.between(-3.0, 3.0), 10f64.powf(random.between(-4.0, 0.5)));
            Interval::new(center - radius, center + radius).unwrap()
        });
        let Some(short) = program.shortened(domain) else { continue };
        shortened += 1;
        for _ in 0..16 {
            let point = domain.map(|side| random.inside(side));
            let [expected, found] = [&program, &short].map(|program| program.evaluate(point)[0]);
            let is_same = expected.partial_cmp(&0.0) == found.partial_cmp(&0.0);
            assert!(
                is_same,
                "{found:?} instead of {expected:?} at {point:?} in {domain:?}\n{program}\n{short}"
            );
            differ += u32::from(expected != found);
        }
    }
    assert!(shortened > 1000, "only {shortened} were shortened");
    assert!(differ > 100, "only {differ} values were let go");
}

#[test]
fn what_may_be_undefined_somewhere_is_not_said_to_be_a_number_everywhere() {
    for formula in
        ["x^3 - 2*y + 1", "min(x, sin(y)) + abs(z)", "sqrt(x^2 + y^2 + 1)", "if(x < y, x, floor(z))"]
    {
        assert!(program(formula).is_defined_everywhere(), "{formula}");
    }
    for formula in ["1/x", "sqrt(x)", "min(x, ln(y))", "tan(z)", "x^y", "asin(x)"] {
        assert!(!program(formula).is_defined_everywhere(), "{formula}");
    }
}
