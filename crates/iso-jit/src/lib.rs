//! Compiles programs of iso-expr to native code with Cranelift.
//!
//! ```text
//! Program ─ Blueprint (point, batch or boxes) → Cranelift's IR ─ compile, link → Code in memory → kernel
//! ```
//!
//! Kernels over boxes that are not worth compiling are assembled from pieces, single operations compiled once for all of them.
//!
//! A kernel keeps its own code, which is given back when the last user drops the kernel. Values and enclosures are, bit
//! for bit, those that the table of operations defines.

// The one crate of the project that is allowed to: it calls the code it made.
#![allow(unsafe_code)]

mod assembled;
mod batch;
mod boxes;
mod code;
mod domain;
mod elementary;
mod enclosures;
mod engine;
mod host;
mod lanes;
mod listing;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod nearby;
mod pieces;
mod point;
mod symbols;
mod together;
mod trampoline;
mod values;

use std::fmt::Display;

use iso_expr::CompileError;

pub use engine::Jit;
pub use listing::{Kind, Listing};
pub use point::NativeFunction;

/// The code generator's refusal, as every engine reports it.
fn refused(reason: &dyn Display) -> CompileError {
    CompileError::Backend { engine: engine::NAME, reason: reason.to_string() }
}
