//! What is read is printed so that it reads the same, for texts made of pieces of formulas.
#![no_main]

#[allow(dead_code, reason = "another target checks the rest")]
#[path = "../../crates/iso-expr/tests/properties/language.rs"]
mod language;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    language::prints_as_it_reads(&language::text_of_pieces(bytes));
});
