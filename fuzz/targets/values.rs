//! Native code gives the interpreter's values, at points alone and in batches.
#![no_main]

#[path = "../../crates/iso-jit/tests/properties/values.rs"]
mod values;

use iso_expr::random::Random;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    let operations = 1 + random.below(30);
    let program = random.program(operations);
    let points = values::points(&mut random, 9);
    values::values_agree(&program, &points);
    if random.below(4) == 0 {
        values::values_agree(&program.with_gradient(), &points);
    }
});
