//! The engines and the threads that a command works with.

use std::sync::Arc;

use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, Interpreter, PointKernel, Program};
use iso_jit::Jit;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::Failure;
use crate::flags::{EngineName, ThreadsFlag};

/// The engine called `name`.
pub(crate) fn engine(name: EngineName) -> Result<Arc<dyn Engine>, CompileError> {
    Ok(match name {
        EngineName::Jit => Arc::new(Native(Jit::new()?)),
        EngineName::Interp => Arc::new(Interpreter),
    })
}

/// Native code, and the interpreter for programs that are too large to compile. As engines agree bit for bit, only time
/// tells which of them worked.
struct Native(Jit);

impl Engine for Native {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        unless_too_large(self.0.point(program), || Interpreter.point(program))
    }

    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        unless_too_large(self.0.batch(program), || Interpreter.batch(program))
    }

    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        unless_too_large(self.0.boxes(program), || Interpreter.boxes(program))
    }
}

fn unless_too_large<K>(
    compiled: Result<K, CompileError>,
    otherwise: impl FnOnce() -> Result<K, CompileError>,
) -> Result<K, CompileError> {
    match compiled {
        Err(CompileError::TooLarge { .. } | CompileError::FrameTooLarge { .. }) => otherwise(),
        result => result,
    }
}

/// As many threads as `flag` says.
pub(crate) fn threads(flag: &ThreadsFlag) -> Result<ThreadPool, Failure> {
    Ok(ThreadPoolBuilder::new().num_threads(usize::from(flag.threads)).build()?)
}
