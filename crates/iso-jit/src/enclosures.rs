//! Interval extensions of operations, written as instructions on two boxes at a time: bit for bit what
//! [`Operation::extension`] gives, by the recipe of iso-expr's intervals.

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{InstBuilder, Value};
use cranelift_frontend::FuncInstBuilder;
use iso_expr::{Decorated, Decoration, Operation};

use crate::lanes::{Mask, Writer};

/// The enclosures over two boxes, end by end.
///
/// Upper ends are held with the other sign, so that both ends are lower ends: what is done to one is done to the other,
/// and all rounding is downwards.
#[derive(Clone, Copy)]
pub(crate) struct Enclosure {
    pub(crate) lo: Value,
    pub(crate) minus_hi: Value,
    /// The decorations, as [`known`] has them: the lesser of two is what both have in common.
    pub(crate) known: Value,
}

/// A decoration as bits: one for each decoration that it exceeds.
pub(crate) const fn known(decoration: Decoration) -> u64 {
    (1 << decoration as u64) - 1
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
    Enclosure {
        lo: writer.constant(constant.interval.lo),
        minus_hi: writer.constant(-constant.interval.hi),
        known: writer.integers(known(constant.decoration)),
    }
}

/// Arguments that run from `lo` to `hi`, by the rule of [`Decorated::argument`].
pub(crate) fn argument(writer: &mut Writer<'_, '_>, lo: Value, hi: Value) -> Enclosure {
    let [zero, infinity, minus_infinity] =
        [0.0, f64::INFINITY, f64::NEG_INFINITY].map(|value| writer.constant(value));
    let in_order = writer.compare(FloatCC::LessThanOrEqual, lo, hi);
    let begins = writer.compare(FloatCC::LessThan, lo, infinity);
    let ends = writer.compare(FloatCC::LessThan, minus_infinity, hi);
    let holds_numbers = writer.both(in_order, begins);
    let holds_numbers = writer.both(holds_numbers, ends);
    // Zeros are made to point inwards.
    let lo = writer.builder.ins().fadd(lo, zero);
    let minus_hi = writer.builder.ins().fsub(zero, hi);
    let common = writer.integers(known(Decoration::Common));
    let known = writer.builder.ins().band(common, holds_numbers.0);
    let bounded = enclosing(writer, lo, minus_hi, known);
    let empty = writer.not(holds_numbers);
    emptied(writer, empty, bounded)
}

/// Writes `operation`, unless its extension is better called. Only as many operands as its arity count; `constants` are
/// those among them that are constants.
pub(crate) fn apply(
    writer: &mut Writer<'_, '_>,
    operation: Operation,
    operands: [Enclosure; 3],
    constants: [Option<Decorated>; 2],
) -> Option<Enclosure> {
    use Operation as O;
    let [a, b, _] = operands;
    let [left, right] = constants.map(|constant| constant.and_then(nonzero_point));
    Some(match operation {
        O::Add => sum(writer, a, b),
        O::Subtract => sum(writer, a, negative(b)),
        O::Negate => negative(a),
        O::Multiply => match (left, right) {
            (_, Some(scale)) => scaled(writer, a, scale, |ends, u, v| ends.fmul(u, v)),
            (Some(scale), _) => scaled(writer, b, scale, |ends, u, v| ends.fmul(u, v)),
            _ => product(writer, a, b),
        },
        O::Divide => match right {
            Some(scale) => scaled(writer, a, scale, |ends, u, v| ends.fdiv(u, v)),
            None => quotient(writer, a, b),
        },
        O::Absolute => absolute(writer, a),
        O::Minimum => minimum(writer, a, b),
        O::Maximum => negative(minimum(writer, negative(a), negative(b))),
        O::SquareRoot => square_root(writer, a),
        O::IntegerPower => power(writer, a, constants[1]?.interval.lo as u32),
        _ => return None,
    })
}

/// The number that a constant is, if it is a double other than zero.
fn nonzero_point(constant: Decorated) -> Option<f64> {
    let value = constant.interval.lo;
    (constant.interval.is_point() && value != 0.0).then_some(value)
}

