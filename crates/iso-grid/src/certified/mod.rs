//! Certified intersection: every ray ends with a proof, or says where the proof stopped. Nothing is to be tuned.

mod classify;
mod clip;
mod line;
mod newton;
mod search;
mod side;

use std::sync::Arc;

use iso_expr::{CompileError, Program};

use crate::{Counters, Outcome, Ray, Region, Surface, Tracer, Workspace};
use clip::Clip;
use line::{Kernels, Line};
use search::Search;

/// The method that proves what it says, by interval arithmetic rounded outwards.
///
/// What is proven is about real arithmetic on the exact doubles of the formula, the ray and the region:
/// - [`Outcome::Hit`]: F is continuous and strictly monotone on the bracket, it has a root there, a simple one, inside
///   the region, and no point of the region before it is a root;
/// - [`Outcome::Touch`]: no point of the region before the bracket is a root, and in the bracket, which cannot be split
///   further, F is continuous and comes within rounding of zero, or is zero on all of it;
/// - [`Outcome::Miss`]: no point of the region is a root;
/// - [`Outcome::Undecided`]: no point of the region before the stretch is a root. In the stretch the proof stopped: at a
///   possible root next to a jump, a pole or an edge of the domain, on a face of the region, or since too much
///   work was done along this ray.
///
/// The ray is searched front to back. A stretch of it is discarded when the enclosure of F excludes zero, over the
/// stretch as a whole, by the slope from its ends, or piece by piece around poles and jumps. It is a crossing when F
/// is monotone and changes sign, and then the interval Newton method encloses the root. Else it is cut into parts.
pub struct Certified {
    kernels: Kernels,
    program: Program,
    region: Region,
    accuracy: f64,
}

impl Certified {
    /// The width, relative to t and to 1 where t is smaller, to which a root is enclosed unless asked otherwise.
    pub const ACCURACY: f64 = 1e-12;

    /// The method for a surface in a region.
    ///
    /// # Errors
    /// When the engine cannot compile the surface.
    pub fn new(surface: &Surface, region: Region) -> Result<Self, CompileError> {
        Ok(Self {
            kernels: Kernels {
                values: Arc::clone(surface.value_enclosures()?),
                gradients: Arc::clone(surface.gradient_enclosures()?),
            },
            program: surface.program().clone(),
            region,
            accuracy: Self::ACCURACY,
        })
    }

    /// The same with another accuracy: coarser is faster, what is said stays proven.
    pub fn with_accuracy(self, accuracy: f64) -> Self {
        Self { accuracy, ..self }
    }
}

impl Tracer for Certified {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut [Outcome]) {
        assert_eq!(rays.len(), outcomes.len());
        let mut ahead = Vec::new();
        for (ray, outcome) in rays.iter().zip(outcomes) {
            workspace.counters.rays += 1;
            let Some(clip) = Clip::new(&self.region, ray) else {
                *outcome = Outcome::Miss;
                continue;
            };
            workspace.counters.rays_in_region += 1;
            let line =
                Line { kernels: &self.kernels, scratch: &mut workspace.scratch, ray: *ray, evaluations: 0 };
            let mut search =
                Search { line, program: &self.program, accuracy: self.accuracy, clip, ahead: &mut ahead };
            *outcome = search.run();
            workspace.counters.box_evaluations += search.line.evaluations;
        }
    }

    fn preprocessing(&self) -> Counters {
        Counters::default()
    }
}
