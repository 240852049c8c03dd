//! Sine and cosine.

use super::double::Double;
use super::{Approximation, nearest_integer};

/// Steps of the table around the circle.
const STEPS: usize = 256;

/// A step, π/128, in three parts. The first two have 33 bits, so that up to 2²⁰ times each is exact.
const STEP: [f64; 3] = [0.024_543_692_605_220_713, 9.495_469_541_099_947e-13, 3.159_791_013_743_673e-23];

const STEPS_PER_RADIAN: f64 = 40.743_665_431_525_21;

/// Fewer than 2²⁰ steps.
const LARGEST: f64 = 25_000.0;

/// Sine and cosine at every step.
static WAVE: [[Double; 2]; STEPS] = wave();

#[inline(always)]
pub(super) fn sin(x: f64) -> Approximation {
    let near = Near::of(x, 0);
    near.turned(near.sine, near.cosine)
}

#[inline(always)]
pub(super) fn cos(x: f64) -> Approximation {
    let near = Near::of(x, 0);
    near.turned(near.cosine, near.sine.negated())
}

/// The sine, or the cosine.
#[inline(always)]
pub(super) fn sin_or_cos(is_sine: bool, x: f64) -> Approximation {
    let near = Near::of(x, if is_sine { 0 } else { STEPS / 4 });
    near.turned(near.sine, near.cosine)
}

/// The sine and the cosine, for little more than one of them.
#[inline(always)]
pub(super) fn sin_and_cos(x: f64) -> [Approximation; 2] {
    let near = Near::of(x, 0);
    [near.turned(near.sine, near.cosine), near.turned(near.cosine, near.sine.negated())]
}

/// What the sine of a number is computed from.
#[derive(Clone, Copy)]
struct Near {
    /// Sine and cosine of the nearest step.
    sine: Double,
    cosine: Double,
    /// The rest, and its square.
    rest: Double,
    square: f64,
    /// (sin r − r)/r³ and (cos r − 1)/r² for the rest r.
    sine_tail: f64,
    cosine_tail: f64,
    is_covered: bool,
}

impl Near {
    /// Of x + shift·π/128.
    #[inline(always)]
    fn of(x: f64, shift: usize) -> Self {
        let (steps, index) = nearest_integer(x * STEPS_PER_RADIAN);
        let [sine, cosine] = WAVE[(index as usize).wrapping_add(shift) % STEPS];

        // Exact: a multiple of x's last place or of 2⁻³⁸, and less than 2⁻⁶.
        let rest = (-steps).mul_add(STEP[0], x);
        let rest = Double::sum(rest, -(steps * STEP[1]));
        let rest = Double::sum(rest.hi, (-steps).mul_add(STEP[2], rest.lo));
        let r = rest.hi;
        let square = (r + r).mul_add(rest.lo, r * r);

        let sine_tail = square.mul_add(square.mul_add(-1.0 / 5040.0, 1.0 / 120.0), -1.0 / 6.0);
        let cosine_tail =
            square.mul_add(square.mul_add(square.mul_add(1.0 / 40320.0, -1.0 / 720.0), 1.0 / 24.0), -0.5);
        Self { sine, cosine, rest, square, sine_tail, cosine_tail, is_covered: x.abs() < LARGEST }
    }

    /// The sine of the sum of the rest and an angle with this sine and cosine: S·cos r + C·sin r, with r at most π/256 < 2⁻⁶·³.
    ///
    /// Errors, as parts of the result, which is at least S/2 (at S = 0 only those of sin r count):
    ///
    /// - r²'s 2·2⁻⁵³, that of cos r's polynomial 2⁻⁵³ and that of their product 2⁻⁵³, times r²/2 < 2⁻¹³·⁷ and 2: 2⁻⁶³·⁷;
    /// - sums of terms below r²/2, at most three times 2⁻⁵³ of them, half of that being 2⁻⁵⁴: 2⁻⁶⁴;
    /// - the series cut off: 2⁻⁶⁹ of sin r after r⁷, 2⁻⁸⁵ of cos r after r⁸;
    /// - r's own error, 2⁻¹⁰³, from k < 2²⁰ steps, absolute.
    ///
    /// Together 2⁻⁶²·⁸; the greatest that was seen, in 50,000 values beside ones of 250 bits, is 2⁻⁶⁴·⁸.
    #[inline(always)]
    fn turned(self, sine: Double, cosine: Double) -> Approximation {
        let Self { rest, square, sine_tail, cosine_tail, is_covered, .. } = self;
        let turned = Double::product(cosine.hi, rest.hi);
        let Double { hi, lo } = Double::sum(sine.hi, turned.hi);
        let sine_rest = (rest.hi * square).mul_add(sine_tail, rest.lo);
        let small = (sine.lo + turned.lo) + cosine.lo.mul_add(rest.hi, cosine.hi * sine_rest);
        let lo = lo + sine.hi.mul_add(square * cosine_tail, small);
        let error = if is_covered { hi.abs() * 2f64.powi(-62) + 2f64.powi(-98) } else { f64::INFINITY };
        Approximation { hi, lo, error }
    }
}

/// Fills the first quarter from the series; the others turn it.
const fn wave() -> [[Double; 2]; STEPS] {
    const PI: Double = Double { hi: std::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };
    let mut wave = [[Double::ZERO; 2]; STEPS];
    let mut step = 0;
    while step < STEPS / 4 {
        let angle = PI.times(Double::from(step as f64 / 128.0));
        // The terms with even powers sum to the cosine, those with odd ones to the sine.
        let (mut term, mut sums) = (Double::from(1.0), [Double::ZERO; 2]);
        let mut power = 0;
        while power < 32 {
            let signed = if power % 4 < 2 { term } else { term.negated() };
            sums[power % 2] = sums[power % 2].plus(signed);
            power += 1;
            term = term.times(angle).over(power as f64);
        }
        let [cosine, sine] = sums;
        wave[step] = [sine, cosine];
        wave[step + STEPS / 4] = [cosine, sine.negated()];
        wave[step + STEPS / 2] = [sine.negated(), cosine.negated()];
        wave[step + 3 * STEPS / 4] = [cosine.negated(), sine];
        step += 1;
    }
    wave
}
