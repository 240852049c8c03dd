//! What the benchmarks share: the surfaces, measuring in turns, and results with date and machine.

pub mod machine;
pub mod results;
pub mod samples;
pub mod surfaces;

use mimalloc::MiMalloc;

/// That of the program `iso`, for everything that is measured.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;
