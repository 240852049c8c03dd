//! Cells of a region, and which of them the surface is in.

use std::ops::Range;

use glam::{DVec3, IVec3};
use iso_expr::{BoxKernel, Decoration, Interval};

use crate::batch::BoxBatch;
use crate::{Region, Workspace};

/// A region is cut in halves this often along each axis: 16 cells.
pub(super) const HALVINGS: u32 = 4;

/// Cells of a cube along each axis that lie in the cube before it.
pub(super) const BEFORE: Range<i32> = 6..10;

/// Cells at the faces of a cube are cut in halves this often to find out whether the surface meets the faces.
const HALVINGS_AT_FACES: u32 = 4;

/// Of more cells at the faces of a cube none are halved.
const MOST_AT_FACES: usize = 512;

/// In how many of those points of the surface are looked for first: if any are found, it most likely meets the faces, and none are halved.
const ASKED_AT_FACES: usize = 64;

/// Cells that may hold the surface are cut in halves this often to prove that they do.
const HALVINGS_TO_PROVE: u32 = 8;

/// Of more cells that may hold the surface none are halved, and only some are looked at.
const MOST_TO_PROVE: usize = 300;

/// No side is drawn closer than this part of the longest one, so that flat surfaces keep some space around them.
const THINNEST: f64 = 0.25;

impl Region {
    /// The cells, sixteen along each axis, that may hold the surface.
    pub(super) fn open_cells(&self, kernel: &dyn BoxKernel, workspace: &mut Workspace) -> Vec<IVec3> {
        (1..=HALVINGS).fold(vec![IVec3::ZERO], |cells, depth| {
            self.not_empty(halved(&cells), 1 << depth, kernel, workspace)
        })
    }

    /// The box around some of sixteen cells along each axis, but not too thin; `None` when there are none.
    pub(super) fn around(&self, cells: &[IVec3]) -> Option<Self> {
        let first = cells.iter().copied().reduce(IVec3::min)?;
        let last = cells.iter().copied().reduce(IVec3::max)?;
        let (min, max) = (self.corner(first, 1 << HALVINGS), self.corner(last + 1, 1 << HALVINGS));
        let spare = 0.5 * (DVec3::splat(THINNEST * (max - min).max_element()) - (max - min)).max(DVec3::ZERO);
        Some(Self { min: (min - spare).max(self.min), max: (max + spare).min(self.max) })
    }

