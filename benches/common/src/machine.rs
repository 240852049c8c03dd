//! The machine and the day, as far as results depend on them.

use std::fmt;

use time::OffsetDateTime;

/// Where and when something was measured.
#[derive(Clone, Debug)]
pub struct Machine {
    /// The processor's name for itself.
    pub processor: String,
    /// How many threads it runs at once.
    pub cores: usize,
    /// The day in UTC, as in 2026-01-31.
    pub date: String,
}

impl Machine {
    /// This machine, today.
    pub fn here() -> Self {
        Self {
            processor: processor().unwrap_or_else(|| format!("unknown ({})", std::env::consts::ARCH)),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            date: OffsetDateTime::now_utc().date().to_string(),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, cores, date } = self;
        write!(f, "{processor}, {cores} cores, {date}")
    }
}

/// What Linux says about the processor: its model name, and the numbers that tell models of one name apart.
fn processor() -> Option<String> {
    let description = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let field = |name: &str| {
        let line =
            description.lines().find(|line| line.split(':').next().is_some_and(|key| key.trim() == name))?;
        Some(line.split_once(':')?.1.trim())
    };
    Some(format!("{} (family {}, model {})", field("model name")?, field("cpu family")?, field("model")?))
}
