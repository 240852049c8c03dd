//! First roots along single rays on which F bends one way, or is monotone.
//!
//! All is written for F that bends upwards, or else for −F. Then F has no more than two roots in the part: one where it falls,
//! which is the first, and one where it rises, before which F is negative back to the first.

use iso_expr::Interval;

use super::bend::{Bend, Course};
use super::form::{Ball, ROUNDING};
use super::pixels::{Pixel, Verdict};
use crate::{Ray, Span};

/// What is known of F along a ray that bends.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bowed {
    /// The slope where the part's expansion is centred.
    slope: f64,
    /// Where F was taken last, and its value there; NaN before the first.
    last_t: f64,
    last: f64,
    /// Whether F is negative where a root is wanted first.
    starts_below: bool,
}

/// What is known of F all over a part.
pub(super) struct Bow {
    /// Where the part's expansion is centred.
    t: f64,
    /// How far the slope of a ray there may be off.
    slope_error: f64,
    /// −1 where this is said of −F, or else 1.
    pub(super) sign: f64,
    /// Second derivatives along rays, their middle, half their width, and the largest size.
    curvature: Interval,
    middle: f64,
    spread: f64,
    most: f64,
    /// Twice the least second derivative, and a little less; zero where F does not bend upwards everywhere.
    twice_least: f64,
    /// The slopes along rays, where they are all of one sign.
    slopes: Option<Interval>,
    /// How far a value of F may be off.
    error: f64,
    /// How wide the enclosure of a root may be.
    tolerance: f64,
}

impl Bow {
    /// What helps to find roots where F is as `bend` says with slopes in `slope`, and values are off by no more than `error`; `None` if
    /// F neither bends one way nor is monotone. Brackets are to be as narrow as `tolerance`.
    pub(super) fn new(bend: &Bend, slope: Ball, error: f64, tolerance: f64) -> Option<Self> {
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
            slope_error: bend.slope_error,
            sign,
            curvature,
            middle: 0.5 * (curvature.lo + curvature.hi),
            spread: (1.0 + ROUNDING) * 0.5 * (curvature.hi - curvature.lo),
            most: curvature.magnitude(),
            twice_least: (2.0 - 16.0 * ROUNDING) * curvature.lo.max(0.0),
            slopes: slopes.map(signed),
            error,
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
}

impl Pixel {
    /// Learns from the `value` that was computed for F at t.
    #[inline]
    pub(super) fn look(&mut self, value: f64, bow: &Bow) -> Verdict {
        let value = bow.sign * value;
        if !value.is_finite() {
            return Verdict::Lost;
        }
        let Self { t, known, .. } = *self;
        let away = t - bow.t;
        let [slope, bending] = [known.slope, away * bow.middle];
        let mut course = Course {
            value,
            value_error: bow.error,
            slope: slope + bending,
            slope_error: bow.slope_error + away.abs() * bow.spread + ROUNDING * (slope.abs() + bending.abs()),
        };
        // The slope at t is the one from the last place to here, and half the way more of bending.
        let step = t - known.last_t;
        let [slope, bending] = [(value - known.last) / step, 0.5 * step * bow.middle];
        let slope_error = 0.5 * step.abs() * bow.spread
            + 2.0 * bow.error / step.abs()
            + ROUNDING * (slope.abs() + bending.abs());
        if slope_error < course.slope_error {
            (course.slope, course.slope_error) = (slope + bending, slope_error);
        }
        (self.known.last_t, self.known.last) = (t, value);
        self.judge(course, bow)
    }

    /// A ray on which F is `course` where the part's expansion is centred.
    #[inline]
    pub(super) fn starting(
        (place, ray): (usize, Ray),
        [wanted, reach]: [Span; 2],
        course: &Course,
        bow: &Bow,
    ) -> Self {
        let known = Bowed { slope: course.slope, last_t: f64::NAN, last: f64::NAN, starts_below: false };
        Self { place, ray, wanted, reach, t: bow.t, known }
    }

    /// What F and its slope at t say of the root that is wanted.
    #[inline]
    pub(super) fn judge(&mut self, mut course: Course, bow: &Bow) -> Verdict {
        course.slope_error += ROUNDING * (course.slope.abs() + course.slope_error);
        if course.stays_above(bow) {
            return Verdict::Free(bow.sign);
        }
        if let Some(slopes) = bow.slopes {
            course.narrow(slopes);
        }
        let t = self.t;
        // What bends upwards is negative between two places where it is.
        if self.known.starts_below && t >= self.wanted.end && course.value + course.value_error < 0.0 {
            return Verdict::Free(-bow.sign);
        }
        let [from, to] = ways(self.wanted, t);
        let discriminant = course.discriminant(bow);
        let has_root = discriminant > 0.0 || bow.slopes.is_some();
        let mut way = course.way(discriminant, self.side(bow), bow);
        if !(has_root && from <= way && way <= to) {
            if let Some(sign) = course.sign_between([from, to], bow) {
                return Verdict::Free(sign * bow.sign);
            }
            if bow.slopes.is_none() && discriminant > 0.0 && way < from && !self.known.starts_below {
                if course.is_negative_at(from, bow) {
                    self.known.starts_below = true;
                    way = course.way(discriminant, 1.0, bow);
                } else {
                    way = from;
                }
            }
        }
        if has_root && let Some(verdict) = self.enclose(&course, way, bow) {
            return verdict;
        }
        let next = (t + way).max(self.reach.start).min(self.reach.end);
        if next == t || !next.is_finite() {
            return Verdict::Lost;
        }
        self.t = next;
        Verdict::Open
    }

