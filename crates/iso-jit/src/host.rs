//! The machine that code is made for: the one this process runs on.

use std::fmt::Display;
use std::sync::Arc;

use cranelift_codegen::isa::TargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use iso_expr::{CompileError, Program};

use crate::engine::NAME;
use crate::refused;

/// The most operations that a kernel over points may have, integer powers written out. Time to compile a batch kernel, in
/// milliseconds, on one core of a 2.6 GHz server, for two shapes of program:
///
/// | operations | sum of products | random arithmetic |
/// |-----------:|----------------:|------------------:|
/// |         20 |             0.3 |               0.3 |
/// |      1,000 |               4 |                 3 |
/// |     10,000 |              50 |                20 |
/// |    100,000 |             700 |               200 |
const LARGEST: usize = 100_000;

/// The most operations for which registers are allocated with care. Care takes longer than in proportion: 100,000 random
/// operations would take 7 seconds to compile, and a program with 4,000 values alive at once 1.6 instead of 0.07.
const LARGEST_ALLOCATED_WITH_CARE: usize = 2_000;

/// This machine's instruction set, with every extension that the processor reports.
#[derive(Clone)]
pub(crate) struct Host {
    /// Allocates registers with care.
    careful: Arc<dyn TargetIsa>,
    /// Allocates registers in one pass.
    quick: Arc<dyn TargetIsa>,
}

impl Host {
    /// Asks the processor.
    ///
    /// # Errors
    /// When Cranelift makes no code for this machine.
    pub(crate) fn new() -> Result<Self, CompileError> {
        Ok(Self { careful: instruction_set("backtracking")?, quick: instruction_set("single_pass")? })
    }

    /// What to compile `program` for.
    ///
    /// # Errors
    /// When the program is too large.
    pub(crate) fn admit(&self, program: &Program) -> Result<&Arc<dyn TargetIsa>, CompileError> {
        let given = program.operations();
        if given > LARGEST {
            return Err(CompileError::TooLarge { engine: NAME, given, allowed: LARGEST });
        }
        Ok(if given > LARGEST_ALLOCATED_WITH_CARE { &self.quick } else { &self.careful })
    }

    /// The machine's name.
    pub(crate) fn name(&self) -> String {
        self.careful.triple().to_string()
    }
}

fn instruction_set(register_allocation: &str) -> Result<Arc<dyn TargetIsa>, CompileError> {
    let mut flags = settings::builder();
    for (flag, value) in [
        // Programs are simplified and free of repetition already. Cranelift's own optimiser would find nothing more, take
        // as long as the rest of it, and reorder the instructions so that evaluations side by side come one after the
        // other, which doubles the time of long chains.
        ("opt_level", "none"),
        ("regalloc_algorithm", register_allocation),
        ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
        ("is_pic", "false"),
        // A frame larger than the guard page must not step over it.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
    ] {
        flags.set(flag, value).map_err(|error| unsupported(&error))?;
    }
    let builder = cranelift_native::builder().map_err(|reason| unsupported(&reason))?;
    builder.finish(settings::Flags::new(flags)).map_err(|error| unsupported(&error))
}

fn unsupported(reason: &dyn Display) -> CompileError {
    refused(&format_args!("native code is not supported on this machine: {reason}"))
}

/// Whether doubles are rounded to integers by single instructions. Only x86 before SSE4.1 lacks them.
pub(crate) fn rounds_natively(isa: &dyn TargetIsa) -> bool {
    let sse41 = isa.isa_flags().into_iter().find(|flag| flag.name == "has_sse41");
    sse41.is_none_or(|flag| flag.as_bool() == Some(true))
}
