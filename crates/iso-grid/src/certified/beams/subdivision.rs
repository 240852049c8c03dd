//! The subdivision of a tile into beams and of beams into stretches.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Decorated, Extreme, Interval};
use rustc_hash::FxHashMap;

use super::beam::{Beam, count_in};
use super::bundle::Bundle;
use super::form::{Form, Gradient};
use super::grazing::Attempts;
use super::pixels::{Ended, Pixel};
use super::rounding::Rounding;
use super::seams::Approach;
use crate::area::Area;
use crate::certified::Certified;
use crate::certified::cells::Cell;
use crate::certified::classify::free_of_zero;
use crate::certified::clip::Clip;
use crate::certified::kernels::{BATCH, Kernels, bounds_between};
use crate::raster::Rays;
use crate::{Kernel, Outcome, Region, Span, Tile, Workspace};

/// Into how many stretches a beam is cut at most.
const SLICES: usize = BATCH;

/// A stretch is cut, and not the beam, when it is longer than this many times the beam's width; and then into stretches
/// about so long.
const LONG: f64 = 2.0;

/// Beams of so many columns and rows are not cut further, and left to their rays where F is not monotone.
const SMALLEST: usize = 2;

/// By how much of their length stretches overlap, so that a root near an end lies well inside one of them.
const OVERLAP: f64 = 1.0 / 16.0;
/// The least overlap, as part of the tile's farthest distance.
const LEAST_OVERLAP: f64 = 1.0 / (1u64 << 30) as f64;

/// Over beams of more columns and rows F is enclosed before forms are asked for.
const VAGUE: usize = 8;

/// How many boxes may be enclosed for each ray of a tile before the rest is left to single rays.
const WORK_LIMIT: u64 = 64;

/// A stretch of a beam that may hold roots.
#[derive(Debug)]
pub(super) struct Part {
    /// The beam's number.
    pub(super) beam: u32,
    /// The number of kernels that hold on it.
    pub(super) kernels: u32,
    pub(super) stretch: Span,
    pub(super) form: Form,
    /// Whether all of it lies in the region, and a little more at both ends too.
    pub(super) is_inside: bool,
}

/// A stretch of a beam, and a box around its part in the region.
#[derive(Clone, Copy, Debug)]
struct Slab {
    /// The beam's number.
    beam: u32,
    /// The number of kernels that hold on the box.
    kernels: u32,
    stretch: Span,
    /// The stretch and a little more at both ends.
    reach: Span,
    lo: DVec3,
    hi: DVec3,
    /// The middle of `reach`, and a point of the box that is in the middle of the beam there where that is in the region.
    middle: (f64, DVec3),
    is_inside: bool,
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
        })
    }
}

/// Gradients all over the part that is nearest on top, on which F is monotone along every ray and all of which lies in the
/// region, so that the middle of its box is that of the beam.
struct Behind {
    gradient: Gradient,
    reach: Span,
}

/// `count` parts of `span`, equally long.
fn slices(span: Span, count: usize) -> impl DoubleEndedIterator<Item = Span> {
    let cut = move |at: usize| {
        let part = at as f64 / count as f64;
        if at == count { span.end } else { span.start + part * (span.end - span.start) }
    };
    (0..count).map(move |slice| Span { start: cut(slice), end: cut(slice + 1) })
}

/// Working memory for the subdivision of a tile.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// Whether each ray's first root is still looked for.
    pub(super) open: Vec<bool>,
    /// What lies ahead. For each ray its stretches are in order, the nearest on top; everything before them is free of
    /// roots, and so is all between.
    ahead: Vec<Part>,
    /// The beams that the tile was cut into so far.
    pub(super) beams: Vec<Beam>,
    slabs: Vec<Slab>,
    pub(super) attempts: Attempts,
    pub(super) bundles: Vec<Bundle>,
    pub(super) bowed: Vec<Pixel>,
    pub(super) approaches: Vec<Approach>,
    /// How rays ended that were pursued.
    pub(super) ended: Vec<Ended>,
    /// What was found out last of rounding.
    pub(super) rounding: Option<Rounding>,
}

/// The subdivision of a tile.
pub(in crate::certified) struct Subdivision<'a> {
    pub(super) certified: &'a Certified,
    pub(super) workspace: &'a mut Workspace,
    pub(super) tile: Tile<'a>,
    pub(super) outcomes: &'a mut [Outcome],
    pub(super) memory: Memory,
    /// Kernels by number. The first hold everywhere.
    pub(super) kernels: Vec<Arc<Kernels>>,
    /// The kernels of which each of some kernels is the least or the greatest, by number; `None` where it is neither.
    pub(super) faces: FxHashMap<u32, Option<(Extreme, Vec<u32>)>>,
    /// How many more boxes may be enclosed.
    work_left: u64,
    least_overlap: f64,
}

