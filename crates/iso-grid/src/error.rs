//! Why a method cannot be prepared.

use iso_expr::CompileError;
use thiserror::Error;

/// Why a method of intersection cannot be prepared for its surface and region.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum GridError {
    /// No cells along an axis, or too many.
    #[error(
        "the grid has {given} cells along {axis}; it takes 1 to {allowed}, and none at all only with the method direct"
    )]
    Cells {
        /// The axis's name.
        axis: char,
        /// The cells asked for.
        given: u32,
        /// The most that are allowed.
        allowed: u32,
    },
    /// More cells in all than memory is given to.
    #[error("the {method} comes to {given} cells; at most {allowed} are allowed")]
    TooManyCells {
        /// The method's name.
        method: &'static str,
        /// The cells that it comes to.
        given: u64,
        /// The most that are allowed.
        allowed: u64,
    },
    /// A cell is cut into no parts or into too many when it is examined again.
    #[error("cells examined again are cut into {given} parts along {axis}; it takes 1 to {allowed}")]
    Refinement {
        /// The axis's name.
        axis: char,
        /// The parts asked for.
        given: u32,
        /// The most that are allowed.
        allowed: u32,
    },
    /// The distance between samples is out of range.
    #[error("samples {given:?} of a cell's side apart; it takes {least:?} to 1")]
    Step {
        /// The distance asked for.
        given: f64,
        /// The least that is allowed.
        least: f64,
    },
    /// The width to which roots are narrowed is out of range.
    #[error(
        "roots are narrowed to {given} of their distance; it takes 0 to 1, and 0 goes as far as floats do"
    )]
    Tolerance {
        /// The width asked for.
        given: f64,
    },
    /// Work on the surface was asked to end: see [`Stop`](crate::Stop).
    #[error("stopped before the method was prepared")]
    Stopped,
    /// The engine cannot compile F − C.
    #[error(transparent)]
    Compile(#[from] CompileError),
}
