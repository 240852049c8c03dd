//! What models mean, and what is said about wrong ones.

use proptest::prelude::*;

use super::super::error::FormulaErrorKind;
use super::*;

/// The value of a model whose operands `_a` and `_b` are x and y.
fn value(operation: &str, a: f64, b: f64) -> f64 {
    let arity = CODES.iter().find(|(name, _)| *name == operation).unwrap().1.arity();
    let operands = ["", "_a", "_a _b"][arity];
    let text = format!("_a var-x\n_b var-y\n_c {operation} {operands}\n");
    Formula::read_model(&text).unwrap().program().evaluate([a, b, 0.0])[0]
}

fn error(text: &str) -> (FormulaErrorKind, &str) {
    let FormulaError { kind, span, .. } = Formula::read_model(text).unwrap_err();
    (kind, &text[span])
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_name() {
    let model = Formula::read_model("\u{feff}a var-x\nb neg a").unwrap();
    assert_eq!(model.program().evaluate([2.0, 0.0, 0.0]), [-2.0]);
    assert_eq!(error("\u{feff}a var-x\nb add a q").1, "q");
}

#[test]
fn operations_mean_what_fidget_documents() {
    // fidget's `and` and `or` are short circuits, `mod` is `rem_euclid`, `round` that of Rust's floats.
    for (operation, a, b, expected) in [
        ("square", -3.0, 0.0, 9.0),
        ("sub", 5.0, 2.0, 3.0),
        ("div", 1.0, 4.0, 0.25),
        ("compare", 1.0, 2.0, -1.0),
        ("compare", 2.0, 2.0, 0.0),
        ("compare", 3.0, 2.0, 1.0),
        ("and", 0.0, 7.0, 0.0),
        ("and", 2.0, 7.0, 7.0),
        ("or", 0.0, 7.0, 7.0),
        ("or", 2.0, 7.0, 2.0),
        ("not", 0.0, 0.0, 1.0),
        ("not", 0.5, 0.0, 0.0),
        ("atan2", 1.0, -1.0, 0.75 * std::f64::consts::PI),
    ] {
        assert_eq!(value(operation, a, b), expected, "{operation} {a} {b}");
    }
}

proptest! {
    #[test]
    fn rounding_and_remainders_are_those_of_rust(a in -1e3..1e3_f64, b in -9.0..9.0_f64, halves in -99..99) {
        for a in [a, f64::from(halves) / 2.0, (f64::from(halves) / 2.0).next_up(), 0.5_f64.next_down()] {
            prop_assert_eq!(value("round", a, 0.0), a.round());
            prop_assume!(b != 0.0);
            prop_assert_eq!(value("mod", a, b), a.rem_euclid(b));
        }
    }

    #[test]
    fn no_text_does_harm(text in "([a-c_]( (const|add|var-x|square|[a-c_]|[0-9.e-]{1,4})){0,4}\n){0,9}|.{0,40}") {
        let _ = Formula::read_model(&text);
    }

    #[test]
    fn what_is_written_is_read(lines in prop::collection::vec((4..31_usize, 0..1000_usize, 0..1000_usize), 1..60)) {
        // The same operations on the same operands, by the model's text and by the formula language.
        let mut model = String::from("v0 var-x\nv1 var-y\nv2 var-z\n");
        let mut formula = String::new();
        let mut names = vec!["x".to_owned(), "y".to_owned(), "z".to_owned()];
        for (code, a, b) in lines {
            let name = CODES[code].0;
            let Some(written) = in_the_language(name) else { continue };
            let (a, b) = (a % names.len(), b % names.len());
            let operands = if CODES[code].1.arity() == 1 { format!("v{a}") } else { format!("v{a} v{b}") };
            model.push_str(&format!("v{} {name} {operands}\n", names.len()));
            let result = format!("w{}", names.len());
            let term = written.replace('A', &names[a]).replace('B', &names[b]);
            formula.push_str(&format!("{result} := {term};"));
            names.push(result);
        }
        formula.push_str(names.last().unwrap());
        let expected = crate::Ast::parse(&formula).unwrap().lower(&[]).unwrap();
        let read = Formula::read_model(&model).unwrap();
        for point in [[0.3, -1.2, 0.7], [2.5, 0.0, -3.0]] {
            let (read, expected) = (read.program().evaluate(point), expected.program().evaluate(point));
            prop_assert!(read[0].to_bits() == expected[0].to_bits() || read[0].is_nan() && expected[0].is_nan());
        }
    }
}

/// An operation on A and B as formulas write it.
fn in_the_language(name: &str) -> Option<&'static str> {
    Some(match name {
        "add" => "A + B",
        "sub" => "A - B",
        "mul" => "A * B",
        "div" => "A / B",
        "min" => "min(A, B)",
        "max" => "max(A, B)",
        "atan2" => "atan2(A, B)",
        "neg" => "-A",
        "abs" => "abs(A)",
        "sqrt" => "sqrt(A)",
        "square" => "A^2",
        "floor" => "floor(A)",
        "ceil" => "ceil(A)",
        "sin" => "sin(A)",
        "cos" => "cos(A)",
        "tan" => "tan(A)",
        "asin" => "asin(A)",
        "acos" => "acos(A)",
        "atan" => "atan(A)",
        "ln" => "ln(A)",
        "exp" => "exp(A)",
        _ => return None,
    })
}

