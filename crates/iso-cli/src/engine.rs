//! The engines and the threads that a command works with.

use std::sync::Arc;

use iso_expr::{CompileError, Engine, Interpreter};
use iso_jit::Jit;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::Failure;
use crate::flags::{EngineName, ThreadsFlag};

/// The engine called `name`.
pub(crate) fn engine(name: EngineName) -> Result<Arc<dyn Engine>, CompileError> {
    Ok(match name {
        EngineName::Jit => Arc::new(Jit::new()?),
        EngineName::Interp => Arc::new(Interpreter),
    })
}

/// As many threads as `flag` says.
pub(crate) fn threads(flag: &ThreadsFlag) -> Result<ThreadPool, Failure> {
    Ok(ThreadPoolBuilder::new().num_threads(usize::from(flag.threads)).build()?)
}
