//! The engines and the threads that a command works with.

use std::sync::Arc;

use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, Interpreter, PointKernel, Program};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::Failure;
use crate::flags::{EngineName, ThreadsFlag};

/// The engine called `name`.
pub(crate) fn engine(name: EngineName) -> Result<Arc<dyn Engine>, Failure> {
    Ok(match name {
        EngineName::Jit => Arc::new(Native(native_code()?)),
        EngineName::Interp => Arc::new(Interpreter),
    })
}

/// Native code alone: what is too large to compile is an error.
#[cfg(feature = "jit")]
pub(crate) fn native_code() -> Result<Arc<dyn Engine>, Failure> {
    Ok(Arc::new(iso_jit::Jit::new()?))
}

/// Native code is a feature that this program was built without.
#[cfg(not(feature = "jit"))]
pub(crate) fn native_code() -> Result<Arc<dyn Engine>, Failure> {
    Err(Failure::usage(
        "this program is built without native code",
        "take --engine interp where there is a choice, or build the program with its feature `jit`",
    ))
}

/// Native code, and over points the interpreter for programs that are too large to compile. As engines agree bit for bit, only time
/// tells which of them worked.
struct Native(Arc<dyn Engine>);

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
        self.0.boxes(program)
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        self.0.for_few_runs()
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

#[cfg(all(test, not(feature = "jit")))]
mod tests {
    use super::*;
    use crate::flags::name_of;

    #[test]
    fn a_program_without_native_code_says_so() {
        let failure = engine(EngineName::Jit).err().expect("there is no native code");
        assert_eq!((failure.exit_code(), EngineName::DEFAULT), (2, EngineName::Interp));
        assert!(failure.to_string().contains("without native code"), "{failure}");
        assert_eq!(
            engine(EngineName::DEFAULT).expect("the interpreter is there").name(),
            name_of(EngineName::Interp)
        );
    }
}
