//! What a user may set of the paper's methods.

use crate::GridError;
use crate::roots::RootFinding;

/// How the paper's methods cut the region and sample rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridSettings {
    /// Ni, Nj, Nk: the cells along x, y and z, each 1 to [`GridSettings::MOST_CELLS`].
    pub cells: [u32; 3],
    /// Mi, Mj, Mk: the parts into which a cell is cut along x, y and z when it is examined again, 1 to
    /// [`GridSettings::LARGEST_REFINEMENT`]. One part along each axis has no new corners: nothing is found again.
    pub refinement: [u32; 3],
    /// The largest distance between samples along a ray, as a part of a cell's largest side: from
    /// [`GridSettings::LEAST_STEP`] to 1.
    pub step: f64,
    /// How roots are found between samples of unlike sign.
    pub roots: RootFinding,
}

impl GridSettings {
    /// The distance between samples that the paper uses: 1/20 of a cell.
    pub const STEP: f64 = 0.05;
    /// The least distance between samples, below which a ray would take hours.
    pub const LEAST_STEP: f64 = 1e-6;
    /// The most cells along an axis.
    pub const MOST_CELLS: u32 = 1 << 16;
    /// The most parts along an axis into which a cell is cut when it is examined again.
    pub const LARGEST_REFINEMENT: u32 = 64;

    /// The paper's settings for a grid of these cells: samples 1/20 of a cell apart, and cells examined again in 2 parts
    /// along an axis of more than 20 cells, in 3 parts along a shorter one; bisection.
    pub fn new(cells: [u32; 3]) -> Self {
        let refinement = cells.map(|count| if count > 20 { 2 } else { 3 });
        Self { cells, refinement, step: Self::STEP, roots: RootFinding::PAPER }
    }

    /// Checks all that does not depend on the method.
    pub(crate) fn check(&self) -> Result<(), GridError> {
        for (axis, (&cells, &parts)) in
            ['x', 'y', 'z'].into_iter().zip(self.cells.iter().zip(&self.refinement))
        {
            if !(1..=Self::MOST_CELLS).contains(&cells) {
                return Err(GridError::Cells { axis, given: cells, allowed: Self::MOST_CELLS });
            }
            if !(1..=Self::LARGEST_REFINEMENT).contains(&parts) {
                return Err(GridError::Refinement { axis, given: parts, allowed: Self::LARGEST_REFINEMENT });
            }
        }
        check_step(self.step)
    }

    /// How many cells the grid has.
    pub(crate) fn count(&self) -> u64 {
        self.cells.iter().map(|&cells| u64::from(cells)).product()
    }
}

impl Default for GridSettings {
    /// 30 cells along each axis, in the middle of the sizes that the paper compares.
    fn default() -> Self {
        Self::new([30; 3])
    }
}

/// Checks a distance between samples, as a part of a cell's largest side.
pub(crate) fn check_step(step: f64) -> Result<(), GridError> {
    let least = GridSettings::LEAST_STEP;
    if (least..=1.0).contains(&step) { Ok(()) } else { Err(GridError::Step { given: step, least }) }
}
