//! Kernels over batches of boxes: a loop over pairs of boxes, one in each 128-bit lane.

use std::collections::HashMap;
use std::mem::offset_of;
use std::sync::{Arc, OnceLock};

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Value, types};
use cranelift_frontend::FunctionBuilder;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BoxKernel, Decorated, Decoration, Engine, Node, Operation, Program, Scratch};

use crate::assembled::Assembler;
use crate::code::{Blueprint, Compiled};
use crate::domain::{Assumption, Domain};
use crate::elementary;
use crate::enclosures::{self, Enclosure};
use crate::host::{self, Limits};
use crate::lanes::{Lanes, Mask, Writer};
use crate::symbols::Calls;
use crate::trampoline::Room;

/// Boxes in one round of the loop, or one run of steps.
pub(crate) const PAIR: usize = 2;

/// The most operations of a program whose constants stay in registers. Measured: 17 operations are 8 % faster with it, 33 are 9 %
/// slower, and 75 with quickly allocated registers take 1.7 times as long.
const LARGEST_WITH_LASTING_CONSTANTS: usize = 24;

/// Where a kernel reads and writes: the boxes' ends along x, y and z, and room for the outputs' enclosures.
#[repr(C)]
pub(crate) struct Places {
    lo: [*const f64; 3],
    hi: [*const f64; 3],
    output_lo: *mut f64,
    output_hi: *mut f64,
    output_decoration: *mut Decoration,
}

/// The places; how many boxes there are, at least one; and how far the second box of a round stands from the first: one
/// place, or none where there is just one box. Zero if what was [assumed](Assumption) holds for all boxes; else what was written
/// means nothing.
type Enclose = unsafe extern "C" fn(&Places, usize, usize) -> u64;

/// A kernel over batches of boxes, as native code.
pub(crate) struct NativeBoxes {
    compiled: Compiled<Enclose>,
    outputs: usize,
    /// The [reach](Domain::reach) of the boxes for which the code was made.
    reach: f64,
    program: Program,
    assembler: Assembler,
    /// For all others, empty, unbounded and huge ones, and for those of which too much was assumed: assembled when first needed.
    otherwise: OnceLock<Arc<dyn BoxKernel>>,
}

impl NativeBoxes {
    pub(crate) fn new(
        BoxBlueprint { program, domain }: &BoxBlueprint<'_>,
        compiled: Compiled<Enclose>,
        assembler: Assembler,
    ) -> Self {
        Self {
            compiled,
            outputs: program.outputs().len(),
            reach: domain.reach,
            program: (*program).clone(),
            assembler,
            otherwise: OnceLock::new(),
        }
    }

    /// The kernel for any boxes.
    fn otherwise(&self) -> &dyn BoxKernel {
        &**self.otherwise.get_or_init(|| {
            self.assembler.boxes(&self.program).expect("what cannot be assembled is interpreted")
        })
    }
}

impl BoxKernel for NativeBoxes {
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>) {
        if !Domain::holds_all(self.reach, boxes) {
            return self.otherwise().evaluate(scratch, boxes, enclosures);
        }
        let Enclosures { lo, hi, decoration } = enclosures;
        let count = boxes.lo[0].len();
        assert!(boxes.lo.iter().chain(&boxes.hi).all(|ends| ends.len() == count), "six ends for each box");
        assert_eq!(
            [lo.len(), hi.len(), decoration.len()],
            [self.outputs * count; 3],
            "room for every output over every box"
        );
        if count == 0 {
            return;
        }
        let places = Places {
            lo: boxes.lo.map(<[f64]>::as_ptr),
            hi: boxes.hi.map(<[f64]>::as_ptr),
            output_lo: lo.as_mut_ptr(),
            output_hi: hi.as_mut_ptr(),
            output_decoration: decoration.as_mut_ptr(),
        };
        let second = count.min(PAIR) - 1;
        // SAFETY: at all places there are `count` boxes, and room for `count` enclosures of each output; what is written is
        // borrowed mutably, so that it overlaps nothing else.
        let violated = unsafe { (self.compiled.function)(&places, count, second) };
        if violated != 0 {
            self.otherwise().evaluate(scratch, boxes, Enclosures { lo, hi, decoration });
        }
    }
}

