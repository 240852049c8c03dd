mod precise;

use astro_float::BigFloat;
use iso_expr::random::Random;
use iso_expr::{Ast, Program};

use super::*;
use precise::{difference, error, exactly, product, sum, value};

fn program(formula: &str) -> Program {
    Ast::parse(formula).unwrap().lower(&[]).unwrap().program().clone()
}

/// Forms with digits to lose, what to write instead, and a point where the digits are lost.
const FORMS: [(&str, &str, [f64; 3]); 12] = [
    ("exp(x*y) - 1", "expm1(x*y)", [1e-6, 3e-7, 0.0]),
    ("1 - exp(x)", "-expm1(x)", [-1e-9, 0.0, 0.0]),
    ("1 - cos(x)", "2*sin(x/2)^2", [3e-7, 0.0, 0.0]),
    ("cos(x*y) - 1", "-2*sin((x*y)/2)^2", [1e-3, 0.02, 0.0]),
    ("ln(1 + (x*y))", "log1p(x*y)", [1e-6, 1e-7, 0.0]),
    ("ln(x + 1)", "log1p(x)", [-3e-10, 0.0, 0.0]),
    ("ln(1 - x)", "log1p(-x)", [1e-12, 0.0, 0.0]),
    ("sqrt((x^2) + (y*y))", "hypot(x, y)", [3e-162, 4e-162, 0.0]),
    ("(x^2) - ((y + z)^2)", "(x - (y + z))*(x + (y + z))", [1.31250000017, 0.8125, 0.5]),
    ("1 - (x*x)", "(1 - x)*(1 + x)", [0.999999987, 0.0, 0.0]),
    ("(y^2) - 2.25", "(y - 1.5)*(y + 1.5)", [0.0, 1.50000000004567, 0.0]),
    ("sqrt(x) - sqrt(y + 1)", "(x - (y + 1))/(sqrt(x) + sqrt(y + 1))", [1.2500000001, 0.25, 0.0]),
];

/// Polynomials written out, their form by Horner, and where their terms cancel.
const POLYNOMIALS: [(&str, &str, [f64; 2]); 5] = [
    ("x^3 - 3*x^2 + 3*x - 1", "((x - 3)*x + 3)*x - 1", [0.5, 1.5]),
    ("-1 + 9*x^2 - 6*x^4 + x^6", "((x^2 - 6)*x^2 + 9)*x^2 - 1", [-2.0, 2.0]),
    ("64*x^7 - 112*x^5 + 56*x^3 - 7*x", "(((64*x^2 - 112)*x^2 + 56)*x^2 - 7)*x", [-1.0, 1.0]),
    (
        "1 - 32*x^2 + 160*x^4 - 256*x^6 + 128*x^8",
        "(((128*x^2 - 256)*x^2 + 160)*x^2 - 32)*x^2 + 1",
        [-1.0, 1.0],
    ),
    (
        "120 - 274*x + 225*x^2 - 85*x^3 + 15*x^4 - x^5",
        "((((-x + 15)*x - 85)*x + 225)*x - 274)*x + 120",
        [1.0, 5.0],
    ),
];

/// All forms, and what to write instead.
fn pairs() -> impl Iterator<Item = (&'static str, &'static str)> {
    let polynomials = POLYNOMIALS.map(|(written, instead, _)| (written, instead));
    FORMS.map(|(written, instead, _)| (written, instead)).into_iter().chain(polynomials)
}

#[test]
fn forms_that_lose_digits_are_found() {
    for (written, instead) in pairs() {
        for formula in [written.to_owned(), format!("({written}) + abs(z)")] {
            let found = hints(&program(&formula));
            let [hint] = &found[..] else { panic!("{formula}: {found:?}") };
            assert_eq!((hint.written.as_str(), hint.instead.as_str()), (written, instead), "{formula}");
        }
    }
}

/// As a whole, left side minus right side, it has two constants: nobody wrote that polynomial.
#[test]
fn an_equation_with_constants_on_both_sides_holds_a_polynomial() {
    let [hint] = &hints(&program("x^3 - 3*x^2 + 3*x - 1 = 0.125"))[..] else { panic!("one hint") };
    assert_eq!(hint.written, "x^3 - 3*x^2 + 3*x - 1");
}

