//! The interpreter: an engine that needs no code generator and runs everywhere.
//!
//! A program becomes [`Code`](code::Code), instructions over slots. Kernels over points run it on a block of points at a
//! time, so that the cost of decoding an instruction is shared and its loop is compiled to vector instructions; kernels
//! over boxes run it on decorated intervals.

mod batch;
mod block;
mod boxes;
mod code;
mod dispatch;
mod point;

use std::sync::Arc;

use crate::Program;
use crate::engine::{BatchKernel, BoxKernel, CompileError, Engine, PointKernel};
use batch::Batch;
use boxes::Boxed;
use code::Code;
use point::Point;

/// The engine that interprets programs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Interpreter;

impl Engine for Interpreter {
    fn name(&self) -> &'static str {
        "interp"
    }

    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        Ok(Arc::new(Point::new(Code::new(&program.with_powers_expanded()))))
    }

    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        Ok(Arc::new(Batch::new(Code::new(&program.with_powers_expanded()))))
    }

    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        Ok(Arc::new(Boxed::new(Code::new(&program.pruned()))))
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        Arc::new(*self)
    }
}

#[cfg(test)]
mod tests;
