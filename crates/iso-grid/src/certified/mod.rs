//! Certified intersection: every ray ends with a proof, or says where the proof stopped. Nothing is to be tuned.

mod beams;
mod cells;
mod classify;
mod clip;
mod formula;
mod isolate;
mod kernels;
mod line;
mod newton;
mod places;
mod polynomial;
mod search;
mod side;
mod walk;

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError};

use crate::tracer::trace_each;
use crate::{
    Accuracy, Counters, Outcome, Outcomes, Ray, Region, Span, Stop, Surface, Tile, Traced, Tracer, Workspace,
};
pub(crate) use beams::Memory;
use beams::Subdivision;
use cells::Cell;
pub(crate) use cells::Cells;
use clip::Clip;
pub(crate) use isolate::Expansion;
use isolate::Isolation;
use kernels::Kernels;
use line::Line;
use places::Places;
use polynomial::Polynomial;
pub(crate) use search::Ahead;
use search::{Search, WORK_LIMIT, Way};
pub(crate) use walk::Entry;
use walk::Walk;

/// The method that proves what it says, by interval arithmetic rounded outwards.
///
/// What is proven is about real arithmetic on the exact doubles of the formula, the ray and the region. F is the formula's function, or
/// [another one with its signs](Surface::by_signs) that has simple roots where that may have multiple ones:
/// - [`Outcome::Hit`]: F is continuous and strictly monotone on the bracket, it has a root there, a simple one, inside
///   the region, and no point of the region before it is a root;
/// - [`Outcome::Touch`]: no point of the region before the bracket is a root, and in the bracket, which cannot be split
///   further or on all of which rounding hides F, F is continuous and comes within rounding of zero, or is zero on all of it. Its t is the bottom of a
///   narrow valley of F if F may be zero there by its enclosure; else the first of the start, the middle and the end of what cannot be split at
///   which F may be zero, so that a plateau is touched where it begins; or the middle if F may be zero only between them;
/// - [`Outcome::Miss`]: no point of the region is a root;
/// - [`Outcome::Undecided`]: no point of the region before the stretch is a root. In the stretch the proof stopped: at a
///   possible root next to a jump, a pole or an edge of the domain, on a face of the region, or since too much
///   work was done along this ray.
///
/// The region is a grid of cells, proven empty where they are when a ray first comes by; what is found out is kept with the
/// surface, and spares later rays and later pictures the search through empty space. It depends on the surface alone, so that
/// the outcome of a ray does not depend on others. Where the formula is a polynomial and a ray is hard, its Bernstein coefficients along the ray tell the
/// search where to look.
///
/// The ray is searched front to back. A stretch of it is discarded when the enclosure of F excludes zero, over the
/// stretch as a whole, by the slope from its ends, or piece by piece around poles and jumps. It is a crossing when F
/// is monotone and changes sign, and then the interval Newton method encloses the root. Else it is cut into parts.
///
/// The rays of a tile share their proofs as far as they go: see [`Tracer::trace_tile`].
pub struct Certified {
    kernels: Arc<Kernels>,
    places: Places,
    polynomial: Option<Polynomial>,
    region: Region,
    cells: Arc<Cells>,
    accuracy: Accuracy,
    stop: Stop,
}

/// How many boxes an easy ray takes at most.
const EASY: u64 = 128;

impl Certified {
    /// The method for a surface in a region.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn new(surface: &Surface, region: Region) -> Result<Self, CompileError> {
        let by_signs = surface.by_signs();
        let kernels = Arc::new(Kernels::of(by_signs)?);
        Ok(Self {
            places: Places::new(&kernels, &region),
            kernels,
            polynomial: Polynomial::of(surface.program()),
            cells: by_signs.cells(&region),
            region,
            accuracy: Accuracy::NARROW,
            stop: surface.stop().clone(),
        })
    }

    /// The same without leaving out what boxes decide of the formula, to compare with: what is proven is the same, and takes
    /// longer where the formula has many branches.
    pub fn with_whole_formula(self) -> Self {
        Self { places: self.places.ignored(), ..self }
    }

    /// The same with another accuracy than [`Accuracy::NARROW`].
    pub fn with_accuracy(self, accuracy: Accuracy) -> Self {
        Self { accuracy, ..self }
    }
}

impl Certified {
    /// How the search along a ray ends, if it begins with `entry`, a stretch in a cell, and goes no further. `local` are
    /// kernels that hold thereabouts.
    ///
    /// Most rays are decided soon, from cell to cell. Those that are not get a second chance where F is a polynomial: its
    /// expansion along the ray takes longer than an easy ray does, but tells apart what boxes cannot.
    fn search(
        &self,
        workspace: &mut Workspace,
        ray: Ray,
        clip: Clip,
        entry: Entry,
        local: &Kernels,
    ) -> Outcome {
        let Workspace { scratch, counters, ahead, entries, expansion, .. } = workspace;
        let mut search = Search {
            line: Line {
                kernels: &self.kernels,
                local,
                asked: &self.kernels,
                scratch,
                ray,
                evaluations: 0,
                points: 0,
                operations: 0,
            },
            accuracy: self.accuracy.of_single_rays(),
            stop: &self.stop,
            clip,
            way: Way::Cells(Walk::new(&self.cells, ray, entry, entries)),
            budget: if self.polynomial.is_some() { EASY } else { WORK_LIMIT },
            ahead,
        };
        let mut end = search.run();
        if let (Err(rest), Some(polynomial), false) = (end, &self.polynomial, self.stop.is_requested()) {
            search.way.tally(counters);
            let rest = Span { end: entry.1.end, ..rest };
            search.way = Way::Pieces(Isolation::new(polynomial, &search.line, rest, expansion));
            search.budget = WORK_LIMIT;
            end = search.run();
        }
        search.way.tally(counters);
        counters.box_evaluations += search.line.evaluations;
        counters.trace_evaluations += search.line.points;
        counters.operations += search.line.operations;
        end.unwrap_or_else(Outcome::Undecided)
    }
}

impl Tracer for Certified {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes) {
        outcomes.reset(rays.len());
        for (number, ray) in rays.iter().enumerate() {
            workspace.counters.rays += 1;
            let Some(clip) = Clip::new(&self.region, ray) else { continue };
            workspace.counters.rays_in_region += 1;
            let outcome = self.search(workspace, *ray, clip, (Cell::REGION, clip.outer), &self.kernels);
            outcomes.set(number, outcome);
        }
    }

    fn trace_tile(
        &self,
        workspace: &mut Workspace,
        tile: Tile<'_>,
        outcomes: &mut Outcomes,
        normals: Option<&mut [DVec3]>,
    ) -> Traced {
        assert!(normals.as_ref().is_none_or(|normals| normals.len() == tile.len()));
        match Subdivision::new(self, workspace, tile, (outcomes, normals)) {
            Some(subdivision) => subdivision.run(),
            None => trace_each(self, workspace, tile, outcomes),
        }
    }

    fn gradients_on(&self, lo: DVec3, hi: DVec3) -> Option<Arc<dyn BatchKernel>> {
        self.places
            .are_asked()
            .then(|| self.places.kernels(lo, hi).gradients_at_points(&self.kernels))
            .flatten()
    }

    fn preprocessing(&self) -> Counters {
        Counters::default()
    }
}
