//! Interval extensions of operations, written as instructions on two boxes at a time: bit for bit what
//! [`Operation::extension`] gives, by the recipe of iso-expr's intervals.

mod common;
mod general;
mod rounding;
mod steps;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{InstBuilder, Value};
use iso_expr::{Decorated, Decoration, Operation, by_squaring};

use crate::domain::Sign;
use crate::lanes::{Mask, Writer};

/// The enclosures over two boxes, end by end.
///
/// Upper ends are held with the other sign, so that both ends are lower ends: what is done to one is done to the other,
/// and all rounding is downwards.
#[derive(Clone, Copy)]
pub(crate) struct Enclosure {
    pub(crate) lo: Value,
    pub(crate) minus_hi: Value,
    /// The decorations, as [`known`] has them: the lesser of two is what both have in common. None where they are common over
    /// every box, which [`range`](Self::range) tells.
    pub(crate) known: Option<Value>,
    /// What holds this enclosure over every box.
    pub(crate) range: Decorated,
}

impl Enclosure {
    /// Whether the value is certainly common.
    fn is_common(&self) -> bool {
        self.known.is_none()
    }

    /// On which side of zero the value certainly is.
    fn sign(&self) -> Sign {
        Sign::of(self.range.interval)
    }

    /// What is known of it, as bits.
    pub(crate) fn known(&self, writer: &mut Writer<'_, '_>) -> Value {
        self.known.unwrap_or_else(|| writer.integers(known(Decoration::Common)))
    }
}

/// A decoration as bits: one for each decoration that it exceeds.
pub(crate) const fn known(decoration: Decoration) -> u64 {
    (1 << decoration as u64) - 1
}

/// The decoration that bits stand for.
pub(crate) const fn decoration_of(known: u64) -> Decoration {
    match known {
        0b000 => Decoration::Trivial,
        0b001 => Decoration::Defined,
        0b011 => Decoration::Continuous,
        _ => Decoration::Common,
    }
}

/// The decorations that bits stand for, as their numbers.
pub(crate) fn decoration(writer: &mut Writer<'_, '_>, known: Value) -> Value {
    // Of 0, 1, 3 and 7, less the half and the quarter: 0, 1, 2 and 3.
    let [half, quarter] = [1, 2].map(|shift| writer.builder.ins().ushr_imm_u(known, shift));
    let without_half = writer.builder.ins().isub(known, half);
    writer.builder.ins().isub(without_half, quarter)
}

/// A constant.
pub(crate) fn constant(writer: &mut Writer<'_, '_>, constant: Decorated) -> Enclosure {
    let is_common = constant.decoration == Decoration::Common;
    Enclosure {
        lo: writer.constant(constant.interval.lo),
        minus_hi: writer.constant(-constant.interval.hi),
        known: (!is_common).then(|| writer.integers(known(constant.decoration))),
        range: constant,
    }
}

/// Arguments that run from `lo` to `hi`, not empty and within `range`.
pub(crate) fn argument(writer: &mut Writer<'_, '_>, lo: Value, hi: Value, range: Decorated) -> Enclosure {
    let zero = writer.constant(0.0);
    // Zeros are made to point inwards.
    let lo = writer.builder.ins().fadd(lo, zero);
    let minus_hi = writer.builder.ins().fsub(zero, hi);
    Enclosure { lo, minus_hi, known: None, range }
}

/// Writes `operation`, unless its extension is better called. `range` holds the result over every box. Only as many operands
/// as the arity count.
pub(crate) fn apply(
    writer: &mut Writer<'_, '_>,
    operation: Operation,
    operands: [Enclosure; 3],
    range: Decorated,
) -> Option<Enclosure> {
    use Operation as O;
    let [a, b, _] = operands;
    match operation {
        O::Subtract => return apply(writer, O::Add, [a, negative(b), b], range),
        O::Negate => return Some(negative(a)),
        O::Maximum => {
            let range = opposite(range);
            return apply(writer, O::Minimum, [negative(a), negative(b), b], range).map(negative);
        }
        O::Less | O::LessOrEqual | O::Select => return steps::apply(writer, operation, operands, range),
        _ => {}
    }
    // A result is decorated no better than its operands.
    if range.decoration == Decoration::Common {
        common::apply(writer, operation, operands, range)
    } else {
        general::apply(writer, operation, operands, range)
    }
}

/// The number that an operand certainly is, if it is one other than zero.
fn nonzero_point(operand: &Enclosure) -> Option<f64> {
    let interval = operand.range.interval;
    (operand.is_common() && interval.is_point() && interval.lo != 0.0).then_some(interval.lo)
}

/// The exponent of an integer power.
fn exponent(operand: &Enclosure) -> u32 {
    operand.range.interval.lo as u32
}

/// The empty interval where the mask holds.
fn emptied(writer: &mut Writer<'_, '_>, mask: Mask, a: Enclosure) -> Enclosure {
    Enclosure { lo: writer.undefine(mask, a.lo), minus_hi: writer.undefine(mask, a.minus_hi), ..a }
}

/// What is known of both.
fn both(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Value {
    match (a.known, b.known) {
        (Some(a), Some(b)) => writer.builder.ins().band(a, b),
        _ => a.known.or(b.known).unwrap_or_else(|| a.known(writer)),
    }
}

fn negative(a: Enclosure) -> Enclosure {
    Enclosure { lo: a.minus_hi, minus_hi: a.lo, known: a.known, range: opposite(a.range) }
}

fn opposite(range: Decorated) -> Decorated {
    Decorated { interval: range.interval.negated(), ..range }
}

/// The lesser of two doubles, the second one when they are equal or one is NaN: one instruction on x86.
fn lesser(writer: &mut Writer<'_, '_>, p: Value, q: Value) -> Value {
    let less = writer.compare(FloatCC::LessThan, p, q);
    writer.choose(less, p, q)
}

/// The greater of two doubles, the second one when they are equal or one is NaN: one instruction on x86.
fn greater(writer: &mut Writer<'_, '_>, p: Value, q: Value) -> Value {
    let greater = writer.compare(FloatCC::LessThan, q, p);
    writer.choose(greater, p, q)
}

/// Each base multiplied by itself [by squaring](by_squaring), every product made by `multiply`.
fn powers(
    writer: &mut Writer<'_, '_>,
    base: Value,
    exponent: u32,
    multiply: impl Fn(&mut Writer<'_, '_>, Value, Value) -> Value,
) -> Value {
    let power = by_squaring(base, exponent, |u, v| multiply(writer, u, v.unwrap_or(u)));
    power.expect("exponents are positive")
}
