//! The subdivision of a tile into beams and of beams into stretches.

use std::rc::Rc;
use std::sync::Arc;

use glam::DVec3;

use super::area::Area;
use super::bundle::{Beam, Bundle};
use super::form::Form;
use crate::certified::Certified;
use crate::certified::cells::Cell;
use crate::certified::classify::free_of_zero;
use crate::certified::clip::Clip;
use crate::certified::kernels::Kernels;
use crate::{Kernel, Outcome, Region, Span, Workspace};

/// Into how many stretches a beam is cut at most, and so how many boxes a kernel is given at once.
const SLICES: usize = 8;

/// A stretch is cut, and not the beam, when it is longer than this many times the beam's width; and then into stretches
/// about so long.
const LONG: f64 = 2.0;

/// Beams of so many columns and rows are not cut further, and left to their rays where F is not monotone.
const SMALLEST: usize = 2;

/// Beams of so many columns and rows are not cut just since not all of their rays have a root.
const SMALL: usize = 4;

/// How uneven the slope of F may be over a beam whose rays are followed each for its own.
const UNEVEN: f64 = 0.6;

/// By how much of their length stretches overlap, so that a root near an end lies well inside one of them.
const OVERLAP: f64 = 1.0 / 16.0;
/// The least overlap, as part of the tile's farthest distance.
const LEAST_OVERLAP: f64 = 1.0 / (1u64 << 30) as f64;

/// How many boxes may be enclosed for each ray of a tile before the rest is left to single rays.
const WORK_LIMIT: u64 = 64;

/// A stretch of a beam that may hold roots.
pub(super) struct Part {
    pub(super) beam: Rc<Beam>,
    pub(super) stretch: Span,
    form: Option<Form>,
    /// Whether all of it lies in the region, and a little more at both ends too.
    pub(super) is_inside: bool,
    pub(super) kernels: Arc<Kernels>,
}

/// A stretch of a beam, and a box around its part in the region.
struct Slab {
    beam: Rc<Beam>,
    stretch: Span,
    /// The stretch and a little more at both ends.
    reach: Span,
    lo: DVec3,
    hi: DVec3,
    is_inside: bool,
}

impl Slab {
    /// `None` when it lies outside the region.
    fn new(beam: &Rc<Beam>, stretch: Span, least_overlap: f64, region: &Region) -> Option<Self> {
        let overlap = (OVERLAP * (stretch.end - stretch.start)).max(least_overlap);
        let reach = Span { start: (stretch.start - overlap).max(0.0), end: stretch.end + overlap };
        let (lo, hi) = beam.bounds(reach, region)?;
        let is_inside = (lo, hi) == beam.bounds_in_space(reach);
        Some(Self { beam: Rc::clone(beam), stretch, reach, lo, hi, is_inside })
    }

    /// A point of the box, in the middle of the beam where that is in the region.
    fn center(&self) -> DVec3 {
        let t = 0.5 * (self.reach.start + self.reach.end);
        (self.beam.origins.middle + t * self.beam.directions.middle).clamp(self.lo, self.hi)
    }
}

/// `count` parts of `span`, equally long.
fn slices(span: Span, count: usize) -> impl DoubleEndedIterator<Item = Span> {
    let cut = move |at: usize| {
        let part = at as f64 / count as f64;
        if at == count { span.end } else { span.start + part * (span.end - span.start) }
    };
    (0..count).map(move |slice| Span { start: cut(slice), end: cut(slice + 1) })
}

/// The subdivision of a tile.
pub(in crate::certified) struct Subdivision<'a> {
    pub(super) certified: &'a Certified,
    pub(super) workspace: &'a mut Workspace,
    pub(super) bundle: &'a Bundle<'a>,
    pub(super) outcomes: &'a mut [Outcome],
    /// Whether each ray's first root is still looked for.
    pub(super) open: Vec<bool>,
    /// What lies ahead. For each ray its stretches are in order, the nearest on top; everything before them is free of
    /// roots, and so is all between.
    ahead: Vec<Part>,
    /// How many more boxes may be enclosed.
    work_left: u64,
    least_overlap: f64,
}

impl<'a> Subdivision<'a> {
    pub(in crate::certified) fn new(
        certified: &'a Certified,
        workspace: &'a mut Workspace,
        bundle: &'a Bundle<'a>,
        outcomes: &'a mut [Outcome],
    ) -> Self {
        let rays = bundle.rays;
        workspace.counters.rays += rays.len() as u64;
        workspace.counters.rays_in_region += bundle.count_in(&certified.region, bundle.area);
        outcomes.fill(Outcome::Miss);
        Self {
            certified,
            workspace,
            bundle,
            outcomes,
            open: vec![true; rays.len()],
            ahead: Vec::new(),
            work_left: WORK_LIMIT * rays.len() as u64,
            least_overlap: 0.0,
        }
    }

