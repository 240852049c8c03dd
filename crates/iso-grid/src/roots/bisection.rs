//! Bisection.

use super::Bracket;

/// The middle, unless the ends are neighbouring doubles.
pub(super) fn next(bracket: &Bracket) -> Option<f64> {
    let middle = bracket.before.t + 0.5 * bracket.width();
    bracket.contains_inside(middle).then_some(middle)
}
