//! How parts are cut: along t or the beam, and what is left of them by what is known of F there.

use super::beam::Beam;
use super::subdivision::{Part, SMALLEST, Subdivision};
use crate::certified::kernels::BATCH;
use crate::{Kernel, Span};

/// Into how many stretches a beam is cut at most.
const SLICES: usize = BATCH;

/// A stretch is cut, and not the beam, when it is longer than this many times the beam's width; and then into stretches
/// about so long. The second number is that of formulas of more than [`MANY`] operations, which are shorter in smaller places.
const LONG: [f64; 2] = [2.0, 1.5];
const MANY: u64 = 100;

/// A stretch of a beam that is to be looked at in so many slices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The beam's number.
    pub(super) beam: u32,
    pub(super) stretch: Span,
    pub(super) slices: usize,
}

impl Cut {
    /// The slices, equally long and nearest first.
    pub(super) fn slices(self) -> impl DoubleEndedIterator<Item = Span> {
        let Self { stretch: Span { start, end }, slices: count, .. } = self;
        let cut = move |at: usize| {
            let part = at as f64 / count as f64;
            if at == count { end } else { start + part * (end - start) }
        };
        (0..count).map(move |slice| Span { start: cut(slice), end: cut(slice + 1) })
    }
}

impl Part {
    /// What is left of a part where roots may lie.
    pub(super) fn narrowed(&self) -> Option<Self> {
        self.form.narrow(self.stretch).map(|stretch| Self { stretch, ..*self })
    }
}

impl Subdivision<'_> {
    /// How long a stretch may be.
    fn long(&self) -> f64 {
        let [few, many] = LONG;
        if self.kernels(0).operations(Kernel::Values) > MANY { many } else { few }
    }

    /// Cuts a stretch when it is longer than the beam is wide, or else the beam.
    pub(super) fn divide(&mut self, part: &Part) {
        let beam = self.beam(part.beam);
        let elongation = beam.elongation(part.stretch);
        let (is_smallest, long) = (beam.area.side() <= SMALLEST, self.long());
        if elongation > long && elongation.is_finite() {
            let slices = (elongation / long).ceil().min(SLICES as f64) as usize;
            self.examine(&[Cut { beam: part.beam, stretch: part.stretch, slices }], part.kernels);
        } else if !is_smallest {
            self.divide_beam(part);
        } else {
            self.search_each(part);
        }
    }

    /// Cuts a beam. Of each quarter only the stretch is kept where roots may lie, in halves at once where it is long and slopes will not be even otherwise.
    pub(super) fn divide_beam(&mut self, Part { beam: number, stretch, kernels, form, .. }: &Part) {
        let (mut cuts, mut count) = ([Cut { beam: *number, stretch: *stretch, slices: 1 }; 4], 0);
        let (beam, long) = (*self.beam(*number), self.long());
        for area in beam.area.quarters() {
            let form = form.on(&beam, area);
            let Some(stretch) = form.narrow(*stretch) else { continue };
            let quarter = Beam::new(&self.tile, area);
            let is_cut =
                quarter.elongation(stretch) > long && form.is_known() && !form.is_even_within(stretch);
            cuts[count] =
                Cut { beam: self.memory.beams.len() as u32, stretch, slices: 1 + usize::from(is_cut) };
            count += 1;
            self.memory.beams.push(quarter);
        }
        self.examine(&cuts[..count], *kernels);
    }
}
