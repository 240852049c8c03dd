//! What ends work before it is done: Ctrl-C and time limits.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;

use iso_grid::Stop;

use crate::failure::Failure;
use crate::flags::LimitFlags;
use crate::{diagnostics, output};

/// The exit code after Ctrl-C, by the custom of shells: 128 and the signal's number.
pub(crate) const INTERRUPTED: u8 = 130;

/// The work that Ctrl-C ends gently, so that what is finished is written.
static KEPT: OnceLock<Interruption> = OnceLock::new();

/// From now on, Ctrl-C, a request to end and a terminal that is closed leave no half-written file. They end the program unless some work
/// is to be kept; a second one always does.
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

/// How far work is.
#[derive(Clone, Copy, Debug, Default)]
enum Stage {
    /// Formulas and tables are read, kernels compiled, methods prepared.
    #[default]
    Preparing,
    /// Pixels or rays are finished one after the other.
    Working,
    /// It ended before it was done.
    Ended(Cause),
}

/// The end of some work before it is done. Its copies are one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interruption {
    stop: Stop,
    stage: Arc<Mutex<Stage>>,
}

impl Interruption {
    /// The time limit begins now, with preparations.
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

    /// The first preparations are done: from now on there may be something finished that is worth keeping.
    pub(crate) fn begin_work(&self) {
        let mut stage = self.stage();
        if let Stage::Preparing = *stage {
            *stage = Stage::Working;
        }
    }

    /// Ends the work; false when it was ended before. Preparations have nothing to keep, and may be deep in a compiler or wait
    /// for input: during them, this ends the program.
    fn end(&self, cause: Cause) -> bool {
        let mut stage = self.stage();
        match *stage {
            Stage::Preparing => {
                let failure = Failure::StoppedEarly { cause };
                diagnostics::print(&failure);
                output::exit_between_files(failure.exit_code());
            }
            Stage::Working => {
                *stage = Stage::Ended(cause);
                self.stop.request();
                true
            }
            Stage::Ended(_) => false,
        }
    }

    fn stage(&self) -> MutexGuard<'_, Stage> {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn cause(&self) -> Option<Cause> {
        match *self.stage() {
            Stage::Ended(cause) => Some(cause),
            Stage::Preparing | Stage::Working => None,
        }
    }

    /// An error when all pixels or rays are unfinished, so that there is nothing to write.
    pub(crate) fn check_begun(&self, unfinished: u64, all: u64) -> Result<(), Failure> {
        match self.cause() {
            Some(cause) if unfinished > 0 && unfinished == all => Err(Failure::StoppedEarly { cause }),
            _ => Ok(()),
        }
    }

    /// An error when some of `all` pixels or rays, as `things` calls them, are unfinished.
    pub(crate) fn check_done(&self, unfinished: u64, all: u64, things: &'static str) -> Result<(), Failure> {
        match self.cause() {
            Some(cause) if unfinished > 0 => Err(Failure::Stopped { cause, unfinished, all, things }),
            _ => Ok(()),
        }
    }
}
