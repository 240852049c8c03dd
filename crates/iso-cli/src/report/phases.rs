//! What the repetitions of a run took, phase by phase.

use serde::Serialize;

use crate::clock::{Cost, Spread};
use crate::measurement::{PhaseCosts, Sample};

/// Something for each phase of a picture, and for the whole.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct ByPhase<T> {
    /// From programs to colours.
    pub(crate) total: T,
    /// From programs to kernels.
    pub(crate) compile: T,
    /// What the method prepares before the first ray.
    pub(crate) preprocess: T,
    /// Following rays.
    pub(crate) trace: T,
    /// Normals and colours.
    pub(crate) shade: T,
    /// What belongs to none of these.
    pub(crate) other: T,
}

impl<T> ByPhase<T> {
    /// The whole, and then the phases in their order.
    pub(crate) fn each(&self) -> [&T; 6] {
        [&self.total, &self.compile, &self.preprocess, &self.trace, &self.shade, &self.other]
    }

    fn of<S>(
        samples: &[Sample],
        mut of_phase: impl FnMut(&[S]) -> T,
        phase: impl Fn(&Sample) -> [S; 6],
    ) -> Self {
        let mut columns: [Vec<S>; 6] = Default::default();
        for sample in samples {
            for (column, value) in columns.iter_mut().zip(phase(sample)) {
                column.push(value);
            }
        }
        let [total, compile, preprocess, trace, shade, other] = columns.map(|column| of_phase(&column));
        Self { total, compile, preprocess, trace, shade, other }
    }
}

/// Milliseconds of all repetitions of a run.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Times {
    /// The middle repetition, the lower one of two middle ones: its phases sum to its total.
    pub(crate) middle: ByPhase<f64>,
    /// Its time on processors, all threads together; null where the system does not tell.
    pub(crate) middle_processor: ByPhase<Option<f64>>,
    /// How each phase is spread over the repetitions, by itself.
    pub(crate) spread: ByPhase<Spread>,
}

impl Times {
    /// The times of at least one repetition.
    pub(crate) fn of(samples: &[Sample]) -> Self {
        let mut sorted = samples.to_vec();
        sorted.sort_by(|one, other| one.total.wall.total_cmp(&other.total.wall));
        let middle = [sorted[(sorted.len() - 1) / 2]];
        Self {
            middle: ByPhase::of(&middle, |walls: &[f64]| walls[0], walls),
            middle_processor: ByPhase::of(&middle, |costs: &[Option<f64>]| costs[0], processors),
            spread: ByPhase::of(samples, Spread::of, walls),
        }
    }
}

fn walls(sample: &Sample) -> [f64; 6] {
    let PhaseCosts { compile, preprocess, trace, shade } = sample.phases;
    let [total, compile, preprocess, trace, shade] =
        [sample.total, compile, preprocess, trace, shade].map(|cost| cost.wall);
    [total, compile, preprocess, trace, shade, sample.other()]
}

fn processors(sample: &Sample) -> [Option<f64>; 6] {
    let PhaseCosts { compile, preprocess, trace, shade } = sample.phases;
    let costs = [compile, preprocess, trace, shade];
    let total = sample.total.processor;
    let known: Option<f64> = costs.iter().map(|cost: &Cost| cost.processor).sum();
    let other = total.zip(known).map(|(total, known)| total - known);
    let [compile, preprocess, trace, shade] = costs.map(|cost| cost.processor);
    [total, compile, preprocess, trace, shade, other]
}
