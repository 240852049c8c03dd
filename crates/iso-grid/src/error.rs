//! Why a method cannot be prepared.

use iso_expr::CompileError;
use thiserror::Error;

/// Why a method of intersection cannot be prepared for its surface and region.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum GridError {
    /// A grid without cells.
    #[error("the grid has 0 cells along {axis}; it needs at least 1 (the method without a grid is `direct`)")]
    NoCells {
        /// The axis's name.
        axis: char,
    },
    /// More cells than memory is given to.
    #[error("the {method} asks for {given} cells; at most {allowed} are allowed")]
    TooManyCells {
        /// What holds the cells.
        method: &'static str,
        /// The cells asked for.
        given: u128,
        /// The most that are allowed.
        allowed: u128,
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
    #[error("samples {given} of a cell's side apart; it takes {least} to 1")]
    Step {
        /// The distance asked for.
        given: f64,
        /// The least that is allowed.
        least: f64,
    },
    /// The engine cannot compile F − C.
    #[error(transparent)]
    Compile(#[from] CompileError),
}
