//! The subdivision of a tile into beams and of beams into stretches.

use std::rc::Rc;
use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Composition, Decorated};
use rustc_hash::FxHashMap;

use super::beam::{Beam, count_in};
use super::edges::Meeting;
use super::form::Form;
use super::grazing::Attempts;
use super::made::MOST;
use super::met::Met;
use super::open_rays::OpenRays;
use super::packet::Packet;
use super::pixels::Pixels;
use super::rounding::{AROUND, Rounding};
use super::sheaf::Sheaf;
use super::slabs::{LEAST_OVERLAP, Slab};
use crate::area::Area;
use crate::certified::Certified;
use crate::certified::cells::Cell;
use crate::certified::clip::Clip;
use crate::certified::kernels::Kernels;
use crate::certified::line::bounds_along;
use crate::lanes::{ROW, Row};
use crate::normals::{Asked, answer};
use crate::raster::Rays;
use crate::{Hit, Kernel, Outcome, Outcomes, Span, Tile, Traced, Workspace};

/// Beams of so many columns and rows are not cut further, and left to their rays where F is not monotone.
pub(super) const SMALLEST: usize = 2;

/// For how many kernels there is room before memory is asked for again. In tiles of large models some hundreds get numbers.
const NUMBERED: usize = 256;

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

impl Part {
    /// Where its roots are wanted, and where all holds that is known of it.
    pub(super) fn stretches(&self) -> [Span; 2] {
        [self.stretch, self.form.reach]
    }

    /// What is known of F along its rays, unless they may leave the region.
    pub(super) fn known(&self) -> Option<KnownAlong> {
        self.is_inside.then_some(KnownAlong { kernels: self.kernels, span: self.form.reach })
    }
}

/// Kernels whose signs F has along a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnownAlong {
    /// Their number.
    pub(super) kernels: u32,
    /// Where F has them.
    pub(super) span: Span,
}

/// How a function is made of others: the numbers of their kernels.
pub(super) type Faces = Rc<Composition<u32>>;

/// What is known of how a function is made of others; `None` where it has no kinks.
#[derive(Clone)]
pub(super) enum Known {
    /// It was not asked for.
    Nothing,
    /// How it is everywhere.
    Everywhere(Option<Faces>),
    /// How it is on a slab, where places tell no more.
    OnSlab(Option<Faces>),
}

/// Working memory for the subdivision of a tile.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    pub(super) open: OpenRays,
    /// What lies ahead. For each ray its stretches are in order, the nearest on top; everything before them is free of
    /// roots, and so is all between.
    pub(super) ahead: Vec<Part>,
    /// The beams that the tile was cut into so far.
    pub(super) beams: Vec<Beam>,
    pub(super) slabs: Vec<Slab>,
    /// The numbers of functions that others are made of, by their [identities](Kernels::identity).
    pub(super) numbers: FxHashMap<usize, u32>,
    /// Functions that are left of others on slabs, by the slab's number among those that are looked at.
    pub(super) left: Vec<(usize, u32)>,
    pub(super) attempts: Attempts,
    pub(super) sheaf: Sheaf,
    pub(super) packets: Vec<Packet>,
    pub(super) pixels: Vec<Pixels>,
    pub(super) meetings: Vec<Meeting>,
    /// Rays that can meet one face of a body alone, for each face.
    pub(super) alone: [Vec<Packet>; MOST],
    /// The numbers of meetings that are asked for a face, and where.
    pub(super) asked: Vec<(usize, Span)>,
    pub(super) met: Met,
    /// What was found out of rounding, the last at the end.
    pub(super) roundings: Vec<Rounding>,
    /// How many times its size a box for which rounding is bounded grows at each side, so that it holds neighbours too.
    pub(super) room: f64,
}

/// The subdivision of a tile.
pub(in crate::certified) struct Subdivision<'a> {
    pub(super) certified: &'a Certified,
    pub(super) workspace: &'a mut Workspace,
    pub(super) tile: Tile<'a>,
    pub(super) outcomes: &'a mut Outcomes,
    /// Those of rays that were found on the way, if they are wanted.
    pub(super) normals: Option<&'a mut [DVec3]>,
    pub(super) memory: Memory,
    /// Whether some hits or touches have no normals although they are wanted.
    pub(super) lacks_normals: bool,
    /// Kernels by number. The first hold everywhere.
    pub(super) kernels: Vec<Arc<Kernels>>,
    /// What is known of how each of them is made of others.
    pub(super) faces: Vec<Known>,
    /// How many more boxes may be enclosed.
    pub(super) work_left: u64,
    pub(super) least_overlap: f64,
}

