//! The tree above the existence cells, and the way of a ray through it.

use crate::paper::lattice::Lattice;
use crate::paper::walk::Passage;
use crate::{Ray, Span};

/// A sparse octree: each node knows which of its eight parts exist, and where the first of them is.
#[derive(Debug)]
pub(super) struct Tree {
    /// The nodes whose parts are cells, then those whose parts are these nodes, and so on up to the root alone. Each list
    /// is in Z-order, so that the parts of a node stand next to each other. Empty when there are no cells.
    levels: Vec<Vec<Node>>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// The place of the first part among those of the level below.
    first: u32,
    /// Which parts exist, a bit each.
    parts: u8,
}

impl Node {
    /// The place of a part among those of the level below, if it exists.
    fn part(self, octant: u32) -> Option<u32> {
        let before = self.parts & ((1 << octant) - 1);
        (self.parts >> octant & 1 == 1).then(|| self.first + before.count_ones())
    }
}

impl Tree {
    /// The tree above `cells` of a lattice with `counts` cells along the axes.
    pub(super) fn new(cells: &[[usize; 3]], counts: [usize; 3]) -> Self {
        let mut codes: Vec<u64> = cells.iter().map(|&cell| z_order(cell)).collect();
        codes.sort_unstable();
        let longest = counts.into_iter().max().unwrap_or(1);
        let height = longest.next_power_of_two().ilog2().max(1);
        let mut levels = Vec::new();
        for _ in 0..height {
            let (mut above, mut nodes) = (Vec::new(), Vec::<Node>::new());
            for (place, code) in codes.iter().enumerate() {
                if above.last() != Some(&(code >> 3)) {
                    above.push(code >> 3);
                    nodes.push(Node { first: place as u32, parts: 0 });
                }
                if let Some(node) = nodes.last_mut() {
                    node.parts |= 1 << (code & 7);
                }
            }
            levels.push(nodes);
            codes = above;
        }
        Self { levels }
    }
}

/// The bits of a place's coordinates, x lowest, in turn.
fn z_order(place: [usize; 3]) -> u64 {
    let bit = |axis: usize, bit: u32| (place[axis] as u64 >> bit & 1) << (3 * bit + axis as u32);
    (0..u64::BITS / 3).map(|number| (0..3).map(|axis| bit(axis, number)).sum::<u64>()).sum()
}

/// The cells of a tree that a ray passes through, from the nearest to the farthest. Where a ray crosses the planes that cut
/// a node is enough to tell which of its parts it visits and when, as in J. Revelles, C. Ureña and M. Lastra, 'An Efficient
/// Parametric Algorithm for Octree Traversal', WSCG 2000.
///
/// Each cell's part of the ray is, to the last bit, that of the walk from cell to cell.
pub(super) struct TreeWalk<'a> {
    tree: &'a Tree,
    lattice: &'a Lattice,
    ray: Ray,
    /// What is left to visit, the nearest last.
    waiting: Vec<Visit>,
    steps: u64,
}

/// A part of the tree to be visited.
#[derive(Clone, Copy)]
struct Visit {
    /// How many levels above the cells.
    level: usize,
    /// The place among the level's nodes.
    node: u32,
    /// The place among all blocks of this size.
    block: [usize; 3],
    span: Span,
}

impl<'a> TreeWalk<'a> {
    /// The way along `span`, the part of `ray` inside the lattice's region.
    pub(super) fn new(tree: &'a Tree, lattice: &'a Lattice, ray: Ray, span: Span) -> Self {
        let level = tree.levels.len();
        let has_root = tree.levels.last().is_some_and(|root| !root.is_empty());
        let waiting = has_root.then_some(Visit { level, node: 0, block: [0; 3], span }).into_iter().collect();
        Self { tree, lattice, ray, waiting, steps: 0 }
    }

