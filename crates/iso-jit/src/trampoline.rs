//! The way from native code to the interval extensions that are not written out.

use std::mem::offset_of;

use cranelift_codegen::ir::{InstBuilder, StackSlot, StackSlotData, StackSlotKind, Type, Value, types};
use iso_expr::interval::{ByEnds, sine_and_cosine_by_ends};
use iso_expr::{Decorated, Decoration, Interval, Operation};

use crate::elementary;
use crate::enclosures::{Enclosure, decoration_of, known};
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
        let interval = Interval { lo: self.lo[lane], hi: -self.minus_hi[lane] };
        Decorated { interval, decoration: decoration_of(self.known[lane]) }
    }

    /// Whether both enclosures are equal. They are, all through a kernel, where it is given a single box.
    fn is_twice_the_same(&self) -> bool {
        let same = |ends: [f64; 2]| ends[0].to_bits() == ends[1].to_bits();
        same(self.lo) && same(self.minus_hi) && self.known[0] == self.known[1]
    }

    /// The lower ends, the upper ends, and both again, to fill the lanes of a function with numbers of which it gives the values anyway: of
    /// others it might have to call the scalar function.
    fn ends_twice(&self) -> [f64; elementary::WIDTH] {
        let ([a, b], [c, d]) = (self.lo, self.minus_hi.map(|end| -end));
        [a, b, c, d, a, b, c, d]
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
    let extended = |lane: usize| {
        let operand = |place: usize| operands.get(place).map_or(Decorated::EMPTY, |pair| pair.get(lane));
        operation.extension().of([0, 1, 2].map(operand))
    };
    let first = extended(0);
    result.set(0, first);
    result.set(1, if operands.iter().all(Pair::is_twice_the_same) { first } else { extended(1) });
}

/// Applies an extension to one operand over each of two boxes. `function` computes the values at all ends at once. Native code calls it.
///
/// # Safety
/// Behind `operand` and `result` there are different places, and `function` is one that [`elementary::function`] gave.
pub(crate) unsafe extern "C" fn extend_by_ends(
    by_ends: ByEnds,
    function: elementary::InPlace,
    operand: *const Pair,
    result: *mut Pair,
) {
    // SAFETY: both are there, and apart.
    let (operand, result) = unsafe { (&*operand, &mut *result) };
    let mut ends = operand.ends_twice();
    // SAFETY: this processor has the features that the function was compiled for.
    unsafe { function(&mut ends) };
    for lane in 0..2 {
        result.set(lane, by_ends.extension(operand.get(lane), [ends[lane], ends[2 + lane]]));
    }
}

/// Applies the extensions of sine and cosine to one operand over each of two boxes, and puts the ends of the results behind it: what
/// is known of the operand is known of them. `function` computes the values at all ends at once. Native code calls it.
///
/// # Safety
/// Behind `pairs` there is the operand and room for two results, and `function` is one that [`elementary::sines_and_cosines`] gave.
pub(crate) unsafe extern "C" fn extend_to_both(function: elementary::InPlace, pairs: *mut [Pair; 3]) {
    // SAFETY: all three are there.
    let [operand, sine, cosine] = unsafe { &mut *pairs };
    let mut ends = operand.ends_twice();
    // SAFETY: this processor has the features that the function was compiled for.
    unsafe { function(&mut ends) };
    for lane in 0..2 {
        let interval = Interval { lo: operand.lo[lane], hi: -operand.minus_hi[lane] };
        let a = Decorated { interval, decoration: Decoration::Common };
        let at_ends = |first: usize| [ends[first + lane], ends[first + 2 + lane]];
        let found = sine_and_cosine_by_ends(a, at_ends(0), at_ends(4));
        for (result, Decorated { interval, .. }) in [&mut *sine, &mut *cosine].into_iter().zip(found) {
            (result.lo[lane], result.minus_hi[lane]) = (interval.lo, -interval.hi);
        }
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

    /// Writes a call of [`extend`], or of [`extend_by_ends`] if this machine has a function for it.
    pub(crate) fn call(
        &self,
        writer: &mut Writer<'_, '_>,
        calls: &mut Calls<'_>,
        operation: Operation,
        operands: &[Enclosure],
        range: Decorated,
    ) -> Enclosure {
        for (place, operand) in operands.iter().enumerate() {
            self.store(writer, place, operand);
        }
        let result = MOST_OPERANDS * size_of::<Pair>();
        let operands = writer.builder.ins().stack_addr(types::I64, self.0, 0);
        let address = writer.builder.ins().stack_addr(types::I64, self.0, result as i32);
        if let Some((by_ends, function)) = ByEnds::of(operation).zip(elementary::function(operation)) {
            let by_ends = writer.builder.ins().iconst(types::I8, by_ends as i64);
            let function = writer.builder.ins().iconst(types::I64, function as usize as i64);
            let extend = calls.extend_by_ends(writer.builder.func);
            writer.builder.ins().call(extend, &[by_ends, function, operands, address]);
        } else {
            let index = writer.builder.ins().iconst(types::I8, operation.index() as i64);
            let extend = calls.extend(writer.builder.func);
            writer.builder.ins().call(extend, &[index, operands, address]);
        }
        let [lo, minus_hi] = [offset_of!(Pair, lo), offset_of!(Pair, minus_hi)]
            .map(|offset| self.load(writer, types::F64, result + offset));
        let known = (range.decoration < Decoration::Common)
            .then(|| self.load(writer, types::I64, result + offset_of!(Pair, known)));
        Enclosure { lo, minus_hi, known, range }
    }

    /// Writes a call of [`extend_to_both`], if this machine has a function for it. The ranges of the results are left to say.
    pub(crate) fn call_for_both(
        &self,
        writer: &mut Writer<'_, '_>,
        calls: &mut Calls<'_>,
        operand: &Enclosure,
    ) -> Option<[Enclosure; 2]> {
        let function = elementary::sines_and_cosines()?;
        self.store(writer, 0, operand);
        let function = writer.builder.ins().iconst(types::I64, function as usize as i64);
        let pairs = writer.builder.ins().stack_addr(types::I64, self.0, 0);
        let extend = calls.extend_to_both(writer.builder.func);
        writer.builder.ins().call(extend, &[function, pairs]);
        Some([1, 2].map(|place| {
            let [lo, minus_hi] = [offset_of!(Pair, lo), offset_of!(Pair, minus_hi)]
                .map(|offset| self.load(writer, types::F64, place * size_of::<Pair>() + offset));
            Enclosure { lo, minus_hi, ..*operand }
        }))
    }

    /// Puts an operand in its place.
    fn store(&self, writer: &mut Writer<'_, '_>, place: usize, operand: &Enclosure) {
        let known = operand.known(writer);
        let start = place * size_of::<Pair>();
        for (value, offset) in [
            (operand.lo, start + offset_of!(Pair, lo)),
            (operand.minus_hi, start + offset_of!(Pair, minus_hi)),
            (known, start + offset_of!(Pair, known)),
        ] {
            writer.builder.ins().stack_store(types::I64, value, self.0, offset as i32);
        }
    }

    /// Two elements, lane by lane, as they were written: the processor forwards no wider load from narrower stores.
    fn load(&self, writer: &mut Writer<'_, '_>, element: Type, offset: usize) -> Value {
        let [low, high] = [0, size_of::<f64>()]
            .map(|lane| writer.builder.ins().stack_load(types::I64, element, self.0, (offset + lane) as i32));
        let pair = writer.builder.ins().scalar_to_vector(element.by(2).expect("a vector type"), low);
        writer.builder.ins().insertlane(pair, high, 1)
    }
}
