//! Texts that nobody wrote: whatever they are, they are read or refused, and what is read is printed so that it reads the
//! same.

#[allow(dead_code, reason = "a fuzzer makes its texts in another way")]
#[path = "properties/language.rs"]
mod language;
#[path = "properties/model.rs"]
mod model;

use language::{PIECES, bytes_are_read_or_refused, prints_as_it_reads};
use proptest::prelude::*;

/// What stands between operands, and operands, of which most rows mean something.
const OPERATORS: &[&str] =
    &["+", " - ", "*", "/", "^", " ", "", "²·", "³ ", " and ", " or ", "<", "==", "√", ",", "\n", ";"];
const OPERANDS: &[&str] =
    &["x", "2", ".5", "-y", "√z", "(x+1)", "|x|", "sin(x)", "f(x)", "a", "e", "(not x)", "min(x,y)", "--2"];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(5_000) })]

    #[test]
    fn any_pieces_are_read_or_refused(
        pieces in proptest::collection::vec(proptest::sample::select(PIECES), 0..24),
        blank in proptest::sample::select(&["", " "][..]),
    ) {
        prints_as_it_reads(&pieces.join(blank));
    }

    #[test]
    fn plausible_rows_are_read_or_refused(
        rows in proptest::collection::vec((proptest::sample::select(OPERATORS), proptest::sample::select(OPERANDS)), 1..10),
    ) {
        let row: String = rows.into_iter().flat_map(|(operator, operand)| [operator, operand]).collect();
        prints_as_it_reads(&format!("a := 1; f(u) := u^a; if(x{row}, 1, 2)"));
        prints_as_it_reads(&format!("a := 1; f(u) := u^a; x{row}"));
        prints_as_it_reads(&format!("a := 1; f(u) := u^a; y where x{row} > 0"));
    }

    #[test]
    fn any_pieces_of_models_are_read_or_refused(numbers in proptest::collection::vec(any::<u8>(), 0..40)) {
        model::bytes_are_read_or_refused(model::text_of_pieces(&numbers).as_bytes());
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,40}|[-+*/^|(), .;=<x0-9e²√\n]{0,40}") {
        prints_as_it_reads(&text);
    }

    #[test]
    fn any_bytes_are_decoded_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..24)) {
        bytes_are_read_or_refused(&bytes);
        model::bytes_are_read_or_refused(&bytes);
    }
}
