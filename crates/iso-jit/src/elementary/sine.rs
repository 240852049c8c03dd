//! Sine and cosine.

use super::double::Double;
use super::{Approximation, ENTRIES, Table, nearest_multiple};

const STEPS_PER_RADIAN: f64 = 10.185_916_357_881_302;

/// A step, π/32, in three parts. The first two have 35 bits, so that up to 2¹⁸ times each is exact.
const STEP: [f64; 3] = [0.098_174_770_424_520_83, 1.602_090_094_739_972_4e-13, 6.601_874_416_867_142e-25];

/// Fewer than 2¹⁸ steps.
const LARGEST: f64 = 25_000.0;

/// Sine and cosine at every step of a quarter, each as hi and lo.
pub(super) static WAVE: Table<4> = wave();

/// The entry nearest to an argument, in the lowest bits of a word.
#[inline(always)]
pub(super) fn index(x: f64) -> u64 {
    nearest_multiple(x, STEPS_PER_RADIAN).1
}

/// The sine of x + quarters·π/2.
#[inline(always)]
pub(super) fn sin(x: f64, entry: [f64; 4], quarters: u64) -> Approximation {
    let near = Near::of(x, entry, quarters);
    near.turned(near.sine, near.cosine)
}

/// The sine and the cosine, for little more than one of them.
#[inline(always)]
pub(super) fn sin_and_cos(x: f64, entry: [f64; 4]) -> [Approximation; 2] {
    let near = Near::of(x, entry, 0);
    [near.turned(near.sine, near.cosine), near.turned(near.cosine, near.sine.negated())]
}

/// What the sine of a number is computed from.
#[derive(Clone, Copy)]
struct Near {
    /// Sine and cosine of the nearest step.
    sine: Double,
    cosine: Double,
    /// The rest r, (sin r − r)/r, and cos r − 1 + r²/2.
    rest: Double,
    sine_tail: f64,
    cosine_tail: f64,
    is_covered: bool,
}

impl Near {
    /// Of x + quarters·π/2.
    #[inline(always)]
    fn of(x: f64, [sine, sine_lo, cosine, cosine_lo]: [f64; 4], quarters: u64) -> Self {
        let (steps, index) = nearest_multiple(x, STEPS_PER_RADIAN);
        let in_quarter = [Double { hi: sine, lo: sine_lo }, Double { hi: cosine, lo: cosine_lo }];
        let [sine, cosine] = turned_by(in_quarter, (index / ENTRIES as u64).wrapping_add(quarters));

        // Exact: a multiple of x's last place or of 2⁻³⁸, and less than 2⁻⁴. The last place of what is taken off next is finer.
        let rest = (-steps).mul_add(STEP[0], x);
        let rest = Double::ordered_sum(rest, -(steps * STEP[1]));
        let rest = Double { hi: rest.hi, lo: (-steps).mul_add(STEP[2], rest.lo) };

        let square = rest.hi * rest.hi;
        let sine_tail = square.mul_add(square.mul_add(1.0 / 362_880.0, -1.0 / 5040.0), 1.0 / 120.0);
        let sine_tail = square * square.mul_add(sine_tail, -1.0 / 6.0);
        let cosine_tail = square.mul_add(square.mul_add(1.0 / 40320.0, -1.0 / 720.0), 1.0 / 24.0);
        let cosine_tail = square * square * cosine_tail;
        Self { sine, cosine, rest, sine_tail, cosine_tail, is_covered: x.abs() < LARGEST }
    }

    /// The sine of the sum of the rest and an angle with this sine and cosine: S·cos r + C·sin r, with r at most π/64 < 2⁻⁴·³. It is
    /// summed as S + r·(C − S·r/2) and what remains of both series, for the slope in brackets is known with its rounding error.
    ///
    /// Errors, as parts of the result, which is at least S/2 (at S = 0 only those of sin r count):
    ///
    /// - of C·(sin r − r), which is at most 2⁻¹¹·²: from r², its factor, their product and C times that, four times 2⁻⁵³; from
    ///   sums of terms below it, three times 2⁻⁵³: 2⁻⁶¹·⁴ together;
    /// - what r's low part, at most 2⁻⁵⁸, takes of it: 2⁻⁶³·³;
    /// - the series cut off: 2⁻⁶⁸ of sin r after r⁹, 2⁻⁶⁴ of cos r after r⁸;
    /// - r's own error, 2⁻¹¹⁰, from k < 2¹⁸ steps, absolute.
    ///
    /// Together 2⁻⁶⁰·⁹; the greatest that was seen, in 200,000 values beside ones of 300 bits, is 2⁻⁶²·¹.
    #[inline(always)]
    fn turned(self, sine: Double, cosine: Double) -> Approximation {
        let Self { rest, sine_tail, cosine_tail, is_covered, .. } = self;
        let half = 0.5 * rest.hi;
        let slope = (-sine.hi).mul_add(half, cosine.hi);
        let slope_lo = (-sine.hi).mul_add(half, cosine.hi - slope) + cosine.lo;
        let turned = Double::product(slope, rest.hi);
        let Double { hi, lo } = Double::ordered_sum(sine.hi, turned.hi);

        // r's low part counts by the derivative, C − S·r.
        let small = (-sine.hi).mul_add(half, slope).mul_add(rest.lo, sine.lo + turned.lo);
        let small = sine.hi.mul_add(cosine_tail, small);
        let lo = lo + cosine.hi.mul_add(sine_tail, slope_lo).mul_add(rest.hi, small);
        let error = if is_covered { hi.abs() * 2f64.powi(-60) + 2f64.powi(-98) } else { f64::INFINITY };
        Approximation { hi, lo, error }
    }
}

/// The sine and the cosine of an angle after so many quarters of a turn.
#[inline(always)]
fn turned_by([sine, cosine]: [Double; 2], quarters: u64) -> [Double; 2] {
    let is_odd = quarters & 1 == 1;
    let (sine, cosine) = if is_odd { (cosine, sine) } else { (sine, cosine) };
    let sign = quarters << 62 & 1 << 63;
    [sine.signed(sign), cosine.signed(sign ^ quarters << 63)]
}

const fn wave() -> Table<4> {
    const PI: Double = Double { hi: std::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };
    let mut columns = [[0.0; ENTRIES]; 4];
    let mut step = 0;
    while step < ENTRIES {
        let [a, b, c, d] = PI.times(Double::from(step as f64 / (2 * ENTRIES) as f64)).series();
        let (sine, cosine) = (b.plus(d.negated()), a.plus(c.negated()));
        [columns[0][step], columns[1][step]] = [sine.hi, sine.lo];
        [columns[2][step], columns[3][step]] = [cosine.hi, cosine.lo];
        step += 1;
    }
    Table { columns }
}
