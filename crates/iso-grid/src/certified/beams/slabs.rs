//! Slabs: stretches of beams in boxes, and which of them may hold roots.

use glam::DVec3;
use iso_expr::{Composition, Decorated, Decoration, Interval};

use super::beam::Beam;
use super::cuts::Cut;
use super::form::{Form, Gradient, along};
use super::grazing::{LARGE, SIZES};
use super::subdivision::{Part, Subdivision};
use crate::batch::Affine;
use crate::certified::classify::free_of_zero;
use crate::certified::kernels::{BATCH, bounds_between};
use crate::{Kernel, Region, Span, Workspace};

/// By how much of their length stretches overlap, so that a root near an end lies well inside one of them.
const OVERLAP: f64 = 1.0 / 16.0;
/// The least overlap, as part of the tile's farthest distance.
pub(super) const LEAST_OVERLAP: f64 = 1.0 / (1u64 << 30) as f64;

/// Over beams of more columns and rows F is enclosed before forms are asked for, and gradients are not where those say nothing.
const VAGUE: usize = 8;

/// Of functions of more operations no forms are asked for over beams of more than [`LARGE`] columns and rows, where they hardly ever say anything.
const LONG: u64 = 100;

/// Faces of no more operations each, on average, are asked for instead of forms of F.
const SHORT: u64 = 8;

/// A stretch of a beam, and a box around its part in the region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slab {
    /// The beam's number.
    pub(super) beam: u32,
    /// The number of kernels that hold on the box.
    pub(super) kernels: u32,
    pub(super) stretch: Span,
    /// The stretch and a little more at both ends.
    pub(super) reach: Span,
    pub(super) lo: DVec3,
    pub(super) hi: DVec3,
    /// The middle of `reach`, and a point of the box that is in the middle of the beam there where that is in the region.
    pub(super) middle: (f64, DVec3),
    pub(super) is_inside: bool,
    /// Whether F was enclosed over the box and may be undefined there or jump.
    pub(super) may_break: bool,
}

impl Slab {
    /// `None` when it lies outside the region.
    #[inline]
    fn new((number, beam): (u32, &Beam), stretch: Span, least_overlap: f64, region: &Region) -> Option<Self> {
        let overlap = (OVERLAP * (stretch.end - stretch.start)).max(least_overlap);
        let reach = Span { start: (stretch.start - overlap).max(0.0), end: stretch.end + overlap };
        let (lo_in_space, hi_in_space) = beam.bounds_in_space(reach);
        let (lo, hi) = (lo_in_space.max(region.min()), hi_in_space.min(region.max()));
        let t = 0.5 * (reach.start + reach.end);
        let middle = beam.origins.middle + t * beam.directions.middle;
        lo.cmple(hi).all().then(|| Self {
            beam: number,
            kernels: 0,
            stretch,
            reach,
            lo,
            hi,
            middle: (t, middle.clamp(lo, hi)),
            is_inside: lo == lo_in_space && hi == hi_in_space,
            may_break: false,
        })
    }
}

/// Gradients all over the part that is nearest on top, on which F is monotone along every ray and all of which lies in the
/// region, so that the middle of its box is that of the beam.
struct Behind {
    gradient: Gradient,
    reach: Span,
}

