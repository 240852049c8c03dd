//! Why a command failed. Everything that can go wrong below comes up as a [`Failure`].

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use iso_expr::{CompileError, FormulaError};
use iso_grid::{GridError, RegionError};
use iso_render::{CameraError, EncodeError, RenderError};
use thiserror::Error;

use crate::formula::Source;
use crate::interruption::{Cause, INTERRUPTED};
use crate::table::TableError;

/// Why a command failed.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// Flags that do not go together, or with the formula.
    #[error("{problem}")]
    Usage {
        /// What is wrong.
        problem: String,
        /// What to do about it.
        help: Option<String>,
    },
    /// The formula is wrong.
    #[error("{error}")]
    Formula {
        /// The text in which it is.
        source_text: Box<Source>,
        /// What is wrong, and where.
        error: Box<FormulaError>,
    },
    /// The camera cannot be set up.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A table of points, boxes or rays is wrong.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        error: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {error}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        error: Box<dyn Error + Send + Sync>,
    },
    /// Standard output cannot be written.
    #[error("cannot write to standard output: {0}")]
    StandardOutput(io::Error),
    /// The formula cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The picture cannot be made.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A promise of the engines or of the certified method did not hold.
    #[error("{promises} promises are broken; the report names them")]
    Broken {
        /// How many.
        promises: usize,
    },
    /// Work ended before it was done, and what is finished is written.
    #[error("{cause}: {unfinished} of {all} {things} are unfinished, and marked so in what is written")]
    Stopped {
        /// Why.
        cause: Cause,
        /// Pixels or rays that are not finished.
        unfinished: u64,
        /// Pixels or rays in all.
        all: u64,
        /// Whether these are pixels or rays.
        things: &'static str,
    },
    /// Work ended before anything was finished, and nothing is written.
    #[error("{cause} before anything was finished; nothing is written")]
    StoppedEarly {
        /// Why.
        cause: Cause,
    },
    /// Ctrl-C cannot be listened to.
    #[error("cannot listen to Ctrl-C: {0}")]
    CtrlC(ctrlc::Error),
    /// The threads cannot be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl Failure {
    /// A file cannot be written.
    pub(crate) fn write(path: &Path, error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        let error = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
                format!("there is no folder {}", folder.display()).into()
            }
            _ => error.into(),
        };
        Self::Write { path: path.to_owned(), error }
    }

    /// Flags that do not go together, and what to do about it.
    pub(crate) fn usage(problem: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Usage { problem: problem.into(), help: Some(help.into()) }
    }

    /// 2 for what the user can mend in what was given: flags, formula, tables; 3 for a time limit and 130 for Ctrl-C; 1 for
    /// the rest.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Usage { .. }
            | Self::Formula { .. }
            | Self::Camera(_)
            | Self::Table(_)
            | Self::Read { .. } => 2,
            Self::Stopped { cause, .. } | Self::StoppedEarly { cause } => match cause {
                Cause::TimeLimit(_) => 3,
                Cause::CtrlC => INTERRUPTED,
            },
            _ => 1,
        }
    }

    /// Whether the reader of standard output went away, as `head` does: that is no failure.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::StandardOutput(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl From<GridError> for Failure {
    /// All that a method refuses are settings, but for what the engine cannot compile.
    fn from(error: GridError) -> Self {
        match error {
            GridError::Compile(error) => Self::Compile(error),
            GridError::TooManyCells { .. } => Self::usage(error.to_string(), "choose a smaller --grid"),
            other => Self::Usage { problem: other.to_string(), help: None },
        }
    }
}

impl From<RegionError> for Failure {
    /// Boxes come from flags, and are known before anything is computed: bad usage.
    fn from(error: RegionError) -> Self {
        Self::Usage { problem: error.to_string(), help: None }
    }
}

impl From<EncodeError> for Failure {
    /// A format that cannot be written is known before anything is computed: bad usage.
    fn from(error: EncodeError) -> Self {
        Self::Usage { problem: error.to_string(), help: None }
    }
}
