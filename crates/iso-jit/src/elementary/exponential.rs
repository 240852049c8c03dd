//! The exponential function.

use super::double::Double;
use super::{Approximation, ENTRIES, Table, nearest_multiple};

const STEPS_PER_UNIT: f64 = 23.083_120_654_223_414;

/// A step, ln 2/16, in two parts. The first has 38 bits, so that up to 2¹⁵ times it is exact.
const STEP: [f64; 2] = [0.043_321_698_784_893_67, 1.029_121_848_931_067_6e-13];

/// Up to here powers are between 2⁻⁹⁹⁶ and 2⁹⁹⁶, far from where anything underflows or overflows.
const LARGEST: f64 = 690.0;

/// Below this, powers are less than half of the least double, so that they round to zero.
const NEXT_TO_NOTHING: f64 = -746.0;

/// Where the bits of a double count sixteen times how often it is doubled.
const SIXTEENTHS: u32 = 48;

/// 2^(i/16): the double next to it, and what is missing as a part of that. The bits of the double are less by i at [`SIXTEENTHS`],
/// so that adding a number of steps there also doubles it once every sixteen.
pub(super) static POWERS: Table<2> = powers();

/// The entry nearest to an argument, in the lowest bits of a word.
#[inline(always)]
pub(super) fn index(x: f64) -> u64 {
    nearest_multiple(x, STEPS_PER_UNIT).1
}

/// The exponential of x = k·ln 2/16 + r, with r at most ln 2/32 < 2⁻⁵·⁵, from the entry at k mod 16: T·e^r with T = 2^(k/16). The
/// part m that is missing in T counts as one of r.
///
/// Errors, as parts of T; the result is at least 0.978 of it:
///
/// - of e^r − 1 − r, at most 2⁻¹²: from r² 2⁻⁶⁶, from its factor 2⁻⁶⁵, from m, which is added to r only, 2⁻⁶⁵;
/// - sums of terms below 2⁻¹²: 2⁻⁶⁶ before and three times 2⁻⁶⁵ after they are multiplied by T;
/// - the series cut off after r⁸: 2⁻⁶⁸;
/// - r's own error: 2⁻⁸⁰.
///
/// Together 2⁻⁶²·³; the greatest that was seen, in 200,000 values beside ones of 300 bits, is 2⁻⁶³·³.
#[inline(always)]
pub(super) fn exp(x: f64, [power, missing]: [f64; 2]) -> Approximation {
    let (steps, index) = nearest_multiple(x, STEPS_PER_UNIT);
    let power = f64::from_bits(power.to_bits().wrapping_add(index << SIXTEENTHS));
    let is_nothing = x < NEXT_TO_NOTHING;
    let power = if is_nothing { 0.0 } else { power };

    // The first difference is exact: a multiple of x's last place or of 2⁻⁴², and less than 2⁻⁵.
    let rest = (-steps).mul_add(STEP[0], x);
    let r = (-steps).mul_add(STEP[1], rest);
    let low = (-steps).mul_add(STEP[1], rest - r) + missing;

    let tail = r.mul_add(1.0 / 40320.0, 1.0 / 5040.0);
    let tail = r.mul_add(r.mul_add(r.mul_add(tail, 1.0 / 720.0), 1.0 / 120.0), 1.0 / 24.0);
    let tail = r.mul_add(r.mul_add(tail, 1.0 / 6.0), 0.5);
    let small = (r * r).mul_add(tail, low.mul_add(r, low));

    let product = Double::product(power, r);
    let Double { hi, lo } = Double::ordered_sum(power, product.hi);
    let lo = lo + power.mul_add(small, product.lo);
    let error = if is_nothing | (x.abs() < LARGEST) { hi * 2f64.powi(-61) } else { f64::INFINITY };
    Approximation { hi, lo, error }
}

const fn powers() -> Table<2> {
    const LN_2: Double = Double { hi: std::f64::consts::LN_2, lo: 2.319_046_813_846_299_6e-17 };
    let mut columns = [[0.0; ENTRIES]; 2];
    let mut step = 0;
    while step < ENTRIES {
        let [a, b, c, d] = LN_2.times(Double::from(step as f64 / ENTRIES as f64)).series();
        let Double { hi, lo } = a.plus(b).plus(c.plus(d));
        columns[0][step] = f64::from_bits(hi.to_bits() - ((step as u64) << SIXTEENTHS));
        columns[1][step] = lo / hi;
        step += 1;
    }
    Table { columns }
}
