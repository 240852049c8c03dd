//! Many searches that share the calls of a kernel.

use iso_expr::BatchKernel;

use crate::paper::search::Search;
use crate::paper::stretch::Stretches;
use crate::{Outcome, Ray, Region, Span, Stop, Workspace};

/// Searches under way at once: enough to fill a kernel's batch, few enough to stay in the nearest cache.
const LANES: usize = 64;

/// A search and the place of its ray.
struct Lane<S> {
    place: usize,
    search: Search<S>,
    asked: usize,
}

/// Searches along each ray the stretches that `stretches` gives for its part inside `region`, all rays in lockstep: each
/// round, every search asks for its next points, and one call of the kernel answers them all. Ends early when `stop` is requested.
pub(crate) fn trace<S: Stretches>(
    kernel: &dyn BatchKernel,
    stop: &Stop,
    region: &Region,
    workspace: &mut Workspace,
    rays: &[Ray],
    outcomes: &mut [Outcome],
    stretches: impl Fn(&Ray, Span) -> S,
) {
    assert_eq!(rays.len(), outcomes.len(), "each ray has an outcome");
    let Workspace { scratch, counters, points, .. } = workspace;
    counters.rays += rays.len() as u64;
    outcomes.fill(Outcome::Miss);
    let mut waiting = rays.iter().enumerate().filter_map(|(place, ray)| {
        region.clip(ray).map(|span| (place, Search::new(*ray, stretches(ray, span))))
    });
    let mut lanes: Vec<Lane<S>> = Vec::with_capacity(LANES.min(rays.len()));
    loop {
        for (place, search) in waiting.by_ref().take(LANES - lanes.len()) {
            counters.rays_in_region += 1;
            lanes.push(Lane { place, search, asked: 0 });
        }
        if lanes.is_empty() || stop.is_requested() {
            return;
        }
        points.clear();
        for lane in &mut lanes {
            lane.asked = lane.search.ask(points);
        }
        counters.trace_evaluations += points.len() as u64;
        let mut values = points.evaluate(kernel, scratch, 1);
        lanes.retain_mut(|lane| {
            let (answers, rest) = values.split_at(lane.asked);
            values = rest;
            let outcome = lane.search.answer(answers);
            if let Some(outcome) = outcome {
                outcomes[lane.place] = outcome;
                counters.steps += lane.search.steps();
            }
            outcome.is_none()
        });
    }
}
