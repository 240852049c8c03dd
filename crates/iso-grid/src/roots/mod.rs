//! Narrowing the interval between two samples of unlike sign down to a root.

mod bisection;
mod bracket;
mod itp;
mod newton;
#[cfg(test)]
mod tests;

pub(crate) use bracket::{Bracket, Sample};

use crate::GridError;
use crate::sign::Signs;
use itp::Itp;
use newton::Newton;

/// How the sampling methods choose the next point inside an interval that holds a change of sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RootFinder {
    /// Halve the interval, as the paper does.
    #[default]
    Bisection,
    /// Interpolate, truncate and project (Oliveira and Takahashi, 'An enhancement of the bisection method average performance
    /// preserving minmax optimality', ACM Transactions on Mathematical Software 47, 2020): about as fast as the secant method
    /// where F is smooth, and hardly ever slower than bisection.
    Itp,
    /// Follow the derivative of F along the ray, and halve the interval where that does not shorten it soon. Each step costs a
    /// gradient.
    Newton,
}

impl RootFinder {
    /// All root finders.
    pub const ALL: [Self; 3] = [Self::Bisection, Self::Itp, Self::Newton];

    /// The root finder's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bisection => "bisection",
            Self::Itp => "itp",
            Self::Newton => "newton",
        }
    }
}

/// A root finder, and how far it goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RootFinding {
    /// How the next point is chosen.
    pub finder: RootFinder,
    /// The width, relative to t, to which the interval around a root is narrowed: from 0 to 1. At 0, its ends are neighbouring
    /// doubles.
    pub tolerance: f64,
}

impl RootFinding {
    /// The paper's: bisection, down to neighbouring doubles.
    pub const PAPER: Self = Self { finder: RootFinder::Bisection, tolerance: 0.0 };

    /// Checks that the tolerance is in range.
    pub(crate) fn check(&self) -> Result<(), GridError> {
        let given = self.tolerance;
        if (0.0..=1.0).contains(&given) { Ok(()) } else { Err(GridError::Tolerance { given }) }
    }
}

/// An interval on its way to a root.
#[derive(Clone, Copy)]
pub(crate) struct Narrowing {
    bracket: Bracket,
    /// The distance between the samples that the interval began as.
    step: f64,
    tolerance: f64,
    way: Way,
}

/// What a root finder remembers from point to point.
#[derive(Clone, Copy)]
enum Way {
    Bisection,
    Itp(Itp),
    Newton(Newton),
}

impl Narrowing {
    pub(crate) fn new(roots: RootFinding, bracket: Bracket) -> Self {
        let narrowing =
            Self { bracket, step: bracket.width(), tolerance: roots.tolerance, way: Way::Bisection };
        let way = match roots.finder {
            RootFinder::Bisection => Way::Bisection,
            RootFinder::Itp => Way::Itp(Itp::new(narrowing.step, narrowing.goal())),
            RootFinder::Newton => Way::Newton(Newton::new(&bracket)),
        };
        Self { way, ..narrowing }
    }

    /// The interval as it is now.
    pub(crate) fn bracket(&self) -> Bracket {
        self.bracket
    }

    /// The distance between the samples that the interval began as.
    pub(crate) fn step(&self) -> f64 {
        self.step
    }

    /// Whether the slope of F along the ray is to be known beside its value.
    pub(crate) fn wants_slope(&self) -> bool {
        matches!(self.way, Way::Newton(_))
    }

    /// Where F is to be known next; `None` when the interval is as narrow as it was to be.
    pub(crate) fn next(&self) -> Option<f64> {
        let middle = bisection::next(&self.bracket)?;
        if self.tolerance > 0.0 && self.bracket.width() <= self.goal() {
            return None;
        }
        let chosen = match &self.way {
            Way::Bisection => middle,
            Way::Itp(itp) => itp.next(&self.bracket),
            Way::Newton(newton) => newton.next(&self.bracket, self.goal()),
        };
        // Rounding may lead to an end, and what F overflows to leads nowhere.
        Some(if self.bracket.contains_inside(chosen) { chosen } else { middle })
    }

    /// Keeps the part whose ends have unlike signs, given F at the point that was asked for and its slope there, if that was
    /// wanted. Says whether F has a sign there; where it has none, the interval stays.
    pub(crate) fn take(&mut self, sample: Sample, slope: f64) -> bool {
        if sample.signs() == Signs::NONE {
            return false;
        }
        self.bracket.keep(sample);
        match &mut self.way {
            Way::Bisection => {}
            Way::Itp(itp) => itp.count(),
            Way::Newton(newton) => newton.remember(sample, slope, &self.bracket),
        }
        true
    }

    /// The width at which the interval is narrow enough: that of neighbouring doubles at least.
    fn goal(&self) -> f64 {
        let farther = self.bracket.before.t.abs().max(self.bracket.after.t.abs());
        (self.tolerance * farther).max(farther.next_up() - farther)
    }
}
