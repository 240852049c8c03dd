//! Elementary functions of eight doubles at once, correctly rounded.
//!
//! Each is computed from a table and a short polynomial as hi + lo with a proven bound of the error (Gal, Tang). Where every
//! number within the bound rounds to the same double, that is the correctly rounded value (Ziv); where not, one time in some
//! hundreds, and outside the range that is covered, the scalar function is called. So the bits are those of
//! [`Operation::value`], whatever the machine.
//!
//! Only what gains is here. In batches sine and cosine take 5 ns a value instead of 14, and less than 4 where both are taken of the
//! same numbers; exponential functions and logarithms made
//! in the same way were no quicker than eight calls, 5 ns, because the scalar ones are short.

// Elsewhere than on x86 every value is left to a call so far.
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code))]

mod double;
mod sine;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;

use iso_expr::{Operation, Value};

/// How many doubles are computed at once.
pub(crate) const WIDTH: usize = 8;

/// Replaces arguments by values, on processors with the features that it was compiled for.
pub(crate) type InPlace = unsafe extern "C" fn(&mut [f64; WIDTH]);

/// The function of eight doubles that gives the values of `operation`, if there is one and the machine has fused
/// multiplications, without which it would be slower than eight calls.
pub(crate) fn function(operation: Operation) -> Option<InPlace> {
    #[cfg(target_arch = "x86_64")]
    return x86::versions(operation).next();
    #[cfg(not(target_arch = "x86_64"))]
    return None;
}

/// The function that replaces the first four of eight arguments by their sines, and puts their cosines behind, under the same
/// condition.
pub(crate) fn sines_and_cosines() -> Option<InPlace> {
    #[cfg(target_arch = "x86_64")]
    return x86::of_both().next();
    #[cfg(not(target_arch = "x86_64"))]
    return None;
}

/// Replaces arguments by their sines, and what stands behind them by their cosines, under the same condition.
pub(crate) type InPlaceOfBoth = unsafe extern "C" fn(&mut [[f64; WIDTH]; 2]);

/// The function of eight doubles that gives their sines and cosines, under the same condition.
pub(crate) fn both_of_eight() -> Option<InPlaceOfBoth> {
    #[cfg(target_arch = "x86_64")]
    return x86::of_both_of_eight().next();
    #[cfg(not(target_arch = "x86_64"))]
    return None;
}

/// A value somewhere in hi + lo ± error.
#[derive(Clone, Copy)]
struct Approximation {
    hi: f64,
    lo: f64,
    /// Infinite where nothing is known.
    error: f64,
}

impl Approximation {
    /// Puts the doubles next to both ends in a lane.
    #[inline(always)]
    fn bound(self, lane: usize, [least, most]: &mut [[f64; WIDTH]; 2]) {
        least[lane] = self.hi + (self.lo - self.error);
        most[lane] = self.hi + (self.lo + self.error);
    }
}

/// Approximates where that decides the rounding, else calls the function. Both are given the lane.
#[inline(always)]
fn round(
    arguments: &mut [f64; WIDTH],
    approximate: impl Fn(usize, f64) -> Approximation,
    function: impl Fn(usize, f64) -> f64,
) {
    let mut bounds = [[0.0; WIDTH]; 2];
    for (lane, argument) in arguments.iter().enumerate() {
        approximate(lane, *argument).bound(lane, &mut bounds);
    }
    *arguments = decided(bounds, |lane| function(lane, arguments[lane]));
}

/// The value in each lane where its bounds are the same, else what `function` gives.
#[inline(always)]
fn decided([mut least, most]: [[f64; WIDTH]; 2], function: impl Fn(usize) -> f64) -> [f64; WIDTH] {
    // Counted rather than searched, which is one comparison of all lanes.
    let undecided: u64 = (0..WIDTH).map(|lane| u64::from(least[lane] != most[lane])).sum();
    if undecided > 0 {
        for lane in 0..WIDTH {
            // An unknown value is not even equal to itself.
            if least[lane] != most[lane] {
                least[lane] = function(lane);
            }
        }
    }
    least
}