/// Takes what [`Enclose`] names, and walks through it round by round. The last round ends with the last box, and so may
/// take one box a second time, which changes nothing.
pub(crate) struct BoxBlueprint<'a> {
    program: &'a Program,
    domain: Domain,
}

impl<'a> BoxBlueprint<'a> {
    pub(crate) fn new(program: &'a Program) -> Self {
        Self { program, domain: Domain::of(program) }
    }
}

impl Blueprint for BoxBlueprint<'_> {
    const NAME: &'static str = "boxes";
    const LIMITS: Limits = host::BOXES;
    type Function = Enclose;

    fn sign(&self, signature: &mut Signature) {
        signature.params.extend([AbiParam::new(types::I64); 3]);
        signature.returns.push(AbiParam::new(types::I64));
    }

    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>) {
        let entry = builder.current_block().expect("writing begins in the entry block");
        let &[places, count, second] = builder.block_params(entry) else {
            unreachable!("three parameters were signed")
        };
        let before_last = builder.ins().isub(count, second);
        let last = builder.ins().iadd_imm_s(before_last, -1);
        let first = builder.ins().iconst(types::I64, 0);
        let (round, end) = (builder.create_block(), builder.create_block());
        let index = builder.append_block_param(round, types::I64);
        let violated = builder.append_block_param(round, types::I64);
        builder.ins().jump(round, &[first.into(), first.into()]);

        builder.switch_to_block(round);
        let mut round_of_boxes =
            Round { writer: Writer::new(builder, Lanes::Two), places, count, index, second, violated };
        round_of_boxes.write(calls, self.program, &self.domain);
        let violated = round_of_boxes.violated;
        let next = builder.ins().iadd_imm_s(index, PAIR as i64);
        let beyond = builder.ins().icmp(IntCC::UnsignedGreaterThan, next, last);
        let next = builder.ins().select(beyond, last, next);
        let done = builder.ins().icmp(IntCC::Equal, index, last);
        builder.ins().brif(done, end, &[], round, &[next.into(), violated.into()]);

        builder.switch_to_block(end);
        builder.ins().return_(&[violated]);
    }

    unsafe fn function(&self, start: *const u8) -> Self::Function {
        // SAFETY: the code has the C convention, with the parameters that were signed.
        unsafe { std::mem::transmute(start) }
    }
}

/// Writes one round of the loop.
struct Round<'a, 'b> {
    writer: Writer<'a, 'b>,
    places: Value,
    count: Value,
    /// The first box of the round.
    index: Value,
    /// How far the second one stands from it.
    second: Value,
    /// Not zero if an assumption does not hold.
    violated: Value,
}

impl Round<'_, '_> {
    fn write(&mut self, calls: &mut Calls<'_>, program: &Program, domain: &Domain) {
        let is_large = program.operations() > LARGEST_WITH_LASTING_CONSTANTS;
        let mut room = None;
        let mut waves = HashMap::new();
        let mut enclosures: Vec<Enclosure> = Vec::with_capacity(program.nodes().len());
        let known = domain.ranges.iter().zip(&domain.assumptions);
        for (node, (range, assumption)) in program.nodes().iter().zip(known) {
            if is_large {
                self.writer.forget_constants();
            }
            enclosures.push(match node {
                Node::Variable(argument) => self.argument(argument.index(), *range),
                Node::Constant(_) => enclosures::constant(&mut self.writer, *range),
                Node::Apply(operation @ (Operation::Sin | Operation::Cos), [operand, ..])
                    if elementary::sines_and_cosines().is_some() =>
                {
                    let room = room.get_or_insert_with(|| Room::new(&mut self.writer));
                    let both = waves.entry(*operand).or_insert_with(|| {
                        let operand = &enclosures[operand.index()];
                        room.call_for_both(&mut self.writer, calls, operand)
                            .expect("this machine has the function")
                    });
                    Enclosure { range: *range, ..both[usize::from(*operation == Operation::Cos)] }
                }
                Node::Apply(operation, operands) => {
                    let operands = operands.map(|id| enclosures[id.index()]);
                    if let Some(assumption) = assumption {
                        self.check(*assumption, operands[assumption.operand]);
                    }
                    let written = enclosures::apply(&mut self.writer, *operation, operands, *range);
                    written.unwrap_or_else(|| {
                        let room = room.get_or_insert_with(|| Room::new(&mut self.writer));
                        let operands = &operands[..operation.arity()];
                        room.call(&mut self.writer, calls, *operation, operands, *range)
                    })
                }
            });
        }
        let mut place = self.index;
        for output in program.outputs() {
            self.store(enclosures[output.index()], place);
            place = self.writer.builder.ins().iadd(place, self.count);
        }
    }

