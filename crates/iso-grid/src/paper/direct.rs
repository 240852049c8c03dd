//! The paper's method without a grid.

use crate::paper::lockstep::Lockstep;
use crate::paper::settings::check_step;
use crate::paper::stretch::{Spacing, Stretch, Stretches};
use crate::roots::RootFinding;
use crate::{Counters, GridError, Outcomes, Ray, Region, Surface, Tracer, Workspace};

/// Samples each ray through the whole region and narrows down the first change of sign: the paper's N = 0.
///
/// Without cells there is nothing to measure the distance between samples by, so it is that of a grid with
/// [`Direct::CELLS`] cells along the region's longest side: at the default step of 1/20, no more than 1/600 of that side.
///
/// It misses pairs of roots between neighbouring samples, roots where F − C does not change sign, and takes poles that
/// change sign for roots. A sample that is exactly zero is a root: a [`Outcome::Hit`](crate::Outcome::Hit) when the signs before and behind it
/// differ, otherwise a [`Outcome::Touch`](crate::Outcome::Touch).
pub struct Direct {
    lockstep: Lockstep,
    spacing: Spacing,
}

impl Direct {
    /// The cells along the region's longest side of the grid whose samples are as close.
    pub const CELLS: u32 = 30;

    /// Prepares the method. `step` is the largest distance between samples as a part of 1/[`Direct::CELLS`] of the
    /// region's longest side, from [`GridSettings::LEAST_STEP`](crate::GridSettings::LEAST_STEP) to 1; `roots` says how roots
    /// are found between samples.
    ///
    /// # Errors
    /// When a setting is out of range or the engine cannot compile F − C or its gradient.
    pub fn new(surface: &Surface, region: Region, step: f64, roots: RootFinding) -> Result<Self, GridError> {
        check_step(step)?;
        let cells = f64::from(Self::CELLS);
        let spacing = Spacing::new(step, region.extent().max_element() / cells, cells);
        Ok(Self { lockstep: Lockstep::new(surface, region, roots)?, spacing })
    }
}

impl Tracer for Direct {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes) {
        self.lockstep.trace(workspace, rays, outcomes, |ray, span| {
            Whole(Some(self.spacing.stretch(ray.direction, span)))
        });
    }

    fn preprocessing(&self) -> Counters {
        Counters::default()
    }
}

/// The whole of a ray inside the region, until it is taken.
struct Whole(Option<Stretch>);

impl Iterator for Whole {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        self.0.take()
    }
}

impl Stretches for Whole {
    fn steps(&self) -> u64 {
        0
    }
}
