//! Kernels as text, for people.

use std::sync::Arc;
use std::time::{Duration, Instant};

use cranelift_codegen::Context;
use cranelift_codegen::isa::TargetIsa;
use iso_expr::CompileError;

use crate::code::{Blueprint, Compiled, frame_bytes};

/// What a kernel runs over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One point.
    Point,
    /// A batch of points.
    Batch,
    /// A batch of boxes.
    Boxes,
}

/// How a kernel looks, and what it took.
#[derive(Clone, Debug)]
pub struct Listing {
    /// Cranelift's intermediate representation, its functions named `u0:0` for the kernel and `u0:1` and so on for those
    /// that it calls.
    pub clif: String,
    /// The machine code as text, labels in place of addresses.
    pub assembly: String,
    /// The size of the machine code with its constants, in bytes.
    pub code_bytes: usize,
    /// The size of the stack frame, in bytes.
    pub frame_bytes: usize,
    /// The time from the program to code that can be called.
    pub compile_time: Duration,
}

impl Listing {
    /// Compiles `blueprint` twice, for the time and for the text.
    pub(crate) fn new(isa: &Arc<dyn TargetIsa>, blueprint: &impl Blueprint) -> Result<Self, CompileError> {
        let start = Instant::now();
        Compiled::new(isa, &mut Context::new(), blueprint)?;
        let compile_time = start.elapsed();
        let mut context = Context::new();
        context.set_disasm(true);
        Compiled::new(isa, &mut context, blueprint)?;
        let code = context.compiled_code().expect("it is compiled");
        Ok(Self {
            clif: context.func.display().to_string(),
            assembly: code.vcode.clone().unwrap_or_default(),
            code_bytes: code.code_buffer().len(),
            frame_bytes: frame_bytes(&context) as usize,
            compile_time,
        })
    }
}