impl<'a> Subdivision<'a> {
    /// `None` when there are no rays, or they are not finite or out of all proportion.
    pub(in crate::certified) fn new(
        certified: &'a Certified,
        workspace: &'a mut Workspace,
        tile: Tile<'a>,
        outcomes: &'a mut [Outcome],
    ) -> Option<Self> {
        let is_finite = match tile.rays {
            Rays::Raster { .. } => true,
            Rays::Listed(rays) => rays.iter().all(|ray| ray.origin.is_finite() && ray.direction.is_finite()),
        };
        if tile.is_empty() || !is_finite {
            return None;
        }
        let area = Area { column: 0, row: 0, width: tile.width(), height: tile.height() };
        let beam = Beam::new(&tile, area);
        if !beam.is_proportionate() {
            return None;
        }
        workspace.counters.rays += tile.len() as u64;
        workspace.counters.rays_in_region += count_in(&certified.region, &tile, area);
        outcomes.fill(Outcome::Miss);
        let mut memory = std::mem::take(&mut workspace.tile);
        memory.ahead.clear();
        memory.beams.clear();
        memory.beams.push(beam);
        memory.rounding = None;
        memory.attempts = Attempts::default();
        memory.open.clear();
        memory.open.resize(tile.len(), true);
        let kernels = vec![Arc::clone(&certified.kernels)];
        let work_left = WORK_LIMIT * tile.len() as u64;
        Some(Self {
            certified,
            workspace,
            tile,
            outcomes,
            memory,
            kernels,
            faces: FxHashMap::default(),
            work_left,
            least_overlap: 0.0,
        })
    }

    /// Says of every ray how its search ends.
    pub(in crate::certified) fn run(mut self) {
        if let Some(stretch) = self.passage() {
            self.least_overlap = LEAST_OVERLAP * stretch.end;
            let form = Form::unknown(stretch);
            self.memory.ahead.push(Part { beam: 0, kernels: 0, stretch, form, is_inside: false });
        }
        while let Some(part) = self.memory.ahead.pop() {
            if self.certified.stop.is_requested() {
                break;
            }
            if !self.is_open(self.beam(part.beam).area) {
                continue;
            }
            if self.work_left == 0 {
                self.search_each(&part);
            } else if part.form.is_monotone() {
                self.follow(&part);
            } else if !self.follow_edge(&part) && !self.follow_bent(&part) {
                self.divide(&part);
            }
        }
        self.workspace.tile = self.memory;
    }

    /// A stretch that holds all of the tile's rays inside the region; `None` when they miss it.
    fn passage(&self) -> Option<Span> {
        let region = &self.certified.region;
        if let Some(passage) = self.memory.beams[0].passage(region) {
            return (passage.start <= passage.end).then_some(passage);
        }
        let spans = self.tile.rays().filter_map(|ray| Clip::new(region, &ray)).map(|clip| clip.outer);
        spans.reduce(|a, b| Span { start: a.start.min(b.start), end: a.end.max(b.end) })
    }

    /// The beam of a number.
    pub(super) fn beam(&self, number: u32) -> &Beam {
        &self.memory.beams[number as usize]
    }

    /// The kernels of a number.
    pub(super) fn kernels(&self, number: u32) -> &Arc<Kernels> {
        &self.kernels[number as usize]
    }

    /// The column and the row of a ray of the tile.
    pub(super) fn position(&self, place: usize) -> (usize, usize) {
        (place % self.tile.width(), place / self.tile.width())
    }

    /// Encloses the `N` outputs of one of the kernels of a number over the box with these corners; `None` where that does not pay.
    pub(super) fn enclose_one<const N: usize>(
        &mut self,
        number: u32,
        kernel: Kernel,
        bounds: (DVec3, DVec3),
    ) -> Option<[Decorated; N]> {
        self.enclose_all(number, kernel, [bounds]).map(|[found]| found)
    }

    /// The same over several boxes at once.
    pub(super) fn enclose_all<const N: usize, const COUNT: usize>(
        &mut self,
        number: u32,
        kernel: Kernel,
        bounds: [(DVec3, DVec3); COUNT],
    ) -> Option<[[Decorated; N]; COUNT]> {
        let kernels = &self.kernels[number as usize];
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        boxes.replace(bounds.iter().map(|(lo, hi)| (lo, hi)));
        boxes.evaluate(kernels.over_boxes(kernel)?, scratch, N);
        counters.box_evaluations += COUNT as u64;
        counters.operations += kernels.charge(kernel, COUNT);
        self.work_left = self.work_left.saturating_sub(COUNT as u64);
        Some(std::array::from_fn(|place| std::array::from_fn(|output| boxes.decorated(output, place))))
    }

