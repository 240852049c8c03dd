//! Any bytes are read or refused.
#![no_main]

#[allow(dead_code, reason = "another target checks the rest")]
#[path = "../../crates/iso-expr/tests/properties/language.rs"]
mod language;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| language::bytes_are_read_or_refused(bytes));
