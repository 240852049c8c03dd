//! Any bytes are read as a table or refused, and what is read is written so that it reads the same.
#![no_main]

#[path = "../../crates/iso-cli/src/table/property.rs"]
mod property;
#[allow(dead_code, reason = "a table's files are not read here")]
#[path = "../../crates/iso-cli/src/table.rs"]
mod table;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| property::bytes_are_read_or_refused(bytes));
