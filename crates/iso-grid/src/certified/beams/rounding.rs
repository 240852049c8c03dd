//! Bounds of what rounding does to F.

use glam::DVec3;
use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decorated, Decoration, Interval, Program};

use super::beam::Beam;
use super::form::ROUNDING;
use super::subdivision::Subdivision;
use crate::{Kernel, Span};

/// How many times its size a box for which rounding is bounded grows at each side at most, so that it holds neighbours too.
pub(super) const AROUND: f64 = 3.0;

/// How many times as much it grows after a larger box did, and less after one that did not.
const GROWTH: f64 = 1.25;

/// So many of the last boxes are remembered: rays come back to places in front of and behind others.
const KEPT: usize = 16;

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
    /// What rounding does to F on a box, if that is bounded: by a bound on a larger box that neighbours share, if there is one that
    /// will do for this beam, or by one of its own.
    pub(super) fn rounding(
        &mut self,
        (beam, kernels): (u32, u32),
        (lo, hi): (DVec3, DVec3),
        will_do: impl Fn(&Rounding, &Beam) -> bool,
    ) -> Option<Rounding> {
        let function = self.kernels(kernels).identity();
        let is_known = |known: &&Rounding| known.covers(function, lo, hi) && will_do(known, self.beam(beam));
        if let Some(known) = self.memory.roundings.iter().rev().find(is_known) {
            return Some(*known);
        }
        // It holds for the function wherever that is anything to F.
        let (region, room) = (&self.certified.region, self.memory.room * (hi - lo));
        let around = ((lo - room).max(region.min()).min(lo), (hi + room).min(region.max()).max(hi));
        let [around, own] = self.roundings(kernels, [around, (lo, hi)])?;
        let around = around.filter(|around| will_do(around, self.beam(beam)));
        self.memory.room = match around {
            Some(_) => AROUND.min(GROWTH * self.memory.room),
            None => self.memory.room / GROWTH,
        };
        let found = around.or(own)?;
        let known = &mut self.memory.roundings;
        if known.len() == KEPT {
            known.remove(0);
        }
        known.push(found);
        Some(found)
    }

    /// What rounding does to F on two boxes, which take no longer than one.
    fn roundings(&mut self, kernels: u32, corners: [(DVec3, DVec3); 2]) -> Option<[Option<Rounding>; 2]> {
        let function = self.kernels(kernels).identity();
        let bounds = corners.map(|(lo, hi)| {
            let sides = outwards(lo, hi);
            (DVec3::from_array(sides.map(|side| side.lo)), DVec3::from_array(sides.map(|side| side.hi)))
        });
        let found: [[Decorated; 5]; 2] = self.enclose_all(kernels, Kernel::RoundingBounds, bounds)?;
        let rounding = |place: usize| {
            let ((lo, hi), [value, bounds @ ..]) = (corners[place], found[place]);
            let is_known = value.decoration == Decoration::Common
                && bounds.iter().all(|bound| bound.decoration >= Decoration::Defined);
            let [of_values, gradient @ ..] = bounds.map(|bound| bound.interval.magnitude());
            let gradient = DVec3::from_array(gradient);
            let is_bounded = is_known && of_values.is_finite() && gradient.is_finite();
            is_bounded.then_some(Rounding { function, lo, hi, of_values, gradient })
        };
        Some([0, 1].map(rounding))
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
    use std::sync::Arc;

    use iso_expr::{Ast, Interpreter};

    use super::*;
    use crate::{Certified, Outcomes, Raster, Region, Surface, Tile, Workspace};

    /// exp(40x) is 1 at 0, but up to e⁸ on a box that is only 0.4 wide.
    #[test]
    fn a_larger_box_is_shared_where_it_will_do_and_grows_no_larger_than_that() {
        let program = Ast::parse("exp(40x) - y").unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let certified =
            Certified::new(&surface, Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap()).unwrap();
        let (right, down) = (0.02 * DVec3::X, 0.02 * DVec3::Y);
        let raster = Raster::Parallel { middle: 4.0 * DVec3::Z, right, down, direction: DVec3::NEG_Z };
        let tile = Tile::of(&raster, [-2.0, -2.0], 4, 4);
        let (mut workspace, mut outcomes) = (Workspace::default(), Outcomes::default());
        let mut subdivision =
            Subdivision::new(&certified, &mut workspace, tile, (&mut outcomes, None)).unwrap();
        let size = 0.05 * DVec3::ONE;
        let at = |x: f64| (x * DVec3::X - size, x * DVec3::X + size);
        let runs = |subdivision: &Subdivision<'_>| subdivision.workspace.counters.box_evaluations / 2;

        // Any bound will do: the box around also holds what is beside the one that was asked for.
        let wide = subdivision.rounding((0, 0), at(0.0), |_, _| true).unwrap();
        assert!(wide.covers(wide.function, at(-0.1).0, at(0.1).1));
        subdivision.rounding((0, 0), at(0.1), |_, _| true).unwrap();
        assert_eq!(runs(&subdivision), 1);

        // That is too much for some: then it is the box itself, and the next box around is smaller.
        let is_little = |bound: &Rounding, _: &Beam| bound.of_values < 100.0;
        let own = subdivision.rounding((0, 0), at(0.0), is_little).unwrap();
        assert!(own.of_values < 100.0 && wide.of_values > 1000.0);
        assert_eq!((own.lo, own.hi), at(0.0));
        assert!(subdivision.memory.room < AROUND);
        assert_eq!(runs(&subdivision), 2);

        // It is remembered, too, and found behind one that came after it.
        subdivision.rounding((0, 0), at(-0.5), |_, _| true).unwrap();
        subdivision.rounding((0, 0), at(0.0), is_little).unwrap();
        assert_eq!(runs(&subdivision), 3);

        for _ in 0..60 {
            subdivision.memory.roundings.clear();
            let shared = subdivision.rounding((0, 0), at(0.0), is_little).unwrap();
            assert!(shared.of_values < 100.0);
        }
        // With r boxes more at each side, exp(40x) is up to e²⁺⁴ʳ, of which a few come to 100 where r is a quarter.
        assert!((0.15..0.4).contains(&subdivision.memory.room), "{}", subdivision.memory.room);
    }

    #[test]
    fn a_bound_holds_for_its_own_function_inside_its_own_box() {
        let (lo, hi) = (DVec3::NEG_ONE, DVec3::ONE);
        let bound = Rounding { function: 3, lo, hi, of_values: 1.0, gradient: DVec3::ONE };
        assert!(bound.covers(3, lo, hi) && bound.covers(3, 0.5 * lo, 0.5 * hi));
        assert!(!bound.covers(2, lo, hi), "another function");
        assert!(!bound.covers(3, lo, hi + 1e-9 * DVec3::Z) && !bound.covers(3, lo - 1e-9 * DVec3::X, hi));
    }
}