    /// Whether some ray of `area` is still followed.
    pub(super) fn is_open(&self, area: Area) -> bool {
        area.rows().any(|row| self.memory.open[row * self.tile.width()..][area.columns()].contains(&true))
    }

    /// Cuts a stretch when it is longer than the beam is wide, or else the beam.
    pub(super) fn divide(&mut self, part: &Part) {
        let beam = self.beam(part.beam);
        let elongation = beam.elongation(part.stretch);
        let is_smallest = beam.area.width.max(beam.area.height) <= SMALLEST;
        if elongation > LONG && elongation.is_finite() {
            let count = (elongation / LONG).ceil().min(SLICES as f64) as usize;
            self.examine(part.beam..part.beam + 1, (part.stretch, count), part.kernels);
        } else if !is_smallest {
            self.divide_beam(part);
        } else {
            self.search_each(part);
        }
    }

    /// Cuts a beam.
    pub(super) fn divide_beam(&mut self, Part { beam, stretch, kernels, .. }: &Part) {
        let first = self.memory.beams.len() as u32;
        let area = self.beam(*beam).area;
        self.memory.beams.extend(area.quarters().map(|quarter| Beam::new(&self.tile, quarter)));
        self.examine(first..self.memory.beams.len() as u32, (*stretch, 1), *kernels);
    }

    /// Looks at a stretch of all beams, cut into `count`, and keeps the stretches that may hold roots. Kernels of the number
    /// `kernels` may hold there.
    pub(super) fn examine(&mut self, beams: Range<u32>, (stretch, count): (Span, usize), kernels: u32) {
        let mut slabs = std::mem::take(&mut self.memory.slabs);
        slabs.clear();
        for number in beams {
            let beam = self.beam(number);
            for stretch in slices(stretch, count).rev() {
                slabs.extend(Slab::new((number, beam), stretch, self.least_overlap, &self.certified.region));
            }
        }
        if self.certified.places.are_asked() {
            for slab in &mut slabs {
                slab.kernels = self.kernels_on(slab.lo, slab.hi, kernels);
            }
        }
        for slabs in slabs.chunk_by_mut(|a, b| a.kernels == b.kernels) {
            self.keep_open(slabs);
        }
        self.memory.slabs = slabs;
    }

    /// The number of kernels that hold on a box: those `around` it, if it decides nothing more there.
    fn kernels_on(&mut self, lo: DVec3, hi: DVec3, around: u32) -> u32 {
        let kernels = self.kernels(around);
        if !kernels.may_be_shortened() && kernels.cover(&bounds_between(lo, hi)) {
            return around;
        }
        let found = self.certified.places.kernels(lo, hi);
        let known = [0, around, self.kernels.len() as u32 - 1];
        let known = known.into_iter().find(|number| Arc::ptr_eq(self.kernels(*number), &found));
        known.unwrap_or_else(|| self.number_of(found))
    }

    /// Gives kernels a number.
    pub(super) fn number_of(&mut self, kernels: Arc<Kernels>) -> u32 {
        self.kernels.push(kernels);
        self.kernels.len() as u32 - 1
    }

    /// Keeps those slabs that may hold roots. All lie where the same kernels hold.
    fn keep_open(&mut self, mut slabs: &mut [Slab]) {
        let Some(&Slab { beam, kernels, .. }) = slabs.first() else { return };
        let (area, kernels) = (self.beam(beam).area, self.kernels(kernels));
        let is_large = area.width.max(area.height) > VAGUE;
        let has_forms = kernels.forms().is_some();
        if kernels.may_be_shortened() || has_forms && is_large {
            // The gradient of a formula with branches takes much longer than its values, which often say enough. Of large sets
            // forms say less than enclosures.
            let count = self.drop_free(slabs);
            slabs = &mut slabs[..count];
        }
        if has_forms {
            self.keep_by_forms(slabs);
        } else {
            self.keep_by_gradients(slabs);
        }
    }

