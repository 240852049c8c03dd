//! The search for existence cells from large blocks to single cells.

use iso_expr::{BatchKernel, Scratch};
use rayon::prelude::*;

use super::Octree;
use super::places::{PlaceMap, PlaceSet};
use crate::batch::PointBatch;
use crate::paper::existence::{Examination, Suspect};
use crate::paper::lattice::{self, Lattice};
use crate::sign::Signs;
use crate::{Counters, GridError, Stop};

/// How many blocks the longest axis holds at least when the search begins, unless it has fewer cells.
const COARSEST: usize = 8;
/// Points evaluated by one call of the kernel.
const BATCH: usize = 1024;

/// The places of the existence cells, in no particular order.
pub(super) fn find(
    kernel: &dyn BatchKernel,
    stop: &Stop,
    lattice: &Lattice,
    refinement: [u32; 3],
    counters: &mut Counters,
) -> Result<Vec<[usize; 3]>, GridError> {
    let longest = lattice.cells().into_iter().max().unwrap_or(1);
    let mut blocks = Blocks { lattice, side: 1 << (longest / COARSEST).max(1).ilog2() };
    let mut signs = PointSigns { kernel, stop, lattice, known: PlaceMap::default() };
    let examination = Examination { kernel, stop, refinement };
    let mut candidates: Vec<[usize; 3]> =
        (0..blocks.counts().iter().product()).map(|number| lattice::place(number, blocks.counts())).collect();
    let holding = loop {
        let holding = holding(&blocks, candidates, &mut signs, &examination, counters)?;
        if blocks.side == 1 {
            break holding;
        }
        candidates = holding.into_iter().flat_map(|block| blocks.parts(block)).collect();
        blocks.side /= 2;
    };
    counters.preprocess_evaluations += signs.known.len() as u64;
    counters.existence_cells += holding.len() as u64;
    Ok(holding)
}

/// The blocks that hold the surface: those of `candidates` whose corners differ in sign, and all that are found from them,
/// neighbour by neighbour.
fn holding(
    blocks: &Blocks<'_>,
    candidates: Vec<[usize; 3]>,
    signs: &mut PointSigns<'_>,
    examination: &Examination<'_>,
    counters: &mut Counters,
) -> Result<Vec<[usize; 3]>, GridError> {
    let mut looked_at = candidates.len() as u64;
    check_count(looked_at)?;
    signs.learn(blocks, &candidates);
    signs.stop.check()?;
    let mut newest = candidates;
    newest.retain(|&block| signs.at_corners(blocks, block).differ());
    let counts = blocks.counts();
    let mut labelled: PlaceSet = newest.iter().map(|&block| lattice::index(block, counts)).collect();
    let mut holding = Vec::new();
    while !newest.is_empty() {
        holding.extend_from_slice(&newest);
        let bordering: Vec<_> = newest
            .iter()
            .flat_map(|&block| lattice::neighbours(block, counts))
            .filter(|&neighbour| labelled.insert(lattice::index(neighbour, counts)))
            .collect();
        looked_at += bordering.len() as u64;
        check_count(looked_at)?;
        signs.learn(blocks, &bordering);
        signs.stop.check()?;
        let suspects: Vec<_>;
        (newest, suspects) =
            bordering.into_iter().partition(|&block| signs.at_corners(blocks, block).differ());
        let found = examination.of_all(&suspects, |block| {
            let [near, far] = blocks.span(block);
            let signs = signs.at_corners(blocks, block);
            Suspect { near: blocks.lattice.point(near), far: blocks.lattice.point(far), signs }
        });
        counters.examined_cells += suspects.len() as u64;
        counters.rescued_cells += found.holding.len() as u64;
        counters.preprocess_evaluations += found.evaluations;
        newest.extend(found.holding);
    }
    signs.stop.check()?;
    counters.cells += looked_at;
    Ok(holding)
}

fn check_count(given: u64) -> Result<(), GridError> {
    let allowed = Octree::MOST_CELLS;
    if given > allowed { Err(GridError::TooManyCells { method: "octree", given, allowed }) } else { Ok(()) }
}

/// The cells of a lattice taken together in cubes.
struct Blocks<'a> {
    lattice: &'a Lattice,
    /// Cells along a block's side, a power of two.
    side: usize,
}

