//! What holds of any bytes: as a model they are read or refused, and what is read has a value.

use iso_expr::{Formula, decode};

/// Pieces of models, wrong ones among them.
pub(crate) const PIECES: &[&str] = &[
    "_0 ",
    "_1 ",
    "_2 ",
    "a ",
    "b ",
    "\n",
    "\n",
    "\n",
    "_0 var-x\n",
    "_1 var-y\n",
    "var-z",
    "const ",
    "1",
    "-2.5e3",
    "nan",
    "inf",
    "1e999",
    "square ",
    "sqrt ",
    "neg ",
    "add ",
    "sub ",
    "mul ",
    "div ",
    "mod ",
    "max ",
    "compare ",
    "and ",
    "or ",
    "not ",
    "atan2 ",
    "round ",
    "# ",
    "\u{feff}",
    "\t",
    "é",
];

/// The text of [`PIECES`] that `bytes` number.
pub(crate) fn text_of_pieces(bytes: &[u8]) -> String {
    bytes.iter().map(|&byte| PIECES[usize::from(byte) % PIECES.len()]).collect()
}

/// Reads bytes as a file with a model is read.
pub(crate) fn bytes_are_read_or_refused(bytes: &[u8]) {
    let Ok(text) = decode(bytes) else { return };
    match Formula::read_model(text) {
        Ok(model) => assert_eq!(model.program().evaluate([0.5, -2.0, 3.0]).len(), 1),
        Err(error) => {
            assert!(text.get(error.span.clone()).is_some(), "{:?} is no part of the text", error.span);
            let message = error.to_string();
            assert!(!message.contains('\n') && message.chars().count() < 200, "{message}");
        }
    }
}