/// Lower bounds of real numbers whose nearest doubles are `value`: the double below, but −∞, NaN and +0 stay.
fn round_down(writer: &mut Writer<'_, '_>, value: Value) -> Value {
    let [one, zero] = [1, 0].map(|value| writer.integers(value));
    let minus_infinity = writer.constant(f64::NEG_INFINITY);
    let bits = writer.bits(value);
    let is_negative = writer.builder.ins().icmp(IntCC::SignedLessThan, bits, zero);
    let step = writer.builder.ins().bor(is_negative, one);
    let is_plus_zero = Mask(writer.builder.ins().icmp(IntCC::Equal, bits, zero));
    let moves = writer.compare(FloatCC::LessThan, minus_infinity, value);
    let moves = writer.but_not(moves, is_plus_zero);
    let step = writer.builder.ins().band(step, moves.0);
    let bits = writer.builder.ins().isub(bits, step);
    writer.doubles(bits)
}

/// Lower bounds of the least of four real numbers, given the nearest double of each; −0 counts as less than +0.
fn round_down_least(writer: &mut Writer<'_, '_>, [p, q, r, s]: [Value; 4]) -> Value {
    let (left, right) = (lesser(writer, p, q), lesser(writer, r, s));
    let least = lesser(writer, left, right);
    let (left, right) = (writer.builder.ins().bor(p, q), writer.builder.ins().bor(r, s));
    let signs = writer.builder.ins().bor(left, right);
    let signs = signs_of(writer, signs);
    let least = writer.builder.ins().bor(least, signs);
    round_down(writer, least)
}

/// Nothing but the sign bits.
fn signs_of(writer: &mut Writer<'_, '_>, value: Value) -> Value {
    let sign = writer.constant(-0.0);
    writer.builder.ins().band(value, sign)
}

/// The lesser of two doubles, the second one when they are equal or one is NaN: one instruction on x86.
fn lesser(writer: &mut Writer<'_, '_>, p: Value, q: Value) -> Value {
    let less = writer.compare(FloatCC::LessThan, p, q);
    writer.choose(less, p, q)
}

/// The enclosure with these ends, known to be no more than continuous where it is unbounded.
fn enclosing(writer: &mut Writer<'_, '_>, lo: Value, minus_hi: Value, decoration: Value) -> Enclosure {
    let minus_infinity = writer.constant(f64::NEG_INFINITY);
    let continuous = writer.integers(known(Decoration::Continuous));
    let outermost = lesser(writer, lo, minus_hi);
    let bounded = writer.compare(FloatCC::LessThan, minus_infinity, outermost);
    let bound = writer.builder.ins().bor(bounded.0, continuous);
    Enclosure { lo, minus_hi, known: writer.builder.ins().band(decoration, bound) }
}

/// The empty interval where the mask holds.
fn emptied(writer: &mut Writer<'_, '_>, mask: Mask, a: Enclosure) -> Enclosure {
    Enclosure { lo: writer.undefine(mask, a.lo), minus_hi: writer.undefine(mask, a.minus_hi), known: a.known }
}

/// The same enclosure, of which nothing is known where the mask holds.
fn trivial(writer: &mut Writer<'_, '_>, mask: Mask, a: Enclosure) -> Enclosure {
    Enclosure { known: writer.builder.ins().band_not(a.known, mask.0), ..a }
}

