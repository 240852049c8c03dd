//! Boxes, one at a time.

use super::code::{Code, Slot};
use crate::engine::{BoxKernel, Boxes, Enclosures, Scratch};
use crate::{Decorated, Extension};

/// A kernel over boxes: every slot holds a decorated interval.
#[derive(Debug)]
pub(super) struct Boxed {
    steps: Vec<Step>,
    constants: Vec<Decorated>,
    slots: usize,
    outputs: Vec<Slot>,
}

/// An instruction with what it calls.
#[derive(Debug)]
struct Step {
    extension: Extension,
    target: Slot,
    operands: [Slot; 3],
}

impl Boxed {
    pub(super) fn new(code: Code) -> Self {
        let first_register = code.first_register();
        let steps = code.instructions.iter().map(|instruction| Step {
            extension: instruction.operation.extension(),
            target: first_register as Slot + instruction.target,
            operands: instruction.operands,
        });
        Self {
            steps: steps.collect(),
            constants: code
                .constants
                .iter()
                .map(|constant| Decorated::constant(constant.enclosure()))
                .collect(),
            slots: first_register + code.registers,
            outputs: code.outputs,
        }
    }
}

impl BoxKernel for Boxed {
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>) {
        let count = boxes.lo[0].len();
        assert!(boxes.lo.iter().chain(&boxes.hi).all(|ends| ends.len() == count), "six ends for each box");
        let Enclosures { lo, hi, decoration } = enclosures;
        let expected = count * self.outputs.len();
        assert!(
            [lo.len(), hi.len(), decoration.len()] == [expected; 3],
            "one enclosure for each output and box"
        );
        let slots = scratch.enclosures(self.slots);
        slots[Code::FIRST_CONSTANT..][..self.constants.len()].copy_from_slice(&self.constants);
        for index in 0..count {
            for ((slot, lo), hi) in slots.iter_mut().zip(boxes.lo).zip(boxes.hi) {
                *slot = Decorated::argument(lo[index], hi[index]);
            }
            self.run(slots);
            for (place, output) in self.outputs.iter().enumerate() {
                let Decorated { interval, decoration: known } = slots[*output as usize];
                let place = place * count + index;
                (lo[place], hi[place], decoration[place]) = (interval.lo, interval.hi, known);
            }
        }
    }
}

impl Boxed {
    fn run(&self, slots: &mut [Decorated]) {
        for step in &self.steps {
            let operand = |place: usize| slots[step.operands[place] as usize];
            slots[step.target as usize] = match step.extension {
                Extension::Unary(extend) => extend(operand(0)),
                Extension::Binary(extend) => extend(operand(0), operand(1)),
                Extension::Ternary(extend) => extend(operand(0), operand(1), operand(2)),
            };
        }
    }
}
