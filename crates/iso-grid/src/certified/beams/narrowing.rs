//! What is left on slabs of a function that is made of others. No more is asked for on their parts.

use std::rc::Rc;
use std::sync::Arc;

use iso_expr::{Composition, Decoration, Extreme};

use super::form::Form;
use super::made::deciding;
use super::slabs::Slab;
use super::subdivision::{Known, Part, Subdivision};
use crate::certified::kernels::{BATCH, bounds_between};
use crate::certified::side::side;
use crate::{Kernel, Workspace};

/// Of functions of more operations it takes less time to enclose them as a whole, until places leave less of them.
const LONG: u64 = 1024;

/// Over beams of so many columns and rows hardly more is left out than over those that they are parts of.
const SMALL: usize = 4;

/// What is left of a function on a slab.
#[derive(Clone, Copy, Debug)]
enum Left {
    /// It is of this sign wherever it is a number, and whether it is one everywhere.
    Sign { sign: f64, is_defined: bool },
    /// It is that of this number.
    Function(u32),
}

impl Subdivision<'_> {
    /// Keeps slabs that may hold roots, where F is made of functions that say more than F. All lie in the region, where the same kernels hold.
    pub(super) fn keep_by_faces(&mut self, slabs: &mut [Slab]) {
        let Some(&Slab { beam, kernels, reach, .. }) = slabs.first() else { return };
        if self.kernels(kernels).operations(Kernel::Values) > LONG {
            let count = self.drop_free(slabs);
            return slabs[..count].iter().for_each(|slab| self.keep_unknown(slab));
        }
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        let is_small = self.beam(beam).area.side() <= SMALL && self.is_short(beam, reach);
        if is_small && self.is_narrowed(kernels) {
            return slabs.iter().for_each(|slab| self.keep_unknown(slab));
        }
        self.workspace.boxes.replace(slabs.iter().map(|slab| (slab.lo, slab.hi)));
        for (slab, left) in slabs.iter().zip(self.left_of(kernels, slabs)) {
            if let Left::Function(left) = left {
                let kernels = self.number_within(left, slab);
                self.keep_unknown(&Slab { kernels, ..*slab });
            }
        }
    }

    /// Keeps slabs that may hold roots, where F is a function wherever a margin is not negative. Where that is so all over a slab, the function
    /// alone is asked for from there on.
    pub(super) fn keep_within(&mut self, slabs: &mut [Slab]) {
        let faces = self.faces_of(slabs[0].kernels);
        let Some(&Composition::Within { function, margin }) = faces.as_deref() else {
            return slabs.iter().for_each(|slab| self.keep_unknown(slab));
        };
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        self.workspace.boxes.replace(slabs.iter().map(|slab| (slab.lo, slab.hi)));
        let found = self.left_of_smooth(margin, slabs.len());
        let (cut, mut kept) = (slabs[0].kernels, 0);
        for (number, margin) in found.into_iter().enumerate().take(slabs.len()) {
            let slab = slabs[number];
            let kernels = match margin {
                Left::Sign { sign, .. } if sign < 0.0 => continue,
                Left::Sign { is_defined: true, .. } => {
                    let kernels = self.kernels(function).within(bounds_between(slab.lo, slab.hi));
                    self.number_of(Arc::new(kernels))
                }
                _ => function,
            };
            slabs[kept] = Slab { kernels, ..slab };
            kept += 1;
        }
        // Those with an edge are kept one by one: joined, they would be cut again as they were.
        for slabs in slabs[..kept].chunk_by_mut(|a, b| a.kernels == b.kernels && a.kernels != function) {
            let (is_cut, first) = (slabs[0].kernels == function, self.memory.ahead.len());
            self.keep_open(slabs);
            if is_cut {
                // What may be zero may be nothing.
                for part in &mut self.memory.ahead[first..] {
                    *part = Part { kernels: cut, form: Form::unknown(part.form.reach), ..*part };
                }
            }
        }
    }

    /// Keeps a slab, with nothing known of F there.
    pub(super) fn keep_unknown(&mut self, &Slab { beam, kernels, stretch, reach, is_inside, .. }: &Slab) {
        self.memory.ahead.push(Part { beam, kernels, stretch, form: Form::unknown(reach), is_inside });
    }

    /// What is left of the function of a number on each of the slabs, whose boxes are there.
    fn left_of(&mut self, number: u32, slabs: &[Slab]) -> [Left; BATCH] {
        match self.faces_of(number).as_deref() {
            None => self.left_of_smooth(number, slabs.len()),
            Some(Composition::Choice { by, below, above }) => {
                self.left_of_choice(number, (*by, [*below, *above]), slabs.len())
            }
            Some(Composition::Extreme(extreme, faces)) => {
                self.left_of_extreme(number, (*extreme, faces), slabs)
            }
            Some(Composition::Within { .. }) => self.left_of_smooth(number, slabs.len()),
        }
    }

    /// What its enclosures tell of a function.
    fn left_of_smooth(&mut self, number: u32, count: usize) -> [Left; BATCH] {
        let kernels = &self.kernels[number as usize];
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        boxes.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += count as u64;
        counters.operations += kernels.charge(Kernel::ValueEnclosures, count);
        let mut left = [Left::Function(number); BATCH];
        for (slab, left) in left.iter_mut().enumerate().take(count) {
            let found = boxes.decorated(0, slab);
            if let Some(side) = side(found.interval) {
                *left = Left::Sign { sign: side.sign(), is_defined: found.decoration >= Decoration::Defined };
            }
        }
        left
    }

    /// The same of a function with a kink inside, and on which side of that a slab lies, if on one.
    fn left_of_choice(
        &mut self,
        number: u32,
        (by, [below, above]): (u32, [u32; 2]),
        count: usize,
    ) -> [Left; BATCH] {
        let mut left = self.left_of_smooth(number, count);
        if left[..count].iter().any(|left| matches!(left, Left::Function(_))) {
            for (left, by) in left.iter_mut().zip(self.left_of_smooth(by, count)) {
                if let (Left::Function(side), Left::Sign { sign, is_defined: true }) = (left, by) {
                    *side = if sign < 0.0 { below } else { above };
                }
            }
        }
        left
    }

    /// The same of the least or the greatest of some functions. What may be undefined stays.
    fn left_of_extreme(
        &mut self,
        number: u32,
        (extreme, faces): (Extreme, &[u32]),
        slabs: &[Slab],
    ) -> [Left; BATCH] {
        // What may be zero or undefined is put behind what is there for functions around this one.
        let first = self.memory.left.len();
        let mut are_decided = [false; BATCH];
        for face in faces {
            let found = self.left_of(*face, slabs);
            for (slab, (left, is_decided)) in found.into_iter().zip(&mut are_decided).enumerate() {
                match left {
                    Left::Sign { sign, .. } if sign == deciding(extreme) => *is_decided = true,
                    Left::Sign { is_defined: true, .. } => {}
                    Left::Sign { is_defined: false, .. } => self.memory.left.push((slab, *face)),
                    Left::Function(left) => self.memory.left.push((slab, left)),
                }
            }
            if are_decided[..slabs.len()].iter().all(|is_decided| *is_decided) {
                break;
            }
        }
        let mut left = [Left::Sign { sign: -deciding(extreme), is_defined: true }; BATCH];
        for (slab, (left, is_decided)) in left.iter_mut().zip(are_decided).enumerate().take(slabs.len()) {
            let mut open =
                self.memory.left[first..].iter().filter(|(of, _)| *of == slab).map(|(_, face)| *face);
            if is_decided {
                let is_defined = self.kernels(number).are_defined_everywhere();
                *left = Left::Sign { sign: deciding(extreme), is_defined };
            } else if let Some(face) = open.next() {
                let others: Vec<_> = open.collect();
                *left = Left::Function(self.number_of_left(number, (extreme, face, others)));
            }
        }
        self.memory.left.truncate(first);
        left
    }

    /// The number of the least or the greatest of these functions, which the one of a number comes to.
    fn number_of_left(&mut self, number: u32, (extreme, face, others): (Extreme, u32, Vec<u32>)) -> u32 {
        if others.is_empty() {
            return face;
        }
        let open = std::iter::once(face).chain(others).collect();
        let left = self.number_of(Arc::clone(self.kernels(number)));
        self.faces[left as usize] = Known::OnSlab(Some(Rc::new(Composition::Extreme(extreme, open))));
        left
    }

    /// The number of kernels of what F comes to on a slab. They hold there alone, but places are not asked for less, unless there are branches of
    /// other kinds.
    fn number_within(&mut self, left: u32, slab: &Slab) -> u32 {
        let faces = self.faces_of(left);
        let mut is_left_to_places =
            |face: &u32| self.kernels(*face).may_be_shortened() && self.faces_of(*face).is_none();
        let are_left_to_places = match faces.as_deref() {
            Some(Composition::Extreme(_, faces)) => faces.iter().any(is_left_to_places),
            Some(Composition::Choice { .. } | Composition::Within { .. }) => false,
            None => is_left_to_places(&left),
        };
        if are_left_to_places {
            return slab.kernels;
        }
        let kernels = Arc::new(self.kernels(left).within(bounds_between(slab.lo, slab.hi)));
        let number = self.number_of(kernels);
        self.faces[number as usize] = Known::OnSlab(faces);
        number
    }

    /// Whether what the kernels of a number come to on a slab is known, so that places tell no more.
    pub(super) fn is_narrowed(&self, number: u32) -> bool {
        matches!(self.faces[number as usize], Known::OnSlab(_))
    }
}
