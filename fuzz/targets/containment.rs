//! Enclosures hold the values at points of their boxes.
#![no_main]

#[path = "../../crates/iso-expr/tests/properties/containment.rs"]
mod containment;

use iso_expr::Scratch;
use iso_expr::random::Random;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    let mut scratch = Scratch::default();
    let operations = random.below(20);
    let program = random.program(operations).pruned();
    for program in [&program, &program.simplified(), &program.with_gradient()] {
        containment::enclosures_hold_values(&mut random, &mut scratch, program);
    }
});
