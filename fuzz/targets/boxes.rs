//! Native code gives the interpreter's enclosures.
#![no_main]

#[path = "../../crates/iso-jit/tests/properties/boxes.rs"]
mod boxes;

use std::sync::LazyLock;

use iso_expr::random::Random;
use iso_jit::Jit;

static JIT: LazyLock<Jit> = LazyLock::new(|| Jit::new().expect("this machine is supported"));

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    // Native code takes long to make, the longer the larger: most programs are small.
    let largest = 1 + random.below(16);
    let operations = 1 + random.below(largest);
    let program = random.program(operations);
    let program = if random.below(8) == 0 { program.with_gradient() } else { program };
    let boxes = boxes::boxes(&mut random, 33);
    boxes::enclosures_agree(&JIT, &program, &boxes);
});