    /// Notes whether an assumption does not hold for an operand.
    fn check(&mut self, assumption: Assumption, operand: Enclosure) {
        let end = if operand.range.interval.hi > 0.0 { operand.lo } else { operand.minus_hi };
        let least = self.writer.constant(assumption.least);
        let Mask(is_violated) = self.writer.compare(FloatCC::LessThan, end, least);
        let is_anywhere = self.writer.builder.ins().vany_true(is_violated);
        let is_anywhere = self.writer.builder.ins().uextend(types::I64, is_anywhere);
        self.violated = self.writer.builder.ins().bor(self.violated, is_anywhere);
    }

    /// The boxes' extents along an axis.
    fn argument(&mut self, axis: usize, range: Decorated) -> Enclosure {
        let offset = axis * size_of::<*const f64>();
        let [lo, hi] = [offset_of!(Places, lo), offset_of!(Places, hi)].map(|ends| {
            let [low, high] = self.elements(ends + offset, size_of::<f64>(), self.index).map(|address| {
                self.writer.builder.ins().load(types::F64, MemFlagsData::trusted(), address, 0)
            });
            let pair = self.writer.builder.ins().scalar_to_vector(types::F64X2, low);
            self.writer.builder.ins().insertlane(pair, high, 1)
        });
        enclosures::argument(&mut self.writer, lo, hi, range)
    }

    /// Puts an output's enclosures at its `place` and the one `second` after it.
    fn store(&mut self, enclosure: Enclosure, place: Value) {
        let hi = self.writer.negated(enclosure.minus_hi);
        for (end, offset) in
            [(enclosure.lo, offset_of!(Places, output_lo)), (hi, offset_of!(Places, output_hi))]
        {
            for (lane, address) in self.elements(offset, size_of::<f64>(), place).into_iter().enumerate() {
                let end = self.writer.builder.ins().extractlane(end, lane as u8);
                self.writer.builder.ins().store(MemFlagsData::trusted(), end, address, 0);
            }
        }
        let known = enclosure.known(&mut self.writer);
        let decoration = enclosures::decoration(&mut self.writer, known);
        let addresses = self.elements(offset_of!(Places, output_decoration), size_of::<Decoration>(), place);
        for (lane, address) in addresses.into_iter().enumerate() {
            let decoration = self.writer.builder.ins().extractlane(decoration, lane as u8);
            self.writer.builder.ins().istore8(MemFlagsData::trusted(), decoration, address, 0);
        }
    }

    /// The addresses of the element at `place` and of the one `second` after it, in the array to which the pointer at
    /// `offset` in [`Places`] points.
    fn elements(&mut self, offset: usize, size: usize, place: Value) -> [Value; 2] {
        let ins = &mut self.writer.builder;
        let array = ins.ins().load(types::I64, MemFlagsData::trusted(), self.places, offset as i32);
        let distances = [place, self.second].map(|distance| ins.ins().imul_imm_s(distance, size as i64));
        let first = ins.ins().iadd(array, distances[0]);
        [first, ins.ins().iadd(first, distances[1])]
    }
}
