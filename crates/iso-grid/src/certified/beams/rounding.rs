//! Bounds of what rounding does to F.

use glam::DVec3;
use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decorated, Decoration, Interval, Program};

use super::beam::Beam;
use super::form::ROUNDING;
use super::subdivision::Subdivision;
use crate::{Kernel, Span};

/// How many times its size a box for which rounding is bounded grows at each side, so that it holds neighbours too.
const AROUND: f64 = 1.5;

/// So many of the last boxes are remembered: rays come back to places in front of and behind others.
const KEPT: usize = 8;

/// What rounding does to F on a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// The [identity](Kernels::identity) of the function whose values are meant.
    function: usize,
    lo: DVec3,
    hi: DVec3,
    /// By how many [units](Program::ROUNDING_UNIT) a value at a point may be off.
    of_values: f64,
    /// What no derivative exceeds.
    gradient: DVec3,
}

impl Rounding {
    fn covers(&self, function: usize, lo: DVec3, hi: DVec3) -> bool {
        self.function == function && self.lo.cmple(lo).all() && hi.cmple(self.hi).all()
    }

    /// How far F computed at a computed point of one of the beam's rays may be from F at the point itself.
    pub(super) fn error(&self, beam: &Beam, reach: Span) -> f64 {
        let way = reach.end * beam.directions.size;
        let points = self.gradient.dot(way + self.lo.abs().max(self.hi.abs()) + f64::MIN_POSITIVE);
        (1.0 + ROUNDING) * Program::ROUNDING_SLACK * Program::ROUNDING_UNIT * (self.of_values + points)
    }
}

impl Subdivision<'_> {
    /// What rounding does to F on a box and around it, if that is bounded: neighbouring parts share it.
    pub(super) fn rounding_around(&mut self, kernels: u32, (lo, hi): (DVec3, DVec3)) -> Option<Rounding> {
        let function = self.kernels(kernels).identity();
        let known = &self.memory.roundings;
        if let Some(known) = known.iter().rev().find(|known| known.covers(function, lo, hi)) {
            return Some(*known);
        }
        // It holds for the function wherever that is anything to F.
        let (region, room) = (&self.certified.region, AROUND * (hi - lo));
        let around = [(lo - room).max(region.min()), (hi + room).min(region.max())];
        let found = self.rounding(kernels, (around[0].min(lo), around[1].max(hi)))?;
        let known = &mut self.memory.roundings;
        if known.len() == KEPT {
            known.remove(0);
        }
        known.push(found);
        Some(found)
    }

    /// What rounding does to F on a box.
    pub(super) fn rounding(&mut self, kernels: u32, (lo, hi): (DVec3, DVec3)) -> Option<Rounding> {
        let sides = outwards(lo, hi);
        let corners = [sides.map(|side| side.lo), sides.map(|side| side.hi)].map(DVec3::from_array);
        let [value, bounds @ ..]: [Decorated; 5] =
            self.enclose_one(kernels, Kernel::RoundingBounds, (corners[0], corners[1]))?;
        let is_known = value.decoration == Decoration::Common
            && bounds.iter().all(|bound| bound.decoration >= Decoration::Defined);
        let [of_values, gradient @ ..] = bounds.map(|bound| bound.interval.magnitude());
        let gradient = DVec3::from_array(gradient);
        let function = self.kernels(kernels).identity();
        let found = Rounding { function, lo, hi, of_values, gradient };
        let is_bounded = is_known && found.of_values.is_finite() && gradient.is_finite();
        is_bounded.then_some(found)
    }
}

/// The sides of a box in which points of rays lie as they are computed, two doubles larger at each side.
///
/// A point is computed by two roundings. That of the product is made up for by [`Beam::bounds_in_space`], or at a face of the region by two
/// roundings of t, by which [`Clip::inner`](crate::certified::clip::Clip::inner) keeps away from it; that of the sum is less than a double.
pub(super) fn outwards(lo: DVec3, hi: DVec3) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval { lo: round_down(round_down(lo[axis])), hi: round_up(round_up(hi[axis])) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_holds_for_its_own_function_inside_its_own_box() {
        let (lo, hi) = (DVec3::NEG_ONE, DVec3::ONE);
        let bound = Rounding { function: 3, lo, hi, of_values: 1.0, gradient: DVec3::ONE };
        assert!(bound.covers(3, lo, hi) && bound.covers(3, 0.5 * lo, 0.5 * hi));
        assert!(!bound.covers(2, lo, hi), "another function");
        assert!(!bound.covers(3, lo, hi + 1e-9 * DVec3::Z) && !bound.covers(3, lo - 1e-9 * DVec3::X, hi));
    }
}
