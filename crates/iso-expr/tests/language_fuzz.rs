//! Texts that nobody wrote: whatever they are, they are read or refused, and what is read is printed so that it reads the
//! same.

use iso_expr::{Ast, decode};
use proptest::prelude::*;

/// Pieces of formulas, wrong ones among them.
const PIECES: &[&str] = &[
    "x",
    "y",
    "z",
    "a",
    "f",
    "u",
    "pi",
    "π",
    "e",
    "2",
    ".5",
    "1e3",
    "1e",
    "9e999",
    "+",
    "-",
    "−",
    "*",
    "·",
    "/",
    "^",
    "**",
    "²",
    "⁻¹",
    "√",
    "(",
    ")",
    "|",
    ",",
    ";",
    "\n",
    "=",
    "==",
    "<",
    "≥",
    "!=",
    "and",
    "or",
    "not",
    ":=",
    "a :=",
    "f(u) :=",
    "g(u, v) :=",
    "f(",
    "g(",
    "sin(",
    "if(",
    "min(",
    "clamp(",
    "log(",
    "sin",
    "#",
    "%",
    "\u{1F30A}",
    "xy",
];

/// What stands between operands, and operands, of which most rows mean something.
const OPERATORS: &[&str] =
    &["+", " - ", "*", "/", "^", " ", "", "²·", "³ ", " and ", " or ", "<", "==", "√", ",", "\n", ";"];
const OPERANDS: &[&str] =
    &["x", "2", ".5", "-y", "√z", "(x+1)", "|x|", "sin(x)", "f(x)", "a", "e", "(not x)", "min(x,y)", "--2"];

/// Reads `text`; what is read is printed, outlined and lowered.
fn check(text: &str) -> Result<(), TestCaseError> {
    match Ast::parse(text) {
        Ok(ast) => {
            let printed = ast.to_string();
            let again =
                Ast::parse(&printed).map_err(|error| TestCaseError::fail(format!("{printed}: {error}")))?;
            prop_assert_eq!(&again, &ast, "{}", printed);
            prop_assert!(!ast.outline().to_string().is_empty());
            prop_assert!(ast.lower(&[]).is_ok());
        }
        Err(error) => {
            prop_assert!(text.get(error.span.clone()).is_some(), "{:?} is no part of the text", error.span);
            let message = error.to_string();
            prop_assert!(!message.contains('\n') && message.chars().count() < 200, "{}", message);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(5_000) })]

    #[test]
    fn any_pieces_are_read_or_refused(
        pieces in proptest::collection::vec(proptest::sample::select(PIECES), 0..24),
        blank in proptest::sample::select(&["", " "][..]),
    ) {
        check(&pieces.join(blank))?;
    }

    #[test]
    fn plausible_rows_are_read_or_refused(
        rows in proptest::collection::vec((proptest::sample::select(OPERATORS), proptest::sample::select(OPERANDS)), 1..10),
    ) {
        let row: String = rows.into_iter().flat_map(|(operator, operand)| [operator, operand]).collect();
        check(&format!("a := 1; f(u) := u^a; if(x{row}, 1, 2)"))?;
        check(&format!("a := 1; f(u) := u^a; x{row}"))?;
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,40}|[-+*/^|(), .;=<x0-9e²√\n]{0,40}") {
        check(&text)?;
    }

    #[test]
    fn any_bytes_are_decoded_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..24)) {
        match decode(&bytes) {
            Ok(text) => check(text)?,
            Err(error) => prop_assert!(error.span.end <= bytes.len() && !error.span.is_empty()),
        }
    }
}
