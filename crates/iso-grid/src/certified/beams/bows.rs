//! First roots along rays on which F bends one way, or is monotone.
//!
//! All is written for F that bends upwards, or else for −F. Then F has no more than two roots in the part: one where it falls,
//! which is the first, and one where it rises, before which F is negative back to the first.

use iso_expr::Interval;
use pulp::Simd;

use super::bend::Bend;
use super::course::{Course, ways};
use super::form::{Ball, ROUNDING};
use super::pixels::{Pixels, Verdict, state};
use crate::Span;
use crate::lanes::{Lanes, Mask};

/// What is known of F all over a part.
pub(super) struct Bow {
    /// Where the part's expansion is centred.
    pub(super) t: f64,
    /// Where the part's certificate holds inside the region.
    reach: Span,
    /// How far the slope of a ray there may be off.
    pub(super) slope_error: f64,
    /// −1 where this is said of −F, or else 1.
    pub(super) sign: f64,
    /// Second derivatives along rays, their middle, half their width, and the largest size; these two are more than what underflow may cost.
    pub(super) curvature: Interval,
    pub(super) middle: f64,
    pub(super) spread: f64,
    pub(super) most: f64,
    /// Twice the least second derivative, and a little less; zero where F does not bend upwards everywhere.
    pub(super) twice_least: f64,
    /// The slopes along rays, where they are all of one sign.
    slopes: Option<Interval>,
    /// How far a value of F may be off.
    pub(super) error: f64,
    /// How wide the enclosure of a root may be.
    tolerance: f64,
}

impl Bow {
    /// What helps to find roots where F is as `bend` says on `reach`, with slopes in `slope`, and values are off by no more than `error`; `None` if
    /// F neither bends one way nor is monotone. Brackets are to be as narrow as `tolerance`.
    pub(super) fn new((bend, reach): (&Bend, Span), slope: Ball, error: f64, tolerance: f64) -> Option<Self> {
        let slopes = slope.excludes_zero().then(|| slope.interval());
        let Interval { lo, hi } = bend.curvature;
        if slopes.is_none() && lo <= 0.0 && hi >= 0.0 {
            return None;
        }
        let sign = if lo + hi < 0.0 { -1.0 } else { 1.0 };
        let signed = |interval: Interval| if sign < 0.0 { interval.negated() } else { interval };
        let curvature = signed(bend.curvature);
        error.is_finite().then(|| Self {
            t: bend.t,
            reach,
            slope_error: bend.slope_error,
            sign,
            curvature,
            middle: 0.5 * (curvature.lo + curvature.hi),
            spread: (1.0 + ROUNDING) * 0.5 * (curvature.hi - curvature.lo) + f64::MIN_POSITIVE,
            most: curvature.magnitude() + f64::MIN_POSITIVE,
            twice_least: (2.0 - 16.0 * ROUNDING) * curvature.lo.max(0.0),
            slopes: slopes.map(signed),
            error: error + f64::MIN_POSITIVE,
            tolerance,
        })
    }

    /// Whether F may have another root behind one before which it has this sign.
    pub(super) fn turns_after(&self, sign: f64) -> bool {
        !self.is_monotone() && sign * self.sign > 0.0
    }

    /// Whether F is monotone along every ray.
    pub(super) fn is_monotone(&self) -> bool {
        self.slopes.is_some()
    }

    /// The sign of the slope at a first root.
    #[inline(always)]
    pub(super) fn first_side(&self) -> f64 {
        self.slopes.map_or(-1.0, |slopes| slopes.lo.signum())
    }

    /// The signs of slopes at the roots that are wanted, where rays start below zero or not.
    #[inline(always)]
    fn side<S: Simd>(&self, starts_below: Mask<S>, like: Lanes<S>) -> Lanes<S> {
        let first = like.all_be(self.first_side());
        if self.is_monotone() { first } else { starts_below.select(like.all_be(1.0), first) }
    }

    /// The nearest t at which F may be taken.
    #[inline(always)]
    pub(super) fn in_reach<S: Simd>(&self, t: Lanes<S>) -> Lanes<S> {
        t.between(t.all_be(self.reach.start), t.all_be(self.reach.end))
    }
}

