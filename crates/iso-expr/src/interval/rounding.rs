//! Outward rounding by neighbouring doubles.
//!
//! The processor's rounding mode is left alone: an end is computed to nearest and then moved to the neighbouring double
//! outwards, which is at most one further out than the tightest end. What follows is a recipe, not just an
//! implementation: native code repeats it in lanes, bit for bit.
//!
//! **Zeros point inwards.** A lower end that is zero is +0, an upper one is −0; so [0, 0] is held as [+0, −0]. A computed
//! zero therefore tells where the real number is: +0 is exact or stands for a positive number that underflowed, so as a
//! lower end it is right as it is, while −0 stands for a negative number that underflowed and must move down. Any other
//! choice of signs is sound too, and at most one subnormal wider.
//!
//! **Only downwards.** Every upper end is minus the lower end of the negated problem: that of a + b is
//! −round_down((−a) − b), for which an exact zero is again +0.
//!
//! # Recipe
//!
//! With `bits` the double as a signed 64-bit integer, every comparison being one of integers that gives 1 or 0:
//!
//! ```text
//! round_down(x) = bits − (bits > 0) + (bits < the bits of −∞)
//!
//! least(p, q, r, s) = lesser(lesser(p, q), lesser(r, s)) | ((p | q | r | s) & sign bit)
//! lesser(p, q)      = p < q ? p : q
//!
//! add       lo = round_down(a.lo + b.lo)        hi = −round_down((−a.hi) − b.hi)
//! subtract  lo = round_down(a.lo − b.hi)        hi = −round_down(b.lo − a.hi)
//! multiply  lo = round_down(least(product(u, v)  for u in a.lo, a.hi; v in b.lo, b.hi))
//!           hi = −round_down(least(product(−u, v) for the same))
//!           product(u, v) = u = 0 or v = 0 ? +0 : u · v
//! divide    v.lo = b.lo + 0, v.hi = −(0 − b.hi)                              (zeros made to point inwards)
//!           lo = round_down(least(quotient(u, v) for the four pairs)), hi = −round_down(least(quotient(−u, v)))
//!           quotient(u, v) = u = 0 or u/v is NaN ? +0 : u / v
//!           then [−∞, +∞] where b.lo < 0 < b.hi and (a.lo < 0 or a.hi > 0); empty where b.lo = b.hi = 0
//! negate    lo = −a.hi, hi = −a.lo
//! absolute  lo = a.lo > 0 ? a.lo : a.hi < 0 ? −a.hi : +0          hi = −a.lo > a.hi ? −a.lo : a.hi
//! minimum   each end: a < b ? a : b              maximum   each end: a > b ? a : b
//! root      lo = a.lo ≤ 0 ? +0 : round_down(√a.lo)                 hi = −round_down(−√a.hi); empty where a.hi < 0
//! power n   m = magnitude of the end (for even n: lo of absolute(a) for lo, hi of absolute(a) for hi)
//!           down(m): every product is followed by round_down; up(m): by −round_down(−·), and is 0 where m = 0
//!           even n: lo = down(m), hi = −(0 − up(m)), which makes a zero −0
//!           odd n:  lo = a.lo < 0 ? −up(−a.lo) : down(a.lo),  hi = a.hi > 0 ? up(a.hi) : −down(−a.hi)
//! ```
//!
//! An argument's ends are lo + 0 and −(0 − hi); it is empty unless lo ≤ hi, lo < +∞ and hi > −∞. Absolute, minimum,
//! maximum, multiply and divide give the empty interval where an operand is empty; for the others that follows from the
//! arithmetic of NaN. The decoration is the least of the operands' (of the base's alone for a power); no more than
//! continuous unless lo > −∞ and hi < +∞ in the result; and trivial where a divisor holds zero, where the radicand's
//! lower end is below zero, and for the empty interval.

/// The greatest double below `value`, except that −∞ and NaN stay, and so does +0.
///
/// For a real number whose nearest double is `value` (a zero having its sign) this is a lower bound, and the
/// greatest such bound or the one below it. +∞ becomes the greatest double, −0 the smallest negative one.
#[inline]
pub fn round_down(value: f64) -> f64 {
    const MINUS_INFINITY: i64 = f64::NEG_INFINITY.to_bits() as i64;
    let bits = value.to_bits() as i64;
    // As integers, negative doubles count from −0, the least, up to −∞, and NaNs stand beyond the infinities. Of the positive NaNs
    // the payload is lowered, and arithmetic gives none that would become +∞.
    f64::from_bits((bits - i64::from(bits > 0) + i64::from(bits < MINUS_INFINITY)) as u64)
}

/// The least double above `value`, except that +∞ and NaN stay, and so does −0: the mirror image of [`round_down`].
#[inline]
pub fn round_up(value: f64) -> f64 {
    -round_down(-value)
}

/// The lesser of two doubles, the second one when they are equal or one is NaN.
#[inline]
pub(super) fn lesser(p: f64, q: f64) -> f64 {
    if p < q { p } else { q }
}

/// The greater of two doubles, the second one when they are equal or one is NaN.
#[inline]
pub(super) fn greater(p: f64, q: f64) -> f64 {
    if p > q { p } else { q }
}

/// A lower bound of four real numbers, given the nearest double of each; −0 counts as less than +0.
#[inline]
pub(super) fn round_down_least([p, q, r, s]: [f64; 4]) -> f64 {
    const SIGN: u64 = 1 << 63;
    let least = lesser(lesser(p, q), lesser(r, s));
    let signs = (p.to_bits() | q.to_bits() | r.to_bits() | s.to_bits()) & SIGN;
    round_down(f64::from_bits(least.to_bits() | signs))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TINY: f64 = f64::from_bits(1);

    #[test]
    fn neighbours_are_those_of_the_standard_library_but_for_zeros() {
        let magnitudes = [TINY, 3.0 * TINY, f64::MIN_POSITIVE, 0.1, 1.0, 2.0, 1e300, f64::MAX, f64::INFINITY];
        for value in magnitudes.into_iter().flat_map(|value| [value, -value]) {
            assert_eq!(round_down(value), value.next_down(), "below {value:e}");
            assert_eq!(round_up(value), value.next_up(), "above {value:e}");
        }
        for nan in [f64::NAN, -f64::NAN, f64::from_bits(u64::MAX), f64::from_bits(u64::MAX >> 1)] {
            assert!(round_down(nan).is_nan() && round_up(nan).is_nan());
        }
    }

    #[test]
    fn a_zero_moves_only_away_from_where_its_sign_says_it_came_from() {
        let cases = [
            ("down from +0", round_down(0.0), 0.0),
            ("down from -0", round_down(-0.0), -TINY),
            ("up from +0", round_up(0.0), TINY),
            ("up from -0", round_up(-0.0), -0.0),
            ("down from the smallest", round_down(TINY), 0.0),
            ("up from the smallest negative", round_up(-TINY), -0.0),
        ];
        for (what, given, expected) in cases {
            assert_eq!(given.to_bits(), expected.to_bits(), "{what}: {given:e}");
        }
    }

    #[test]
    fn the_least_of_four_sees_the_sign_of_a_zero() {
        for place in 0..4 {
            let mut candidates = [0.0; 4];
            assert_eq!(round_down_least(candidates).to_bits(), 0);
            candidates[place] = -0.0;
            assert_eq!(round_down_least(candidates), -TINY);
            candidates[place] = -1.0;
            assert_eq!(round_down_least(candidates), (-1.0f64).next_down());
        }
        assert_eq!(round_down_least([4.0, 3.0, 2.0, 5.0]), 2.0f64.next_down());
    }
}
