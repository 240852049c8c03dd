//! Any bytes are read as a model or refused, and so are texts made of pieces of models.
#![no_main]

#[path = "../../crates/iso-expr/tests/properties/model.rs"]
mod model;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    match bytes.split_first() {
        Some((0..128, numbers)) => {
            model::bytes_are_read_or_refused(model::text_of_pieces(numbers).as_bytes());
        }
        _ => model::bytes_are_read_or_refused(bytes),
    }
});
