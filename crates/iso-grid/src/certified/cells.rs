//! The certified grid: cells of the region that are proven to hold no root, found when a ray first comes by and kept.

use std::sync::atomic::{AtomicU16, Ordering};

use iso_expr::{Decorated, Decoration, Interval, Scratch};

use super::classify::free_of_zero;
use super::kernels::{Bounds, Jet, Kernels};
use crate::Region;

/// How often the region is halved along each axis: 32 cells along each at last.
pub(super) const DEPTH: u32 = 5;

/// How many pieces of F around its poles and jumps are looked at.
const PIECES: usize = 16;

/// What is known of the cells of the region, and of the cells they are made of, down to the smallest.
///
/// What is found out about a cell depends on the surface and the cell alone, so it does not matter which ray comes first,
/// nor that threads that come by at once each find it out.
pub(crate) struct Cells {
    /// The planes between the smallest cells, along each axis, the region's faces included.
    planes: [Vec<f64>; 3],
    /// For each cell but the smallest: which of its parts are empty, one bit each, and [`KNOWN`] once that has been asked.
    empty_parts: Vec<AtomicU16>,
}

/// Set when the parts of a cell have been looked at.
const KNOWN: u16 = 1 << PARTS;

/// A cell is made of eight: bit 0 of a part's number is set for the half with the larger x, bit 1 for y, bit 2 for z.
pub(super) const PARTS: usize = 8;

/// A cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// How often the region is halved to get it.
    pub(super) depth: u32,
    /// Its place along each axis among the cells of its size.
    place: [u32; 3],
    /// Its place in the tree, in which the parts of cell n are the cells from 8n + 1 on.
    node: usize,
}

impl Cell {
    /// The whole region.
    pub(super) const REGION: Self = Self { depth: 0, place: [0; 3], node: 0 };
    /// Stands for any of the smallest cells, of which nothing more is asked.
    pub(super) const SMALLEST: Self = Self { depth: DEPTH, place: [0; 3], node: 0 };

    pub(super) fn part(self, number: usize) -> Self {
        Self {
            depth: self.depth + 1,
            place: std::array::from_fn(|axis| 2 * self.place[axis] + (number >> axis & 1) as u32),
            node: PARTS * self.node + 1 + number,
        }
    }
}

impl Cells {
    pub(crate) fn new(region: &Region) -> Self {
        let count = 1 << DEPTH;
        let planes = [0, 1, 2].map(|axis| {
            let (min, max) = (region.min()[axis], region.max()[axis]);
            let plane = |number| min + (max - min) * (f64::from(number) / f64::from(count));
            (0..=count).map(|number| if number == count { max } else { plane(number) }).collect()
        });
        // 1 + 8 + 64 + … cells have parts.
        let divided = ((1 << (3 * DEPTH)) - 1) / (PARTS - 1);
        Self { planes, empty_parts: (0..divided).map(|_| AtomicU16::new(0)).collect() }
    }

    /// The plane along `axis` between the halves of a cell.
    pub(super) fn middle(&self, cell: Cell, axis: usize) -> f64 {
        self.planes[axis][((2 * cell.place[axis] + 1) << (DEPTH - 1 - cell.depth)) as usize]
    }

    fn bounds(&self, cell: Cell) -> Bounds {
        [0, 1, 2].map(|axis| {
            let plane = |place: u32| self.planes[axis][(place << (DEPTH - cell.depth)) as usize];
            Interval { lo: plane(cell.place[axis]), hi: plane(cell.place[axis] + 1) }
        })
    }

    /// Which of the parts of a cell are empty, bit by bit: no point of them, faces included, is a root. Adds to
    /// `evaluations` how many boxes were enclosed to find out.
    pub(super) fn empty_parts(
        &self,
        kernels: &Kernels,
        scratch: &mut Scratch,
        evaluations: &mut u64,
        cell: Cell,
    ) -> u16 {
        let known = self.empty_parts[cell.node].load(Ordering::Relaxed);
        if known & KNOWN != 0 {
            return known;
        }
        let bounds = std::array::from_fn(|number| self.bounds(cell.part(number)));
        let (empty, enclosed) = prove_empty(kernels, scratch, &bounds);
        *evaluations += enclosed;
        let found =
            (0..PARTS).filter(|number| empty[*number]).fold(KNOWN, |found, number| found | 1 << number);
        self.empty_parts[cell.node].store(found, Ordering::Relaxed);
        found
    }
}

