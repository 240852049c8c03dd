//! The engine itself.

use std::fmt;
use std::sync::Arc;

use cranelift_codegen::Context;
use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, PointKernel, Program};

use crate::batch::{BatchBlueprint, NativeBatch};
use crate::boxes::{BoxBlueprint, NativeBoxes};
use crate::code::Compiled;
use crate::host::Host;
use crate::point::{FunctionBlueprint, NativeFunction, NativePoint, PointBlueprint};

/// The engine's name on the command line and in reports.
pub(crate) const NAME: &str = "jit";

/// Compiles programs to native code. Threads may share it, and compile at the same time.
#[derive(Clone)]
pub struct Jit {
    host: Host,
}

impl Jit {
    /// An engine for this machine.
    ///
    /// # Errors
    /// When the code generator does not support the machine.
    pub fn new() -> Result<Self, CompileError> {
        Ok(Self { host: Host::new()? })
    }

    /// The one output of `program` as a native function.
    ///
    /// # Errors
    /// When the program is too large.
    ///
    /// # Panics
    /// When the program has another number of outputs.
    pub fn function(&self, program: &Program) -> Result<NativeFunction, CompileError> {
        assert_eq!(program.outputs().len(), 1, "a function has one output");
        let program = program.with_powers_expanded();
        let isa = self.host.admit(&program)?;
        Ok(NativeFunction(Compiled::new(isa, &mut Context::new(), &FunctionBlueprint(&program))?))
    }
}

impl Engine for Jit {
    fn name(&self) -> &'static str {
        NAME
    }

    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        let program = program.with_powers_expanded();
        let isa = self.host.admit(&program)?;
        let compiled = Compiled::new(isa, &mut Context::new(), &PointBlueprint(&program))?;
        Ok(Arc::new(NativePoint::new(&program, compiled)))
    }

    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        let program = program.with_powers_expanded();
        let isa = self.host.admit(&program)?;
        let blueprint = BatchBlueprint::new(&program);
        let compiled = Compiled::new(isa, &mut Context::new(), &blueprint)?;
        Ok(Arc::new(NativeBatch::new(&blueprint, compiled)))
    }

    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        let program = program.pruned();
        let isa = self.host.admit(&program)?;
        let compiled = Compiled::new(isa, &mut Context::new(), &BoxBlueprint(&program))?;
        Ok(Arc::new(NativeBoxes::new(&program, compiled)))
    }
}

impl fmt::Debug for Jit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Jit").field("target", &self.host.name()).finish()
    }
}