/// The largest t of rays that are proven together: no sum or product of such ones overflows.
const LONGEST_WAY: f64 = 1e150;

impl<'a> Subdivision<'a> {
    /// `None` when there are no rays, or they are not finite or out of all proportion.
    pub(in crate::certified) fn new(
        certified: &'a Certified,
        workspace: &'a mut Workspace,
        tile: Tile<'a>,
        (outcomes, normals): (&'a mut Outcomes, Option<&'a mut [DVec3]>),
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
        outcomes.reset(tile.len());
        workspace.counters.rays += tile.len() as u64;
        workspace.counters.rays_in_region += count_in(&certified.region, &tile, area);
        let mut memory = std::mem::take(&mut workspace.tile);
        memory.ahead.clear();
        memory.beams.clear();
        memory.beams.push(beam);
        memory.met.clear();
        memory.roundings.clear();
        memory.numbers.clear();
        memory.room = AROUND;
        memory.attempts = Attempts::default();
        memory.open.open_all(tile.width(), tile.height());
        let (mut kernels, mut faces) = (Vec::with_capacity(NUMBERED), Vec::with_capacity(NUMBERED));
        kernels.push(Arc::clone(&certified.kernels));
        faces.push(Known::Nothing);
        let work_left = WORK_LIMIT * tile.len() as u64;
        Some(Self {
            certified,
            workspace,
            tile,
            outcomes,
            normals,
            lacks_normals: false,
            memory,
            kernels,
            faces,
            work_left,
            least_overlap: 0.0,
        })
    }