    /// How many blocks and cells were visited so far.
    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    /// Puts the parts of a node that the ray passes through in the waiting list.
    fn open(&mut self, visit: Visit) {
        let node = self.tree.levels[visit.level - 1][visit.node as usize];
        let first_new = self.waiting.len();
        let crossings = [0, 1, 2].map(|axis| self.middle_crossing(axis, &visit));
        let mut upper = [0, 1, 2].map(|axis| self.starts_above(axis, &visit, crossings[axis]));
        let mut start = visit.span.start;
        loop {
            let next = (0..3)
                .filter(|&axis| {
                    upper[axis] != (self.ray.direction[axis] > 0.0) && crossings[axis] < visit.span.end
                })
                .min_by(|&a, &b| crossings[a].total_cmp(&crossings[b]));
            let end = next.map_or(visit.span.end, |axis| crossings[axis]);
            let octant = (0..3).map(|axis| u32::from(upper[axis]) << axis).sum();
            if let Some(part) = node.part(octant).filter(|_| start < end) {
                let block = [0, 1, 2].map(|axis| 2 * visit.block[axis] + usize::from(upper[axis]));
                let span = Span { start, end };
                self.waiting.push(Visit { level: visit.level - 1, node: part, block, span });
            }
            let Some(axis) = next else { break };
            upper[axis] = !upper[axis];
            start = end;
        }
        self.waiting[first_new..].reverse();
    }

    /// The plane that cuts a node's block across `axis`, if it lies inside the region.
    fn middle(&self, axis: usize, visit: &Visit) -> Option<f64> {
        let planes = self.lattice.planes(axis);
        let place = (2 * visit.block[axis] + 1) << (visit.level - 1);
        planes[..planes.len() - 1].get(place).copied()
    }

    /// Where the ray crosses the plane that cuts a node's block across `axis`; never, if it does not.
    fn middle_crossing(&self, axis: usize, visit: &Visit) -> f64 {
        let (origin, direction) = (self.ray.origin[axis], self.ray.direction[axis]);
        match self.middle(axis, visit) {
            Some(middle) if direction != 0.0 => (middle - origin) / direction,
            _ => f64::INFINITY,
        }
    }

    /// Whether the ray is in the upper half of a node's block along `axis` where it enters the block.
    fn starts_above(&self, axis: usize, visit: &Visit, crossing: f64) -> bool {
        let direction = self.ray.direction[axis];
        match self.middle(axis, visit) {
            None => false,
            Some(_) if direction > 0.0 => crossing <= visit.span.start,
            Some(_) if direction < 0.0 => crossing > visit.span.start,
            Some(middle) => self.ray.origin[axis] >= middle,
        }
    }
}

impl Iterator for TreeWalk<'_> {
    type Item = Passage;

    fn next(&mut self) -> Option<Passage> {
        loop {
            let visit = self.waiting.pop()?;
            self.steps += 1;
            if visit.level == 0 {
                return Some(Passage { place: visit.block, span: visit.span });
            }
            self.open(visit);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::paper::walk::CellWalk;
    use crate::{Region, testing};

    proptest! {
        #![proptest_config(testing::property(4000))]

        /// With some cells left out, by a number that says which.
        #[test]
        fn the_tree_is_walked_as_the_grid_is(
            ray in testing::ray(),
            counts in proptest::array::uniform3(1_u32..20),
            left_out in any::<u64>(),
        ) {
            let region = Region::new(DVec3::splat(-1.0), DVec3::new(1.0, 1.5, 2.0)).unwrap();
            let Some(span) = region.clip(&ray) else { return Ok(()) };
            let lattice = Lattice::new(&region, counts);
            let exists = |place: [usize; 3]| {
                let number = crate::paper::lattice::index(place, lattice.cells()) as u32;
                left_out.rotate_left(number * 7) & 3 != 0
            };
            let all = (0..lattice.cells().iter().product()).map(|number| crate::paper::lattice::place(number, lattice.cells()));
            let cells: Vec<_> = all.filter(|&place| exists(place)).collect();
            let tree = Tree::new(&cells, lattice.cells());
            let by_tree: Vec<_> = TreeWalk::new(&tree, &lattice, ray, span).collect();
            let by_cells: Vec<_> =
                CellWalk::new(&lattice, ray, span).filter(|passage| exists(passage.place)).collect();
            prop_assert_eq!(by_tree, by_cells);
        }
    }

    #[test]
    fn a_tree_without_cells_has_no_way() {
        let region = Region::new(DVec3::ZERO, DVec3::ONE).unwrap();
        let lattice = Lattice::new(&region, [5; 3]);
        let ray = Ray { origin: DVec3::splat(0.5), direction: DVec3::X };
        let tree = Tree::new(&[], lattice.cells());
        assert_eq!(TreeWalk::new(&tree, &lattice, ray, region.clip(&ray).unwrap()).next(), None);
    }
}
