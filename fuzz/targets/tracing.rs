//! Every method ends soon, and the certified one says nothing impossible.
#![no_main]

#[path = "../../crates/iso-grid/tests/properties/tracing.rs"]
mod tracing;

use std::time::Duration;

use iso_expr::random::Random;

/// For a tile of up to 36 rays, traced by two methods: a second of work, on a machine that does ten other things.
const LIMIT: Duration = Duration::from_secs(10);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut random = Random::led_by(bytes);
    let operations = 1 + random.below(12);
    let program = random.program(operations);
    assert!(tracing::ends_in_time(&mut random, &program, LIMIT), "no end after {LIMIT:?}:\n{program}");
});
