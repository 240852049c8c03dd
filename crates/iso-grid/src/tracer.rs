//! What every method of intersection offers.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch};
use pulp::Arch;

use crate::batch::{BoxBatch, FormBatch, PointBatch};
use crate::certified::{Ahead, Entry, Expansion, Memory};
use crate::normals::Asked;
use crate::point_rows::PointRows;
use crate::{Counters, OutcomeKind, Outcomes, Ray, Tile};

/// What came of the rays of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Traced {
    /// All of them end in misses.
    Nothing,
    /// Some do not.
    Outcomes,
    /// Some do not, and each hit and touch has its normal.
    OutcomesAndNormals,
}

/// A method of intersection, ready for its surface and region.
pub trait Tracer: Send + Sync {
    /// Says for each ray how the search along it ended, whatever stood in `outcomes` before.
    ///
    /// The outcome of a ray depends on that ray alone, not on its neighbours in the slice, nor on earlier calls.
    ///
    /// When the surface's [`Stop`](crate::Stop) is requested, this returns soon, and no outcome means anything.
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes);

    /// The same for a tile, row by row; says what came of it.
    ///
    /// A method may share work between the rays of a tile. What it says of each is as true as if it were traced alone, but
    /// where in its bracket a root is placed, and how wide the bracket is, may depend on the other rays of the tile.
    ///
    /// With `normals`, of which there are as many, a method puts those of hits in their places that it comes by on the way: the unit normal ∇F/|∇F| at
    /// a point of the ray no farther from the hit than brackets may be wide. It leaves all others as they are.
    fn trace_tile(
        &self,
        workspace: &mut Workspace,
        tile: Tile<'_>,
        outcomes: &mut Outcomes,
        normals: Option<&mut [DVec3]>,
    ) -> Traced {
        let _ = normals;
        trace_each(self, workspace, tile, outcomes)
    }

    /// A function with the signs of F − C, and its three derivatives, at points of the box with these corners, where the method knows
    /// a kernel for it that takes much less time than that of F − C. On the surface its gradient has the direction of that of F − C.
    fn gradients_on(&self, lo: DVec3, hi: DVec3) -> Option<Arc<dyn BatchKernel>> {
        let _ = (lo, hi);
        None
    }

    /// What preprocessing took.
    fn preprocessing(&self) -> Counters;
}

/// Traces the rays of a tile each for its own; says what came of it.
pub(crate) fn trace_each<T: Tracer + ?Sized>(
    tracer: &T,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    outcomes: &mut Outcomes,
) -> Traced {
    tracer.trace(workspace, &tile.rays().collect::<Vec<_>>(), outcomes);
    let are_missed = outcomes.kinds().iter().all(|kind| *kind == OutcomeKind::Miss);
    if are_missed { Traced::Nothing } else { Traced::Outcomes }
}

/// A thread's working memory and counts, reused from call to call. It carries no results but its counters.
#[derive(Debug, Default)]
pub struct Workspace {
    /// For the kernels.
    pub scratch: Scratch,
    /// What was done with this workspace so far.
    pub counters: Counters,
    /// How many numbers the processor computes with at once.
    pub(crate) arch: Arch,
    /// Where normals are asked for along the rays of a tile.
    pub(crate) asked: Vec<Asked>,
    /// Points for the kernels, and their values.
    pub(crate) points: PointBatch,
    /// The same of rays side by side.
    pub(crate) point_rows: PointRows,
    /// Points whose gradients are asked for beside their values.
    pub(crate) sloped_points: PointBatch,
    /// Boxes for the kernels, and their enclosures.
    pub(crate) boxes: BoxBatch,
    /// Points in the middle of some of those boxes, as boxes of their own.
    pub(crate) middles: BoxBatch,
    pub(crate) forms: FormBatch,
    /// What lies ahead of a certified search.
    pub(crate) ahead: Vec<Ahead>,
    /// Which cells a certified search is to enter.
    pub(crate) entries: Vec<Entry>,
    /// A tile and its beams.
    pub(crate) tile: Memory,
    /// A polynomial along a ray.
    pub(crate) expansion: Expansion,
}
