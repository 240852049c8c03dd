//! F along rays side by side, near one place of each: where it bends.
//!
//! All is written for F that bends upwards, or else for −F.

use iso_expr::Interval;
use pulp::Simd;

use super::bows::Bow;
use super::form::ROUNDING;
use crate::lanes::{Lanes, Mask};

/// F and its derivatives along rays at some t of each, with bounds of how far they may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course<S: Simd> {
    pub(super) value: Lanes<S>,
    pub(super) value_error: Lanes<S>,
    pub(super) slope: Lanes<S>,
    pub(super) slope_error: Lanes<S>,
}

impl<S: Simd> Course<S> {
    /// Where F is positive all along a ray, as far as the part goes.
    #[inline(always)]
    pub(super) fn stays_above(&self, bow: &Bow) -> Mask<S> {
        let steepest = self.slope.abs() + self.slope_error;
        let risen = (self.value - self.value_error) * self.value.all_be(bow.twice_least);
        // Where the least second derivative is so small that `twice_least` has no room for roundings, both products underflow.
        (steepest * steepest).is_less(risen - self.value.all_be(f64::MIN_POSITIVE))
    }

    /// Leaves out what slopes are not.
    #[inline(always)]
    pub(super) fn narrow(&mut self, slopes: Interval) {
        let all = |number| self.slope.all_be(number);
        let lo = (self.slope - self.slope_error).at_least(all(slopes.lo));
        let hi = (self.slope + self.slope_error).at_most(all(slopes.hi));
        self.slope_error = all(0.5) * (hi - lo) + all(ROUNDING) * (lo.abs() + hi.abs());
        self.slope = all(0.5) * (lo + hi);
    }

    /// Where there may be no root after all, or none from the first to the last of these ways.
    #[inline(always)]
    pub(super) fn is_doubtful(&self, way: Lanes<S>, [from, to]: [Lanes<S>; 2], bow: &Bow) -> Mask<S> {
        let all = |number| way.all_be(number);
        let is_beyond = way.is_less(from) | to.is_less(way);
        if bow.is_monotone() {
            return is_beyond;
        }
        let error = self.slope.abs() * self.slope_error + all(bow.middle) * self.value_error;
        self.discriminant(bow).is_less(all(2.0) * error) | is_beyond
    }

    /// Of the parabolas through here: positive where they have roots.
    #[inline(always)]
    pub(super) fn discriminant(&self, bow: &Bow) -> Lanes<S> {
        self.slope * self.slope - self.value.all_be(2.0 * bow.middle) * self.value
    }

    /// How far the root on a side of each parabola is, or else a place where F may be seen to be positive.
    #[inline(always)]
    pub(super) fn way(&self, discriminant: Lanes<S>, side: Lanes<S>, bow: &Bow) -> Lanes<S> {
        let all = |number| side.all_be(number);
        let Self { value, slope, .. } = *self;
        let has_root = all(0.0).is_less(discriminant);
        let root = side * has_root.select(discriminant, all(0.0)).sqrt();
        let is_near = all(0.0).is_less(side * slope);
        let near = all(-2.0) * value / (slope + root);
        if bow.is_monotone() {
            return (has_root & is_near).select(near, -value / slope);
        }
        let far = (root - slope) / all(bow.middle);
        // There is a lowest point. Where that is all but here, another value nearby tells the slope.
        let lowest = -slope / all(bow.middle);
        let nearby = all(0.5) * (value.abs() / all(bow.middle)).sqrt();
        let beside = lowest.is_less(all(0.0)).select(-nearby, nearby);
        let without = lowest.abs().is_less(all(0.5) * nearby).select(beside, lowest);
        has_root.select(is_near.select(near, far), without)
    }

    /// Where F is certainly negative so far away.
    #[inline(always)]
    pub(super) fn is_negative_at(&self, way: Lanes<S>, bow: &Bow) -> Mask<S> {
        let all = |number| way.all_be(number);
        let is_behind = way.is_less(all(0.0));
        let slope = self.slope + is_behind.select(-self.slope_error, self.slope_error);
        let rise = way * (slope + all(0.5) * way * all(bow.curvature.hi));
        (self.value + self.value_error + rise + self.slack(way.abs(), bow)).is_less(all(0.0))
    }

