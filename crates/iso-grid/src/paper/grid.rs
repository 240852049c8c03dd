//! The paper's method.

use iso_expr::Axis;

use crate::paper::existence::Cells;
use crate::paper::lattice::Lattice;
use crate::paper::lockstep::Lockstep;
use crate::paper::stretch::{Spacing, Stretch, Stretches};
use crate::paper::walk::CellWalk;
use crate::{Counters, GridError, GridSettings, Kernel, Outcomes, Ray, Region, Surface, Tracer, Workspace};

/// The paper's method: a grid that knows which of its cells hold the surface.
///
/// Preprocessing takes the sign of F − C at every grid point. A cell whose corners differ in sign is an existence cell.
/// Every other cell that shares a face, an edge or a corner with an existence cell is examined again: the corners of its
/// parts are evaluated, and at the first that differs it becomes an existence cell, whose neighbours are examined in turn.
/// No cell is examined twice. Along an axis that F does not depend on, all cells are alike and classified as one.
///
/// A ray walks from cell to cell. In existence cells it is sampled; where F − C changes sign between samples, a root
/// finder gives the point: in the paper bisection, down to neighbouring doubles. Samples are joined across faces between existence cells.
///
/// Zero has both signs, so a surface through grid points is found, and so is a sample that happens to be zero: a
/// [`Outcome::Hit`](crate::Outcome::Hit) when the signs before and behind it differ, otherwise a [`Outcome::Touch`](crate::Outcome::Touch). NaN and infinite values
/// have no sign.
///
/// It misses what is smaller than a cell and far from what it found, pairs of roots between neighbouring samples, roots
/// where F − C does not change sign, and takes poles that change sign for roots.
pub struct Grid {
    lockstep: Lockstep,
    lattice: Lattice,
    cells: Cells,
    spacing: Spacing,
    preprocessing: Counters,
}

impl Grid {
    /// The most cells in all; each takes a byte, and so does each grid point while they are found.
    pub const MOST_CELLS: u64 = 1 << 28;

    /// Prepares the method: evaluates F − C at the grid's points, over all threads, and finds the existence cells.
    ///
    /// # Errors
    /// When a setting is out of range, the grid has more than [`Grid::MOST_CELLS`] cells, the engine cannot compile F − C or its gradient,
    /// or the surface's [`Stop`](crate::Stop) is requested.
    pub fn new(surface: &Surface, region: Region, settings: &GridSettings) -> Result<Self, GridError> {
        settings.check()?;
        if settings.count() > Self::MOST_CELLS {
            let (given, allowed) = (settings.count(), Self::MOST_CELLS);
            return Err(GridError::TooManyCells { method: "grid", given, allowed });
        }
        let values = surface.over_points(Kernel::Values)?;
        let lattice = Lattice::new(&region, settings.cells);
        let mut preprocessing = Counters::default();
        let along = |count: [u32; 3]| {
            Axis::ALL.map(|axis| if surface.program().takes(axis) { count[axis as usize] } else { 1 })
        };
        let classified = Lattice::new(&region, along(settings.cells));
        let refinement = along(settings.refinement);
        let cells = Cells::find(&**values, surface.stop(), &classified, refinement, &mut preprocessing)?;
        let spacing = Spacing::new(settings.step, lattice.largest_side(), 1.0);
        let lockstep = Lockstep::new(surface, region, settings.roots)?;
        Ok(Self { lockstep, lattice, cells, spacing, preprocessing })
    }
}

impl Tracer for Grid {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes) {
        self.lockstep.trace(workspace, rays, outcomes, |ray, span| ExistenceStretches {
            grid: self,
            walk: CellWalk::new(&self.lattice, *ray, span),
            ray: *ray,
            steps: 0,
        });
    }

    fn preprocessing(&self) -> Counters {
        self.preprocessing
    }
}

/// A ray's passages through existence cells.
struct ExistenceStretches<'a> {
    grid: &'a Grid,
    walk: CellWalk<'a>,
    ray: Ray,
    steps: u64,
}

impl Iterator for ExistenceStretches<'_> {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        loop {
            let passage = self.walk.next()?;
            self.steps += 1;
            if self.grid.cells.holds_surface(passage.place) {
                return Some(self.grid.spacing.stretch(self.ray.direction, passage.span));
            }
        }
    }
}

impl Stretches for ExistenceStretches<'_> {
    fn steps(&self) -> u64 {
        self.steps
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use iso_expr::{Ast, Interpreter};

    use super::*;
    use crate::paper::lattice;

    /// A formula without an argument has columns of like cells: those of a formula that takes it with no weight.
    #[test]
    fn cells_along_an_argument_that_is_not_taken_are_classified_as_one() {
        let settings = GridSettings::new([7, 6, 5]);
        let region = Region::new(glam::DVec3::splat(-1.0), glam::DVec3::splat(1.25)).unwrap();
        let grid = |formula: &str| {
            let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
            Grid::new(&Surface::new(Arc::new(Interpreter), program), region, &settings).unwrap()
        };
        for (without, with, cells) in [
            ("2x + y = 0.3", "2x + y + 0*z = 0.3", 7 * 6),
            ("hypot(y, 3z) = 0.9", "hypot(y, 3z) + 0*x = 0.9", 6 * 5),
            ("y^2 = 0.9", "y^2 + 0*x*z = 0.9", 6),
        ] {
            let (some, all) = (grid(without), grid(with));
            assert_eq!((some.preprocessing.cells, all.preprocessing.cells), (cells, 7 * 6 * 5));
            let (some_work, all_work) =
                [&some, &all].map(|grid| grid.preprocessing.preprocess_evaluations).into();
            assert!(2 * some_work < all_work, "{without}: {some_work} of {all_work} evaluations");
            let held = |grid: &Grid| {
                let place = |index| lattice::place(index, [7, 6, 5]);
                (0..7 * 6 * 5).map(|index| grid.cells.holds_surface(place(index))).collect::<Vec<_>>()
            };
            assert!(held(&some).contains(&true) && held(&some).contains(&false), "{without}");
            assert_eq!(held(&some), held(&all), "{without}");
        }
    }
}
