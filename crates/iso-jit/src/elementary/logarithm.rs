//! The natural logarithm.

use super::double::Double;
use super::{Approximation, DOUBLINGS, ENTRIES, Table, difference};

/// ln 2 in two parts. The first is a multiple of 2⁻⁴², so that up to 2¹⁰ times it is exact.
const LN_2: [f64; 2] = [0.693_147_180_559_890_3, 5.497_923_018_708_371e-14];

/// Arguments are brought to between this and twice as much. The bits of 1 are in the middle of an entry.
const LEAST: f64 = 0.703_125;

/// Where they count sixteenths of what is between two powers of two.
const SIXTEENTHS: u32 = 48;

/// How often [`LEAST`] is doubled, as its bits count it.
const DOUBLINGS_OF_LEAST: u64 = LEAST.to_bits() >> DOUBLINGS;

/// 1/c, short, for c in the middle of an entry, and ln c in two parts, the first a multiple of 2⁻⁴².
pub(super) static LOGARITHMS: Table<3> = logarithms();

/// The bits of x less those of the fraction of [`LEAST`], so that they count how often that is doubled, and its sixteenths.
#[inline(always)]
fn above_least(x: f64) -> u64 {
    x.to_bits().wrapping_sub(LEAST.to_bits() - (DOUBLINGS_OF_LEAST << DOUBLINGS))
}

/// The entry of an argument in the lowest bits of a word.
#[inline(always)]
pub(super) fn index(x: f64) -> u64 {
    above_least(x) >> SIXTEENTHS
}

/// The logarithm of x = 2ᵏ·c·(1 + r), from the entry of c: k·ln 2 + ln c + ln(1 + r), with r at most 2⁻⁵. Both first are zero
/// around 1, where r is exact; else r has a low part, at most 2⁻⁵³, and the result is at least 2⁻⁶.
///
/// Errors, as parts of the result:
///
/// - of what is left of the series after r − r²/2, which is at most 2⁻¹¹·⁵: from its factors and their products, four times
///   2⁻⁵³: 2⁻⁶²·⁵;
/// - sums of terms below it: three times 2⁻⁶⁴·⁵;
/// - the series cut off after r¹²: 2⁻⁶³·⁷;
/// - what r's low part adds, cut off after r²: 2⁻⁶³·³;
/// - ln c and ln 2: 2⁻⁸⁰.
///
/// Together 2⁻⁶¹·⁰; the greatest that was seen, in 330,000 values beside ones of 300 bits, is 2⁻⁶²·⁵.
#[inline(always)]
pub(super) fn ln(x: f64, [inverse, logarithm, logarithm_lo]: [f64; 3]) -> Approximation {
    let doublings = above_least(x) >> DOUBLINGS;
    let k = difference(doublings, DOUBLINGS_OF_LEAST);
    let doubled = doublings.wrapping_sub(DOUBLINGS_OF_LEAST) << DOUBLINGS;
    let product = Double::product(f64::from_bits(x.to_bits().wrapping_sub(doubled)), inverse);
    let r = product.hi - 1.0;

    let tail = r.mul_add(-1.0 / 12.0, 1.0 / 11.0);
    let tail = r.mul_add(r.mul_add(r.mul_add(tail, -1.0 / 10.0), 1.0 / 9.0), -1.0 / 8.0);
    let tail = r.mul_add(r.mul_add(r.mul_add(tail, 1.0 / 7.0), -1.0 / 6.0), 1.0 / 5.0);
    let tail = r.mul_add(r.mul_add(tail, -1.0 / 4.0), 1.0 / 3.0);

    let half_square = Double::product(r, -0.5 * r);
    let first = Double::ordered_sum(k.mul_add(LN_2[0], logarithm), r);
    let Double { hi, lo } = Double::ordered_sum(first.hi, half_square.hi);
    // r's low part counts by the derivative, 1/(1 + r).
    let derivative = r.mul_add(r - 1.0, 1.0);
    let small = product.lo.mul_add(derivative, k.mul_add(LN_2[1], logarithm_lo));
    let small = (r * r * r).mul_add(tail, half_square.lo + small);
    let is_covered = (f64::MIN_POSITIVE..f64::INFINITY).contains(&x);
    let error = if is_covered { hi.abs() * 2f64.powi(-60) } else { f64::INFINITY };
    Approximation { hi, lo: lo + (first.lo + small), error }
}

const fn logarithms() -> Table<3> {
    /// Adding it pushes out of the significand what is less than 2⁻⁴².
    const SHIFT: f64 = 1536.0;
    /// How often inverses are divided, so that they have 21 bits.
    const SHORT: f64 = (1u64 << 20) as f64;
    let mut columns = [[0.0; ENTRIES]; 3];
    let mut step = 0;
    while step < ENTRIES {
        let middle = LEAST.to_bits() + ((2 * step as u64 + 1) << (SIXTEENTHS - 1));
        let inverse = (SHORT / f64::from_bits(middle)).round() / SHORT;
        let Double { hi, lo } = Double::from(1.0 - inverse).over(1.0 + inverse).inverse_hyperbolic_tangent();
        let (hi, lo) = (2.0 * hi, 2.0 * lo);
        let upper = (hi + SHIFT) - SHIFT;
        columns[0][step] = inverse;
        columns[1][step] = upper;
        columns[2][step] = (hi - upper) + lo;
        step += 1;
    }
    Table { columns }
}
