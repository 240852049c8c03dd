//! Newton's method inside an interval.

use super::{Bracket, Sample};

/// How many times further each point goes than the last one did, while all come to lie on the same side of the zero.
const FURTHER: f64 = 8.0;

/// Follows the slope from the last point, and goes a little further than it says: by the square of the step, as the error
/// of Newton's next point is of that order. So the zero comes to lie between the last point and the next one, and the whole
/// interval shrinks as fast as the error does. Where it did not halve with the last two points, it is bisected.
#[derive(Clone, Copy)]
pub(super) struct Newton {
    /// The width of the interval that the search began with.
    first_width: f64,
    /// At first there is none.
    last: Option<Last>,
    /// The widths of the interval after the last two points, the older one first.
    widths: [f64; 2],
    /// Whether the interval is to be bisected next.
    bisects: bool,
}

/// The last point, which is an end of the interval.
#[derive(Clone, Copy)]
struct Last {
    sample: Sample,
    slope: f64,
    /// Whether it is the first end, so that the zero lies behind it.
    is_before: bool,
    /// How many times further than by the square of the step to go.
    reach: f64,
}

impl Newton {
    pub(super) fn new(bracket: &Bracket) -> Self {
        let width = bracket.width();
        Self { first_width: width, last: None, widths: [f64::INFINITY, width], bisects: false }
    }

    /// The next point; none of the interval's where the slope leads out of it, or where it is to be bisected.
    pub(super) fn next(&self, bracket: &Bracket, goal: f64) -> f64 {
        if self.bisects {
            return f64::NAN;
        }
        let Some(Last { sample, slope, is_before, reach }) = self.last else { return bracket.secant() };
        let step = -sample.value / slope;
        let square = (step * (step / self.first_width)).abs();
        let further = reach * square.max(0.75 * goal);
        sample.t + step + if is_before { further } else { -further }
    }

    pub(super) fn remember(&mut self, sample: Sample, slope: f64, bracket: &Bracket) {
        let width = bracket.width();
        self.bisects = !self.bisects && width > 0.5 * self.widths[0];
        self.widths = [self.widths[1], width];
        let is_before = sample.t == bracket.before.t;
        let reach =
            self.last.filter(|last| last.is_before == is_before).map_or(1.0, |last| FURTHER * last.reach);
        self.last = Some(Last { sample, slope, is_before, reach });
    }
}