    /// Says of every ray how its search ends, and what came of all.
    pub(in crate::certified) fn run(mut self) -> Traced {
        if let Some(stretch) = self.passage() {
            self.least_overlap = LEAST_OVERLAP * stretch.end;
            let form = Form::unknown(stretch);
            let part = Part { beam: 0, kernels: 0, stretch, form, is_inside: false };
            if stretch.end <= LONGEST_WAY {
                self.memory.ahead.push(part);
            } else {
                self.search_each(&part);
            }
        }
        while let Some(part) = self.memory.ahead.pop() {
            if self.certified.stop.is_requested() {
                break;
            }
            if !self.memory.open.is_any_in(self.beam(part.beam).area) {
                continue;
            }
            let examined = part.stretch;
            let Some(part) = part.narrowed() else { continue };
            if self.work_left == 0 {
                self.search_each(&part);
            } else if part.form.is_monotone() {
                self.follow(&part, examined);
            } else if !self.follow_edge(&part) && !self.follow_bent(&part) {
                self.divide(&part);
            }
        }
        self.put_normals();
        let are_missed = self.memory.open.are_all();
        self.workspace.tile = self.memory;
        match are_missed {
            true => Traced::Nothing,
            false if self.normals.is_none() || self.lacks_normals => Traced::Outcomes,
            false => Traced::OutcomesAndNormals,
        }
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

    /// The kernel of the forms that tell the tile's rays.
    pub(super) fn forms(&self) -> Kernel {
        if self.tile.direction().is_some() { Kernel::ParallelForms } else { Kernel::Forms }
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
        boxes.replace(bounds.iter().copied());
        boxes.evaluate(kernels.over_boxes(kernel)?, scratch, N);
        counters.box_evaluations += COUNT as u64;
        counters.operations += kernels.charge(kernel, COUNT);
        self.work_left = self.work_left.saturating_sub(COUNT as u64);
        Some(std::array::from_fn(|place| std::array::from_fn(|output| boxes.decorated(output, place))))
    }

    /// Gives kernels a number.
    pub(super) fn number_of(&mut self, kernels: Arc<Kernels>) -> u32 {
        self.kernels.push(kernels);
        self.faces.push(Known::Nothing);
        self.kernels.len() as u32 - 1
    }

    /// The number of kernels, where they are likely to be those of number `other` or to have been given the last one.
    pub(super) fn known_number_of(&mut self, kernels: Arc<Kernels>, other: u32) -> u32 {
        let known = [0, other, self.kernels.len() as u32 - 1];
        // What holds on a slab alone is made of less there than elsewhere.
        let are_same = |number: &u32| !self.is_narrowed(*number) && self.kernels(*number).are(&kernels);
        let known = known.into_iter().find(are_same);
        known.unwrap_or_else(|| self.number_of(kernels))
    }

    /// Leaves a part to the search along single rays, of each of which only as much is searched as roots may lie on.
    pub(super) fn search_each(&mut self, part: &Part) {
        let beam = *self.beam(part.beam);
        for row in beam.area.rows() {
            for column in beam.area.columns() {
                if self.memory.open.holds(row * self.tile.width() + column) {
                    let form = part.form.on(&beam, Area { column, row, width: 1, height: 1 });
                    if let Some(stretch) = form.narrow(part.stretch) {
                        self.search_one((column, row), stretch, part.known());
                    }
                }
            }
        }
    }

    /// Searches a stretch of the ray in a column and a row: by what is known along the ray, where that is all of the stretch, for its kernels were
    /// asked for before, or else by what F comes to in the place around it.
    pub(super) fn search_one(
        &mut self,
        (column, row): (usize, usize),
        stretch: Span,
        known: Option<KnownAlong>,
    ) {
        let ray = self.tile.ray(column, row);
        let Some(clip) = Clip::new(&self.certified.region, &ray) else { return };
        let outer = clip.outer;
        let stretch = Span { start: stretch.start.max(outer.start), end: stretch.end.min(outer.end) };
        if stretch.start > stretch.end {
            return;
        }
        let place = row * self.tile.width() + column;
        let known = known.filter(|known| known.span.start <= stretch.start && stretch.end <= known.span.end);
        let (number, local) = match known {
            Some(KnownAlong { kernels, span }) => {
                (kernels, Arc::new(self.kernels(kernels).within(bounds_along(&ray, span))))
            }
            None => {
                let (start, end) = (ray.at(stretch.start), ray.at(stretch.end));
                let kernels = self.certified.places.kernels(start.min(end), start.max(end));
                let number = self.known_number_of(kernels, 0);
                (number, Arc::clone(self.kernels(number)))
            }
        };
        let outcome = self.certified.search(self.workspace, ray, clip, (Cell::SMALLEST, stretch), &local);
        match outcome {
            Outcome::Miss => {}
            Outcome::Hit(hit) => self.meet(place, hit, number),
            _ => self.end(place, outcome),
        }
    }

    /// Notes that a ray meets the surface where F is the function of the kernels of this number, whose normal there is found
    /// later, with those of others.
    pub(super) fn meet(&mut self, place: usize, hit: Hit, kernels: u32) {
        if self.normals.is_some() {
            let function = || self.kernels[kernels as usize].identity();
            self.memory.met.push(kernels, function, Asked { place, t: hit.t });
        }
        self.end(place, Outcome::Hit(hit));
    }

    /// Puts the normals of hits in their places, those of one function at a time.
    fn put_normals(&mut self) {
        let Some(normals) = &mut self.normals else { return };
        for (number, asked) in self.memory.met.by_function() {
            let kernels = &self.kernels[number as usize];
            self.workspace.counters.operations += kernels.charge(Kernel::Gradients, asked.len());
            let kernel = kernels.over_points(Kernel::Gradients);
            self.lacks_normals |= !answer(kernel, self.workspace, self.tile, asked, normals);
        }
    }

    /// Notes how the search along a ray ends.
    #[inline]
    pub(super) fn end(&mut self, place: usize, outcome: Outcome) {
        self.lacks_normals |= matches!(outcome, Outcome::Touch(_));
        self.outcomes.set(place, outcome);
        self.memory.open.close(place);
    }

    /// Notes that neighbours in a row, from this place on, meet the surface: at these distances, in brackets with these starts and ends.
    #[inline]
    pub(super) fn end_neighbours(&mut self, first: usize, distances: &Row, brackets: &[Row; 2]) {
        self.outcomes.put_hits(first, distances, brackets);
        self.memory.open.close_neighbours(first..first + ROW);
    }
}