/// Which of the boxes certainly hold no root, and how many enclosures that took.
fn prove_empty(kernels: &Kernels, scratch: &mut Scratch, boxes: &[Bounds; PARTS]) -> ([bool; PARTS], u64) {
    let jets = kernels.jets(scratch, boxes);
    let centers = boxes.map(|bounds| bounds.map(|side| Interval::point(side.midpoint())));
    let at_centers = kernels.enclosures(scratch, &centers);
    let mut enclosures = 2 * PARTS as u64;
    let empty = std::array::from_fn(|place| {
        let value = jets[place].value;
        if free_of_zero(value.interval) {
            return true;
        }
        if value.decoration >= Decoration::Continuous {
            return free_of_zero(mean_value(&boxes[place], &jets[place], at_centers[place]));
        }
        let mut pieces = kernels.program().pieces(boxes[place]);
        let free = pieces.by_ref().take(PIECES).all(|piece| {
            enclosures += 1;
            free_of_zero(piece)
        });
        free && pieces.next().is_none()
    });
    (empty, enclosures)
}

/// The mean value form: F at the center and its derivatives over the box bound F (Moore 1966).
fn mean_value(bounds: &Bounds, jet: &Jet, at_center: Decorated) -> Interval {
    let mut value = at_center.interval;
    for (side, partial) in bounds.iter().zip(jet.gradient) {
        if partial.decoration < Decoration::Defined {
            return jet.value.interval;
        }
        let offset = side.minus(Interval::point(side.midpoint()));
        value = value.plus(partial.interval.times(offset));
    }
    value
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use iso_expr::random::Random;
    use iso_expr::{Ast, Engine, Interpreter};

    use super::*;
    use crate::Surface;

    /// What is multiplied with what is zero at a point, some of it with poles, jumps, corners and gaps.
    const FACTORS: [&str; 10] = [
        "1",
        "x*y - 2",
        "sin(3y)",
        "1/(x - 0.3)",
        "floor(2z) + 0.5",
        "sqrt(x + y + 1)",
        "exp(-z^2) - 0.5",
        "abs(x - z)",
        "tan(2z)",
        "max(x, y^3, z - 1)",
    ];

    /// All cells that hold a root of F, on their faces as well, are open.
    #[test]
    fn no_cell_that_holds_a_root_is_empty() {
        let mut random = Random::new(31);
        let region = Region::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
        let mut scratch = Scratch::default();
        let (mut roots, mut open, mut empty) = (0, 0, 0);
        for _ in 0..300 {
            // In cells, on their faces, and at their corners.
            let [x, y, z] = [(); 3].map(|()| (random.below(257) as f64 - 128.0) / 64.0);
            let [a, b, c] = [(); 3].map(|()| random.choose(&FACTORS));
            let formula = format!("(x - ({x}))*({a}) + (y - ({y}))*({b}) + (z - ({z}))*({c})");
            let program = Ast::parse(&formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
            let mut value = [f64::NAN];
            Interpreter.point(&program).unwrap().evaluate(&mut scratch, x, y, z, &mut value);
            if value != [0.0] {
                continue;
            }
            roots += 1;
            let kernels = Kernels::of(&Surface::new(Arc::new(Interpreter), program)).unwrap();
            let (cells, mut evaluations) = (Cells::new(&region), 0);
            let mut ahead = vec![Cell::REGION];
            while let Some(cell) = ahead.pop() {
                let found = cells.empty_parts(&kernels, &mut scratch, &mut evaluations, cell);
                for number in 0..PARTS {
                    let (part, is_empty) = (cell.part(number), found >> number & 1 == 1);
                    let sides = cells.bounds(part).into_iter().zip([x, y, z]);
                    let holds_root = sides.into_iter().all(|(side, at)| side.lo <= at && at <= side.hi);
                    assert!(!holds_root || !is_empty, "{part:?} of {formula}");
                    open += usize::from(holds_root);
                    empty += usize::from(is_empty);
                    if holds_root && part.depth < DEPTH {
                        ahead.push(part);
                    }
                }
            }
        }
        assert!(roots > 200 && open > 5 * roots && empty > roots, "{roots}, {open}, {empty}");
    }
}