impl Pixels {
    /// What F and its slope at t, or where the part's expansion is centred, say of the roots that are wanted.
    #[inline(always)]
    pub(super) fn judge<S: Simd>(
        &self,
        (simd, part): (S, usize),
        mut course: Course<S>,
        bow: &Bow,
    ) -> Verdict<S> {
        let all = |number| Lanes::all(simd, number);
        let (zero, one, sign) = (all(0.0), all(1.0), all(bow.sign));
        let (t, wanted) = (self.t(simd, part), self.wanted(simd, part));
        let mut starts_below = Lanes::of(simd, &self.known.starts_below, part);
        course.slope_error = course.slope_error + all(ROUNDING) * (course.slope.abs() + course.slope_error);
        let stays_above = course.stays_above(bow);
        if let Some(slopes) = bow.slopes {
            course.narrow(slopes);
        }
        // What bends upwards is negative between two places where it is.
        let is_negative = (course.value + course.value_error).is_less(zero);
        let stays_below = zero.is_less(starts_below) & wanted[1].is_at_most(t) & is_negative;

        let [from, to] = ways(wanted, t);
        let discriminant = course.discriminant(bow);
        let has_root = if bow.is_monotone() { zero.is_same(zero) } else { zero.is_less(discriminant) };
        let mut side = bow.side(zero.is_less(starts_below), t);
        let mut way = course.way(discriminant, side, bow);
        let is_within = has_root & from.is_at_most(way) & way.is_at_most(to);
        let sign_there = is_within.select(zero, course.sign_between([from, to], bow));
        if !bow.is_monotone() {
            let is_before = has_root & way.is_less(from) & starts_below.is_same(zero);
            let turns = is_before & course.is_negative_at(from, bow);
            let second = course.way(discriminant, one, bow);
            way = turns.select(second, is_before.select(from, way));
            starts_below = turns.select(one, starts_below);
            side = bow.side(zero.is_less(starts_below), t);
        }

        let found = self.enclose((simd, part), &course, (way, side), bow);
        let next = bow.in_reach(t + way);
        let moves = next.is_less(t) | t.is_less(next);
        let state = moves.select(all(state::OPEN), all(state::LOST));
        let (is_enclosed, enclosed) = (has_root & found.is_enclosed, found.state);
        let is_hit = is_enclosed & enclosed.is_same(all(state::HIT));
        let is_told = zero.is_less(sign_there.abs());
        let is_free = stays_above | stays_below | is_told;
        let told = is_told.select(sign_there * sign, -side * sign);
        Verdict {
            state: is_free.select(all(state::FREE), is_enclosed.select(enclosed, state)),
            sign: stays_above.select(sign, stays_below.select(-sign, told)),
            t: is_hit.select((t + way).between(found.root[0], found.root[1]), next),
            wanted: [is_hit.select(found.root[0], wanted[0]), is_hit.select(found.root[1], wanted[1])],
            starts_below,
        }
    }

    /// The roots in these ways from t, on these sides, where they are enclosed well enough: by the interval Newton method on as much
    /// of the reach as it needs.
    #[inline(always)]
    fn enclose<S: Simd>(
        &self,
        (simd, part): (S, usize),
        course: &Course<S>,
        (way, side): (Lanes<S>, Lanes<S>),
        bow: &Bow,
    ) -> Enclosed<S> {
        let all = |number| Lanes::all(simd, number);
        let (rounding, more) = (all(ROUNDING), all(1.0 + ROUNDING));
        let Course { value, value_error, slope, slope_error } = *course;
        let (t, wanted) = (self.t(simd, part), self.wanted(simd, part));
        let steep = slope.abs();
        let window = all(1.25) * way.abs() + all(2.0) * value_error / steep + rounding * t;
        // All slopes in the window are of one sign, and those of chords from t within it are closer to that at t.
        let changes = window * all(bow.most);
        let is_simple = (more * (slope_error + changes)).is_less(side * slope);
        let off = slope_error + all(0.5) * changes;
        let least = all(1.0 - ROUNDING) * (steep - off);
        let offset = value / slope;
        let radius = more * (offset.abs() * off + value_error) / least + rounding * (t + offset.abs());
        let is_narrow = (radius + radius).is_at_most(all(bow.tolerance));
        let root = [t - offset - radius, t - offset + radius];
        let is_free = wanted[1].is_less(root[0]);
        let is_lost = root[0].is_less(all(bow.reach.start))
            | all(bow.reach.end).is_less(root[1])
            | root[1].is_less(wanted[0]);
        let otherwise = is_lost.select(all(state::LOST), all(state::HIT));
        Enclosed {
            is_enclosed: is_simple & (offset.abs() + radius).is_at_most(window) & is_narrow,
            state: is_free.select(all(state::FREE), otherwise),
            root,
        }
    }
}

