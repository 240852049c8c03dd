//! The cube root.

use super::double::Double;
use super::{Approximation, DOUBLINGS, ENTRIES, Table, difference, nearest_multiple};

/// How often 1 is doubled, as its bits count it.
const DOUBLINGS_OF_ONE: u64 = 1.0f64.to_bits() >> DOUBLINGS;

/// 2^(s/3) and 2^(−2s/3)/3 for s = 0, 1, 2.
pub(super) static ROOTS: Table<2> = roots();

/// The inverse cube root of m from 1 to 2 is this polynomial up to 2⁻¹⁴·⁶ of it.
const INVERSE: [f64; 5] = [1.670_007, -1.172_880_6, 0.695_482_94, -0.221_237_97, 0.028_591_047];

/// How often a magnitude is doubled, as 3q + s with s = 0, 1 or 2: q and s, each in the lowest bits of a word.
#[inline(always)]
fn thirds(x: f64) -> [u64; 2] {
    let count = difference(x.abs().to_bits() >> DOUBLINGS, DOUBLINGS_OF_ONE);
    // (count − 1)/3 is no more than a third away from q.
    let (q, q_bits) = nearest_multiple(count - 1.0, 1.0 / 3.0);
    let (_, s_bits) = nearest_multiple(q.mul_add(-3.0, count), 1.0);
    [q_bits, s_bits]
}

/// The entry of an argument in the lowest bits of a word.
#[inline(always)]
pub(super) fn index(x: f64) -> u64 {
    thirds(x)[1]
}

/// The cube root of x = ±2³ᵠ·a with a = 2ˢ·m and m from 1 to 2, from the entry of s. A double y next to the root of a is 2^(s/3)·m·r², r being
/// the inverse root of m by a polynomial and one step of third order; what is missing in y is (a − y³)/3y², which a Newton step adds.
///
/// Errors, as parts of the result:
///
/// - y, from r, off by 14/81 of (3·2⁻¹⁴·⁶)³, twice, and some roundings: 2⁻⁴⁰;
/// - what the step leaves is the square of that: 2⁻⁸⁰; its divisor is off as y is: 2⁻⁷⁹; its sums are rounded below 2⁻⁹⁰.
///
/// Together 2⁻⁷⁸; the greatest that was seen, in 100,000 values beside ones of 300 bits, is 2⁻⁸⁰·⁷.
#[inline(always)]
pub(super) fn cbrt(x: f64, [root, third_of_inverse_square]: [f64; 2]) -> Approximation {
    const FRACTION: u64 = (1 << DOUBLINGS) - 1;
    let [q, s] = thirds(x);
    let m = f64::from_bits(x.to_bits() & FRACTION | 1.0f64.to_bits());
    let a = f64::from_bits(m.to_bits().wrapping_add(s << DOUBLINGS));

    let [c0, c1, c2, c3, c4] = INVERSE;
    let r = m.mul_add(m.mul_add(m.mul_add(m.mul_add(c4, c3), c2), c1), c0);
    let missing = (-m * r).mul_add(r * r, 1.0);
    let r = (r * missing).mul_add(missing.mul_add(2.0 / 9.0, 1.0 / 3.0), r);

    let square = r * r;
    let y = m * square * root;
    let of_y = Double::product(y, y);
    let cube = Double::product(of_y.hi, y);
    // The first difference is exact, for the two are next to each other.
    let rest = (a - cube.hi) - of_y.lo.mul_add(y, cube.lo);
    let step = rest * (square * third_of_inverse_square);

    let scale = f64::from_bits(q.wrapping_add(DOUBLINGS_OF_ONE) << DOUBLINGS).copysign(x);
    let hi = y * scale;
    let is_covered = (f64::MIN_POSITIVE..f64::INFINITY).contains(&x.abs());
    let error = if is_covered { hi.abs() * 2f64.powi(-72) } else { f64::INFINITY };
    Approximation { hi, lo: step * scale, error }
}

const fn roots() -> Table<2> {
    let mut columns = [[0.0; ENTRIES]; 2];
    columns[0] = first([1.0, 1.259_921_049_894_873_2, 1.587_401_051_968_199_5]);
    columns[1] = first([1.0 / 3.0, 0.209_986_841_649_145_53, 0.132_283_420_997_349_96]);
    Table { columns }
}

/// A column of three numbers.
const fn first(numbers: [f64; 3]) -> [f64; ENTRIES] {
    let mut column = [0.0; ENTRIES];
    let mut entry = 0;
    while entry < numbers.len() {
        column[entry] = numbers[entry];
        entry += 1;
    }
    column
}