impl Blocks<'_> {
    /// The blocks along each axis.
    fn counts(&self) -> [usize; 3] {
        self.lattice.cells().map(|cells| cells.div_ceil(self.side))
    }

    /// The places of a block's first and last points.
    fn span(&self, block: [usize; 3]) -> [[usize; 3]; 2] {
        let point = |ahead: usize| {
            [0, 1, 2].map(|axis| ((block[axis] + ahead) * self.side).min(self.lattice.cells()[axis]))
        };
        [point(0), point(1)]
    }

    /// The places of the points at a block's corners.
    fn corners(&self, block: [usize; 3]) -> [[usize; 3]; 8] {
        let ends = self.span(block);
        lattice::corners([0; 3]).map(|end| [0, 1, 2].map(|axis| ends[end[axis]][axis]))
    }

    /// The blocks of half the side that make up a block.
    fn parts(&self, block: [usize; 3]) -> impl Iterator<Item = [usize; 3]> + use<> {
        let counts = Blocks { side: self.side / 2, ..*self }.counts();
        lattice::corners(block.map(|place| 2 * place))
            .into_iter()
            .filter(move |part| part.iter().zip(counts).all(|(&place, count)| place < count))
    }
}

/// The signs at those points of a lattice that were asked for, each evaluated once.
struct PointSigns<'a> {
    kernel: &'a dyn BatchKernel,
    stop: &'a Stop,
    lattice: &'a Lattice,
    known: PlaceMap<Signs>,
}

impl PointSigns<'_> {
    /// Evaluates what is not yet known at the corners of some blocks, until it is stopped.
    fn learn(&mut self, blocks: &Blocks<'_>, of: &[[usize; 3]]) {
        let counts = self.lattice.points();
        let mut unknown = Vec::new();
        for corner in of.iter().flat_map(|&block| blocks.corners(block)) {
            let point = lattice::index(corner, counts);
            self.known.entry(point).or_insert_with(|| {
                unknown.push(point);
                Signs::NONE
            });
        }
        let (kernel, stop, lattice) = (self.kernel, self.stop, self.lattice);
        let learnt: Vec<Signs> = unknown
            .par_chunks(BATCH)
            .map_init(
                || (PointBatch::default(), Scratch::default()),
                |(batch, scratch), chunk| -> Vec<Signs> {
                    if stop.is_requested() {
                        return Vec::new();
                    }
                    batch.clear();
                    chunk.iter().for_each(|&point| batch.push(lattice.point(lattice::place(point, counts))));
                    batch.evaluate(kernel, scratch, 1).iter().map(|&value| Signs::of(value)).collect()
                },
            )
            .flatten_iter()
            .collect();
        self.known.extend(unknown.into_iter().zip(learnt));
    }

    /// The signs at a block's corners, which were learnt before.
    fn at_corners(&self, blocks: &Blocks<'_>, block: [usize; 3]) -> Signs {
        let counts = self.lattice.points();
        blocks.corners(block).map(|corner| self.known[&lattice::index(corner, counts)]).into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::paper::existence::Cells;
    use crate::testing::{Function, surface_without_gradient};
    use crate::{GridSettings, Kernel, Region};

    /// The existence cells of the octree, of the grid, and of both.
    fn cells_of_octree_grid_and_both(function: Function, cells: [u32; 3]) -> [usize; 3] {
        let region = Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        let lattice = Lattice::new(&region, cells);
        let surface = surface_without_gradient(function);
        let kernel = &**surface.over_points(Kernel::Values).unwrap();
        let refinement = GridSettings::new(cells).refinement;
        let leaves = find(kernel, &Stop::default(), &lattice, refinement, &mut Counters::default()).unwrap();
        let mut counters = Counters::default();
        let grid = Cells::find(kernel, &Stop::default(), &lattice, refinement, &mut counters).unwrap();
        let both = leaves.iter().filter(|&&cell| grid.holds_surface(cell)).count();
        [leaves.len(), counters.existence_cells as usize, both]
    }

    #[test]
    fn connected_surfaces_have_the_cells_of_the_grid() {
        for (function, cells) in [
            ((|p| p.length_squared() - 0.8) as Function, [64, 64, 64]),
            (|p| (7.0 * p.x).sin() + (6.0 * p.y).sin() + (5.0 * p.z).sin(), [45, 33, 17]),
            (|p| if p.x > 0.3 { f64::NAN } else { p.y - p.x * p.z }, [1, 70, 29]),
            (|p| p.z - 0.1, [5, 9, 1]),
        ] {
            let [octree, grid, both] = cells_of_octree_grid_and_both(function, cells);
            assert!(octree > 0 && octree == grid && grid == both, "{octree} {grid} {both} in {cells:?}");
        }
    }

    #[test]
    fn a_small_ball_is_lost_on_its_own_but_not_beside_another() {
        let small_ball: Function = |p| (p - 0.63).length() - 0.08;
        let [octree, grid, _] = cells_of_octree_grid_and_both(small_ball, [64; 3]);
        assert!(octree == 0 && grid > 0, "{octree} {grid}");
        let touching_balls: Function = |p| ((p - 0.63).length() - 0.08).min((p - 0.3).length() - 0.5);
        let [octree, grid, both] = cells_of_octree_grid_and_both(touching_balls, [64; 3]);
        assert!(octree == grid && grid == both, "{octree} {grid} {both}");
    }
}
