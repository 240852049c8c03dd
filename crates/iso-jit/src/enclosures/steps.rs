//! Comparisons and the choice by a condition: what the derivatives of minima and maxima are made of.

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{InstBuilder, Value};
use iso_expr::{Decorated, Decoration, Operation};

use super::{Enclosure, both, emptied, known, lesser};
use crate::lanes::{Mask, Writer};

/// Writes `operation`, unless its extension is better called.
pub(super) fn apply(
    writer: &mut Writer<'_, '_>,
    operation: Operation,
    [a, b, c]: [Enclosure; 3],
    range: Decorated,
) -> Option<Enclosure> {
    let enclosure = match operation {
        Operation::Less => comparison(writer, a, b, [FloatCC::LessThan, FloatCC::LessThanOrEqual]),
        Operation::LessOrEqual => comparison(writer, a, b, [FloatCC::LessThanOrEqual, FloatCC::LessThan]),
        Operation::Select => select(writer, a, b, c),
        _ => return None,
    };
    let is_common = range.decoration == Decoration::Common;
    Some(Enclosure { known: enclosure.known.filter(|_| !is_common), range, ..enclosure })
}

/// 1 where a's upper end is before b's lower one as `always` says, 0 where b's upper end is before a's lower one as `never` says,
/// else both.
fn comparison(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    b: Enclosure,
    [always, never]: [FloatCC; 2],
) -> Enclosure {
    let [a_hi, b_hi] = [a, b].map(|operand| writer.negated(operand.minus_hi));
    let [one, minus_one] = [1.0, -1.0].map(|value| writer.constant(value));
    let is_always = writer.compare(always, a_hi, b.lo);
    let is_never = writer.compare(never, b_hi, a.lo);
    let lo = writer.keep(is_always, one);
    let minus_hi = writer.clear(is_never, minus_one);
    // Where ends only touch, the comparison is constant but jumps beside the box.
    let apart = [(a_hi, b.lo), (b_hi, a.lo)].map(|(hi, lo)| writer.compare(FloatCC::LessThan, hi, lo));
    let apart = writer.either(apart[0], apart[1]);
    let certain = writer.either(is_always, is_never);
    let continuous = writer.integers(known(Decoration::Continuous));
    let defined = writer.integers(known(Decoration::Defined));
    let when_certain = writer.builder.ins().band(certain.0, continuous);
    let at_least = writer.builder.ins().bor(when_certain, defined);
    let of_ends = writer.builder.ins().bor(apart.0, at_least);
    let of_operands = both(writer, a, b);
    let known = writer.builder.ins().band(of_ends, of_operands);
    let comparison = Enclosure { lo, minus_hi, known: Some(known), range: a.range };
    if a.is_common() && b.is_common() {
        return comparison;
    }
    let empty = writer.compare(FloatCC::Unordered, a.lo, b.lo);
    emptied(writer, empty, comparison)
}

/// b where the condition a is not zero, c where it is, both where that is not certain.
fn select(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, c: Enclosure) -> Enclosure {
    let zero = writer.constant(0.0);
    let [from_zero, to_zero] =
        [a.lo, a.minus_hi].map(|end| writer.compare(FloatCC::LessThanOrEqual, end, zero));
    let may_be_zero = writer.both(from_zero, to_zero);
    let [starts_at_zero, ends_at_zero] = [a.lo, a.minus_hi].map(|end| writer.is_zero(end));
    let takes_c = writer.both(ends_at_zero, starts_at_zero);

    let hull = [[b.lo, c.lo], [b.minus_hi, c.minus_hi]].map(|[of_b, of_c]| {
        let hull = lesser(writer, of_b, of_c);
        if c.is_common() {
            return hull;
        }
        // Nothing is lesser than the end of an empty interval, which is NaN.
        let is_empty = writer.is_nan(of_c);
        writer.choose(is_empty, of_b, hull)
    });
    let mut ends = [b.lo, b.minus_hi];
    for (place, of_c) in [c.lo, c.minus_hi].into_iter().enumerate() {
        let unless_b = writer.choose(takes_c, of_c, hull[place]);
        ends[place] = writer.choose(may_be_zero, unless_b, ends[place]);
    }
    let known = known_of_choice(writer, [a, b, c], may_be_zero, takes_c);
    let chosen = Enclosure { lo: ends[0], minus_hi: ends[1], known: Some(known), range: a.range };
    if a.is_common() {
        return chosen;
    }
    let empty = writer.is_nan(a.lo);
    emptied(writer, empty, chosen)
}

/// What is known of a choice: no more than that it is defined where the condition is not certain, that it is continuous on the box where
/// the condition may be another one beside it, and nothing where the condition may be undefined.
fn known_of_choice(
    writer: &mut Writer<'_, '_>,
    [a, b, c]: [Enclosure; 3],
    may_be_zero: Mask,
    takes_c: Mask,
) -> Value {
    let defined = writer.integers(known(Decoration::Defined));
    let of_both = both(writer, b, c);
    let [of_b, of_c] = [b, c].map(|branch| branch.known(writer));
    let uncertain = writer.builder.ins().band(of_both, defined);
    let unless_b = writer.builder.ins().bitselect(takes_c.0, of_c, uncertain);
    let of_chosen = writer.builder.ins().bitselect(may_be_zero.0, unless_b, of_b);
    let Some(of_condition) = a.known else { return of_chosen };
    let [zero, continuous] = [0, known(Decoration::Continuous)].map(|bits| writer.integers(bits));
    let undefined = writer.builder.ins().icmp(IntCC::Equal, of_condition, zero);
    let limit = writer.builder.ins().bor(of_condition, continuous);
    let limited = writer.builder.ins().band(of_chosen, limit);
    writer.builder.ins().band_not(limited, undefined)
}
