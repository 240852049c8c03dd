//! Texts made to exhaust the stack, the memory or the patience: each is refused with a clear error, or works.

use std::thread;
use std::time::{Duration, Instant};

use iso_expr::{Ast, FormulaError, FormulaErrorKind};

/// What a spawned thread usually has.
const STACK: usize = 2 << 20;

/// The longest text that is allowed.
const MEGABYTE: usize = 1 << 20;

/// As many copies of `piece` as a megabyte holds, with some room to spare.
fn megabyte_of(piece: &str) -> String {
    piece.repeat((MEGABYTE - 64) / piece.len())
}

/// More copies of `piece` than there may be operations.
fn many(piece: &str) -> String {
    piece.repeat(100_010)
}

/// Parses, prints, outlines and lowers on an ordinary stack, and sees to it that this ends soon: within a second or two on
/// a machine at rest.
fn run(text: String) -> Result<(), FormulaError> {
    let start = Instant::now();
    let shown: String = text.chars().take(20).collect();
    let work = move || {
        let ast = Ast::parse(&text)?;
        let (printed, outline) = (ast.to_string(), ast.outline().to_string());
        assert!(!printed.is_empty() && !outline.is_empty());
        ast.lower(&[]).map(|_| ())
    };
    let result = thread::Builder::new().stack_size(STACK).spawn(work).unwrap().join().unwrap();
    let elapsed = start.elapsed();
    println!("{shown:24} {elapsed:?} {result:?}");
    assert!(elapsed < Duration::from_secs(60), "{shown}… took {elapsed:?}");
    result
}

fn kind(text: String) -> FormulaErrorKind {
    run(text).unwrap_err().kind
}

#[test]
fn deep_nesting_is_refused_with_its_depth() {
    let nested = |open: &str, close: &str, depth: usize| open.repeat(depth) + "x" + &close.repeat(depth);
    for (open, close) in [("(", ")"), ("sin(", ")"), ("√", ""), ("-(", ")"), ("abs(1+|", "|)")] {
        let levels = if open.contains('|') { 2 } else { 1 };
        assert_eq!(run(nested(open, close, 256 / levels)), Ok(()), "{open}");
        let given = 10_000 * levels;
        assert_eq!(
            kind(nested(open, close, 10_000)),
            FormulaErrorKind::TooDeep { given, allowed: 256 },
            "{open}"
        );
    }
    let error = run(nested("(", ")", 257)).unwrap_err();
    assert_eq!(error.span, 256..257, "the parenthesis that is one too many");
}

#[test]
fn a_megabyte_of_one_sign_is_refused() {
    for (text, last) in
        [(megabyte_of("-"), "-"), (megabyte_of("√"), "√"), (many("not "), "not"), (many("2^"), "^")]
    {
        let kind = kind(format!("a := {text}"));
        assert_eq!(kind, FormulaErrorKind::TrailingOperator { operator: last.to_owned() });
    }
    assert_eq!(kind(megabyte_of("(")), FormulaErrorKind::UnclosedParenthesis);
    assert_eq!(kind(megabyte_of("|")), FormulaErrorKind::UnclosedBar);
    assert_eq!(kind(many("min(")), FormulaErrorKind::UnclosedParenthesis);
    assert_eq!(kind(many(")")), FormulaErrorKind::UnopenedParenthesis);
    assert_eq!(kind(many("^x")), FormulaErrorKind::MissingOperand { found: "`^`".to_owned() });
    assert_eq!(kind(many(";\n")), FormulaErrorKind::Empty);
    assert!(matches!(kind(megabyte_of("x")), FormulaErrorKind::UnknownName { .. }));
    assert!(matches!(kind(megabyte_of("9")), FormulaErrorKind::NumberOutOfRange { .. }));
}

