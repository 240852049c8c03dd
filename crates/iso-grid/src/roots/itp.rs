//! The ITP method: interpolate, truncate, project.

use super::Bracket;

/// κ₁ of the paper's experiments, times the interval that the search begins with.
const TRUNCATION: f64 = 0.2;
/// n₀: points that may be asked for beyond those of bisection.
const SLACK: i32 = 1;

/// How many points the search may still take: it stays as close to the middle as that asks for.
///
/// Oliveira and Takahashi (2020), with κ₁ = 0.2/(b₀ − a₀), κ₂ = 2 and n₀ = 1, the values of their experiments.
#[derive(Clone, Copy)]
pub(super) struct Itp {
    /// b₀ − a₀.
    first_width: f64,
    /// 2ε.
    goal: f64,
    /// How many points are left: n_max − j.
    left: i32,
}

impl Itp {
    /// For an interval that is to be narrowed from `width` to `goal`.
    pub(super) fn new(width: f64, goal: f64) -> Self {
        Self { first_width: width, goal, left: (width / goal).log2().ceil().max(0.0) as i32 + SLACK }
    }

    pub(super) fn next(&self, bracket: &Bracket) -> f64 {
        let width = bracket.width();
        let middle = bracket.before.t + 0.5 * width;
        // Interpolation.
        let secant = bracket.secant();
        // Truncation: a little towards the middle, so that the zero comes to lie on the other side.
        // By less than the goal it would not be seen to.
        let shift = (TRUNCATION * width * (width / self.first_width)).max(0.75 * self.goal);
        let truncated =
            if shift <= (middle - secant).abs() { secant + shift.copysign(middle - secant) } else { middle };
        // Projection: no further from the middle than still ends in time.
        let radius = (0.5 * self.goal * 2_f64.powi(self.left) - 0.5 * width).max(0.0);
        if (truncated - middle).abs() <= radius {
            truncated
        } else {
            middle + radius.copysign(truncated - middle)
        }
    }

    /// One point more was asked for.
    pub(super) fn count(&mut self) {
        self.left -= 1;
    }
}
