//! The certified grid: cells of the region that are proven to hold no root, found when a ray first comes by and kept.

use std::sync::atomic::{AtomicU8, Ordering};

use iso_expr::{Decorated, Decoration, Interval, Program, Scratch};

use super::classify::free_of_zero;
use super::kernels::{BATCH, Bounds, Jet, Kernels};
use crate::Region;

/// How often the region is halved along each axis: 32 cells along each at last.
pub(super) const DEPTH: u32 = 5;

/// How many pieces of F around its poles and jumps are looked at.
const PIECES: usize = 16;

/// What is known of the cells of the region, and of the cells they are made of, down to the smallest.
///
/// What is found out about a cell depends on the surface and the cell alone, so it does not matter which ray comes first,
/// nor that threads that come by at once each find it out.
pub(super) struct Cells {
    /// The planes between the smallest cells, along each axis, the region's faces included.
    planes: [Vec<f64>; 3],
    /// What is known of each cell of each size, the largest first.
    states: Vec<AtomicU8>,
}

/// A cell: how often the region is halved to get it, and its place among the cells of this size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub(super) depth: u32,
    pub(super) place: [u32; 3],
}

/// What is known of a cell. A cell of the region is asked about before its parts, all eight of them at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum State {
    Unknown,
    /// No point of it, faces included, is a root.
    Empty,
    Open,
}

impl Cell {
    /// The whole region.
    pub(super) const REGION: Self = Self { depth: 0, place: [0; 3] };

    /// The eight parts: bit 0 of the number is set for the half with the larger x, bit 1 for y, bit 2 for z.
    pub(super) fn parts(self) -> [Self; 8] {
        std::array::from_fn(|number| Self {
            depth: self.depth + 1,
            place: [0, 1, 2].map(|axis| 2 * self.place[axis] + (number as u32 >> axis & 1)),
        })
    }

    /// Its place in the table.
    fn index(self) -> usize {
        let larger = ((1 << (3 * self.depth)) - 1) / 7;
        let [x, y, z] = self.place;
        larger + (x + ((y + (z << self.depth)) << self.depth)) as usize
    }
}

impl Cells {
    pub(super) fn new(region: &Region) -> Self {
        let count = 1 << DEPTH;
        let planes = [0, 1, 2].map(|axis| {
            let (min, max) = (region.min()[axis], region.max()[axis]);
            let plane = |number| min + (max - min) * (f64::from(number) / f64::from(count));
            (0..=count).map(|number| if number == count { max } else { plane(number) }).collect()
        });
        let smallest = Cell { depth: DEPTH + 1, place: [0; 3] };
        let states = (0..smallest.index()).map(|_| AtomicU8::new(State::Unknown as u8)).collect();
        Self { planes, states }
    }

    /// The plane along `axis` where the cell begins, and the one where it ends.
    pub(super) fn side(&self, cell: Cell, axis: usize) -> Interval {
        let finest = |place: u32| self.planes[axis][(place << (DEPTH - cell.depth)) as usize];
        Interval { lo: finest(cell.place[axis]), hi: finest(cell.place[axis] + 1) }
    }

    fn bounds(&self, cell: Cell) -> Bounds {
        [0, 1, 2].map(|axis| self.side(cell, axis))
    }

    /// Which of the parts of a cell are empty, by number, and how many boxes were enclosed to find out.
    pub(super) fn empty_parts(
        &self,
        kernels: &Kernels,
        program: &Program,
        scratch: &mut Scratch,
        parts: &[Cell; 8],
    ) -> ([bool; 8], u64) {
        let states = parts.map(|part| self.states[part.index()].load(Ordering::Relaxed));
        if !states.contains(&(State::Unknown as u8)) {
            return (states.map(|state| state == State::Empty as u8), 0);
        }
        let bounds = parts.map(|part| self.bounds(part));
        let (empty, boxes) = prove_empty(kernels, program, scratch, &bounds);
        for (part, empty) in parts.iter().zip(empty) {
            let state = if empty { State::Empty } else { State::Open };
            self.states[part.index()].store(state as u8, Ordering::Relaxed);
        }
        (empty, boxes)
    }
}

/// Which of the boxes certainly hold no root, and how many enclosures that took.
fn prove_empty(
    kernels: &Kernels,
    program: &Program,
    scratch: &mut Scratch,
    boxes: &[Bounds; BATCH],
) -> ([bool; BATCH], u64) {
    let jets = kernels.jets(scratch, boxes);
    let centers = boxes.map(|bounds| bounds.map(|side| Interval::point(side.midpoint())));
    let at_centers = kernels.values(scratch, &centers);
    let mut enclosures = 2 * BATCH as u64;
    let empty = std::array::from_fn(|place| {
        let value = jets[place].value;
        if free_of_zero(value.interval) {
            return true;
        }
        if value.decoration >= Decoration::Continuous {
            return free_of_zero(mean_value(&boxes[place], &jets[place], at_centers[place]));
        }
        let mut pieces = program.pieces(boxes[place]);
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