    /// On how many axes faces of the region may be met by the surface, which is in some of sixteen cells along each axis.
    pub(super) fn axes_met(
        &self,
        cells: &[IVec3],
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> usize {
        let mut count = 1 << HALVINGS;
        let mut cells: Vec<_> = cells.iter().copied().filter(|cell| is_at_face(*cell, count)).collect();
        let some = &cells[..cells.len().min(ASKED_AT_FACES)];
        if !self.holds_points(some, count, kernel, workspace) {
            for _ in 0..HALVINGS_AT_FACES {
                if cells.len() > MOST_AT_FACES {
                    break;
                }
                count *= 2;
                let mut parts = halved(&cells);
                parts.retain(|part| is_at_face(*part, count));
                cells = self.not_empty(parts, count, kernel, workspace);
            }
        }
        let is_met = |axis: &usize| cells.iter().any(|cell| is_end(cell[*axis], count));
        (0..3).filter(is_met).count()
    }

    /// Whether the surface is found to have points in some of sixteen cells along each axis. If there are few, they are halved to find out.
    pub(super) fn is_crossed(
        &self,
        mut cells: Vec<IVec3>,
        (kernel, is_stopped): (&dyn BoxKernel, &dyn Fn() -> bool),
        workspace: &mut Workspace,
    ) -> bool {
        for depth in HALVINGS..=HALVINGS + HALVINGS_TO_PROVE {
            if depth > HALVINGS {
                cells = self.not_empty(halved(&cells), 1 << depth, kernel, workspace);
            }
            let step = cells.len().div_ceil(MOST_TO_PROVE).max(1);
            // Not always the same one of each few, for cells lie in rows.
            let some: Vec<_> =
                cells.chunks(step).enumerate().map(|(number, few)| few[number % few.len()]).collect();
            if some.chunks(64).any(|cells| self.holds_points(cells, 1 << depth, kernel, workspace)) {
                return true;
            }
            if cells.len() > MOST_TO_PROVE || is_stopped() {
                return false;
            }
        }
        false
    }

    /// Whether F, continuous on one of `cells`, of which `count` fill the region along each axis, has both signs at its corners, or is zero
    /// at one that is not in the cube before.
    pub(super) fn holds_points(
        &self,
        cells: &[IVec3],
        count: i32,
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> bool {
        let boxes = cells.iter().flat_map(|&cell| {
            let corner = move |octant: IVec3| self.corner(cell + octant, count);
            let corners = OCTANTS.map(|octant| (corner(octant), corner(octant)));
            std::iter::once(self.cell(cell, count)).chain(corners)
        });
        let found = enclose(kernel, workspace, boxes);
        let places = (0..found.len()).step_by(1 + OCTANTS.len());
        places.zip(cells).any(|(place, cell)| {
            let corners = OCTANTS.into_iter().zip(place + 1..);
            let mut corners = corners.map(|(octant, corner)| (*cell + octant, found.interval(0, corner)));
            found.decorated(0, place).decoration >= Decoration::Continuous
                && (corners.clone().any(|(_, value)| value.hi < 0.0)
                    && corners.clone().any(|(_, value)| value.lo > 0.0)
                    || corners.any(|(corner, value)| {
                        value == Interval::point(0.0) && !is_in_cube_before(corner, count)
                    }))
        })
    }

    /// Those of `cells`, of which `count` fill the region along each axis, that may hold the surface.
    pub(super) fn not_empty(
        &self,
        mut cells: Vec<IVec3>,
        count: i32,
        kernel: &dyn BoxKernel,
        workspace: &mut Workspace,
    ) -> Vec<IVec3> {
        let found = enclose(kernel, workspace, cells.iter().map(|&cell| self.cell(cell, count)));
        let mut may_hold = (0..found.len()).map(|cell| found.interval(0, cell).contains_zero());
        cells.retain(|_| may_hold.next() == Some(true));
        cells
    }

    /// The corners of a cell.
    pub(super) fn cell(&self, cell: IVec3, count: i32) -> (DVec3, DVec3) {
        (self.corner(cell, count), self.corner(cell + 1, count))
    }

    /// The corner of a cell next to the region's least corner.
    pub(super) fn corner(&self, cell: IVec3, count: i32) -> DVec3 {
        let part = cell.as_dvec3() / f64::from(count);
        // Written so that the outermost corners are the region's, exactly.
        self.min * (1.0 - part) + self.max * part
    }
}

pub(super) const OCTANTS: [IVec3; 8] = [
    IVec3::new(0, 0, 0),
    IVec3::new(1, 0, 0),
    IVec3::new(0, 1, 0),
    IVec3::new(1, 1, 0),
    IVec3::new(0, 0, 1),
    IVec3::new(1, 0, 1),
    IVec3::new(0, 1, 1),
    IVec3::new(1, 1, 1),
];

/// Whether a cell is the first or the last of `count` along an axis.
fn is_end(along: i32, count: i32) -> bool {
    along == 0 || along == count - 1
}

/// Whether a cell, of which `count` fill a region along each axis, lies at one of its faces.
fn is_at_face(cell: IVec3, count: i32) -> bool {
    cell.to_array().into_iter().any(|along| is_end(along, count))
}

/// The eight cells that each cell is cut into.
pub(super) fn halved(cells: &[IVec3]) -> Vec<IVec3> {
    cells.iter().flat_map(|cell| OCTANTS.map(|octant| 2 * cell + octant)).collect()
}

/// Encloses F over boxes with these corners.
pub(super) fn enclose<'w>(
    kernel: &dyn BoxKernel,
    workspace: &'w mut Workspace,
    boxes: impl Iterator<Item = (DVec3, DVec3)> + Clone,
) -> &'w BoxBatch {
    let Workspace { boxes: batch, scratch, counters, .. } = workspace;
    batch.replace(boxes);
    batch.evaluate(kernel, scratch, 1);
    counters.box_evaluations += batch.len() as u64;
    batch
}

/// Whether a corner of cells, of which `count` fill a cube along each axis, lies in the cube before it, or on its faces.
fn is_in_cube_before(corner: IVec3, count: i32) -> bool {
    let halves = count >> HALVINGS;
    let before = halves * BEFORE.start..=halves * BEFORE.end;
    corner.to_array().iter().all(|along| before.contains(along))
}
