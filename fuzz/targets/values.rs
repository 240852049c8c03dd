//! Native code gives the interpreter's values, at points alone and in batches.
#![no_main]

#[path = "../../crates/iso-jit/tests/properties/values.rs"]
mod values;

use std::sync::LazyLock;

use iso_expr::random::Random;
use iso_jit::Jit;

static JIT: LazyLock<Jit> = LazyLock::new(|| Jit::new().expect("this machine is supported"));

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    // Native code takes long to make, the longer the larger: most programs are small.
    let largest = 1 + random.below(24);
    let operations = 1 + random.below(largest);
    let program = random.program(operations);
    let program = if random.below(4) == 0 { program.with_gradient() } else { program };
    let points = values::points(&mut random, 33);
    values::values_agree(&JIT, &program, &points);
});
