//! Many searches that share the calls of kernels.

use std::sync::Arc;

use iso_expr::BatchKernel;

use crate::paper::search::Search;
use crate::paper::stretch::Stretches;
use crate::roots::{RootFinder, RootFinding};
use crate::{GridError, Kernel, Outcomes, Ray, Region, Span, Stop, Surface, Workspace};

/// Searches under way at once: enough to fill a kernel's batch, few enough to stay in the nearest cache.
const LANES: usize = 64;

/// Follows rays by searches in lockstep: each round, every search asks for its next points, and one call of a kernel answers
/// them all, one more if slopes are wanted.
pub(crate) struct Lockstep {
    region: Region,
    roots: RootFinding,
    values: Arc<dyn BatchKernel>,
    /// For root finders that follow slopes.
    gradients: Option<Arc<dyn BatchKernel>>,
    stop: Stop,
}

/// A search, the place of its ray, and what it waits for.
struct Lane<S> {
    place: usize,
    search: Search<S>,
    asked: usize,
    wants_slope: bool,
}

impl Lockstep {
    /// # Errors
    /// When the tolerance is out of range or the engine cannot compile F − C or its gradient.
    pub(crate) fn new(surface: &Surface, region: Region, roots: RootFinding) -> Result<Self, GridError> {
        roots.check()?;
        let gradients = match roots.finder {
            RootFinder::Newton => Some(Arc::clone(surface.over_points(Kernel::Gradients)?)),
            RootFinder::Bisection | RootFinder::Itp => None,
        };
        let (values, stop) = (Arc::clone(surface.over_points(Kernel::Values)?), surface.stop().clone());
        Ok(Self { region, roots, values, gradients, stop })
    }

    /// Searches along each ray the stretches that `stretches` gives for its part inside the region. Ends early when work on
    /// the surface is to stop.
    pub(crate) fn trace<S: Stretches>(
        &self,
        workspace: &mut Workspace,
        rays: &[Ray],
        outcomes: &mut Outcomes,
        stretches: impl Fn(&Ray, Span) -> S,
    ) {
        workspace.counters.rays += rays.len() as u64;
        outcomes.reset(rays.len());
        let mut waiting = rays.iter().enumerate().filter_map(|(place, ray)| {
            let span = self.region.clip(ray)?;
            Some((place, Search::new(*ray, self.roots, stretches(ray, span))))
        });
        let mut lanes: Vec<Lane<S>> = Vec::with_capacity(LANES.min(rays.len()));
        loop {
            for (place, search) in waiting.by_ref().take(LANES - lanes.len()) {
                workspace.counters.rays_in_region += 1;
                lanes.push(Lane { place, search, asked: 0, wants_slope: false });
            }
            if lanes.is_empty() || self.stop.is_requested() {
                return;
            }
            self.advance(workspace, &mut lanes, outcomes);
        }
    }

    /// Answers what each search asks for, and lets go those that ended.
    fn advance<S: Stretches>(
        &self,
        workspace: &mut Workspace,
        lanes: &mut Vec<Lane<S>>,
        outcomes: &mut Outcomes,
    ) {
        let Workspace { scratch, counters, points, sloped_points, .. } = workspace;
        points.clear();
        sloped_points.clear();
        for lane in lanes.iter_mut() {
            lane.wants_slope = lane.search.wants_slope();
            lane.asked = lane.search.ask(if lane.wants_slope { sloped_points } else { points });
        }
        counters.trace_evaluations += points.len() as u64;
        counters.gradient_evaluations += sloped_points.len() as u64;
        let sloped = sloped_points.len();
        let mut values = points.evaluate(&*self.values, scratch, 1);
        let gradients = match &self.gradients {
            Some(kernel) => sloped_points.evaluate(&**kernel, scratch, 4),
            None => &[],
        };
        let mut next_sloped = 0;
        lanes.retain_mut(|lane| {
            let outcome = if lane.wants_slope {
                let asked = next_sloped..next_sloped + lane.asked;
                next_sloped = asked.end;
                let direction = lane.search.ray().direction;
                let along = |axis: usize| direction[axis] * gradients[(axis + 1) * sloped + asked.start];
                let slope = if asked.is_empty() { f64::NAN } else { along(0) + along(1) + along(2) };
                lane.search.answer(&gradients[asked], slope)
            } else {
                let (answers, rest) = values.split_at(lane.asked);
                values = rest;
                lane.search.answer(answers, f64::NAN)
            };
            if let Some(outcome) = outcome {
                outcomes.set(lane.place, outcome);
                counters.steps += lane.search.steps();
            }
            outcome.is_none()
        });
    }
}
