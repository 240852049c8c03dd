//! One point at a time.

use super::code::{Code, Slot};
use super::dispatch::{Visitor, visit};
use crate::engine::{PointKernel, Scratch};

/// A kernel over one point: every slot holds one double.
#[derive(Debug)]
pub(super) struct Point {
    code: Code,
}

impl Point {
    pub(super) fn new(code: Code) -> Self {
        Self { code }
    }
}

impl PointKernel for Point {
    fn evaluate(&self, scratch: &mut Scratch, x: f64, y: f64, z: f64, values: &mut [f64]) {
        assert_eq!(values.len(), self.code.outputs.len(), "one value for each output");
        let slots = scratch.values(self.code.slots);
        slots[..self.code.arguments].copy_from_slice(&[x, y, z]);
        for (slot, constant) in self.code.constants() {
            slots[slot as usize] = constant.value();
        }
        for instruction in &self.code.instructions {
            let result = visit(instruction.operation, Operands { slots, places: instruction.operands });
            slots[instruction.target as usize] = result;
        }
        for (value, output) in values.iter_mut().zip(&self.code.outputs) {
            *value = slots[*output as usize];
        }
    }
}

/// The operands of one instruction.
struct Operands<'a> {
    slots: &'a [f64],
    places: [Slot; 3],
}

impl Operands<'_> {
    fn get(&self, place: usize) -> f64 {
        self.slots[self.places[place] as usize]
    }
}

impl Visitor for Operands<'_> {
    type Output = f64;

    fn unary(self, value: impl Fn(f64) -> f64) -> f64 {
        value(self.get(0))
    }

    fn binary(self, value: impl Fn(f64, f64) -> f64) -> f64 {
        value(self.get(0), self.get(1))
    }

    fn ternary(self, value: impl Fn(f64, f64, f64) -> f64) -> f64 {
        value(self.get(0), self.get(1), self.get(2))
    }
}
