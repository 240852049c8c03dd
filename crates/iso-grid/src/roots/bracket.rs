//! An interval whose ends have unlike signs.

use crate::sign::Signs;
use crate::{Hit, Span};

/// F − C at a point of the ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) t: f64,
    pub(crate) value: f64,
}

impl Sample {
    pub(crate) fn signs(&self) -> Signs {
        Signs::of(self.value)
    }
}

/// An interval whose ends have unlike signs; the second end may be a zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bracket {
    pub(crate) before: Sample,
    pub(crate) after: Sample,
}

impl Bracket {
    pub(crate) fn width(&self) -> f64 {
        self.after.t - self.before.t
    }

    /// Whether a point lies between the ends.
    pub(crate) fn contains_inside(&self, t: f64) -> bool {
        self.before.t < t && t < self.after.t
    }

    /// The zero of the straight line through both ends.
    pub(crate) fn secant(&self) -> f64 {
        let [before, after] = [self.before.value.abs(), self.after.value.abs()];
        self.before.t + self.width() * (before / (before + after))
    }

    /// Moves one end to a sample between them that has a sign, so that the ends' signs stay unlike.
    pub(crate) fn keep(&mut self, sample: Sample) {
        if sample.signs() == self.before.signs() {
            self.before = sample;
        } else {
            self.after = sample;
        }
    }

    /// The root, where F − C is nearer to zero.
    pub(crate) fn hit(&self) -> Hit {
        let nearer = if self.before.value.abs() < self.after.value.abs() { self.before } else { self.after };
        Hit { t: nearer.t, bracket: Span { start: self.before.t, end: self.after.t } }
    }
}
