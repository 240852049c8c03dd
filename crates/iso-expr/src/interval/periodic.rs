//! Sine, cosine and tangent.
//!
//! Each is monotone on pieces of length π. Which piece an end lies on is decided exactly: by its quotient with π where
//! the error of that quotient leaves no doubt, and else by the sign of a correctly rounded sine or cosine, which is that
//! of the real one. (No double but zero is a multiple of π/2.)

use std::f64::consts::FRAC_1_PI;

use super::rounding::{greater, lesser, round_down, round_up};
use super::{Decorated, Interval};

/// Ends beyond this are not reduced: only points are enclosed tightly there.
const LARGEST_REDUCED: f64 = (1u64 << 45) as f64;

/// The pieces of a function whose extremes or poles are at (n + `shift`)·π for all integers n.
struct Pieces {
    shift: f64,
    /// Has the sign of (−1)ⁿ just above (n + `shift`)·π, and the other one just below.
    side: fn(f64) -> f64,
}

/// Between the extremes of the cosine.
const HALF_WAVES_OF_COSINE: Pieces = Pieces { shift: 0.0, side: core_math::sin };
/// Between the extremes of the sine, which are the poles of the tangent.
const HALF_WAVES_OF_SINE: Pieces = Pieces { shift: 0.5, side: |x| -core_math::cos(x) };

impl Pieces {
    /// The n for which `x` lies from (n + shift)·π to (n + 1 + shift)·π. `x` is not beyond [`LARGEST_REDUCED`].
    fn index(&self, x: f64) -> i64 {
        let turns = x * FRAC_1_PI - self.shift;
        let nearest = nearest_integer(turns);
        // Three roundings (of 1/π, the product and the difference), each of at most half an ulp.
        let error = (turns.abs() + 1.0) * (2.0 * f64::EPSILON);
        if (turns - nearest).abs() > error {
            return nearest as i64 - i64::from(nearest > turns);
        }
        let nearest = nearest as i64;
        let side = (self.side)(x);
        let is_above = if nearest & 1 == 0 { side >= 0.0 } else { side <= 0.0 };
        if is_above { nearest } else { nearest - 1 }
    }

    /// The pieces on which the ends lie; None where that is not decided.
    fn of(&self, interval: Interval) -> Option<(i64, i64)> {
        if interval.is_point() {
            return Some((0, 0));
        }
        (interval.magnitude() <= LARGEST_REDUCED).then(|| (self.index(interval.lo), self.index(interval.hi)))
    }
}

/// The integer nearest to `a`, which is less than 2⁵¹: its fraction is pushed out of the significand. Processors before SSE4.1,
/// for which the project is compiled, have no instruction for it.
fn nearest_integer(a: f64) -> f64 {
    const SHIFT: f64 = 1.5 / f64::EPSILON;
    (a + SHIFT) - SHIFT
}

/// A function that has the value 1 at the even ends of its pieces and −1 at the odd ones.
#[inline]
fn wave(interval: Interval, pieces: &Pieces, function: fn(f64) -> f64) -> Interval {
    const FULL: Interval = Interval { lo: -1.0, hi: 1.0 };
    if interval.is_empty() {
        return interval;
    }
    let Some((first, last)) = pieces.of(interval).filter(|(first, last)| last - first < 2) else {
        return FULL;
    };
    let (p, q) = (function(interval.lo), function(interval.hi));
    // The sine of [0, 0] is [+0, −0]: of two zeros, each end has its own.
    let passes = |extreme_is_odd: bool| first != last && (last & 1 == 1) == extreme_is_odd;
    let lo = if passes(true) { -1.0 } else { greater(-1.0, round_down(lesser(q, p))) };
    let hi = if passes(false) { 1.0 } else { lesser(1.0, round_up(greater(p, q))) };
    Interval { lo, hi }
}

pub(crate) fn sin(a: Decorated) -> Decorated {
    Decorated { interval: wave(a.interval, &HALF_WAVES_OF_SINE, core_math::sin), decoration: a.decoration }
}

pub(crate) fn cos(a: Decorated) -> Decorated {
    Decorated { interval: wave(a.interval, &HALF_WAVES_OF_COSINE, core_math::cos), decoration: a.decoration }
}

/// The extensions of sine and cosine to the same operand, given their correctly rounded values at its lower and its upper end.
///
/// On less than π the sine turns at most once: where the cosine changes its sign. So does the cosine where the sine does.
pub fn sine_and_cosine_by_ends(a: Decorated, sine: [f64; 2], cosine: [f64; 2]) -> [Decorated; 2] {
    /// Less than π.
    const SHORT: f64 = 3.0;
    let Interval { lo, hi } = a.interval;
    let is_reduced = lo == hi || a.interval.magnitude() <= LARGEST_REDUCED;
    if !(lo <= hi && hi - lo < SHORT && is_reduced) {
        return [sin(a), cos(a)];
    }
    let [sine_is_positive, cosine_is_positive] = [sine, cosine].map(|ends| ends.map(|value| value >= 0.0));
    let turned = |[p, q]: [f64; 2], rises: [bool; 2]| Interval {
        lo: if rises == [false, true] { -1.0 } else { greater(-1.0, round_down(lesser(q, p))) },
        hi: if rises == [true, false] { 1.0 } else { lesser(1.0, round_up(greater(p, q))) },
    };
    let cosine_rises = sine_is_positive.map(|is_positive| !is_positive);
    [turned(sine, cosine_is_positive), turned(cosine, cosine_rises)]
        .map(|interval| Decorated { interval, ..a })
}

/// Undefined at its poles; anything where one is inside.
pub(crate) fn tan(a: Decorated) -> Decorated {
    let Interval { lo, hi } = a.interval;
    if a.interval.is_empty() {
        return Decorated::EMPTY;
    }
    let same_piece = HALF_WAVES_OF_SINE.of(a.interval).is_some_and(|(first, last)| first == last);
    if !same_piece {
        return Decorated { interval: Interval::ENTIRE, ..Decorated::EMPTY };
    }
    let interval = Interval { lo: round_down(core_math::tan(lo)), hi: round_up(core_math::tan(hi)) };
    Decorated::enclosing(interval, a.decoration)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn values_at_the_ends_tell_the_same() {
        let mut random = Random::new(11);
        let quarters = |random: &mut Random| std::f64::consts::FRAC_PI_2 * (random.below(40) as f64 - 20.0);
        for round in 0..400_000 {
            let lo = match round % 4 {
                0 => random.between(-20.0, 20.0),
                1 => quarters(&mut random),
                2 => random.double(),
                _ => 0.0,
            };
            let other = match random.below(6) {
                0 => lo,
                1 => lo + 10f64.powf(random.between(-17.0, 1.0)),
                2 => lo - 10f64.powf(random.between(-17.0, 1.0)),
                3 => quarters(&mut random),
                4 => random.double(),
                _ => -0.0,
            };
            let a = Decorated::argument(lo.min(other), lo.max(other));
            let ends = [a.interval.lo, a.interval.hi];
            let found = sine_and_cosine_by_ends(a, ends.map(core_math::sin), ends.map(core_math::cos));
            let bits = |enclosure: Decorated| {
                let Interval { lo, hi } = enclosure.interval;
                ([lo, hi].map(|end| if end.is_nan() { 0 } else { end.to_bits() }), enclosure.decoration)
            };
            assert_eq!(found.map(bits), [sin(a), cos(a)].map(bits), "{a:?}");
        }
    }
}
