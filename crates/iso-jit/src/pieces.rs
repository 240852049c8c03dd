//! Single operations over two boxes as native functions, compiled when first needed and shared by all kernels that are
//! [assembled](crate::assembled) from them.

use std::hash::{Hash, Hasher};
use std::sync::{PoisonError, RwLock};

use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Value, types};
use cranelift_frontend::FunctionBuilder;
use iso_expr::{CompileError, Decorated, Decoration, Interval, Operation};
use rustc_hash::FxHashMap;

use crate::code::{Blueprint, Compiled};
use crate::domain::Sign;
use crate::enclosures::{self, Enclosure};
use crate::host::{self, Host, Limits};
use crate::lanes::{Lanes, Writer};
use crate::symbols::Calls;
use crate::trampoline::Room;

/// Doubles that the enclosures of a value over two boxes take: the lower ends, minus the upper ends, and what is
/// [known](enclosures::known), as bits.
pub(crate) const SIZE: usize = 6;

/// Where, in doubles, the parts of such enclosures begin.
pub(crate) const LO: usize = 0;
pub(crate) const MINUS_HI: usize = 2;
pub(crate) const KNOWN: usize = 4;

/// Where the result goes, and where the operands are: as many as the arity count, the rest is not read.
pub(crate) type Apply = unsafe extern "C" fn(*mut f64, *const f64, *const f64, *const f64);

/// What a piece takes for granted of a value, or says of its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Kind {
    sign: Sign,
    /// What is known of common values is neither written nor read.
    pub(crate) is_common: bool,
}

impl Kind {
    /// The kind of all values in `range`.
    pub(crate) fn of(range: Decorated) -> Self {
        Self { sign: Sign::of(range.interval), is_common: range.decoration == Decoration::Common }
    }

    /// The same kind, whatever the sign.
    fn of_any_sign(self) -> Self {
        Self { sign: Sign::Any, ..self }
    }

    /// A range of this kind.
    fn range(self) -> Decorated {
        let (lo, hi) = match self.sign {
            Sign::Any => (-1.0, 1.0),
            Sign::NotNegative => (0.0, 1.0),
            Sign::NotPositive => (-1.0, 0.0),
        };
        let decoration = if self.is_common { Decoration::Common } else { Decoration::Trivial };
        Decorated { interval: Interval { lo, hi }, decoration }
    }
}

/// An operation on values of some kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    operation: Operation,
    /// The exponent of an integer power.
    exponent: Option<u32>,
    operands: [Kind; 3],
    result: Kind,
}

/// By a single number, for every operation of every kernel that is assembled is looked up.
impl Hash for Piece {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let of_kind = |kind: Kind| kind.sign as u64 * 2 + u64::from(kind.is_common);
        let [a, b, c] = self.operands.map(of_kind);
        let kinds = [a, b, c, of_kind(self.result)].into_iter().fold(0, |kinds, kind| 8 * kinds + kind);
        let operation = self.operation.index() as u64;
        state.write_u64((u64::from(self.exponent.unwrap_or(0)) << 32) | (operation << 16) | kinds);
    }
}

impl Piece {
    /// The piece for `operation` on operands in these ranges, of which only as many as the arity count, with a result in `range`.
    pub(crate) fn new(operation: Operation, operands: [Decorated; 3], range: Decorated) -> Self {
        use Operation as O;
        let exponent = (operation == O::IntegerPower).then_some(operands[1].interval.lo as u32);
        let (kinds, result) = (operands.map(Kind::of), Kind::of(range));
        // Pieces are shared more widely where signs do not matter.
        let (operands, result) = match operation {
            O::Multiply | O::Divide | O::IntegerPower | O::SquareRoot => (kinds, result),
            O::Add | O::Subtract => (kinds.map(Kind::of_any_sign), result),
            O::Absolute => (kinds, result.of_any_sign()),
            _ => (kinds.map(Kind::of_any_sign), result.of_any_sign()),
        };
        let unread = operands[0];
        let read = |place: usize| if place < operation.arity() { operands[place] } else { unread };
        Self { operation, exponent, operands: [0, 1, 2].map(read), result }
    }

    /// The enclosures of the operand at `place`, which stand at `address`.
    fn operand(&self, writer: &mut Writer<'_, '_>, place: usize, address: Value) -> Enclosure {
        let kind = self.operands[place];
        let mut load = |ty, start: usize| {
            writer.builder.ins().load(ty, access(), address, (start * size_of::<f64>()) as i32)
        };
        let (lo, minus_hi) = (load(types::F64X2, LO), load(types::F64X2, MINUS_HI));
        let known = (!kind.is_common).then(|| load(types::I64X2, KNOWN));
        Enclosure { lo, minus_hi, known, range: kind.range() }
    }

