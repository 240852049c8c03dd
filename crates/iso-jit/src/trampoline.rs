//! The way from native code to the interval extensions that are not written out.

use std::mem::offset_of;

use cranelift_codegen::ir::{InstBuilder, StackSlot, StackSlotData, StackSlotKind, types};
use iso_expr::{Decorated, Decoration, Extension, Interval, Operation};

use crate::enclosures::{Enclosure, known};
use crate::lanes::Writer;
use crate::symbols::Calls;

/// The enclosures over two boxes in memory, as [`Enclosure`] holds them in registers.
#[repr(C, align(16))]
pub(crate) struct Pair {
    lo: [f64; 2],
    minus_hi: [f64; 2],
    known: [u64; 2],
}

impl Pair {
    fn get(&self, lane: usize) -> Decorated {
        let decoration = match self.known[lane].count_ones() {
            0 => Decoration::Trivial,
            1 => Decoration::Defined,
            2 => Decoration::Continuous,
            _ => Decoration::Common,
        };
        Decorated { interval: Interval { lo: self.lo[lane], hi: -self.minus_hi[lane] }, decoration }
    }

    fn set(&mut self, lane: usize, enclosure: Decorated) {
        self.lo[lane] = enclosure.interval.lo;
        self.minus_hi[lane] = -enclosure.interval.hi;
        self.known[lane] = known(enclosure.decoration);
    }
}

/// Applies the extension of `operation` to its operands over each of two boxes. Native code calls it.
///
/// # Safety
/// Behind `operands` there are as many as the operation's arity; behind `result` there is room for one.
pub(crate) unsafe extern "C" fn extend(operation: Operation, operands: *const Pair, result: *mut Pair) {
    // SAFETY: as many operands as the arity are there.
    let operands = unsafe { std::slice::from_raw_parts(operands, operation.arity()) };
    // SAFETY: the room is there, and apart from the operands.
    let result = unsafe { &mut *result };
    for lane in 0..2 {
        let operand = |place: usize| operands[place].get(lane);
        let enclosure = match operation.extension() {
            Extension::Unary(extend) => extend(operand(0)),
            Extension::Binary(extend) => extend(operand(0), operand(1)),
            Extension::Ternary(extend) => extend(operand(0), operand(1), operand(2)),
        };
        result.set(lane, enclosure);
    }
}

/// Room on a kernel's stack for the operands and the result of a call: the same for every call.
pub(crate) struct Room(StackSlot);

/// The most operands of an operation.
const MOST_OPERANDS: usize = 3;

impl Room {
    /// Sets room aside.
    pub(crate) fn new(writer: &mut Writer<'_, '_>) -> Self {
        let size = (MOST_OPERANDS + 1) * size_of::<Pair>();
        let align_shift = align_of::<Pair>().trailing_zeros() as u8;
        let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, size as u32, align_shift);
        Self(writer.builder.create_sized_stack_slot(slot))
    }

    /// Writes a call of [`extend`].
    pub(crate) fn call(
        &self,
        writer: &mut Writer<'_, '_>,
        calls: &mut Calls<'_>,
        operation: Operation,
        operands: &[Enclosure],
    ) -> Enclosure {
        for (place, operand) in operands.iter().enumerate() {
            let start = place * size_of::<Pair>();
            for (value, offset) in [
                (operand.lo, start + offset_of!(Pair, lo)),
                (operand.minus_hi, start + offset_of!(Pair, minus_hi)),
                (operand.known, start + offset_of!(Pair, known)),
            ] {
                writer.builder.ins().stack_store(types::I64, value, self.0, offset as i32);
            }
        }
        let result = (MOST_OPERANDS * size_of::<Pair>()) as i32;
        let index = writer.builder.ins().iconst(types::I8, operation.index() as i64);
        let operands = writer.builder.ins().stack_addr(types::I64, self.0, 0);
        let address = writer.builder.ins().stack_addr(types::I64, self.0, result);
        let extend = calls.extend(writer.builder.func);
        writer.builder.ins().call(extend, &[index, operands, address]);
        let mut load = |ty, offset: usize| {
            writer.builder.ins().stack_load(types::I64, ty, self.0, result + offset as i32)
        };
        Enclosure {
            lo: load(types::F64X2, offset_of!(Pair, lo)),
            minus_hi: load(types::F64X2, offset_of!(Pair, minus_hi)),
            known: load(types::I64X2, offset_of!(Pair, known)),
        }
    }
}
