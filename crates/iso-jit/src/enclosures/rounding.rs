//! Outward rounding, in lanes.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value};

use super::lesser;
use crate::domain::Sign;
use crate::lanes::Writer;

/// Lower bounds of real numbers whose nearest doubles are `value`, of the given sign: the double below, but −∞, NaN and +0 stay.
pub(super) fn round_down(writer: &mut Writer<'_, '_>, value: Value, sign: Sign) -> Value {
    let bits = writer.bits(value);
    // Comparisons give −1 where they hold.
    let mut below = bits;
    if sign != Sign::NotPositive {
        let zero = writer.integers(0);
        let is_positive = writer.builder.ins().icmp(IntCC::SignedGreaterThan, bits, zero);
        below = writer.builder.ins().iadd(below, is_positive);
    }
    if sign != Sign::NotNegative {
        let minus_infinity = writer.integers(f64::NEG_INFINITY.to_bits());
        let is_negative = writer.builder.ins().icmp(IntCC::SignedGreaterThan, minus_infinity, bits);
        below = writer.builder.ins().isub(below, is_negative);
    }
    writer.doubles(below)
}

/// [`round_down`] of numbers that are finite and have the sign bit set.
pub(super) fn round_down_negative(writer: &mut Writer<'_, '_>, value: Value) -> Value {
    let bits = writer.bits(value);
    let one = writer.integers(1);
    let below = writer.builder.ins().iadd(bits, one);
    writer.doubles(below)
}

/// The least of some doubles, none of which is NaN; −0 counts as less than +0.
pub(super) fn least(writer: &mut Writer<'_, '_>, p: Value, q: Value) -> Value {
    let least = lesser(writer, p, q);
    let either = writer.builder.ins().bor(p, q);
    let sign = signs_of(writer, either);
    writer.builder.ins().bor(least, sign)
}

/// The least of four; as [`least`].
pub(super) fn least_of_four(writer: &mut Writer<'_, '_>, [p, q, r, s]: [Value; 4]) -> Value {
    let (left, right) = (lesser(writer, p, q), lesser(writer, r, s));
    let least = lesser(writer, left, right);
    let (left, right) = (writer.builder.ins().bor(p, q), writer.builder.ins().bor(r, s));
    let any = writer.builder.ins().bor(left, right);
    let sign = signs_of(writer, any);
    writer.builder.ins().bor(least, sign)
}

/// Nothing but the sign bits.
pub(super) fn signs_of(writer: &mut Writer<'_, '_>, value: Value) -> Value {
    let sign = writer.constant(-0.0);
    writer.builder.ins().band(value, sign)
}
