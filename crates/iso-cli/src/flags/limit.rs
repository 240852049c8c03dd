//! Flags that say when work ends before it is done.

use std::time::Duration;

use clap::Args;

use crate::values;

/// When to stop, and what becomes of unfinished work.
#[derive(Clone, Copy, Debug, Args)]
#[command(next_help_heading = "Running")]
pub(crate) struct LimitFlags {
    /// Stop after this time, such as 90s, 1.5m or 200ms, or a number of seconds; what is finished is written, the rest is marked, the exit code is 3
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = values::duration)]
    pub(crate) time_limit: Option<Duration>,

    /// Upon Ctrl-C, write what is finished and mark the rest; a second Ctrl-C ends at once
    #[arg(long)]
    pub(crate) keep_partial: bool,
}