#[test]
fn what_is_offered_is_equal() {
    let mut random = Random::new(1);
    for (written, instead) in pairs() {
        let [one, other] = [written, instead].map(program);
        for _ in 0..50 {
            let point = [(); 3].map(|()| random.between(0.1, 0.9));
            let [one, other] = [&one, &other].map(|program| value(program, point));
            let allowed = product(&one.abs(), &exactly(2.0_f64.powi(-400)));
            assert!(
                is_less(&difference(&one, &other).abs(), &allowed),
                "{written} is not {instead} at {point:?}"
            );
        }
    }
}

/// At hard points doubles lose seven digits or more in the one form, and keep all but a few bits of the last in the other.
#[test]
fn what_is_offered_keeps_digits() {
    for (written, instead, hard) in FORMS {
        let [written, instead] = [written, instead].map(program);
        let exact = value(&written, hard);
        let error_of = |program: &Program| error(program.evaluate(hard)[0], &exact);
        let part = |share: f64| product(&exact.abs(), &exactly(share));
        assert!(is_less(&part(1e-9), &error_of(&written)), "{written} loses nothing");
        assert!(is_less(&error_of(&instead), &part(1e-15)), "{instead} loses digits");
    }
}

/// What Horner's form gains is less, but it is there: errors of two thirds at most, on average.
#[test]
fn horner_rounds_less() {
    let mut random = Random::new(2);
    for (written, instead, [from, to]) in POLYNOMIALS {
        let programs = [written, instead].map(program);
        let mut errors = [exactly(0.0), exactly(0.0)];
        for _ in 0..400 {
            let point = [random.between(from, to), 0.0, 0.0];
            let exact = value(&programs[0], point);
            for (total, program) in errors.iter_mut().zip(&programs) {
                *total = sum(total, &error(program.evaluate(point)[0], &exact));
            }
        }
        let [written_out, nested] = errors;
        assert!(
            is_less(&product(&nested, &exactly(1.5)), &written_out),
            "{written}: {nested} against {written_out}"
        );
    }
}

#[test]
fn differences_of_roots_name_where_they_differ() {
    let [hint] = &hints(&program("sqrt(x) - sqrt(2*y)"))[..] else { panic!("one hint") };
    let text = hint.to_string();
    assert!(text.ends_with("(x - (2*y))/(sqrt(x) + sqrt(2*y)) keeps more of them, but is another function where x and (2*y) are 0"), "{text}");
}

#[test]
fn good_forms_are_left_alone() {
    for formula in [
        "expm1(x) - y",
        "exp(x) - 2",
        "log1p(x)",
        "hypot(x, y)",
        "x^2 + y^2 + z^2 - 1",
        "2 - cos(x)",
        "x^2 - 2",
        "x^2 - 2*x + 1",
        "x^4 + 2*x^2 + 1",
        "x^6 + 3*x^4 + 3*x^2 + 1",
        "x^4 - 5*x^2 + 4",
        "x^3 - 3*x^2*y + 3*x*y^2 - y^3",
        "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8",
        "((x - 3)*x + 3)*x - 1",
    ] {
        assert_eq!(hints(&program(formula)), [], "{formula}");
    }
}

/// Sums of a part with itself, over and over, are as many terms as nobody can write.
#[test]
fn repeated_sums_take_no_time() {
    let definitions: String =
        (1..60).map(|place| format!("f{place}(u) := f{}(u) + f{}(u)^2; ", place - 1, place - 1)).collect();
    hints(&program(&format!("f0(u) := u; {definitions}f12(x)")));
    let doubled: String =
        (1..60).map(|place| format!("a{place} := a{} + a{}; ", place - 1, place - 1)).collect();
    hints(&program(&format!("a0 := x; {doubled}a59")));
}

fn is_less(one: &BigFloat, other: &BigFloat) -> bool {
    one.cmp(other).is_some_and(|order| order < 0)
}