/// The scalar function of an operation of one operand.
fn scalar(operation: Operation) -> extern "C" fn(f64) -> f64 {
    match operation.value() {
        Value::Unary(function) => function,
        _ => unreachable!("{operation:?} has one operand"),
    }
}

/// The double nearest to `a`, an integer of less than 51 bits, and the same integer in the lowest bits of a word.
#[inline(always)]
fn nearest_integer(a: f64) -> (f64, u64) {
    /// Adding it pushes the fraction out of the significand.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let shifted = a + SHIFT;
    (shifted - SHIFT, shifted.to_bits())
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use iso_expr::Operation;

    use super::{InPlace, InPlaceOfBoth, WIDTH, decided, round, scalar, sine};

    /// The versions of a function that this processor runs, the fastest first.
    fn run_here<F>(avx512: Option<F>, avx2: Option<F>) -> impl Iterator<Item = F> {
        let has_avx512 = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
        let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        avx512.filter(|_| has_avx512).into_iter().chain(avx2.filter(|_| has_avx2))
    }

    /// The versions of [`function`](super::function).
    pub(super) fn versions(operation: Operation) -> impl Iterator<Item = InPlace> {
        run_here(avx512::function(operation), avx2::function(operation))
    }

    /// The versions of [`sines_and_cosines`](super::sines_and_cosines).
    pub(super) fn of_both() -> impl Iterator<Item = InPlace> {
        run_here(Some(avx512::sines_and_cosines as InPlace), Some(avx2::sines_and_cosines))
    }

    /// The versions of [`both_of_eight`](super::both_of_eight).
    pub(super) fn of_both_of_eight() -> impl Iterator<Item = InPlaceOfBoth> {
        run_here(Some(avx512::both_of_eight as InPlaceOfBoth), Some(avx2::both_of_eight))
    }

    /// The functions, compiled for processors with certain features.
    macro_rules! compiled_for {
        ($module:ident, $features:literal) => {
            mod $module {
                use super::*;

                pub(super) fn function(operation: Operation) -> Option<InPlace> {
                    match operation {
                        Operation::Sin => Some(sin),
                        Operation::Cos => Some(cos),
                        _ => None,
                    }
                }

                #[target_feature(enable = $features)]
                extern "C" fn sin(arguments: &mut [f64; WIDTH]) {
                    round(arguments, |_, x| sine::sin(x), |_, x| scalar(Operation::Sin)(x));
                }

                #[target_feature(enable = $features)]
                extern "C" fn cos(arguments: &mut [f64; WIDTH]) {
                    round(arguments, |_, x| sine::cos(x), |_, x| scalar(Operation::Cos)(x));
                }

                #[target_feature(enable = $features)]
                pub(super) extern "C" fn both_of_eight([sines, cosines]: &mut [[f64; WIDTH]; 2]) {
                    let arguments = *sines;
                    let (mut of_sines, mut of_cosines) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
                    for (lane, argument) in arguments.iter().enumerate() {
                        let [sine, cosine] = sine::sin_and_cos(*argument);
                        sine.bound(lane, &mut of_sines);
                        cosine.bound(lane, &mut of_cosines);
                    }
                    *sines = decided(of_sines, |lane| scalar(Operation::Sin)(arguments[lane]));
                    *cosines = decided(of_cosines, |lane| scalar(Operation::Cos)(arguments[lane]));
                }

                #[target_feature(enable = $features)]
                pub(super) extern "C" fn sines_and_cosines(arguments: &mut [f64; WIDTH]) {
                    let (sines, cosines) = arguments.split_at_mut(WIDTH / 2);
                    cosines.copy_from_slice(sines);
                    let is_sine = |lane| lane < WIDTH / 2;
                    round(
                        arguments,
                        |lane, x| sine::sin_or_cos(is_sine(lane), x),
                        |lane, x| scalar(if is_sine(lane) { Operation::Sin } else { Operation::Cos })(x),
                    );
                }
            }
        };
    }

    compiled_for!(avx512, "avx512f,avx512dq");
    compiled_for!(avx2, "avx2,fma");
}