/// What encloses roots, where it is narrow enough, and what that means.
struct Enclosed<S: Simd> {
    is_enclosed: Mask<S>,
    state: Lanes<S>,
    root: [Lanes<S>; 2],
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;
    use crate::Tile;
    use crate::certified::beams::packet::{Packet, for_all};
    use crate::certified::beams::pixels::End;

    /// A function that bends as x² does, or its negative.
    fn bow(sign: f64) -> Bow {
        Bow {
            t: 1.0,
            reach: Span { start: 0.8, end: 1.2 },
            slope_error: 1e-3,
            sign,
            curvature: Interval { lo: 1.9, hi: 2.1 },
            middle: 2.0,
            spread: 0.1,
            most: 2.1,
            twice_least: 3.79,
            slopes: None,
            error: 1e-15,
            tolerance: 1e-12,
        }
    }

    /// What follows where the function, or its negative, has a value in the middle and is level there.
    fn judged(value: f64, bow: &Bow) -> Option<End> {
        let simd = Scalar::new();
        let [value, slope, error] = [value, 0.0, 1e-3].map(|number| Lanes::all(simd, number));
        let course = Course { value, value_error: error, slope, slope_error: error };
        let ray = [crate::Ray { origin: glam::DVec3::ZERO, direction: glam::DVec3::X }];
        let mut packet = Packet::default();
        packet.push(0, (0, 0));
        let rays = packet.rays(simd, &Tile::from(&ray[..]));
        let mut pixels = Pixels::new(packet, rays, for_all(Span { start: 0.9, end: 1.1 }), bow);
        let verdict = pixels.judge((simd, 0), course, bow);
        pixels.follow((simd, 0), &verdict);
        pixels.ends().map(|(_, end)| end).next()
    }

    #[test]
    fn the_sign_is_known_where_there_is_no_root() {
        for sign in [1.0, -1.0] {
            for value in [1.0, -1.0] {
                let Some(End::Free(found)) = judged(value, &bow(sign)) else { panic!("{value}, {sign}") };
                assert_eq!(found, value * sign);
            }
        }
    }

    /// F bends so little that squares of slopes are but two of the least doubles, and all roundings are to its advantage: it dips below zero.
    #[test]
    fn nothing_is_said_of_signs_where_products_underflow() {
        let all = |number| Lanes::all(Scalar::new(), number);
        // Twice a least second derivative like this has no room for anything less.
        let least = 2_f64.powi(-1034);
        let twice_least = (2.0 - 16.0 * ROUNDING) * least;
        assert_eq!(twice_least, 2.0 * least);
        let bow = |twice_least: f64| Bow { twice_least, ..bow(1.0) };
        // Two roundings to even: the value is half a double less, and the slope half a double more.
        let (value, slope, half) = (1.5, 1.5_f64.sqrt(), 0.5 * f64::EPSILON);
        assert_eq!([value - half, slope + half], [value, slope]);
        let [value_there, slope_there] = [value, slope].map(|number| (number / half) as u128);
        assert!((slope_there + 1).pow(2) > (value_there - 1) << 53, "F is negative where it is least");
        let course = |scale: f64| Course {
            value: all(value * scale),
            value_error: all(half * scale),
            slope: all(slope * 2_f64.powi(-537)),
            slope_error: all(half * 2_f64.powi(-537)),
        };
        let scale = 2_f64.powi(-41);
        assert!(!course(scale).stays_above(&bow(twice_least)).is_any());
        // Farther above zero it is certain.
        assert!(course(2_f64.powi(12)).stays_above(&bow(twice_least)).is_any());
    }

    /// It falls no farther than the square of its slope over twice its bending.
    #[test]
    fn what_bends_upwards_stays_above_zero_by_more_than_its_errors() {
        let stays_above = |numbers: [f64; 4]| {
            let [value, value_error, slope, slope_error] =
                numbers.map(|number| Lanes::all(Scalar::new(), number));
            Course { value, value_error, slope, slope_error }.stays_above(&bow(1.0)).is_any()
        };
        for slope in [0.05, -0.05] {
            assert!(stays_above([1e-3, 1e-4, slope, 1e-3]));
            assert!(!stays_above([6e-4, 1e-4, slope, 1e-3]), "it is lower");
            assert!(!stays_above([1e-3, 4e-4, slope, 1e-3]), "its value may be off by more");
            assert!(!stays_above([1e-3, 1e-4, slope, 1e-2]), "its slope may be off by more");
        }
    }
}