#[test]
fn long_formulas_are_refused_by_their_operations() {
    let operations = FormulaErrorKind::TooManyOperations { given: 100_001, allowed: 100_000 };
    assert_eq!(kind(format!("x{}", megabyte_of("+x"))), operations);
    assert_eq!(kind(format!("{}x", megabyte_of("-"))), operations);
    for piece in ["*x", " x", "-|x|", "/2x"] {
        assert_eq!(kind(format!("x{}", many(piece))), operations, "{piece}");
    }
    for prefix in ["x^", "2^-", "not "] {
        assert_eq!(kind(format!("a := {}x; a", many(prefix))), operations, "{prefix}");
    }
    assert_eq!(kind(format!("min({}z)", many("x,y,"))), operations);
}

#[test]
fn a_million_terms_are_too_long() {
    let text = (0..1_000_000).map(|term| format!("+{term}x")).collect::<String>();
    assert_eq!(kind(text), FormulaErrorKind::TooLong { allowed: MEGABYTE });
    assert_eq!(run("#".to_owned() + &"c".repeat(MEGABYTE - 3) + "\nx"), Ok(()));
}

#[test]
fn a_line_may_go_on_after_a_megabyte_of_others() {
    let lines = megabyte_of("\n");
    for text in [format!("x{lines}+ y = 1"), format!("x = 1{lines}where y < 2"), format!("(x{lines}) = 1")] {
        assert_eq!(run(text), Ok(()));
    }
    let joined = FormulaErrorKind::TooManyOperations { given: 100_001, allowed: 100_000 };
    assert_eq!(kind(format!("x where y < 1{}", many(" or z<x"))), joined);
    assert_eq!(kind(format!("x where {}y", many("not "))), FormulaErrorKind::NoDomain);
}

#[test]
fn definitions_do_not_explode() {
    let chain = |levels: usize, body: &dyn Fn(usize) -> String| -> String {
        (1..=levels).map(|level| format!("f{level}(u, v) := {};", body(level - 1))).collect()
    };
    // Twice as many calls a level, all alike: each is put in once.
    let alike =
        format!("f0(u, v) := u + v;{}", chain(1000, &|below| format!("f{below}(u, v) + f{below}(u, v)")));
    assert_eq!(run(alike + "f1000(x, y)"), Ok(()));
    // Twice as many calls a level, all different.
    let different =
        format!("f0(u, v) := u + v;{}", chain(1000, &|below| format!("f{below}(u, v) + f{below}(v + 1, u)")));
    assert!(matches!(kind(different + "f1000(x, y)"), FormulaErrorKind::TooManyOperations { .. }));
    // A long chain, and one that never adds an operation.
    let long = format!("f0(u, v) := u + v;{}", chain(20_000, &|below| format!("f{below}(v, u)")));
    assert_eq!(run(long + "f20000(x, y)"), Ok(()));
    let names: String = (1..=40_000).map(|place| format!("a{place} := a{};", place - 1)).collect();
    assert_eq!(run(format!("a0 := 1;{names} a40000 x")), Ok(()));
    let cycle = kind(format!("a0 := a40000;{names} a40000 x"));
    assert!(matches!(&cycle, FormulaErrorKind::Recursion { cycle } if cycle.len() == 40_002));
    assert!(cycle.to_string().len() < 200, "{cycle}");
}

#[test]
fn expansion_without_operations_is_bounded() {
    // Each level calls the one below with its nine arguments in two other orders, which lead to every order there is.
    let turned = "u2,u3,u4,u5,u6,u7,u8,u9,u1";
    let swapped = "u2,u1,u3,u4,u5,u6,u7,u8,u9";
    let level = |level: usize| {
        let below = level - 1;
        format!("f{level}(u1,u2,u3,u4,u5,u6,u7,u8,u9) := first(f{below}({turned}), f{below}({swapped}));")
    };
    let levels: String = (1..=100).map(level).collect();
    let base = "first(u, v) := u; f0(u1,u2,u3,u4,u5,u6,u7,u8,u9) := u1;";
    let steps = kind(format!("{base}{levels} f100(x, y, z, 1, 2, 3, 4, 5, 6)"));
    assert!(matches!(steps, FormulaErrorKind::TooManySteps { .. }), "{steps}");
}