    /// Says of every ray how its search ends.
    pub(in crate::certified) fn run(mut self) {
        let beam = Rc::new(self.bundle.beam(self.bundle.area));
        let Some(stretch) = self.passage(&beam) else { return };
        self.least_overlap = LEAST_OVERLAP * stretch.end;
        let kernels = Arc::clone(&self.certified.kernels);
        self.ahead.push(Part { beam, stretch, form: None, is_inside: false, kernels });
        while let Some(part) = self.ahead.pop() {
            if self.certified.stop.is_requested() {
                return;
            }
            if !self.is_open(part.beam.area) {
                continue;
            }
            match part.form {
                _ if self.work_left == 0 => self.search_each(&part),
                Some(form) if form.is_monotone() => self.follow(part, &form),
                _ => self.divide(part),
            }
        }
    }

    /// A stretch that holds all of the tile's rays inside the region; `None` when they miss it.
    fn passage(&self, beam: &Beam) -> Option<Span> {
        let region = &self.certified.region;
        if let Some(passage) = beam.passage(region) {
            return (passage.start <= passage.end).then_some(passage);
        }
        let spans = self.bundle.rays.iter().filter_map(|ray| Clip::new(region, ray)).map(|clip| clip.outer);
        spans.reduce(|a, b| Span { start: a.start.min(b.start), end: a.end.max(b.end) })
    }

    /// Whether some ray of `area` is still followed.
    fn is_open(&self, area: Area) -> bool {
        area.rows().any(|row| self.open[row * self.bundle.area.width..][area.columns()].contains(&true))
    }

    /// Cuts a stretch when it is longer than the beam is wide, or else the beam.
    fn divide(&mut self, part: Part) {
        let Part { beam, stretch, .. } = &part;
        let stretch = *stretch;
        let (length, width) = beam.extent(stretch);
        let is_smallest = beam.area.width.max(beam.area.height) <= SMALLEST;
        if length > LONG * width && width > 0.0 {
            let count = (length / (LONG * width)).ceil().min(SLICES as f64) as usize;
            self.examine(std::slice::from_ref(beam), stretch, count);
        } else if !is_smallest {
            self.examine(&self.quarters(beam), stretch, 1);
        } else {
            self.search_each(&part);
        }
    }

    /// Goes on with a stretch on which F is monotone along every ray.
    fn follow(&mut self, part: Part, form: &Form) {
        let Part { beam, stretch, .. } = &part;
        let roots = form.roots();
        let narrowed = Span { start: stretch.start.max(roots.lo), end: stretch.end.min(roots.hi) };
        if narrowed.start > narrowed.end {
            return;
        }
        let length = |span: Span| span.end - span.start;
        let is_small = beam.area.width.max(beam.area.height) <= SMALL;
        let is_even = form.unevenness() < UNEVEN;
        if is_even && (is_small || corners_hit(beam, form, narrowed)) {
            self.follow_each(Part { stretch: narrowed, ..part }, form);
        } else if !is_small {
            self.examine(&self.quarters(beam), narrowed, 1);
        } else if length(narrowed) < 0.5 * length(*stretch) {
            self.examine(std::slice::from_ref(beam), narrowed, 1);
        } else {
            self.divide(Part { stretch: narrowed, ..part });
        }
    }

    fn quarters(&self, beam: &Beam) -> Vec<Rc<Beam>> {
        beam.area.quarters().map(|area| Rc::new(self.bundle.beam(area))).collect()
    }

    /// Looks at all beams, each cut into `count` stretches, and keeps the stretches that may hold roots.
    fn examine(&mut self, beams: &[Rc<Beam>], stretch: Span, count: usize) {
        let mut slabs: Vec<Slab> = beams
            .iter()
            .flat_map(|beam| slices(stretch, count).rev().map(move |stretch| (beam, stretch)))
            .filter_map(|(beam, stretch)| {
                Slab::new(beam, stretch, self.least_overlap, &self.certified.region)
            })
            .collect();
        let places = &self.certified.places;
        let kernels: Vec<_> = slabs.iter().map(|slab| places.kernels(slab.lo, slab.hi)).collect();
        for kernels in kernels.chunk_by(Arc::ptr_eq) {
            let rest = slabs.split_off(kernels.len());
            self.keep_open(slabs, &kernels[0]);
            slabs = rest;
        }
    }

