//! What the benchmarks share: the surfaces, measuring in turns, and results with date and machine.

pub mod machine;
pub mod results;
pub mod samples;
pub mod surfaces;
