//! The machine that code is made for: the one this process runs on.

use std::fmt::Display;
use std::sync::Arc;

use cranelift_codegen::isa::TargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use iso_expr::{CompileError, Program};

use crate::engine::NAME;
use crate::refused;

/// How large a program may be. Times to compile are in milliseconds, on one core of a 2.6 GHz server.
pub(crate) struct Limits {
    /// The most operations.
    largest: usize,
    /// The most operations for which registers are allocated with care, which takes longer than in proportion.
    largest_with_care: usize,
}

/// For kernels over points, integer powers written out.
///
/// | operations | sum of products | random arithmetic | with care    |
/// |-----------:|----------------:|------------------:|--------------|
/// |         20 |             0.3 |               0.3 | yes          |
/// |      1,000 |               4 |                 3 | yes          |
/// |     10,000 |              50 |                20 | no           |
/// |    100,000 |             700 |               200 | no           |
///
/// With care, 10,000 random operations would take 100 and 100,000 of them 7,000.
pub(crate) const POINTS: Limits = Limits { largest: 100_000, largest_with_care: 2_000 };

/// For kernels over boxes, where an operation takes five to fifty instructions. Sums of products of shifted coordinates:
///
/// | operations | milliseconds | with care    |
/// |-----------:|-------------:|--------------|
/// |         18 |          0.7 | yes          |
/// |         59 |          2.0 | yes          |
/// |        177 |          2.6 | no           |
/// |        590 |           11 | no           |
/// |      1,770 |           34 | no           |
///
/// Larger kernels are assembled. With a limit of 10,000 `iso render` takes 3.6 instead of 4.1 s for a model of 1,986 operations, and
/// 1.9 instead of 1.75 s for one of 997, whose bound of rounding takes 4,900; 0.2 s more of both are for compiling.
///
/// With care, Barth's sextic and what rounding does to it, 124 operations, would take several times as long; the kernel would
/// then be 1.5 times as fast. `benches/kernels` measures times to compile.
pub(crate) const BOXES: Limits = Limits { largest: 3_000, largest_with_care: 100 };

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
    pub(crate) fn admit(
        &self,
        program: &Program,
        limits: &Limits,
    ) -> Result<&Arc<dyn TargetIsa>, CompileError> {
        let (given, allowed) = (program.operations(), limits.largest);
        if given > allowed {
            return Err(CompileError::TooLarge { engine: NAME, given, allowed });
        }
        Ok(if given > limits.largest_with_care { &self.quick } else { &self.careful })
    }

    /// What small kernels are compiled for.
    pub(crate) fn careful(&self) -> &Arc<dyn TargetIsa> {
        &self.careful
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
