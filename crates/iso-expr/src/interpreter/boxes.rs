//! Many boxes, a block at a time.

use super::block::{self, Block, Loop};
use super::code::Code;
use crate::engine::{BoxKernel, Boxes, Enclosures, Scratch};
use crate::interval::extension;
use crate::{Decorated, Extension, Operation};

/// A kernel over batches of boxes.
#[derive(Debug)]
pub(super) struct Boxed {
    code: Code,
    constants: Vec<Decorated>,
    /// The most boxes in a block.
    block: usize,
}

impl Boxed {
    pub(super) fn new(code: Code) -> Self {
        let constants =
            code.constants.iter().map(|constant| Decorated::constant(constant.enclosure())).collect();
        let block = block::length::<Decorated>(3 + code.registers);
        Self { code, constants, block }
    }
}

impl BoxKernel for Boxed {
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>) {
        let count = boxes.lo[0].len();
        let Enclosures { lo, hi, decoration } = enclosures;
        let expected = count * self.code.outputs.len();
        assert!(boxes.lo.iter().chain(&boxes.hi).all(|ends| ends.len() == count), "six ends for each box");
        assert_eq!(
            [lo.len(), hi.len(), decoration.len()],
            [expected; 3],
            "an enclosure for each output and box"
        );

        let room = scratch.enclosures((3 + self.code.registers) * self.block);
        let (arguments, registers) = room.split_at_mut(3 * self.block);
        for start in (0..count).step_by(self.block) {
            let length = self.block.min(count - start);
            for (axis, arguments) in arguments.chunks_exact_mut(self.block).enumerate() {
                let ends = boxes.lo[axis][start..].iter().zip(&boxes.hi[axis][start..]);
                for (argument, (lo, hi)) in arguments.iter_mut().zip(ends) {
                    *argument = Decorated::argument(*lo, *hi);
                }
            }
            let argument = |axis: usize| &arguments[axis * self.block..];
            let block = Block {
                arguments: &[argument(0), argument(1), argument(2)],
                places: 0..length,
                constants: &self.constants,
                stride: self.block,
            };
            block.run(&self.code, registers, extend);
            for (place, output) in self.code.outputs.iter().enumerate() {
                let enclosures = block.output(*output, registers);
                for lane in 0..length {
                    let (enclosure, place) = (enclosures.at(lane), place * count + start + lane);
                    (lo[place], hi[place]) = (enclosure.interval.lo, enclosure.interval.hi);
                    decoration[place] = enclosure.decoration;
                }
            }
        }
    }
}

/// Runs one instruction. The loops of the commonest operations are compiled each for its own; for the others the call
/// costs little beside the work.
fn extend(operation: Operation, lanes: &mut Loop<'_, Decorated>) {
    match operation {
        Operation::Add => lanes.binary(extension::add),
        Operation::Subtract => lanes.binary(extension::subtract),
        Operation::Multiply => lanes.binary(extension::multiply),
        Operation::Divide => lanes.binary(extension::divide),
        Operation::Negate => lanes.unary(extension::negate),
        Operation::Minimum => lanes.binary(extension::minimum),
        Operation::Maximum => lanes.binary(extension::maximum),
        Operation::SquareRoot => lanes.unary(extension::square_root),
        Operation::IntegerPower => lanes.binary(extension::integer_power),
        Operation::Less => lanes.binary(extension::less),
        Operation::Select => lanes.ternary(extension::select),
        _ => match operation.extension() {
            Extension::Unary(extend) => lanes.unary(extend),
            Extension::Binary(extend) => lanes.binary(extend),
            Extension::Ternary(extend) => lanes.ternary(extend),
        },
    }
}
