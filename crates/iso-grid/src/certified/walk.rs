//! The way of a ray through the cells that may hold roots.

use iso_expr::{Program, Scratch};

use super::cells::{Cell, Cells, DEPTH};
use super::clip::crossing;
use super::kernels::Kernels;
use crate::{Ray, Span};

/// A walk from cell to cell, front to back: cells proven empty are passed over, others entered as far down as they go.
pub(super) struct Walk<'a> {
    pub(super) cells: &'a Cells,
    pub(super) ray: Ray,
    /// What is to be entered, the nearest on top.
    pub(super) pending: &'a mut Vec<Entry>,
    /// How many boxes were enclosed to learn about cells.
    pub(super) evaluations: u64,
    /// How many cells were entered.
    pub(super) steps: u64,
}

/// A cell to be entered, and a stretch that holds all of the ray inside it.
pub(crate) type Entry = (Cell, Span);

impl Walk<'_> {
    /// Puts the walk at the start of `stretch`, to go no further than its end.
    pub(super) fn begin(&mut self, stretch: Span) {
        self.pending.clear();
        self.pending.push((Cell::REGION, stretch));
    }

    /// A stretch that holds the ray's way through the next of the smallest cells that is not empty. All between it and the
    /// one before is free of roots.
    pub(super) fn next(
        &mut self,
        kernels: &Kernels,
        program: &Program,
        scratch: &mut Scratch,
    ) -> Option<Span> {
        while let Some((cell, stretch)) = self.pending.pop() {
            self.steps += 1;
            if cell.depth == DEPTH {
                return Some(stretch);
            }
            let parts = cell.parts();
            let (empty, evaluations) = self.cells.empty_parts(kernels, program, scratch, &parts);
            self.evaluations += evaluations;
            self.enter(cell, stretch, &parts, empty);
        }
        None
    }

    /// Puts those of the parts that are not empty, and through which the ray may pass, on the way.
    fn enter(&mut self, cell: Cell, stretch: Span, parts: &[Cell; 8], empty: [bool; 8]) {
        let halves: [[Span; 2]; 3] = std::array::from_fn(|axis| self.halves(cell, parts, axis, stretch));
        // A ray only ever goes on along each axis, so this order of the parts is one from front to back.
        let nearest =
            (0..3).filter(|axis| self.ray.direction[*axis] < 0.0).map(|axis| 1 << axis).sum::<usize>();
        for number in (0..8).rev().map(|order| order ^ nearest) {
            if empty[number] {
                continue;
            }
            let [x, y, z] = [0, 1, 2].map(|axis| halves[axis][number >> axis & 1]);
            let start = x.start.max(y.start).max(z.start);
            let end = x.end.min(y.end).min(z.end);
            if start <= end {
                self.pending.push((parts[number], Span { start, end }));
            }
        }
    }

    /// What of `stretch` may lie in the lower half of the cell along `axis`, and what in the upper half.
    fn halves(&self, cell: Cell, parts: &[Cell; 8], axis: usize, stretch: Span) -> [Span; 2] {
        let (origin, direction) = (self.ray.origin[axis], self.ray.direction[axis]);
        let middle = self.cells.side(parts[0], axis).hi;
        debug_assert!(middle < self.cells.side(cell, axis).hi);
        let none = Span { start: f64::INFINITY, end: f64::NEG_INFINITY };
        if direction == 0.0 {
            return [
                if origin <= middle { stretch } else { none },
                if origin >= middle { stretch } else { none },
            ];
        }
        let passage = crossing(middle, origin, direction);
        let before = Span { start: stretch.start, end: stretch.end.min(passage.end) };
        let after = Span { start: stretch.start.max(passage.start), end: stretch.end };
        if direction > 0.0 { [before, after] } else { [after, before] }
    }
}