    /// The same, to be looked at first so far from where the part's expansion is centred, if that is known.
    pub(super) fn at_way(mut self, way: f64) -> Self {
        if way.is_finite() {
            self.t = (self.t + way).max(self.reach.start).min(self.reach.end);
        }
        self
    }

    /// The same where the root is wanted at which a function that bends rises again.
    pub(super) fn rising(mut self) -> Self {
        self.known.starts_below = true;
        self
    }

    /// The sign of F before the root that is wanted.
    pub(super) fn sign_before(&self, bow: &Bow) -> f64 {
        -self.side(bow) * bow.sign
    }

    /// The sign of the slope at the root that is wanted.
    fn side(&self, bow: &Bow) -> f64 {
        match bow.slopes {
            Some(slopes) => slopes.lo.signum(),
            None if self.known.starts_below => 1.0,
            None => -1.0,
        }
    }

    /// Ends with the root in the way from t, if it is enclosed well enough: by the interval Newton method on as much
    /// of the reach as it needs.
    #[inline]
    fn enclose(&mut self, course: &Course, way: f64, bow: &Bow) -> Option<Verdict> {
        let Course { value, value_error, slope, slope_error } = *course;
        let (t, side) = (self.t, self.side(bow));
        let steep = slope.abs();
        let window = 1.25 * way.abs() + 2.0 * value_error / steep + ROUNDING * t;
        // All slopes in the window are of one sign, and those of chords from t within it are closer to that at t.
        let changes = window * bow.most;
        let is_simple = side * slope > (1.0 + ROUNDING) * (slope_error + changes);
        let off = slope_error + 0.5 * changes;
        let least = (1.0 - ROUNDING) * (steep - off);
        let offset = value / slope;
        let radius =
            (1.0 + ROUNDING) * (offset.abs() * off + value_error) / least + ROUNDING * (t + offset.abs());
        if !(is_simple && offset.abs() + radius <= window && 2.0 * radius <= bow.tolerance) {
            return None;
        }
        let root = Span { start: t - offset - radius, end: t - offset + radius };
        if self.wanted.end < root.start {
            return Some(Verdict::Free(-side * bow.sign));
        }
        if root.start < self.reach.start || self.reach.end < root.end || root.end < self.wanted.start {
            return Some(Verdict::Lost);
        }
        self.t = (t + way).max(root.start).min(root.end);
        self.wanted = root;
        Some(Verdict::Hit)
    }
}

impl Course {
    /// Whether F is positive all along the ray, as far as the part goes.
    #[inline]
    fn stays_above(&self, bow: &Bow) -> bool {
        let steepest = self.slope.abs() + self.slope_error;
        (self.value - self.value_error) * bow.twice_least > steepest * steepest
    }

    /// Leaves out what the slope is not.
    #[inline]
    fn narrow(&mut self, slopes: Interval) {
        let lo = slopes.lo.max(self.slope - self.slope_error);
        let hi = slopes.hi.min(self.slope + self.slope_error);
        self.slope = 0.5 * (lo + hi);
        self.slope_error = 0.5 * (hi - lo) + ROUNDING * (lo.abs() + hi.abs());
    }

    /// Whether there may be no root after all, or none from the first to the last of these ways.
    pub(super) fn is_doubtful(&self, way: f64, [from, to]: [f64; 2], bow: &Bow) -> bool {
        let error = self.slope.abs() * self.slope_error + bow.middle * self.value_error;
        bow.slopes.is_none() && self.discriminant(bow) < 2.0 * error || way < from || to < way
    }

    /// Of the parabola through here: positive if it has roots.
    #[inline]
    fn discriminant(&self, bow: &Bow) -> f64 {
        self.slope * self.slope - 2.0 * bow.middle * self.value
    }