    /// Keeps slabs that may hold roots, as far as affine forms tell, which know how F depends on column, row and t.
    fn keep_by_forms(&mut self, slabs: &mut [Slab]) {
        let Some(&Slab { kernels, .. }) = slabs.first() else { return };
        let Workspace { forms, scratch, counters, .. } = &mut *self.workspace;
        let mut units = [(0.0, 0.0); BATCH];
        forms.clear();
        for (slab, unit) in slabs.iter().zip(&mut units) {
            let (arguments, of_t) = self.memory.beams[slab.beam as usize].forms(slab.reach);
            forms.push(&arguments);
            *unit = of_t;
        }
        let kernels = &self.kernels[kernels as usize];
        forms.evaluate(kernels.forms().expect("there are forms"), scratch);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += kernels.charge(Kernel::Forms, slabs.len());
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        for number in 0..slabs.len() {
            let Some(found) = self.workspace.forms.found(number) else {
                self.keep_by_gradients(&slabs[number..=number]);
                continue;
            };
            let Slab { beam, kernels, stretch, reach, is_inside, .. } = slabs[number];
            let form = Form::affine(self.beam(beam), reach, units[number], &found);
            if form.is_vague() {
                // Where F is nearly constant, enclosures of its derivatives and its middle take fewer roundings.
                self.keep_by_gradients(&slabs[number..=number]);
            } else if !form.excludes_zero() {
                self.memory.ahead.push(Part { beam, kernels, stretch, form, is_inside });
            }
        }
    }

    /// Keeps slabs that may hold roots, as far as enclosures of F and its gradient tell.
    fn keep_by_gradients(&mut self, slabs: &[Slab]) {
        self.enclose(slabs);
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
            let form = Form::unknown(reach);
            self.memory.ahead.push(Part { beam, kernels, stretch, form, is_inside });
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

    /// Moves the slabs over which the enclosure of F does not exclude zero to the front, and counts them.
    fn drop_free(&mut self, slabs: &mut [Slab]) -> usize {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        let kernels = &self.kernels[slabs[0].kernels as usize];
        boxes.replace(slabs.iter().map(|slab| (&slab.lo, &slab.hi)));
        boxes.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += kernels.charge(Kernel::ValueEnclosures, slabs.len());
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        let mut kept = 0;
        for number in 0..slabs.len() {
            if !free_of_zero(boxes.interval(0, number)) {
                slabs[kept] = slabs[number];
                kept += 1;
            }
        }
        kept
    }

    /// Encloses F and its derivatives over each slab.
    fn enclose(&mut self, slabs: &[Slab]) {
        let Some(&Slab { kernels, .. }) = slabs.first() else { return };
        let kernels = &self.kernels[kernels as usize];
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        boxes.replace(slabs.iter().map(|slab| (&slab.lo, &slab.hi)));
        boxes.evaluate(kernels.gradients(), scratch, 4);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += kernels.charge(Kernel::GradientEnclosures, slabs.len());
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
    }

    /// Encloses F in the middle of each of the slabs that are open.
    fn enclose_middles(&mut self, slabs: &[Slab], open: &[usize]) {
        let Some(&first) = open.first() else { return };
        let kernels = &self.kernels[slabs[first].kernels as usize];
        let Workspace { middles, scratch, counters, .. } = &mut *self.workspace;
        middles.replace(open.iter().map(|number| (&slabs[*number].middle.1, &slabs[*number].middle.1)));
        middles.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += open.len() as u64;
        counters.operations += kernels.charge(Kernel::ValueEnclosures, open.len());
        self.work_left = self.work_left.saturating_sub(open.len() as u64);
    }

    /// Leaves a part to the search along single rays.
    pub(super) fn search_each(&mut self, part: &Part) {
        let area = self.beam(part.beam).area;
        for row in area.rows() {
            for column in area.columns() {
                if self.memory.open[row * self.tile.width() + column] {
                    self.search_one((column, row), part.stretch, part.kernels);
                }
            }
        }
    }

    /// Searches a stretch of the ray in a column and a row, where the kernels of this number hold.
    pub(super) fn search_one(&mut self, (column, row): (usize, usize), stretch: Span, kernels: u32) {
        let ray = self.tile.ray(column, row);
        let Some(clip) = Clip::new(&self.certified.region, &ray) else { return };
        let outer = clip.outer;
        let stretch = Span { start: stretch.start.max(outer.start), end: stretch.end.min(outer.end) };
        if stretch.start > stretch.end {
            return;
        }
        let local = &self.kernels[kernels as usize];
        let outcome = self.certified.search(self.workspace, ray, clip, (Cell::SMALLEST, stretch), local);
        if outcome != Outcome::Miss {
            self.end(row * self.tile.width() + column, outcome);
        }
    }

    /// Notes how the search along a ray ends.
    pub(super) fn end(&mut self, place: usize, outcome: Outcome) {
        self.outcomes[place] = outcome;
        self.memory.open[place] = false;
    }
}
