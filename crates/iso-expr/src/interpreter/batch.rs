//! Many points, a block at a time.

use super::block::{self, Loop, Rows};
use super::code::Code;
use super::dispatch::{Visitor, visit};
use crate::engine::{BatchKernel, Scratch};

/// A kernel over batches of points.
#[derive(Debug)]
pub(super) struct Batch {
    code: Code,
    /// The most points in a block.
    block: usize,
}

impl Batch {
    pub(super) fn new(code: Code) -> Self {
        let block = block::length::<f64>(code.slots);
        Self { code, block }
    }
}

impl BatchKernel for Batch {
    fn evaluate(&self, scratch: &mut Scratch, arguments: &[&[f64]], values: &mut [f64]) {
        let count = arguments.first().map_or(0, |argument| argument.len());
        assert!(arguments.iter().all(|argument| argument.len() == count), "all arguments of each point");
        let arguments = &arguments[..self.code.arguments];
        assert_eq!(values.len(), count * self.code.outputs.len(), "one value for each output and point");
        let block = self.block.min(count);
        let mut rows = Rows::new(scratch.values(self.code.slots * block), block);
        for (slot, constant) in self.code.constants() {
            rows.row_mut(slot).fill(constant.value());
        }
        for start in (0..count).step_by(block.max(1)) {
            let places = start..count.min(start + block);
            rows.shorten(places.len());
            for (slot, argument) in (0..).zip(arguments) {
                rows.row_mut(slot).copy_from_slice(&argument[places.clone()]);
            }
            rows.run(&self.code, |operation, lanes| visit(operation, lanes));
            for (output, values) in self.code.outputs.iter().zip(values.chunks_exact_mut(count)) {
                values[places.clone()].copy_from_slice(rows.row(*output));
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
