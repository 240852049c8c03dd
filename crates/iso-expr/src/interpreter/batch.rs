//! Many points, a block at a time.

use super::block::{self, Block, Loop, Operand};
use super::code::Code;
use super::dispatch::{Visitor, visit};
use crate::engine::{BatchKernel, Scratch};

/// A kernel over batches of points.
#[derive(Debug)]
pub(super) struct Batch {
    code: Code,
    constants: Vec<f64>,
    /// The most points in a block.
    block: usize,
}

impl Batch {
    pub(super) fn new(code: Code) -> Self {
        let constants = code.constants.iter().map(|constant| constant.value()).collect();
        let block = block::length::<f64>(code.registers);
        Self { code, constants, block }
    }
}

impl BatchKernel for Batch {
    fn evaluate(&self, scratch: &mut Scratch, arguments: &[&[f64]], values: &mut [f64]) {
        let count = arguments.first().map_or(0, |argument| argument.len());
        assert!(arguments.iter().all(|argument| argument.len() == count), "all arguments of each point");
        let arguments = &arguments[..self.code.arguments];
        assert_eq!(values.len(), count * self.code.outputs.len(), "one value for each output and point");
        let registers = scratch.values(self.code.registers * self.block);
        for start in (0..count).step_by(self.block) {
            let range = start..count.min(start + self.block);
            let block =
                Block { arguments, places: range.clone(), constants: &self.constants, stride: self.block };
            block.run(&self.code, registers, |operation, lanes| visit(operation, lanes));
            for (output, values) in self.code.outputs.iter().zip(values.chunks_exact_mut(count)) {
                match block.output(*output, registers) {
                    Operand::Lanes(lanes) => values[range.clone()].copy_from_slice(lanes),
                    Operand::Constant(constant) => values[range.clone()].fill(constant),
                }
            }
        }
    }
}

impl Visitor for &mut Loop<'_, f64> {
    type Output = ();

    fn unary(self, value: impl Fn(f64) -> f64) {
        Loop::unary(self, value);
    }

    fn binary(self, value: impl Fn(f64, f64) -> f64) {
        Loop::binary(self, value);
    }

    fn ternary(self, value: impl Fn(f64, f64, f64) -> f64) {
        Loop::ternary(self, value);
    }
}
