//! Many boxes, a block at a time.

use super::block::{self, Loop, Rows};
use super::code::{Code, Slot};
use crate::engine::{BoxKernel, Boxes, Enclosures, Scratch};
use crate::interval::extension;
use crate::{Axis, Decorated, Extension, Operation};

/// A kernel over batches of boxes.
#[derive(Debug)]
pub(super) struct Boxed {
    code: Code,
    /// The most boxes in a block.
    block: usize,
}

impl Boxed {
    pub(super) fn new(code: Code) -> Self {
        let block = block::length::<Decorated>(code.slots);
        Self { code, block }
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

        let block = self.block.min(count);
        let mut rows = Rows::new(scratch.enclosures(self.code.slots * block), block);
        for (slot, constant) in self.code.constants() {
            rows.row_mut(slot).fill(Decorated::constant(constant.enclosure()));
        }
        for start in (0..count).step_by(block.max(1)) {
            let places = start..count.min(start + block);
            rows.shorten(places.len());
            for axis in Axis::ALL {
                let [lo, hi] = [boxes.lo, boxes.hi].map(|ends| &ends[axis as usize][places.clone()]);
                for (argument, (lo, hi)) in rows.row_mut(axis as Slot).iter_mut().zip(lo.iter().zip(hi)) {
                    *argument = Decorated::argument(*lo, *hi);
                }
            }
            rows.run(&self.code, extend);
            for (output, place) in self.code.outputs.iter().zip((start..).step_by(count)) {
                for (lane, enclosure) in rows.row(*output).iter().enumerate() {
                    (lo[place + lane], hi[place + lane]) = (enclosure.interval.lo, enclosure.interval.hi);
                    decoration[place + lane] = enclosure.decoration;
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
