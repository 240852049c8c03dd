//! Native code gives the interpreter's enclosures.
#![no_main]

#[path = "../../crates/iso-jit/tests/properties/boxes.rs"]
mod boxes;

use iso_expr::random::Random;
use iso_jit::Jit;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    let jit = Jit::new().expect("this machine is supported");
    let operations = 1 + random.below(20);
    let program = random.program(operations);
    let boxes = boxes::boxes(&mut random, 9);
    boxes::enclosures_agree(&jit, &program, &boxes);
    if random.below(4) == 0 {
        boxes::enclosures_agree(&jit, &program.with_gradient(), &boxes);
    }
});