    /// Encloses F over slabs that lie where `kernels` hold, and keeps those that may hold roots.
    fn keep_open(&mut self, mut slabs: Vec<Slab>, kernels: &Arc<Kernels>) {
        if kernels.may_be_shortened() {
            // The gradient of a formula with branches takes much longer than its values, which often say enough.
            self.drop_free(&mut slabs, kernels);
        }
        self.enclose(&slabs, kernels);
        let Workspace { boxes, centers, .. } = &*self.workspace;
        for (number, slab) in slabs.into_iter().enumerate() {
            if free_of_zero(boxes.interval(0, number)) {
                continue;
            }
            let course = [0, 1, 2, 3].map(|output| boxes.decorated(output, number));
            let form = Form::new(&slab.beam, slab.reach, slab.center(), centers.interval(0, number), course);
            if form.as_ref().is_none_or(|form| !form.excludes_zero()) {
                let Slab { beam, stretch, is_inside, .. } = slab;
                self.ahead.push(Part { beam, stretch, form, is_inside, kernels: Arc::clone(kernels) });
            }
        }
    }

    /// Drops the slabs over which the enclosure of F excludes zero.
    fn drop_free(&mut self, slabs: &mut Vec<Slab>, kernels: &Kernels) {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        boxes.clear();
        slabs.iter().for_each(|slab| boxes.push(slab.lo, slab.hi));
        boxes.evaluate(kernels.values(), scratch, 1);
        counters.box_evaluations += slabs.len() as u64;
        counters.operations += slabs.len() as u64 * kernels.operations(Kernel::ValueEnclosures);
        self.work_left = self.work_left.saturating_sub(slabs.len() as u64);
        let mut number = 0..;
        slabs.retain(|_| number.next().is_some_and(|number| !free_of_zero(boxes.interval(0, number))));
    }

    /// Encloses F and its derivatives over each slab, and F at its center.
    fn enclose(&mut self, slabs: &[Slab], kernels: &Kernels) {
        let Workspace { boxes, centers, scratch, counters, .. } = &mut *self.workspace;
        boxes.clear();
        centers.clear();
        for slab in slabs {
            let center = slab.center();
            boxes.push(slab.lo, slab.hi);
            centers.push(center, center);
        }
        boxes.evaluate(kernels.gradients(), scratch, 4);
        centers.evaluate(kernels.values(), scratch, 1);
        let enclosed = 2 * slabs.len() as u64;
        counters.box_evaluations += enclosed;
        counters.operations += slabs.len() as u64
            * (kernels.operations(Kernel::GradientEnclosures) + kernels.operations(Kernel::ValueEnclosures));
        self.work_left = self.work_left.saturating_sub(enclosed);
    }

    /// Leaves a part to the search along single rays.
    pub(super) fn search_each(&mut self, part: &Part) {
        for row in part.beam.area.rows() {
            for column in part.beam.area.columns() {
                let place = row * self.bundle.area.width + column;
                if self.open[place] {
                    self.search_one(place, part.stretch, &part.kernels);
                }
            }
        }
    }

    /// Searches a stretch of one ray.
    pub(super) fn search_one(&mut self, place: usize, stretch: Span, local: &Kernels) {
        let ray = self.bundle.rays[place];
        let Some(clip) = Clip::new(&self.certified.region, &ray) else { return };
        let outer = clip.outer;
        let stretch = Span { start: stretch.start.max(outer.start), end: stretch.end.min(outer.end) };
        if stretch.start > stretch.end {
            return;
        }
        let outcome = self.certified.search(self.workspace, ray, clip, (Cell::SMALLEST, stretch), local);
        if outcome != Outcome::Miss {
            self.end(place, outcome);
        }
    }

    /// Notes how the search along a ray ends.
    pub(super) fn end(&mut self, place: usize, outcome: Outcome) {
        self.outcomes[place] = outcome;
        self.open[place] = false;
    }
}

/// Whether the rays at the corners of a beam are likely to have a root in `stretch`.
fn corners_hit(beam: &Beam, form: &Form, stretch: Span) -> bool {
    let [across, along] = beam.radii;
    [(-across, -along), (across, -along), (-across, along), (across, along)].into_iter().all(|(a, b)| {
        let t = form.estimate(a, b);
        stretch.start <= t && t <= stretch.end
    })
}