/// What is known of both.
fn common(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Value {
    writer.builder.ins().band(a.known, b.known)
}

fn sum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Enclosure {
    let lo = writer.builder.ins().fadd(a.lo, b.lo);
    let minus_hi = writer.builder.ins().fadd(a.minus_hi, b.minus_hi);
    let (lo, minus_hi) = (round_down(writer, lo), round_down(writer, minus_hi));
    let known = common(writer, a, b);
    enclosing(writer, lo, minus_hi, known)
}

fn negative(a: Enclosure) -> Enclosure {
    Enclosure { lo: a.minus_hi, minus_hi: a.lo, known: a.known }
}

/// The product with a number, or the quotient by it: what the general rules come to where only one combination of ends can
/// be the least.
fn scaled(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    scale: f64,
    combine: impl Fn(FuncInstBuilder<'_, '_>, Value, Value) -> Value,
) -> Enclosure {
    let a = if scale < 0.0 { negative(a) } else { a };
    let magnitude = writer.constant(scale.abs());
    let [lo, minus_hi] = [a.lo, a.minus_hi].map(|end| {
        let end = combine(writer.builder.ins(), end, magnitude);
        round_down(writer, end)
    });
    enclosing(writer, lo, minus_hi, a.known)
}

fn product(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Enclosure {
    let combinations = combinations(writer, a, b, |writer, u, v| {
        let product = writer.builder.ins().fmul(u, v);
        let zero = writer.constant(0.0);
        let (u, v) = (writer.compare(FloatCC::Equal, u, zero), writer.compare(FloatCC::Equal, v, zero));
        // Zero times anything is zero: an infinite end only says that there is no bound.
        (product, writer.either(u, v))
    });
    from_combinations(writer, combinations, a, b)
}

fn quotient(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Enclosure {
    let combinations = combinations(writer, a, b, |writer, u, v| {
        let quotient = writer.builder.ins().fdiv(u, v);
        let zero = writer.constant(0.0);
        let (u, undefined) = (writer.compare(FloatCC::Equal, u, zero), writer.is_nan(quotient));
        // Zero over anything is zero, and so is the limit of anything over what grows without bound.
        (quotient, writer.either(u, undefined))
    });
    let [zero, minus_infinity] = [0.0, f64::NEG_INFINITY].map(|value| writer.constant(value));
    let quotient = from_combinations(writer, combinations, a, b);

    let straddles = both_ends(writer, FloatCC::LessThan, b);
    let below = writer.compare(FloatCC::LessThan, a.lo, zero);
    let above = writer.compare(FloatCC::LessThan, a.minus_hi, zero);
    let not_zero = writer.either(below, above);
    let entire = writer.both(straddles, not_zero);
    let lo = writer.choose(entire, minus_infinity, quotient.lo);
    let minus_hi = writer.choose(entire, minus_infinity, quotient.minus_hi);
    let quotient = Enclosure { lo, minus_hi, known: quotient.known };

    let nowhere = both_ends(writer, FloatCC::Equal, b);
    let holds_zero = both_ends(writer, FloatCC::LessThanOrEqual, b);
    let quotient = emptied(writer, nowhere, quotient);
    trivial(writer, holds_zero, quotient)
}

/// Where both the lower end and minus the upper end compare with zero as `condition` says.
fn both_ends(writer: &mut Writer<'_, '_>, condition: FloatCC, a: Enclosure) -> Mask {
    let zero = writer.constant(0.0);
    let lo = writer.compare(condition, a.lo, zero);
    let minus_hi = writer.compare(condition, a.minus_hi, zero);
    writer.both(lo, minus_hi)
}

/// For each end of `a` with each end of `b`, in terms of the ends as they are held: the result that `combine` gives, and
/// where it is taken for zero. The second and the third have the wrong sign, for one end of the two has.
fn combinations(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    b: Enclosure,
    combine: impl Fn(&mut Writer<'_, '_>, Value, Value) -> (Value, Mask),
) -> [(Value, Mask); 4] {
    [(a.lo, b.lo), (a.lo, b.minus_hi), (a.minus_hi, b.lo), (a.minus_hi, b.minus_hi)]
        .map(|(u, v)| combine(writer, u, v))
}

/// The interval from the least to the greatest combination; empty where an operand is.
fn from_combinations(
    writer: &mut Writer<'_, '_>,
    combinations: [(Value, Mask); 4],
    a: Enclosure,
    b: Enclosure,
) -> Enclosure {
    let mut straight = combinations.map(|(value, zero)| writer.clear(zero, value));
    let mut negated = combinations.map(|(value, zero)| {
        let value = writer.builder.ins().fneg(value);
        writer.clear(zero, value)
    });
    for place in [1, 2] {
        std::mem::swap(&mut straight[place], &mut negated[place]);
    }
    let (lo, minus_hi) = (round_down_least(writer, straight), round_down_least(writer, negated));
    let known = common(writer, a, b);
    let empty = writer.compare(FloatCC::Unordered, a.lo, b.lo);
    let enclosure = enclosing(writer, lo, minus_hi, known);
    emptied(writer, empty, enclosure)
}

fn absolute(writer: &mut Writer<'_, '_>, a: Enclosure) -> Enclosure {
    let zero = writer.constant(0.0);
    // No more than one of the two is positive.
    let [above, below] = [a.lo, a.minus_hi].map(|end| {
        let positive = writer.compare(FloatCC::LessThan, zero, end);
        writer.keep(positive, end)
    });
    let lo = writer.builder.ins().bor(above, below);
    let absolute = Enclosure { lo, minus_hi: lesser(writer, a.lo, a.minus_hi), known: a.known };
    let empty = writer.is_nan(a.lo);
    emptied(writer, empty, absolute)
}

fn minimum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> Enclosure {
    let greater = writer.compare(FloatCC::LessThan, b.minus_hi, a.minus_hi);
    let minimum = Enclosure {
        lo: lesser(writer, a.lo, b.lo),
        minus_hi: writer.choose(greater, a.minus_hi, b.minus_hi),
        known: common(writer, a, b),
    };
    let empty = writer.compare(FloatCC::Unordered, a.lo, b.lo);
    emptied(writer, empty, minimum)
}

fn square_root(writer: &mut Writer<'_, '_>, a: Enclosure) -> Enclosure {
    let zero = writer.constant(0.0);
    let hi = writer.builder.ins().fneg(a.minus_hi);
    let [lo, hi] = [a.lo, hi].map(|end| writer.builder.ins().sqrt(end));
    let minus_hi = writer.builder.ins().fneg(hi);
    let (lo, minus_hi) = (round_down(writer, lo), round_down(writer, minus_hi));
    let from_zero = writer.compare(FloatCC::LessThanOrEqual, a.lo, zero);
    let lo = writer.clear(from_zero, lo);
    let root = enclosing(writer, lo, minus_hi, a.known);
    let nowhere = writer.compare(FloatCC::LessThan, zero, a.minus_hi);
    let root = emptied(writer, nowhere, root);
    let somewhere_not = writer.compare(FloatCC::LessThan, a.lo, zero);
    trivial(writer, somewhere_not, root)
}

fn power(writer: &mut Writer<'_, '_>, a: Enclosure, exponent: u32) -> Enclosure {
    let (lo, minus_hi) = if exponent.is_multiple_of(2) {
        let [plus, minus, zero] = [0.0, -0.0, 0.0].map(|value| writer.constant(value));
        let a = absolute(writer, a);
        let at_zero = writer.compare(FloatCC::Equal, a.minus_hi, zero);
        let minus_hi = rounded_power(writer, a.minus_hi, minus, exponent);
        (rounded_power(writer, a.lo, plus, exponent), writer.clear(at_zero, minus_hi))
    } else {
        let ends = [a.lo, a.minus_hi].map(|end| {
            let sign = signs_of(writer, end);
            rounded_power(writer, end, sign, exponent)
        });
        (ends[0], ends[1])
    };
    enclosing(writer, lo, minus_hi, a.known)
}

/// The magnitude of `base` to the power `exponent`, with the given sign, rounded down after every product, in the order
/// that defines the operation's value.
fn rounded_power(writer: &mut Writer<'_, '_>, base: Value, sign: Value, exponent: u32) -> Value {
    let multiply = |writer: &mut Writer<'_, '_>, u: Value, v: Value| {
        let product = writer.builder.ins().fmul(u, v);
        let magnitude = writer.builder.ins().fabs(product);
        let signed = writer.builder.ins().bor(magnitude, sign);
        round_down(writer, signed)
    };
    let (mut remaining, mut square, mut product) = (exponent, base, None);
    loop {
        if remaining & 1 == 1 {
            product = Some(product.map_or(square, |product| multiply(writer, product, square)));
        }
        remaining >>= 1;
        match product {
            Some(product) if remaining == 0 => return product,
            _ => square = multiply(writer, square, square),
        }
    }
}