    /// The sign of F from the first to the last of these ways, if it certainly is the same everywhere, or else 0.
    #[inline(always)]
    pub(super) fn sign_between(&self, [from, to]: [Lanes<S>; 2], bow: &Bow) -> Lanes<S> {
        let zero = from.all_be(0.0);
        let error = self.value_error + self.slack(from.abs().at_least(to.abs()), bow);
        let (lo, hi) = (self.slope - self.slope_error, self.slope + self.slope_error);
        let lowest = least(self.value - error, [lo, hi], bow.curvature.lo, [from, to]);
        let highest = least(-self.value - error, [-hi, -lo], -bow.curvature.hi, [from, to]);
        let is_below = zero.is_less(highest).select(zero.all_be(-1.0), zero);
        (self.stays_above(bow) | zero.is_less(lowest)).select(zero.all_be(1.0), is_below)
    }

    /// About how far the root is that is wanted first, if there is one on the parabola; infinite if it has none.
    #[inline(always)]
    pub(super) fn way_to_root(&self, bow: &Bow) -> Lanes<S> {
        let discriminant = self.discriminant(bow);
        let way = self.way(discriminant, self.value.all_be(bow.first_side()), bow);
        if bow.is_monotone() { way } else { if_there(discriminant, way) }
    }

    /// About how far the second root of the parabola is where it bends; infinite if it has none.
    #[inline(always)]
    pub(super) fn way_to_second_root(&self, bow: &Bow) -> Lanes<S> {
        let discriminant = self.discriminant(bow);
        if_there(discriminant, self.way(discriminant, self.value.all_be(1.0), bow))
    }

    /// What rounding comes to in what is said of F so far away.
    #[inline(always)]
    fn slack(&self, way: Lanes<S>, bow: &Bow) -> Lanes<S> {
        let steepest = self.slope.abs() + self.slope_error + way * way.all_be(bow.most);
        way.all_be(ROUNDING) * (self.value.abs() + way * steepest)
    }
}

/// Ways where there are roots, and infinite ones elsewhere.
#[inline(always)]
fn if_there<S: Simd>(discriminant: Lanes<S>, way: Lanes<S>) -> Lanes<S> {
    way.all_be(0.0).is_less(discriminant).select(way, way.all_be(f64::INFINITY))
}

/// How far the ends of a stretch are from `t`, and a little more, so that rounding leaves nothing out.
#[inline(always)]
pub(super) fn ways<S: Simd>([start, end]: [Lanes<S>; 2], t: Lanes<S>) -> [Lanes<S>; 2] {
    let more = t.all_be(ROUNDING) * (t + end);
    [start - t - more, end - t + more]
}

/// What no value of `value` + s·w + ½·`curvature`·w² is below for `from` ≤ w ≤ `to`, where s is the first of the slopes for w > 0
/// and the second for w < 0.
#[inline(always)]
fn least<S: Simd>(
    value: Lanes<S>,
    slopes: [Lanes<S>; 2],
    curvature: f64,
    [from, to]: [Lanes<S>; 2],
) -> Lanes<S> {
    let zero = value.all_be(0.0);
    let ahead = least_change(slopes[0], curvature, [from.at_least(zero), to]);
    let behind = least_change(slopes[1], curvature, [from, to.at_most(zero)]);
    let found = zero.is_at_most(to).select(ahead, value.all_be(f64::INFINITY));
    value + from.is_at_most(zero).select(behind.at_most(found), found)
}

/// The least of s·w + ½·`curvature`·w² for `from` ≤ w ≤ `to`.
#[inline(always)]
fn least_change<S: Simd>(slope: Lanes<S>, curvature: f64, [from, to]: [Lanes<S>; 2]) -> Lanes<S> {
    let half = slope.all_be(0.5 * curvature);
    if curvature > 0.0 {
        let way = (-slope / slope.all_be(curvature)).between(from, to);
        way * (slope + half * way)
    } else {
        (from * (slope + half * from)).at_most(to * (slope + half * to))
    }
}
