//! Instructions over blocks: every slot is a row with one value for each point or box of a block.

use super::code::{Code, Instruction, Slot};
use crate::Operation;

/// Bytes of all rows together that leave room in a first-level cache of 32 KiB for arguments and outputs.
const ROW_BUDGET: usize = 20 * 1024;
/// The shortest rows, for programs that need many slots.
const SHORTEST: usize = 16;
/// The longest rows; beyond this length the cost of decoding an instruction no longer shows.
const LONGEST: usize = 256;
/// Lanes of which all results are computed before one is written: so the compiler need not ask whether results and operands overlap.
const CHUNK: usize = 8;

/// How many points or boxes, each a `T`, make a block for a program that needs so many slots.
pub(super) fn length<T>(slots: usize) -> usize {
    let fitting = ROW_BUDGET / size_of::<T>() / slots.max(1);
    (fitting / SHORTEST * SHORTEST).clamp(SHORTEST, LONGEST)
}

/// The values of all slots over one block.
pub(super) struct Rows<'a, T> {
    values: &'a mut [T],
    /// The length of a row.
    stride: usize,
    /// How much of each row the block takes: the last one may be shorter.
    length: usize,
}

impl<'a, T: Copy> Rows<'a, T> {
    /// Rows of a `length`, one after the other; what they hold has still to be written.
    pub(super) fn new(values: &'a mut [T], length: usize) -> Self {
        Self { values, stride: length, length }
    }

    /// The row of a slot.
    pub(super) fn row(&self, slot: Slot) -> &[T] {
        &self.values[slot as usize * self.stride..][..self.length]
    }

    /// The row of a slot, to be written.
    pub(super) fn row_mut(&mut self, slot: Slot) -> &mut [T] {
        &mut self.values[slot as usize * self.stride..][..self.length]
    }

    /// Takes no more of each row than a block of this length needs.
    pub(super) fn shorten(&mut self, length: usize) {
        self.length = length.min(self.stride);
    }

    /// Runs all instructions of `code`, each by `execute`.
    pub(super) fn run(&mut self, code: &Code, execute: impl Fn(Operation, &mut Loop<'_, T>)) {
        let (stride, length) = (self.stride, self.length);
        for Instruction { operation, target, operands } in &code.instructions {
            let (before, rest) = self.values.split_at_mut(*target as usize * stride);
            let (result, after) = rest.split_at_mut(length);
            execute(*operation, &mut Loop { before, result, after, stride, operands: *operands });
        }
    }
}

/// One instruction over a block. Loops have no branches, and compile to vector instructions where the function allows it.
pub(super) struct Loop<'a, T> {
    /// What stands before the row that takes the result, and after it.
    before: &'a [T],
    result: &'a mut [T],
    after: &'a [T],
    stride: usize,
    operands: [Slot; 3],
}

impl<'a, T: Copy> Loop<'a, T> {
    #[inline(always)]
    fn operand(&self, place: usize) -> &'a [T] {
        let (start, length) = (self.operands[place] as usize * self.stride, self.result.len());
        match start.checked_sub(self.before.len()) {
            Some(start) => &self.after[start - length..][..length],
            None => &self.before[start..][..length],
        }
    }

    #[inline]
    pub(super) fn unary(&mut self, function: impl Fn(T) -> T) {
        let (a, rest_of_a) = self.operand(0).as_chunks::<CHUNK>();
        let (results, rest) = self.result.as_chunks_mut::<CHUNK>();
        for (results, a) in results.iter_mut().zip(a) {
            *results = std::array::from_fn(|lane| function(a[lane]));
        }
        for (result, a) in rest.iter_mut().zip(rest_of_a) {
            *result = function(*a);
        }
    }

    #[inline]
    pub(super) fn binary(&mut self, function: impl Fn(T, T) -> T) {
        let (a, b) = (self.operand(0), self.operand(1));
        let ((a, rest_of_a), (b, rest_of_b)) = (a.as_chunks::<CHUNK>(), b.as_chunks::<CHUNK>());
        let (results, rest) = self.result.as_chunks_mut::<CHUNK>();
        for ((results, a), b) in results.iter_mut().zip(a).zip(b) {
            *results = std::array::from_fn(|lane| function(a[lane], b[lane]));
        }
        for ((result, a), b) in rest.iter_mut().zip(rest_of_a).zip(rest_of_b) {
            *result = function(*a, *b);
        }
    }

    #[inline]
    pub(super) fn ternary(&mut self, function: impl Fn(T, T, T) -> T) {
        let (a, b, c) = (self.operand(0), self.operand(1), self.operand(2));
        for (lane, result) in self.result.iter_mut().enumerate() {
            *result = function(a[lane], b[lane], c[lane]);
        }
    }
}
