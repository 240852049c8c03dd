//! What ends work before it is done: Ctrl-C and time limits.

use std::fmt;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

use iso_grid::{GridError, Stop};

use crate::failure::Failure;
use crate::flags::LimitFlags;
use crate::output;

/// The exit code after Ctrl-C, by the custom of shells: 128 and the signal's number.
pub(crate) const INTERRUPTED: u8 = 130;

/// The work that Ctrl-C ends gently, so that what is finished is written.
static KEPT: OnceLock<Interruption> = OnceLock::new();

/// From now on, Ctrl-C leaves no half-written file. It ends the program unless some work is to be kept; a second one always
/// does.
pub(crate) fn listen() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        let is_gentle = KEPT.get().is_some_and(|work| work.end(Cause::CtrlC));
        if !is_gentle {
            output::exit_between_files(INTERRUPTED);
        }
    })
    .map_err(Failure::CtrlC)
}

/// Why work ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The user pressed Ctrl-C.
    CtrlC,
    /// So much time was allowed.
    TimeLimit(Duration),
}

impl fmt::Display for Cause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CtrlC => formatter.write_str("stopped by Ctrl-C"),
            Self::TimeLimit(limit) => write!(formatter, "stopped by the time limit of {limit:?}"),
        }
    }
}

/// The end of some work before it is done. Its copies are one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interruption {
    stop: Stop,
    cause: Arc<OnceLock<Cause>>,
}

impl Interruption {
    /// The time limit begins now.
    pub(crate) fn new(flags: &LimitFlags) -> Self {
        let interruption = Self::default();
        if flags.keep_partial {
            KEPT.get_or_init(|| interruption.clone());
        }
        if let Some(limit) = flags.time_limit {
            let interruption = interruption.clone();
            thread::spawn(move || {
                thread::sleep(limit);
                interruption.end(Cause::TimeLimit(limit));
            });
        }
        interruption
    }

    /// What work looks at.
    pub(crate) fn stop(&self) -> Stop {
        self.stop.clone()
    }

    /// Ends the work; false when it was ended before.
    fn end(&self, cause: Cause) -> bool {
        let is_first = self.cause.set(cause).is_ok();
        self.stop.request();
        is_first
    }

    /// An error when some of `all` pixels or rays, as `things` calls them, are unfinished.
    pub(crate) fn check(&self, unfinished: u64, all: u64, things: &'static str) -> Result<(), Failure> {
        match self.cause.get() {
            Some(&cause) if unfinished > 0 => Err(Failure::Stopped { cause, unfinished, all, things }),
            _ => Ok(()),
        }
    }

    /// Why a method could not be prepared.
    pub(crate) fn explain(&self, error: GridError) -> Failure {
        match (&error, self.cause.get()) {
            (GridError::Stopped, Some(&cause)) => Failure::StoppedEarly { cause },
            _ => error.into(),
        }
    }
}