impl Subdivision<'_> {
    /// Looks at slices of beams and keeps those that may hold roots. Kernels of the number `kernels` may hold there.
    pub(super) fn examine(&mut self, cuts: &[Cut], kernels: u32) {
        let mut slabs = std::mem::take(&mut self.memory.slabs);
        slabs.clear();
        for cut in cuts {
            let beam = self.beam(cut.beam);
            for stretch in cut.slices().rev() {
                slabs.extend(Slab::new(
                    (cut.beam, beam),
                    stretch,
                    self.least_overlap,
                    &self.certified.region,
                ));
            }
        }
        let are_several = self.certified.places.are_asked() || self.certified.kernels.are_cut();
        if are_several {
            for slab in &mut slabs {
                slab.kernels = self.kernels_on(slab.lo, slab.hi, kernels);
            }
        }
        // Those that stick out of the region are told otherwise.
        let are_alike =
            |a: &Slab, b: &Slab| a.kernels == b.kernels && (!are_several || a.is_inside == b.is_inside);
        for slabs in slabs.chunk_by_mut(are_alike) {
            self.keep_open(slabs);
        }
        self.memory.slabs = slabs;
    }

    /// The number of kernels that hold on a box: those `around` it, if it decides nothing more there.
    fn kernels_on(&mut self, lo: DVec3, hi: DVec3, around: u32) -> u32 {
        let kernels = self.kernels(around);
        let is_covered = kernels.cover(&bounds_between(lo, hi));
        if is_covered && (!kernels.may_be_shortened() || self.is_narrowed(around)) {
            return around;
        }
        let found = self.certified.places.kernels(lo, hi);
        if is_covered && kernels.operations(Kernel::Values) <= found.operations(Kernel::Values) {
            return around;
        }
        self.known_number_of(found, around)
    }

    /// Keeps those slabs that may hold roots. All lie where the same kernels hold.
    pub(super) fn keep_open(&mut self, mut slabs: &mut [Slab]) {
        let Some(&Slab { beam, kernels, .. }) = slabs.first() else { return };
        if self.kernels(kernels).are_cut() && self.faces_of(kernels).is_some() {
            return self.keep_within(slabs);
        }
        if self.are_left_to_faces(slabs) {
            return self.keep_by_faces(slabs);
        }
        let has_forms = self.kernels(kernels).have_forms();
        let side = self.beam(beam).area.side();
        if self.kernels(kernels).may_be_shortened() || has_forms && side > VAGUE {
            // The gradient of a formula with branches takes much longer than its values, which often say enough. Of large sets
            // forms say less than enclosures.
            let count = self.drop_free(slabs);
            slabs = &mut slabs[..count];
        }
        let are_vain = has_forms && side > LARGE && self.kernels(kernels).operations(Kernel::Values) > LONG;
        for slabs in slabs.chunk_by_mut(|a, b| a.may_break == b.may_break) {
            if slabs[0].may_break || are_vain {
                // Neither forms nor gradients would say anything, as beside a pole.
                slabs.iter().for_each(|slab| self.keep_unknown(slab));
            } else if has_forms {
                self.keep_by_forms(slabs);
            } else {
                self.keep_by_gradients(slabs);
            }
        }
    }

    /// Whether nothing is asked of F itself on slabs where it is made of faces, as those say more. Forms are asked for where faces are
    /// long.
    fn are_left_to_faces(&mut self, slabs: &[Slab]) -> bool {
        let Some(&Slab { beam, kernels, .. }) = slabs.first() else { return false };
        let are_fit =
            self.beam(beam).area.side() >= *SIZES.start() && slabs.iter().all(|slab| slab.is_inside);
        if !are_fit {
            return false;
        }
        let has_forms = self.kernels(kernels).have_forms();
        let operations = self.kernels(kernels).operations(Kernel::Values);
        // What was narrowed before has fewer operations than these.
        let is_narrowed = self.is_narrowed(kernels);
        let are_short = |faces: &[u32]| is_narrowed || operations <= SHORT * faces.len() as u64;
        self.faces_of(kernels).is_some_and(|faces| match &*faces {
            Composition::Extreme(_, faces) => !has_forms || are_short(faces),
            Composition::Choice { .. } | Composition::Within { .. } => !has_forms,
        })
    }

    /// Keeps slabs that may hold roots, as far as affine forms tell, which know how F depends on column, row and t.
    fn keep_by_forms(&mut self, slabs: &mut [Slab]) {
        let Some(&Slab { kernels, .. }) = slabs.first() else { return };
        let kind = self.forms();
        let Workspace { forms, scratch, counters, .. } = &mut *self.workspace;
        let mut units = [(0.0, 0.0); BATCH];
        forms.clear();
        for (slab, unit) in slabs.iter().zip(&mut units) {
            let (arguments, of_t) = self.memory.beams[slab.beam as usize].forms(slab.reach);
            forms.push(&arguments);
            *unit = of_t;
        }
        let kernels = &self.kernels[kernels as usize];
        forms.evaluate(kernels.over_points(kind), self.tile.direction(), scratch);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += kernels.charge(kind, slabs.len());
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        let mut found = [None; BATCH];
        for (number, (slab, found)) in slabs.iter().zip(&mut found).enumerate() {
            *found = self.affine_form(slab, number, units[number]);
        }
        let mut number = 0;
        while let Some(&Slab { beam, kernels, stretch, is_inside, .. }) = slabs.get(number) {
            let vague = found[number..slabs.len()].iter().take_while(|found| found.is_none()).count();
            // Where F is nearly constant, enclosures of its derivatives and its middle take fewer roundings.
            self.keep_by_gradients(&slabs[number..number + vague]);
            number += vague.max(1);
            if let Some(form) = found[number - 1]
                && !form.excludes_zero()
            {
                self.memory.ahead.push(Part { beam, kernels, stretch, form, is_inside });
            }
        }
    }

    /// F on a slab, the one of this number among those whose forms were found last; `None` where gradients may say more: where forms say less than
    /// roundings, and over small beams where they say nothing.
    fn affine_form(&self, slab: &Slab, number: usize, unit: (f64, f64)) -> Option<Form> {
        let rays = self.beam(slab.beam);
        let forms = self.forms_found(rays, number);
        let form = forms.map(|[value, slope]| Form::affine(rays, slab.reach, unit, &value, &slope));
        match form.filter(Form::is_known) {
            Some(form) => (!form.is_vague()).then_some(form),
            None => (rays.area.side() > VAGUE).then(|| Form::unknown(slab.reach)),
        }
    }

    /// The affine forms of F and its slope along the rays of a beam, those of this number among what was found last.
    fn forms_found(&self, rays: &Beam, number: usize) -> Option<[Affine; 2]> {
        let forms = &self.workspace.forms;
        if self.forms() == Kernel::ParallelForms {
            return forms.found(number);
        }
        let [value, gradient @ ..]: [Affine; 4] = forms.found(number)?;
        Some([value, along(&rays.directions, &gradient)])
    }

    /// Keeps slabs that may hold roots, as far as enclosures of F and its gradient tell.
    fn keep_by_gradients(&mut self, slabs: &[Slab]) {
        let first = match slabs {
            [] => return,
            [slab] => return self.keep_by_gradient(slab),
            [first, ..] => first,
        };
        self.enclose(first.kernels, slabs.iter().map(|slab| (slab.lo, slab.hi)));
        let (mut open, mut count) = ([0; BATCH], 0);
        for number in 0..slabs.len() {
            if !free_of_zero(self.workspace.boxes.interval(0, number)) {
                open[count] = number;
                count += 1;
            }
        }
        let open = &open[..count];
        self.enclose_middles(slabs, open);
        let mut behind = None;
        for (place, number) in open.iter().enumerate() {
            let value = self.workspace.middles.interval(0, place);
            behind = self.keep(&slabs[*number], *number, value, behind);
        }
    }

    /// Keeps a slab likewise. Its middle is enclosed with it, for two boxes take no longer than one.
    fn keep_by_gradient(&mut self, slab: &Slab) {
        let (_, middle) = slab.middle;
        self.enclose(slab.kernels, [(slab.lo, slab.hi), (middle, middle)].into_iter());
        let [all, middle] = [0, 1].map(|number| self.workspace.boxes.interval(0, number));
        if !free_of_zero(all) {
            self.keep(slab, 0, middle, None);
        }
    }

    /// Keeps a slab, the one of this number among those enclosed last, in whose middle F is in `value`, if it may hold roots, and
    /// joins it with the part behind it if roots may lie on both sides of their border and their rays can be followed together.
    ///
    /// The sums of vectors as near to the middle ones as the beam's origins are and of products of t with such directions form a
    /// convex set for any stretch of t; those of this stretch are in one box, those of the other in the other. So the mean value
    /// theorem holds with the gradients of both.
    fn keep(
        &mut self,
        slab: &Slab,
        number: usize,
        value: Interval,
        behind: Option<Behind>,
    ) -> Option<Behind> {
        let boxes = &self.workspace.boxes;
        let Slab { beam, kernels, stretch, reach, is_inside, .. } = *slab;
        let Some(gradient) = Gradient::new([0, 1, 2, 3].map(|output| boxes.decorated(output, number))) else {
            self.keep_unknown(slab);
            return None;
        };
        let rays = &self.memory.beams[beam as usize];
        let form = Form::new(rays, reach, slab.middle, value, &gradient);
        if form.excludes_zero() {
            return None;
        }
        let is_monotone = is_inside && form.is_monotone();
        if let (true, Some(behind)) = (is_monotone, behind)
            && let Some(far) = self.memory.ahead.last_mut()
            && far.beam == beam
            && far.stretch.start == stretch.end
            && form.roots().hi >= stretch.end
            && far.form.roots().lo <= stretch.end
        {
            let gradient = gradient.hull(&behind.gradient);
            let reach = Span { start: reach.start, end: behind.reach.end };
            let joined = Form::new(rays, reach, slab.middle, value, &gradient);
            if joined.is_even() {
                far.stretch.start = stretch.start;
                far.form = joined;
                return Some(Behind { gradient, reach });
            }
        }
        self.memory.ahead.push(Part { beam, kernels, stretch, form, is_inside });
        is_monotone.then_some(Behind { gradient, reach })
    }

    /// Moves the slabs over which the enclosure of F does not exclude zero to the front, notes of each whether F may break there, and counts them.
    pub(super) fn drop_free(&mut self, slabs: &mut [Slab]) -> usize {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        let kernels = &self.kernels[slabs[0].kernels as usize];
        boxes.replace(slabs.iter().map(|slab| (slab.lo, slab.hi)));
        boxes.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += kernels.charge(Kernel::ValueEnclosures, slabs.len());
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        let mut kept = 0;
        for number in 0..slabs.len() {
            let Decorated { interval, decoration } = boxes.decorated(0, number);
            if !free_of_zero(interval) {
                slabs[kept] = Slab { may_break: decoration < Decoration::Continuous, ..slabs[number] };
                kept += 1;
            }
        }
        kept
    }

    /// Encloses F and its derivatives over the boxes with these corners by kernels of this number.
    fn enclose(&mut self, kernels: u32, corners: impl Iterator<Item = (DVec3, DVec3)>) {
        let kernels = &self.kernels[kernels as usize];
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        boxes.replace(corners);
        boxes.evaluate(kernels.gradients(), scratch, 4);
        counters.box_evaluations += boxes.len() as u64;
        counters.operations += kernels.charge(Kernel::GradientEnclosures, boxes.len());
        self.work_left = self.work_left.saturating_sub(boxes.len() as u64);
    }

    /// Encloses F in the middle of each of the slabs that are open.
    fn enclose_middles(&mut self, slabs: &[Slab], open: &[usize]) {
        let Some(&first) = open.first() else { return };
        let kernels = &self.kernels[slabs[first].kernels as usize];
        let Workspace { middles, scratch, counters, .. } = &mut *self.workspace;
        middles.replace(open.iter().map(|number| (slabs[*number].middle.1, slabs[*number].middle.1)));
        middles.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += open.len() as u64;
        counters.operations += kernels.charge(Kernel::ValueEnclosures, open.len());
        self.work_left = self.work_left.saturating_sub(open.len() as u64);
    }
}
