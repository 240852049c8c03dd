//! The way of a ray through the cells that may hold roots.

use glam::DVec3;
use iso_expr::Scratch;
use iso_expr::interval::{round_down, round_up};

use super::cells::{Cell, Cells, DEPTH, PARTS};
use super::kernels::Kernels;
use crate::{Ray, Span};

/// A walk from cell to cell, front to back: cells proven empty are passed over, others entered as far down as they go.
///
/// Which cells a ray passes is decided by where it crosses the planes between them, as in the parametric traversal of an
/// octree (Revelles, Ureña and Lastra 2000), but with each crossing enclosed.
pub(super) struct Walk<'a> {
    cells: &'a Cells,
    ray: Ray,
    /// 1/d along each axis.
    inverse: DVec3,
    /// The number of the part of a cell that the ray meets first.
    nearest: usize,
    /// What is to be entered, the nearest on top.
    pending: &'a mut Vec<Entry>,
    /// How many boxes were enclosed to learn about cells.
    pub(super) evaluations: u64,
    /// How many cells were entered.
    pub(super) steps: u64,
}

/// A cell to be entered, and a stretch that holds all of the ray inside it.
pub(crate) type Entry = (Cell, Span);

impl<'a> Walk<'a> {
    /// The walk of `ray` that begins with `entry` and goes no further.
    pub(super) fn new(cells: &'a Cells, ray: Ray, entry: Entry, pending: &'a mut Vec<Entry>) -> Self {
        pending.clear();
        pending.push(entry);
        let nearest = (0..3).filter(|axis| ray.direction[*axis] < 0.0).map(|axis| 1 << axis).sum();
        Self { cells, ray, inverse: ray.direction.recip(), nearest, pending, evaluations: 0, steps: 0 }
    }

    /// A stretch that holds the ray's way through the next of the smallest cells that is not empty. All between it and the
    /// one before is free of roots.
    pub(super) fn next(&mut self, kernels: &Kernels, scratch: &mut Scratch) -> Option<Span> {
        while let Some((cell, stretch)) = self.pending.pop() {
            self.steps += 1;
            if cell.depth == DEPTH {
                return Some(stretch);
            }
            let empty = self.cells.empty_parts(kernels, scratch, &mut self.evaluations, cell);
            self.enter(cell, stretch, empty);
        }
        None
    }

    /// Puts those of the parts that are not empty, and through which the ray may pass, on the way.
    fn enter(&mut self, cell: Cell, stretch: Span, empty: u16) {
        let halves: [[Span; 2]; 3] = std::array::from_fn(|axis| self.halves(cell, axis, stretch));
        // A ray only ever goes on along each axis, so this order of the parts is one from front to back.
        for number in (0..PARTS).rev().map(|order| order ^ self.nearest) {
            if empty >> number & 1 != 0 {
                continue;
            }
            let [x, y, z] = [0, 1, 2].map(|axis| halves[axis][number >> axis & 1]);
            let start = x.start.max(y.start).max(z.start);
            let end = x.end.min(y.end).min(z.end);
            if start <= end {
                self.pending.push((cell.part(number), Span { start, end }));
            }
        }
    }

    /// What of `stretch` may lie in the lower half of the cell along `axis`, and what in the upper half.
    fn halves(&self, cell: Cell, axis: usize, stretch: Span) -> [Span; 2] {
        let (origin, direction) = (self.ray.origin[axis], self.ray.direction[axis]);
        let middle = self.cells.middle(cell, axis);
        if direction == 0.0 {
            let none = Span { start: f64::INFINITY, end: f64::NEG_INFINITY };
            return [
                if origin <= middle { stretch } else { none },
                if origin >= middle { stretch } else { none },
            ];
        }
        let passage = passage(middle - origin, self.inverse[axis]);
        let before = Span { start: stretch.start, end: stretch.end.min(passage.end) };
        let after = Span { start: stretch.start.max(passage.start), end: stretch.end };
        if direction > 0.0 { [before, after] } else { [after, before] }
    }
}

/// Encloses the real quotient of which `distance` and `inverse` are the rounded numerator and reciprocal: three roundings,
/// each by no more than half of ε.
fn passage(distance: f64, inverse: f64) -> Span {
    let t = distance * inverse;
    let slack = 2.0 * f64::EPSILON * t.abs();
    if slack.is_finite() && inverse.is_normal() {
        Span { start: round_down(t - slack), end: round_up(t + slack) }
    } else {
        Span { start: f64::NEG_INFINITY, end: f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_passage_holds_the_quotient() {
        // 1/3 lies between the doubles that its rounded value neighbours.
        let third = passage(1.0, 3.0_f64.recip());
        assert!(third.start < 1.0 / 3.0 && 1.0 / 3.0 < third.end && third.end - third.start < 1e-15);
        let nowhere = passage(1.0, f64::MIN_POSITIVE.powi(2).recip());
        assert_eq!((nowhere.start, nowhere.end), (f64::NEG_INFINITY, f64::INFINITY));
    }
}