    /// The sine or the cosine, where this machine has a function for all ends at once.
    fn wave(
        writer: &mut Writer<'_, '_>,
        calls: &mut Calls<'_>,
        operation: Operation,
        operand: &Enclosure,
        range: Decorated,
    ) -> Option<Enclosure> {
        let both = Room::new(writer).call_for_both(writer, calls, operand)?;
        Some(Enclosure { range, ..both[usize::from(operation == Operation::Cos)] })
    }

    /// The operand that the exponent of an integer power is.
    fn exponent(writer: &mut Writer<'_, '_>, exponent: u32) -> Enclosure {
        enclosures::constant(writer, Decorated::argument(exponent.into(), exponent.into()))
    }
}

impl Blueprint for Piece {
    const NAME: &'static str = "piece";
    const LIMITS: Limits = host::BOXES;
    type Function = Apply;

    fn sign(&self, signature: &mut Signature) {
        signature.params.extend([AbiParam::new(types::I64); 4]);
    }

    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>) {
        let entry = builder.current_block().expect("writing begins in the entry block");
        let &[result, a, b, c] = builder.block_params(entry) else {
            unreachable!("four parameters were signed")
        };
        let mut writer = Writer::new(builder, Lanes::Two);
        let first = self.operand(&mut writer, 0, a);
        let mut operands = [first; 3];
        for (place, address) in [(1, b), (2, c)].into_iter().take(self.operation.arity() - 1) {
            operands[place] = match self.exponent {
                Some(exponent) => Self::exponent(&mut writer, exponent),
                None => self.operand(&mut writer, place, address),
            };
        }
        let range = self.result.range();
        let written = match self.operation {
            Operation::Sin | Operation::Cos => {
                Self::wave(&mut writer, calls, self.operation, &operands[0], range)
            }
            _ => enclosures::apply(&mut writer, self.operation, operands, range),
        };
        let enclosure = written.unwrap_or_else(|| {
            let operands = &operands[..self.operation.arity()];
            Room::new(&mut writer).call(&mut writer, calls, self.operation, operands, range)
        });
        let mut parts = vec![(enclosure.lo, LO), (enclosure.minus_hi, MINUS_HI)];
        if !self.result.is_common {
            parts.push((enclosure.known(&mut writer), KNOWN));
        }
        for (part, start) in parts {
            writer.builder.ins().store(access(), part, result, (start * size_of::<f64>()) as i32);
        }
        writer.builder.ins().return_(&[]);
    }

    unsafe fn function(&self, start: *const u8) -> Self::Function {
        // SAFETY: the code has the C convention, with the parameters that were signed.
        unsafe { std::mem::transmute(start) }
    }
}

/// Doubles in memory: never trapping, aligned to eight bytes only.
fn access() -> MemFlagsData {
    MemFlagsData::new().with_notrap()
}

/// All pieces so far. None is given back before all are.
pub(crate) struct Pieces {
    host: Host,
    compiled: RwLock<FxHashMap<Piece, Compiled<Apply>>>,
}

impl Pieces {
    /// None at all.
    pub(crate) fn new(host: Host) -> Self {
        Self { host, compiled: RwLock::default() }
    }

    /// The functions of some pieces, which are compiled if need be.
    pub(crate) fn functions(&self, pieces: &[Piece]) -> Result<Vec<Apply>, CompileError> {
        self.known(pieces).map_or_else(|| self.compile(pieces), Ok)
    }

    /// The functions, if all are known, as they soon are: then threads do not wait for each other.
    fn known(&self, pieces: &[Piece]) -> Option<Vec<Apply>> {
        // Pieces are only ever put in whole.
        let compiled = self.compiled.read().unwrap_or_else(PoisonError::into_inner);
        pieces.iter().map(|piece| compiled.get(piece).map(|known| known.function)).collect()
    }

    fn compile(&self, pieces: &[Piece]) -> Result<Vec<Apply>, CompileError> {
        let mut compiled = self.compiled.write().unwrap_or_else(PoisonError::into_inner);
        let mut function = |piece: &Piece| {
            if let Some(known) = compiled.get(piece) {
                return Ok(known.function);
            }
            let new = Compiled::new(self.host.careful(), &mut Context::new(), piece)?;
            let function = new.function;
            compiled.insert(*piece, new);
            Ok(function)
        };
        pieces.iter().map(&mut function).collect()
    }
}
