//! Elementary functions of eight doubles at once, correctly rounded.
//!
//! Each is computed from a table and a short polynomial as hi + lo with a proven bound of the error (Gal, Tang). Where every
//! number within the bound rounds to the same double, that is the correctly rounded value (Ziv); where not, one time in a
//! hundred or two, and outside the range that is covered, the scalar function is called. So the bits are those of
//! [`Operation::value`], whatever the machine.
//!
//! Tables have sixteen entries, because two registers of 512 bits hold one number of each and one instruction looks them up in all
//! lanes; from memory that takes as long as all the rest.
//!
//! Only what gains is here. With 512 bits, exponentials take 1.3 ns a value instead of 3.8 in scalar calls, sines and cosines 2.0
//! instead of 13, and 3.5 where both are taken of the same number; with 256 bits 1.9, 3.0 and 4.9.
//! A logarithm in a batch takes 2.1 instead of 4.4, loads and stores included. Cube roots have a call of 23 ns to beat, and no table but of
//! the roots of 2 and 4.

// Elsewhere than on x86 every value is left to a call so far.
#![cfg_attr(not(target_arch = "x86_64"), allow(dead_code))]

mod cube_root;
mod double;
mod exponential;
mod logarithm;
mod sine;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
#[cfg(target_arch = "x86_64")]
mod x86;

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

/// The function that replaces the first four of eight arguments by their sines and the others by their cosines, under the same
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

/// Entries of every table.
const ENTRIES: usize = 16;

/// One number of each entry.
type Column = [f64; ENTRIES];

/// What is known of a function at sixteen places, from which follows what is known at the others.
#[repr(align(64))]
struct Table<const COLUMNS: usize> {
    columns: [Column; COLUMNS],
}

impl<const COLUMNS: usize> Table<COLUMNS> {
    /// The entries of the arguments, whose places are in the lowest bits of what `index` gives.
    #[inline(always)]
    fn entries(
        &self,
        arguments: &[f64; WIDTH],
        index: impl Fn(f64) -> u64,
        look_up: impl Fn(&Column, &[u64; WIDTH]) -> [f64; WIDTH],
    ) -> [[f64; WIDTH]; COLUMNS] {
        let indices = arguments.map(index);
        std::array::from_fn(|column| look_up(&self.columns[column], &indices))
    }
}

/// A value somewhere in hi + lo ± error.
#[derive(Clone, Copy)]
struct Approximation {
    hi: f64,
    lo: f64,
    /// Infinite where nothing is known.
    error: f64,
}

/// The doubles next to both ends in each lane.
type Bounds = [[f64; WIDTH]; 2];

impl Approximation {
    /// Puts the doubles next to both ends in a lane.
    #[inline(always)]
    fn bound(self, lane: usize, [least, most]: &mut Bounds) {
        least[lane] = self.hi + (self.lo - self.error);
        most[lane] = self.hi + (self.lo + self.error);
    }
}

/// The scalar function of an operation of one operand.
fn scalar(operation: Operation) -> extern "C" fn(f64) -> f64 {
    match operation.value() {
        Value::Unary(function) => function,
        _ => unreachable!("{operation:?} has one operand"),
    }
}

/// Where the bits of a double count its doublings.
const DOUBLINGS: u32 = 52;

/// a − b, for integers of less than 51 bits.
#[inline(always)]
fn difference(a: u64, b: u64) -> f64 {
    /// Bits of this double and of a small integer are those of their sum.
    const INTEGERS: f64 = (1u64 << DOUBLINGS) as f64;
    f64::from_bits(INTEGERS.to_bits() | a) - (INTEGERS + b as f64)
}

/// The integer nearest to a·b, of less than 51 bits, and the same integer in the lowest bits of a word.
#[inline(always)]
fn nearest_multiple(a: f64, b: f64) -> (f64, u64) {
    /// Adding it pushes the fraction out of the significand.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let shifted = a.mul_add(b, SHIFT);
    (shifted - SHIFT, shifted.to_bits())
}
