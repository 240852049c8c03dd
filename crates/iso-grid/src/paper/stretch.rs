//! What of a ray is to be sampled, and how closely.

use glam::DVec3;

use crate::Span;

/// A part of a ray, to be sampled in equal steps, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    /// The part of the ray.
    pub(crate) span: Span,
    /// How many steps, at least 1.
    pub(crate) steps: u32,
    /// How long a step is, in t.
    width: f64,
}

impl Stretch {
    /// Where the sample after `step` steps is.
    pub(crate) fn sample(&self, step: u32) -> f64 {
        let Span { start, end } = self.span;
        if step == self.steps {
            end
        } else {
            start + (end - start) * (f64::from(step) / f64::from(self.steps))
        }
    }
}

/// The parts of a ray that a method samples, from the nearest to the farthest.
pub(crate) trait Stretches: Iterator<Item = Stretch> {
    /// How many cells were walked through so far.
    fn steps(&self) -> u64;
}

/// How far samples may lie from each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spacing {
    distance: f64,
    most_steps: f64,
}

impl Spacing {
    /// Samples no more than `step` times `side` apart, along stretches not longer than the diagonal of a cube whose side
    /// is `sides` times `side`.
    pub(crate) fn new(step: f64, side: f64, sides: f64) -> Self {
        Self { distance: step * side, most_steps: (3_f64.sqrt() * sides / step).ceil() + 1.0 }
    }

    /// The span of a ray that moves by `direction` as t grows by 1, to be sampled this closely.
    pub(crate) fn stretch(&self, direction: DVec3, span: Span) -> Stretch {
        let distances = ((span.end - span.start) * direction / self.distance).length();
        // A region too small for doubles to measure gives no number here, and one step.
        let steps = if distances > 1.0 { distances.ceil().min(self.most_steps) as u32 } else { 1 };
        Stretch { span, steps, width: (span.end - span.start) / f64::from(steps) }
    }
}
