//! The machine and the day, as far as measurements depend on them.

use serde::Serialize;
use time::OffsetDateTime;

/// Where and when something was measured.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Machine {
    /// The processor's name for itself.
    pub(crate) processor: String,
    /// How many threads it runs at once.
    pub(crate) cores: usize,
    /// The operating system.
    pub(crate) system: &'static str,
    /// The day in UTC, as in 2026-01-31.
    pub(crate) date: String,
}

impl Machine {
    /// This machine, today.
    pub(crate) fn here() -> Self {
        Self {
            processor: processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: std::env::consts::OS,
            date: OffsetDateTime::now_utc().date().to_string(),
        }
    }
}

/// What Linux says about the processor.
fn processor() -> Option<String> {
    let description = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = description.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
