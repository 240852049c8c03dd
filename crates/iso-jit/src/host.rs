//! The machine that code is made for: the one this process runs on.

use std::sync::Arc;

use cranelift_codegen::isa::TargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use iso_expr::CompileError;

use crate::refused;

/// Describes this machine's instruction set, with every extension that the processor reports.
///
/// # Errors
/// When Cranelift makes no code for this machine.
pub(crate) fn instruction_set() -> Result<Arc<dyn TargetIsa>, CompileError> {
    let unsupported =
        |reason: &str| refused(&format_args!("native code is not supported on this machine: {reason}"));
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (flag, value) in [
        ("opt_level", "speed"),
        ("enable_verifier", verify),
        ("is_pic", "false"),
        // Frames of large programs pass the guard page; a probe in each page finds the end of the stack there.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
    ] {
        flags.set(flag, value).map_err(|error| unsupported(&error.to_string()))?;
    }
    cranelift_native::builder()
        .map_err(unsupported)?
        .finish(settings::Flags::new(flags))
        .map_err(|error| unsupported(&error.to_string()))
}

/// Whether doubles are rounded to integers by single instructions. Only x86 before SSE4.1 lacks them.
pub(crate) fn rounds_natively(isa: &dyn TargetIsa) -> bool {
    isa.isa_flags()
        .iter()
        .find(|flag| flag.name == "has_sse41")
        .is_none_or(|flag| flag.as_bool() == Some(true))
}
