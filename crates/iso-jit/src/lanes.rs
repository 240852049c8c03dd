//! Doubles side by side: one way of writing code for one double and for two in a 128-bit register.

use std::collections::HashMap;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    ConstantData, FuncRef, InstBuilder, MemFlagsData, StackSlot, StackSlotData, StackSlotKind, Type, Value,
    types,
};
use cranelift_frontend::FunctionBuilder;

/// How many doubles one value of the written code holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lanes {
    /// One.
    One,
    /// Two, in a 128-bit register.
    Two,
}

impl Lanes {
    /// The type of such values.
    pub(crate) fn ty(self) -> Type {
        match self {
            Self::One => types::F64,
            Self::Two => types::F64X2,
        }
    }

    /// How many doubles that is.
    pub(crate) fn count(self) -> usize {
        self.ty().lane_count() as usize
    }
}

/// Writes instructions on doubles side by side. Every instruction does the same in every lane.
pub(crate) struct Writer<'a, 'b> {
    pub(crate) builder: &'a mut FunctionBuilder<'b>,
    pub(crate) lanes: Lanes,
    /// The constants so far, by their bits.
    constants: HashMap<u64, Value>,
    /// Room on the stack for the doubles of calls in place, the same for every call.
    room: Option<StackSlot>,
}

/// The truth of a comparison in each lane: a byte for one lane, a mask of ones or zeros for two.
#[derive(Clone, Copy)]
pub(crate) struct Mask(pub(crate) Value);

impl<'a, 'b> Writer<'a, 'b> {
    /// Writes to the block where `builder` stands, and to no other.
    pub(crate) fn new(builder: &'a mut FunctionBuilder<'b>, lanes: Lanes) -> Self {
        Self { builder, lanes, constants: HashMap::new(), room: None }
    }
}

impl Writer<'_, '_> {
    /// The same double in every lane.
    pub(crate) fn constant(&mut self, value: f64) -> Value {
        let (builder, lanes) = (&mut *self.builder, self.lanes);
        *self.constants.entry(value.to_bits()).or_insert_with(|| match lanes {
            Lanes::One => builder.ins().f64const(value),
            Lanes::Two => vector(builder, [value; 2]),
        })
    }

    /// Makes constants anew from here on. Where there are many values, constants that stay in registers from their first use to
    /// their last are in the way of others, and of the allocation of registers, which takes longer than in proportion.
    pub(crate) fn forget_constants(&mut self) {
        self.constants.clear();
    }

    /// The address at a place of a list of addresses.
    pub(crate) fn load_address(&mut self, list: Value, place: usize) -> Value {
        let offset = (size_of::<usize>() * place) as i32;
        self.builder.ins().load(types::I64, slice_access(), list, offset)
    }

    /// The doubles that stand `offset` bytes after `address`.
    pub(crate) fn load(&mut self, address: Value, offset: i32) -> Value {
        self.builder.ins().load(self.lanes.ty(), slice_access(), address, offset)
    }

    /// Puts doubles `offset` bytes after `address`.
    pub(crate) fn store(&mut self, value: Value, address: Value, offset: i32) {
        self.builder.ins().store(slice_access(), value, address, offset);
    }

    /// Where `a` and `b` compare as `condition` says.
    pub(crate) fn compare(&mut self, condition: FloatCC, a: Value, b: Value) -> Mask {
        Mask(self.builder.ins().fcmp(condition, a, b))
    }

    /// Where `a` is a zero.
    pub(crate) fn is_zero(&mut self, a: Value) -> Mask {
        let zero = self.constant(0.0);
        self.compare(FloatCC::Equal, a, zero)
    }

    /// Where `a` is NaN.
    pub(crate) fn is_nan(&mut self, a: Value) -> Mask {
        self.compare(FloatCC::Unordered, a, a)
    }

    /// `a` where the mask holds, else `b`.
    pub(crate) fn choose(&mut self, Mask(mask): Mask, a: Value, b: Value) -> Value {
        match self.lanes {
            Lanes::One => self.builder.ins().select(mask, a, b),
            Lanes::Two => {
                let mask = self.builder.ins().bitcast(types::F64X2, MemFlagsData::new(), mask);
                self.builder.ins().bitselect(mask, a, b)
            }
        }
    }

    /// Calls a function of doubles that gives a double, once for each lane.
    pub(crate) fn call(&mut self, function: FuncRef, operands: &[Value]) -> Value {
        if self.lanes == Lanes::One {
            return self.call_once(function, operands);
        }
        let [low, high] = [0, 1].map(|lane| {
            let operands: Vec<_> =
                operands.iter().map(|&a| self.builder.ins().extractlane(a, lane)).collect();
            self.call_once(function, &operands)
        });
        let low = self.builder.ins().scalar_to_vector(types::F64X2, low);
        self.builder.ins().insertlane(low, high, 1)
    }

