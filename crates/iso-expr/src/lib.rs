//! Formulas F(x, y, z): text, programs, derivatives, intervals and the interpreter.
//!
//! ```text
//! text ─ parse → Ast ─ lower → Program ─ simplify, differentiate → Program ─ Engine → kernels
//! ```
//!
//! [`Operation`] is the one table of operations; everything else in this crate and in the engines reads it.

mod constant;
pub mod engine;
mod interpreter;
pub mod interval;
pub mod language;
mod operation;
mod pieces;
pub mod program;
#[cfg(any(test, feature = "random"))]
pub mod random;

pub use constant::Constant;
pub use engine::{BatchKernel, BoxKernel, CompileError, Engine, PointKernel, Scratch};
pub use interpreter::Interpreter;
pub use interval::{Decorated, Decoration, Extension, Interval};
pub use language::{Ast, Formula, FormulaError, FormulaErrorKind, decode, limits};
pub use operation::{Chain, Operation, Value, by_squaring};
pub use pieces::Pieces;
pub use program::{Argument, Axis, Composition, Extreme, Node, NodeId, Program};
