//! Instructions over blocks: a register holds one value for each point or box of a block.

use std::ops::Range;

use super::code::{Code, Instruction, Slot};
use crate::Operation;

/// Bytes of all registers together that leave room in a first-level cache of 32 KiB for arguments and outputs.
const REGISTER_BUDGET: usize = 20 * 1024;
/// The shortest blocks, for programs that need many registers.
const SHORTEST: usize = 16;
/// The longest blocks; beyond this length the cost of decoding an instruction no longer shows.
const LONGEST: usize = 256;

/// How many points or boxes, each a `T`, make a block for a program that needs `registers` registers.
pub(super) fn length<T>(registers: usize) -> usize {
    let fitting = REGISTER_BUDGET / size_of::<T>() / registers.max(1);
    (fitting / SHORTEST * SHORTEST).clamp(SHORTEST, LONGEST)
}

/// What instructions read besides registers while they run over one block.
pub(super) struct Block<'a, T> {
    /// The arguments of this block and others.
    pub(super) arguments: &'a [&'a [T]],
    /// Where those of this block stand.
    pub(super) places: Range<usize>,
    pub(super) constants: &'a [T],
    /// The length of a register; the block itself may be shorter.
    pub(super) stride: usize,
}

impl<T: Copy> Block<'_, T> {
    /// Runs all instructions of `code`, each by `execute`.
    pub(super) fn run(
        &self,
        code: &Code,
        registers: &mut [T],
        execute: impl Fn(Operation, &mut Loop<'_, T>),
    ) {
        for Instruction { operation, target, operands } in &code.instructions {
            let (before, rest) = registers.split_at_mut(*target as usize * self.stride);
            let (result, after) = rest.split_at_mut(self.stride);
            let result = &mut result[..self.length()];
            execute(*operation, &mut Loop { block: self, before, after, result, operands: *operands });
        }
    }

    /// What has been computed for the output at `slot`.
    pub(super) fn output<'a>(&'a self, slot: Slot, registers: &'a [T]) -> Operand<'a, T> {
        self.operand(slot, |start| &registers[start..])
    }

    fn length(&self) -> usize {
        self.places.len()
    }

    /// The operand at `slot`; `register` gives what stands from a place among the registers.
    #[inline]
    fn operand<'a>(&'a self, slot: Slot, register: impl FnOnce(usize) -> &'a [T]) -> Operand<'a, T> {
        let slot = slot as usize;
        if let Some(argument) = self.arguments.get(slot) {
            Operand::Lanes(&argument[self.places.clone()])
        } else if let Some(constant) = self.constants.get(slot - self.arguments.len()) {
            Operand::Constant(*constant)
        } else {
            let register = register((slot - self.arguments.len() - self.constants.len()) * self.stride);
            Operand::Lanes(&register[..self.length()])
        }
    }
}

/// Where an instruction's operand comes from.
#[derive(Clone, Copy)]
pub(super) enum Operand<'a, T> {
    /// A value for each lane of the block.
    Lanes(&'a [T]),
    /// The same value for every lane.
    Constant(T),
}

impl<T: Copy> Operand<'_, T> {
    #[inline]
    pub(super) fn at(&self, lane: usize) -> T {
        match self {
            Self::Lanes(lanes) => lanes[lane],
            Self::Constant(constant) => *constant,
        }
    }
}

/// One instruction over a block. Each combination of operands gets a loop of its own, without branches, which compiles to
/// vector instructions where the function allows it.
pub(super) struct Loop<'a, T> {
    block: &'a Block<'a, T>,
    /// The registers before the one that takes the result, and those after it.
    before: &'a [T],
    after: &'a [T],
    result: &'a mut [T],
    operands: [Slot; 3],
}

impl<'a, T: Copy> Loop<'a, T> {
    #[inline]
    fn operand(&self, place: usize) -> Operand<'a, T> {
        let start_of_after = self.before.len() + self.block.stride;
        self.block.operand(self.operands[place], |start| match start.checked_sub(start_of_after) {
            Some(start) => &self.after[start..],
            None => &self.before[start..],
        })
    }

    #[inline]
    pub(super) fn unary(&mut self, function: impl Fn(T) -> T) {
        match self.operand(0) {
            Operand::Lanes(a) => {
                for (result, a) in self.result.iter_mut().zip(a) {
                    *result = function(*a);
                }
            }
            Operand::Constant(a) => self.result.fill(function(a)),
        }
    }

    #[inline]
    pub(super) fn binary(&mut self, function: impl Fn(T, T) -> T) {
        match (self.operand(0), self.operand(1)) {
            (Operand::Lanes(a), Operand::Lanes(b)) => {
                for ((result, a), b) in self.result.iter_mut().zip(a).zip(b) {
                    *result = function(*a, *b);
                }
            }
            (Operand::Lanes(a), Operand::Constant(b)) => {
                for (result, a) in self.result.iter_mut().zip(a) {
                    *result = function(*a, b);
                }
            }
            (Operand::Constant(a), Operand::Lanes(b)) => {
                for (result, b) in self.result.iter_mut().zip(b) {
                    *result = function(a, *b);
                }
            }
            (Operand::Constant(a), Operand::Constant(b)) => self.result.fill(function(a, b)),
        }
    }

    #[inline]
    pub(super) fn ternary(&mut self, function: impl Fn(T, T, T) -> T) {
        let (a, b, c) = (self.operand(0), self.operand(1), self.operand(2));
        for (lane, result) in self.result.iter_mut().enumerate() {
            *result = function(a.at(lane), b.at(lane), c.at(lane));
        }
    }
}