    /// Calls a function of a pointer to the doubles of all `operands`, one after the other, which it replaces by `count` results,
    /// no more than twice as many.
    pub(crate) fn call_in_place(
        &mut self,
        function: FuncRef,
        operands: &[Value],
        count: usize,
    ) -> Vec<Value> {
        let ty = self.lanes.ty();
        let room = *self.room.get_or_insert_with(|| {
            let size = 2 * ty.bytes() * operands.len() as u32;
            let align_shift = size_of::<f64>().trailing_zeros() as u8;
            let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, size, align_shift);
            self.builder.create_sized_stack_slot(slot)
        });
        let offsets = (0..).step_by(ty.bytes() as usize);
        for (operand, offset) in operands.iter().zip(offsets.clone()) {
            self.builder.ins().stack_store(types::I64, *operand, room, offset);
        }
        let address = self.builder.ins().stack_addr(types::I64, room, 0);
        self.builder.ins().call(function, &[address]);
        let load = |offset| self.builder.ins().stack_load(types::I64, ty, room, offset);
        offsets.take(count).map(load).collect()
    }

    fn call_once(&mut self, function: FuncRef, operands: &[Value]) -> Value {
        let call = self.builder.ins().call(function, operands);
        self.builder.inst_results(call)[0]
    }
}

/// Pairs of single doubles, for two evaluations by one instruction.
impl Writer<'_, '_> {
    /// Two doubles side by side.
    pub(crate) fn constants(&mut self, values: [f64; 2]) -> Value {
        vector(self.builder, values)
    }

    /// Two values side by side.
    pub(crate) fn pair(&mut self, [a, b]: [Value; 2]) -> Value {
        // One instruction on x86, where filling the other lane with zero takes two.
        let a = self.builder.ins().splat(types::F64X2, a);
        self.builder.ins().insertlane(a, b, 1)
    }

    /// The two values of a pair.
    pub(crate) fn singles(&mut self, pair: Value) -> [Value; 2] {
        [0, 1].map(|lane| self.builder.ins().extractlane(pair, lane))
    }
}

/// What masks do to pairs of doubles, whose bits they cover.
impl Writer<'_, '_> {
    /// Where both hold.
    pub(crate) fn both(&mut self, Mask(a): Mask, Mask(b): Mask) -> Mask {
        Mask(self.builder.ins().band(a, b))
    }

    /// Where one holds.
    pub(crate) fn either(&mut self, Mask(a): Mask, Mask(b): Mask) -> Mask {
        Mask(self.builder.ins().bor(a, b))
    }

    /// `a` where the mask holds, else +0.
    pub(crate) fn keep(&mut self, mask: Mask, a: Value) -> Value {
        let mask = self.doubles(mask.0);
        self.builder.ins().band(a, mask)
    }

    /// +0 where the mask holds, else `a`.
    pub(crate) fn clear(&mut self, mask: Mask, a: Value) -> Value {
        let mask = self.doubles(mask.0);
        self.builder.ins().band_not(a, mask)
    }

    /// NaN where the mask holds, else `a`.
    pub(crate) fn undefine(&mut self, mask: Mask, a: Value) -> Value {
        let mask = self.doubles(mask.0);
        self.builder.ins().bor(a, mask)
    }

    /// `a` with the other sign: one instruction, where Cranelift's own needs two more for the sign.
    pub(crate) fn negated(&mut self, a: Value) -> Value {
        let sign = self.constant(-0.0);
        self.builder.ins().bxor(a, sign)
    }

    /// The absolute value, in one instruction.
    pub(crate) fn magnitude(&mut self, a: Value) -> Value {
        let sign = self.constant(-0.0);
        self.builder.ins().band_not(a, sign)
    }

    /// The bits of two doubles as integers.
    pub(crate) fn bits(&mut self, doubles: Value) -> Value {
        self.builder.ins().bitcast(types::I64X2, MemFlagsData::new(), doubles)
    }

    /// Two doubles of these bits.
    pub(crate) fn doubles(&mut self, bits: Value) -> Value {
        self.builder.ins().bitcast(types::F64X2, MemFlagsData::new(), bits)
    }

    /// The same integer in both lanes.
    pub(crate) fn integers(&mut self, value: u64) -> Value {
        let constant = self.constant(f64::from_bits(value));
        self.bits(constant)
    }
}

/// Two doubles in two lanes.
fn vector(builder: &mut FunctionBuilder<'_>, values: [f64; 2]) -> Value {
    let bytes = values.map(|value| value.to_bits().to_le_bytes()).concat();
    let constant = builder.func.dfg.constants.insert(ConstantData::from(bytes));
    builder.ins().vconst(types::F64X2, constant)
}

/// Elements of slices of doubles: never trapping, aligned to eight bytes only.
fn slice_access() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}
