//! Many points, a block at a time.

use super::code::{Code, Instruction, Slot};
use super::dispatch::{Visitor, visit};
use crate::engine::{BatchKernel, Points, Scratch};

/// A kernel over batches of points: a register holds one double for each point of a block.
#[derive(Debug)]
pub(super) struct Batch {
    code: Code,
    constants: Vec<f64>,
    /// The most points in a block.
    block: usize,
}

/// Doubles in all registers together that leave room in a first-level cache of 32 KiB for the points and the values.
const REGISTER_BUDGET: usize = 2560;
/// The shortest blocks, for programs that need many registers.
const SHORTEST_BLOCK: usize = 16;
/// The longest blocks; beyond this length the cost of decoding an instruction no longer shows.
const LONGEST_BLOCK: usize = 256;

impl Batch {
    pub(super) fn new(code: Code) -> Self {
        let constants = code.constants.iter().map(|constant| constant.value()).collect();
        let block = REGISTER_BUDGET / code.registers.max(1) / SHORTEST_BLOCK * SHORTEST_BLOCK;
        Self { code, constants, block: block.clamp(SHORTEST_BLOCK, LONGEST_BLOCK) }
    }
}

impl BatchKernel for Batch {
    fn evaluate(&self, scratch: &mut Scratch, points: Points<'_>, values: &mut [f64]) {
        let count = points.x.len();
        assert!(points.y.len() == count && points.z.len() == count, "three coordinates for each point");
        assert_eq!(values.len(), count * self.code.outputs.len(), "one value for each output and point");
        let registers = scratch.values(self.code.registers * self.block);
        for start in (0..count).step_by(self.block) {
            let range = start..count.min(start + self.block);
            let arguments = [&points.x[range.clone()], &points.y[range.clone()], &points.z[range.clone()]];
            let block = Block { arguments, constants: &self.constants, stride: self.block };
            for instruction in &self.code.instructions {
                block.execute(instruction, registers);
            }
            for (output, values) in self.code.outputs.iter().zip(values.chunks_exact_mut(count)) {
                block.copy(*output, registers, &mut values[range.clone()]);
            }
        }
    }
}

/// A block of points, and what else instructions read besides registers.
struct Block<'a> {
    arguments: [&'a [f64]; 3],
    constants: &'a [f64],
    /// The length of a register; the block itself may be shorter.
    stride: usize,
}

impl Block<'_> {
    fn length(&self) -> usize {
        self.arguments[0].len()
    }

    fn execute(&self, instruction: &Instruction, registers: &mut [f64]) {
        let target = instruction.target as usize;
        let (before, rest) = registers.split_at_mut(target * self.stride);
        let (result, after) = rest.split_at_mut(self.stride);
        let operands = instruction.operands.map(|slot| {
            self.operand(slot, |register| {
                if register < target {
                    &before[register * self.stride..]
                } else {
                    &after[(register - target - 1) * self.stride..]
                }
            })
        });
        visit(instruction.operation, Loop { result: &mut result[..self.length()], operands });
    }

    fn copy(&self, output: Slot, registers: &[f64], values: &mut [f64]) {
        match self.operand(output, |register| &registers[register * self.stride..]) {
            Operand::Lanes(lanes) => values.copy_from_slice(lanes),
            Operand::Constant(constant) => values.fill(constant),
        }
    }

    fn operand<'a>(&'a self, slot: Slot, register: impl FnOnce(usize) -> &'a [f64]) -> Operand<'a> {
        let slot = slot as usize;
        if let Some(argument) = self.arguments.get(slot) {
            Operand::Lanes(argument)
        } else if let Some(constant) = self.constants.get(slot - Code::FIRST_CONSTANT) {
            Operand::Constant(*constant)
        } else {
            let register = register(slot - Code::FIRST_CONSTANT - self.constants.len());
            Operand::Lanes(&register[..self.length()])
        }
    }
}

/// Where an instruction's operand comes from.
#[derive(Clone, Copy)]
enum Operand<'a> {
    /// One double for each point of the block.
    Lanes(&'a [f64]),
    /// The same double for every point.
    Constant(f64),
}

impl Operand<'_> {
    #[inline]
    fn at(&self, lane: usize) -> f64 {
        match self {
            Self::Lanes(lanes) => lanes[lane],
            Self::Constant(constant) => *constant,
        }
    }
}

/// One instruction over a block. Each combination of operands gets a loop that compiles to vector instructions.
struct Loop<'a> {
    result: &'a mut [f64],
    operands: [Operand<'a>; 3],
}

impl Visitor for Loop<'_> {
    type Output = ();

    fn unary(self, value: impl Fn(f64) -> f64) {
        match self.operands[0] {
            Operand::Lanes(a) => {
                for (result, a) in self.result.iter_mut().zip(a) {
                    *result = value(*a);
                }
            }
            Operand::Constant(a) => self.result.fill(value(a)),
        }
    }

    fn binary(self, value: impl Fn(f64, f64) -> f64) {
        match (self.operands[0], self.operands[1]) {
            (Operand::Lanes(a), Operand::Lanes(b)) => {
                for ((result, a), b) in self.result.iter_mut().zip(a).zip(b) {
                    *result = value(*a, *b);
                }
            }
            (Operand::Lanes(a), Operand::Constant(b)) => {
                for (result, a) in self.result.iter_mut().zip(a) {
                    *result = value(*a, b);
                }
            }
            (Operand::Constant(a), Operand::Lanes(b)) => {
                for (result, b) in self.result.iter_mut().zip(b) {
                    *result = value(a, *b);
                }
            }
            (Operand::Constant(a), Operand::Constant(b)) => self.result.fill(value(a, b)),
        }
    }

    fn ternary(self, value: impl Fn(f64, f64, f64) -> f64) {
        let [a, b, c] = self.operands;
        for (lane, result) in self.result.iter_mut().enumerate() {
            *result = value(a.at(lane), b.at(lane), c.at(lane));
        }
    }
}
