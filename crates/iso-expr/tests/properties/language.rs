//! What holds of any text: it is read or refused, and what is read is printed so that it reads the same.

use iso_expr::{Ast, decode};

/// Pieces of formulas, wrong ones among them.
pub(crate) const PIECES: &[&str] = &[
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
    "where",
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

/// The text of [`PIECES`] that `bytes` number.
pub(crate) fn text_of_pieces(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| PIECES[usize::from(byte) % PIECES.len()]).collect::<Vec<_>>().join(" ")
}

/// Reads bytes as a file of formulas is read.
pub(crate) fn bytes_are_read_or_refused(bytes: &[u8]) {
    match decode(bytes) {
        Ok(text) => prints_as_it_reads(text),
        Err(error) => assert!(error.span.end <= bytes.len() && !error.span.is_empty(), "{error:?}"),
    }
}

/// Reads `text`; what is read is printed, outlined and lowered, and what is refused has a place and a short message.
pub(crate) fn prints_as_it_reads(text: &str) {
    match Ast::parse(text) {
        Ok(ast) => {
            let printed = ast.to_string();
            let again = Ast::parse(&printed).unwrap_or_else(|error| panic!("{printed}: {error}"));
            assert_eq!(again, ast, "{printed}");
            assert!(!ast.outline().to_string().is_empty());
            ast.lower(&[]).unwrap_or_else(|error| panic!("{printed}: {error}"));
        }
        Err(error) => {
            assert!(text.get(error.span.clone()).is_some(), "{:?} is no part of the text", error.span);
            let message = error.to_string();
            assert!(!message.contains('\n') && message.chars().count() < 200, "{message}");
        }
    }
}