    /// How far the root on a side of the parabola is, or else a place where F may be seen to be positive.
    #[inline]
    fn way(&self, discriminant: f64, side: f64, bow: &Bow) -> f64 {
        let Self { value, slope, .. } = *self;
        if discriminant > 0.0 {
            let root = side * discriminant.sqrt();
            if side * slope > 0.0 {
                -2.0 * value / (slope + root)
            } else if bow.slopes.is_none() {
                (root - slope) / bow.middle
            } else {
                -value / slope
            }
        } else if bow.slopes.is_some() {
            -value / slope
        } else {
            // There is a lowest point. Where that is all but here, another value nearby tells the slope.
            let lowest = -slope / bow.middle;
            let near = 0.5 * (value.abs() / bow.middle).sqrt();
            if lowest.abs() < 0.5 * near { near.copysign(lowest) } else { lowest }
        }
    }

    /// Whether F is certainly negative so far away.
    fn is_negative_at(&self, way: f64, bow: &Bow) -> bool {
        let slope = self.slope + self.slope_error.copysign(way);
        let rise = way * (slope + 0.5 * way * bow.curvature.hi);
        self.value + self.value_error + rise + self.slack(way.abs(), bow) < 0.0
    }

    /// The sign of F from the first to the last of these ways, if it certainly is the same everywhere.
    #[inline]
    pub(super) fn sign_between(&self, [from, to]: [f64; 2], bow: &Bow) -> Option<f64> {
        if self.stays_above(bow) {
            return Some(1.0);
        }
        let error = self.value_error + self.slack(from.abs().max(to.abs()), bow);
        let (lo, hi) = (self.slope - self.slope_error, self.slope + self.slope_error);
        if least(self.value - error, [lo, hi], bow.curvature.lo, [from, to]) > 0.0 {
            return Some(1.0);
        }
        let is_below = least(-self.value - error, [-hi, -lo], -bow.curvature.hi, [from, to]) > 0.0;
        is_below.then_some(-1.0)
    }

    /// About how far the root is that is wanted first, if there is one on the parabola; infinite if it has none.
    pub(super) fn way_to_root(&self, bow: &Bow) -> f64 {
        let discriminant = self.discriminant(bow);
        let side = bow.slopes.map_or(-1.0, |slopes| slopes.lo.signum());
        let has_root = discriminant > 0.0 || bow.slopes.is_some();
        if has_root { self.way(discriminant, side, bow) } else { f64::INFINITY }
    }

    /// About how far the second root of the parabola is where it bends; infinite if it has none.
    pub(super) fn way_to_second_root(&self, bow: &Bow) -> f64 {
        let discriminant = self.discriminant(bow);
        if discriminant > 0.0 { self.way(discriminant, 1.0, bow) } else { f64::INFINITY }
    }

    /// What rounding comes to in what is said of F so far away.
    fn slack(&self, way: f64, bow: &Bow) -> f64 {
        ROUNDING * (self.value.abs() + way * (self.slope.abs() + self.slope_error + way * bow.most))
    }
}

/// How far the ends of a stretch are from `t`, and a little more, so that rounding leaves nothing out.
#[inline]
pub(super) fn ways(stretch: Span, t: f64) -> [f64; 2] {
    let more = ROUNDING * (t + stretch.end);
    [stretch.start - t - more, stretch.end - t + more]
}

/// What no value of `value` + s·w + ½·`curvature`·w² is below for `from` ≤ w ≤ `to`, where s is the first of the slopes for w > 0
/// and the second for w < 0.
#[inline]
fn least(value: f64, slopes: [f64; 2], curvature: f64, [from, to]: [f64; 2]) -> f64 {
    let side = |slope: f64, a: f64, b: f64| {
        let at = |way: f64| way * (slope + 0.5 * curvature * way);
        if curvature > 0.0 { at((-slope / curvature).max(a).min(b)) } else { at(a).min(at(b)) }
    };
    let mut found = f64::INFINITY;
    if to >= 0.0 {
        found = side(slopes[0], from.max(0.0), to);
    }
    if from <= 0.0 {
        found = found.min(side(slopes[1], from, to.min(0.0)));
    }
    value + found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function that bends as x² does, or its negative.
    fn bow(sign: f64) -> Bow {
        Bow {
            t: 1.0,
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
    fn judged(value: f64, bow: &Bow) -> Verdict {
        let course = Course { value, value_error: 1e-3, slope: 0.0, slope_error: 1e-3 };
        let [wanted, reach] = [Span { start: 0.9, end: 1.1 }, Span { start: 0.8, end: 1.2 }];
        let ray = Ray { origin: glam::DVec3::ZERO, direction: glam::DVec3::X };
        Pixel::starting((0, ray), [wanted, reach], &course, bow).judge(course, bow)
    }

    #[test]
    fn the_sign_is_known_where_there_is_no_root() {
        for sign in [1.0, -1.0] {
            for value in [1.0, -1.0] {
                let Verdict::Free(found) = judged(value, &bow(sign)) else { panic!("{value}, {sign}") };
                assert_eq!(found, value * sign);
            }
        }
    }
}
