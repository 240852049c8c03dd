//! Every method on formulas that nobody wrote.

#[path = "properties/tracing.rs"]
mod tracing;

use std::time::Duration;

use iso_expr::random::Random;
use tracing::ends_in_time;

/// Far more than any of these formulas takes, on a busy machine too.
const LIMIT: Duration = Duration::from_secs(60);

#[test]
fn random_formulas_are_traced_without_contradiction() {
    let mut random = Random::new(11);
    for _ in 0..400 {
        let operations = 1 + random.below(12);
        let program = random.program(operations);
        assert!(ends_in_time(&mut random, &program, LIMIT), "no end after {LIMIT:?}:\n{program}");
    }
}

#[test]
fn work_ends_when_its_time_is_over() {
    let mut random = Random::new(12);
    let program = random.wide_program(2000);
    assert!(!ends_in_time(&mut random, &program, Duration::ZERO));
}
