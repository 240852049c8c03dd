//! The engine itself.

use std::fmt;
use std::sync::Arc;

use cranelift_codegen::Context;
use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, PointKernel, Program};

use crate::assembled::{Assembled, Assembler};
use crate::batch::{BatchBlueprint, NativeBatch};
use crate::boxes::{BoxBlueprint, NativeBoxes};
use crate::code::{Blueprint, Compiled};
use crate::host::Host;
use crate::listing::{Kind, Listing};
use crate::pieces::Pieces;
use crate::point::{FunctionBlueprint, NativeFunction, NativePoint, PointBlueprint};

/// The engine's name on the command line and in reports.
pub(crate) const NAME: &str = "jit";

/// Compiles programs to native code. Threads may share it, and compile at the same time.
#[derive(Clone)]
pub struct Jit {
    host: Host,
    pieces: Arc<Pieces>,
}

impl Jit {
    /// An engine for this machine.
    ///
    /// # Errors
    /// When the code generator does not support the machine.
    pub fn new() -> Result<Self, CompileError> {
        let host = Host::new()?;
        let pieces = Arc::new(Pieces::new(host.clone()));
        Ok(Self { host, pieces })
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
        Ok(NativeFunction(self.compile(&program, &FunctionBlueprint(&program))?))
    }

    /// The kernel of `program` that runs over `kind`, as text.
    ///
    /// # Errors
    /// When the program is too large.
    pub fn listing(&self, program: &Program, kind: Kind) -> Result<Listing, CompileError> {
        let program = if kind == Kind::Boxes { program.pruned() } else { program.with_powers_expanded() };
        match kind {
            Kind::Point => self.list(&program, &PointBlueprint(&program)),
            Kind::Batch => self.list(&program, &BatchBlueprint::new(&program)),
            Kind::Boxes => self.list(&program, &BoxBlueprint::new(&program)),
        }
    }

    /// The engine for what is not worth compiling.
    fn assembler(&self) -> Assembler {
        Assembler { pieces: Arc::clone(&self.pieces) }
    }

    /// Lists `blueprint`, which is one of `program`.
    fn list<B: Blueprint>(&self, program: &Program, blueprint: &B) -> Result<Listing, CompileError> {
        Listing::new(self.host.admit(program, &B::LIMITS)?, blueprint)
    }

    /// Compiles `blueprint`, which is one of `program`.
    fn compile<B: Blueprint>(
        &self,
        program: &Program,
        blueprint: &B,
    ) -> Result<Compiled<B::Function>, CompileError> {
        Compiled::new(self.host.admit(program, &B::LIMITS)?, &mut Context::new(), blueprint)
    }
}

impl Engine for Jit {
    fn name(&self) -> &'static str {
        NAME
    }

    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        let program = program.with_powers_expanded();
        let compiled = self.compile(&program, &PointBlueprint(&program))?;
        Ok(Arc::new(NativePoint::new(&program, compiled)))
    }

    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        let program = program.with_powers_expanded();
        let blueprint = BatchBlueprint::new(&program);
        let compiled = self.compile(&program, &blueprint)?;
        Ok(Arc::new(NativeBatch::new(&blueprint, compiled)))
    }

    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        // Integer powers stay: an interval's square is narrower than its product with itself.
        let program = program.pruned();
        let blueprint = BoxBlueprint::new(&program);
        match self.compile(&program, &blueprint) {
            Ok(compiled) => Ok(Arc::new(NativeBoxes::new(&blueprint, compiled, self.assembler()))),
            Err(CompileError::TooLarge { .. } | CompileError::FrameTooLarge { .. }) => {
                Ok(Arc::new(Assembled::new(&self.pieces, &program)?))
            }
            Err(refusal) => Err(refusal),
        }
    }

    /// Assembles kernels over boxes from operations that are compiled once, and interprets those over points.
    fn for_few_runs(&self) -> Arc<dyn Engine> {
        Arc::new(self.assembler())
    }
}

impl fmt::Debug for Jit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Jit").field("target", &self.host.name()).finish()
    }
}
