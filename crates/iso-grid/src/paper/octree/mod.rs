//! The paper's method, hierarchical.

mod leaves;
mod places;
mod tree;

use crate::paper::lattice::Lattice;
use crate::paper::lockstep::Lockstep;
use crate::paper::stretch::{Spacing, Stretch, Stretches};
use crate::{Counters, GridError, GridSettings, Kernel, Outcomes, Ray, Region, Surface, Tracer, Workspace};
use tree::{Tree, TreeWalk};

/// The paper's closing idea: the sign test of [`Grid`](crate::Grid), made on blocks of cells first.
///
/// Blocks are cubes of 1, 2, 4, … cells a side, cut short at the region's upper faces. The search begins with blocks of
/// which the longest axis holds 8 to 16 (all cells, if there are fewer than 16). At each size, blocks whose corners differ
/// in sign hold the surface, and their neighbours are examined again as the grid's cells are, on and on. Blocks that hold
/// the surface are cut into eight, the others are dropped. What is left at the size of one cell are existence cells: just
/// the grid's own, but for pieces of the surface that no block's corners or parts gave a sign of. The larger the blocks,
/// the larger the pieces that can be lost; whatever is connected to a piece that was found is found with it, except where
/// the grid would lose it too.
///
/// A ray goes down from block to block, past everything that was dropped, and is sampled in existence cells just as in
/// the grid.
pub struct Octree {
    lockstep: Lockstep,
    lattice: Lattice,
    tree: Tree,
    spacing: Spacing,
    preprocessing: Counters,
}

impl Octree {
    /// The most blocks of one size that are looked at.
    pub const MOST_CELLS: u64 = 1 << 22;

    /// Prepares the method: finds the existence cells, over all threads, and builds the tree above them.
    ///
    /// # Errors
    /// When a setting is out of range, more than [`Octree::MOST_CELLS`] blocks of one size come up, the engine cannot
    /// compile F − C or its gradient, or the surface's [`Stop`](crate::Stop) is requested.
    pub fn new(surface: &Surface, region: Region, settings: &GridSettings) -> Result<Self, GridError> {
        settings.check()?;
        let values = surface.over_points(Kernel::Values)?;
        let lattice = Lattice::new(&region, settings.cells);
        let mut preprocessing = Counters::default();
        let leaves =
            leaves::find(&**values, surface.stop(), &lattice, settings.refinement, &mut preprocessing)?;
        let tree = Tree::new(&leaves, lattice.cells());
        let spacing = Spacing::new(settings.step, lattice.largest_side(), 1.0);
        let lockstep = Lockstep::new(surface, region, settings.roots)?;
        Ok(Self { lockstep, lattice, tree, spacing, preprocessing })
    }
}

impl Tracer for Octree {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes) {
        self.lockstep.trace(workspace, rays, outcomes, |ray, span| LeafStretches {
            walk: TreeWalk::new(&self.tree, &self.lattice, *ray, span),
            spacing: self.spacing,
            ray: *ray,
        });
    }

    fn preprocessing(&self) -> Counters {
        self.preprocessing
    }
}

/// A ray's passages through existence cells.
struct LeafStretches<'a> {
    walk: TreeWalk<'a>,
    spacing: Spacing,
    ray: Ray,
}

impl Iterator for LeafStretches<'_> {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        self.walk.next().map(|passage| self.spacing.stretch(self.ray.direction, passage.span))
    }
}

impl Stretches for LeafStretches<'_> {
    fn steps(&self) -> u64 {
        self.walk.steps()
    }
}
