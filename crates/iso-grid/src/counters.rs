//! What the work of a method is measured in.

use serde::Serialize;

/// Counts of work, added up over rays and threads. A method leaves at zero what it does not do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counters {
    /// Rays asked about.
    pub rays: u64,
    /// Rays that met the region.
    pub rays_in_region: u64,
    /// Evaluations of F at points while preprocessing.
    pub preprocess_evaluations: u64,
    /// Evaluations of F at points while tracing, samples and root finding alike, with its slope or without.
    pub trace_evaluations: u64,
    /// Evaluations of F and its gradient at points, and of F where slopes stand for the gradient. Those that find a root and its normal at once are evaluations while tracing, too.
    pub gradient_evaluations: u64,
    /// Enclosures of F, or of F and its gradient, over boxes.
    pub box_evaluations: u64,
    /// Operations of formulas that were proven with, at points and over boxes, each as often as it was evaluated.
    pub operations: u64,
    /// Cells that rays walked through.
    pub steps: u64,
    /// Cells that were classified.
    pub cells: u64,
    /// Cells whose corners differ in sign.
    pub existence_cells: u64,
    /// Cells examined again because they border an existence cell.
    pub examined_cells: u64,
    /// Examined cells that turned out to be existence cells.
    pub rescued_cells: u64,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.rays_in_region += other.rays_in_region;
        self.preprocess_evaluations += other.preprocess_evaluations;
        self.trace_evaluations += other.trace_evaluations;
        self.gradient_evaluations += other.gradient_evaluations;
        self.box_evaluations += other.box_evaluations;
        self.operations += other.operations;
        self.steps += other.steps;
        self.cells += other.cells;
        self.existence_cells += other.existence_cells;
        self.examined_cells += other.examined_cells;
        self.rescued_cells += other.rescued_cells;
    }
}