#[test]
fn comments_blanks_and_line_ends_do_not_count() {
    let model = Formula::read_model("# sphere\r\n\r\n  _0 var-x\r\n\t_1 square _0 \r\n # end").unwrap();
    assert_eq!(model.program().evaluate([3.0, 0.0, 0.0]), [9.0]);
    assert!(!model.is_equation() && model.parameters().is_empty());
}

#[test]
fn faults_are_named_with_their_place() {
    use FormulaErrorKind::*;
    let name = |name: &str| name.to_owned();
    assert_eq!(error("a var-x\nb add a q\n"), (UnknownName { name: name("q") }, "q"));
    assert_eq!(error("a add a a"), (UnknownName { name: name("a") }, "a"));
    assert_eq!(error("a var-x\nb foo a"), (UnknownOperation { name: name("foo") }, "foo"));
    assert_eq!(error("a var-x\na var-y"), (DefinedTwice { name: name("a") }, "a"));
    assert_eq!(error("a\n"), (MissingOperation { name: name("a") }, "a"));
    assert_eq!(error("a const one"), (NotANumber { found: name("one") }, "one"));
    assert_eq!(error("a const inf"), (NumberOutOfRange { number: name("inf") }, "inf"));
    assert_eq!(error("a const 1e999"), (NumberOutOfRange { number: name("1e999") }, "1e999"));
    assert_eq!(error("# nothing\n\n"), (Empty, ""));
    let count = |function: &str, given, expected: &str| ArgumentCount {
        function: name(function),
        given,
        expected: name(expected),
    };
    assert_eq!(error("a var-x\nb add a"), (count("add", 1, "two operands"), "add"));
    assert_eq!(error("a var-x 3"), (count("var-x", 1, "no operands"), "var-x"));
    assert_eq!(error("a const"), (count("const", 0, "one operand"), "const"));
    assert_eq!(Formula::read_model("a var-x\nb ad a a").unwrap_err().help.unwrap(), "did you mean `add`?");
}

#[test]
fn size_is_limited() {
    let long_line = format!("a var-x\nb add a {}", "q".repeat(1 << 20));
    let FormulaErrorKind::UnknownName { name } = error(&long_line).0 else { panic!("the name is unknown") };
    assert!(name.len() < 100, "names in errors are shortened");
    let many_words = format!("a var-x {}", "a ".repeat(1 << 20));
    assert!(matches!(error(&many_words).0, FormulaErrorKind::ArgumentCount { given: 1_048_576, .. }));
    let too_long = " ".repeat(limits::LARGEST_MODEL + 1);
    assert!(matches!(error(&too_long).0, FormulaErrorKind::TooLong { .. }));
    let mut deep = String::from("v0 var-x\n");
    for number in 1..=limits::MOST_OPERATIONS + 1 {
        deep.push_str(&format!("v{number} sin v{}\n", number - 1));
    }
    let (kind, place) = error(&deep);
    assert!(matches!(kind, FormulaErrorKind::TooManyOperations { .. }), "{kind}");
    assert_eq!(place, format!("v{}", limits::MOST_OPERATIONS + 1));
}
