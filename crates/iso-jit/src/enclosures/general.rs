//! Extensions of any operands, empty and unbounded ones included, decorations with them.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{InstBuilder, Value};
use cranelift_frontend::FuncInstBuilder;
use iso_expr::{Decorated, Decoration, Operation};

use super::common::quotients;
use super::rounding::{least_of_four, round_down, signs_of};
use super::{
    Enclosure, both, emptied, exponent, greater, known, lesser, negative, nonzero_point, opposite, powers,
};
use crate::domain::Sign;
use crate::lanes::{Mask, Writer};

/// Writes `operation`, unless its extension is better called.
pub(super) fn apply(
    writer: &mut Writer<'_, '_>,
    operation: Operation,
    [a, b, _]: [Enclosure; 3],
    range: Decorated,
) -> Option<Enclosure> {
    use Operation as O;
    Some(match operation {
        O::Add => sum(writer, a, b, range),
        O::Multiply => match (nonzero_point(&a), nonzero_point(&b)) {
            (_, Some(scale)) => scaled(writer, a, scale, range, |ends, u, v| ends.fmul(u, v)),
            (Some(scale), _) => scaled(writer, b, scale, range, |ends, u, v| ends.fmul(u, v)),
            _ => product(writer, a, b, range),
        },
        O::Divide => match nonzero_point(&b) {
            Some(scale) => scaled(writer, a, scale, range, |ends, u, v| ends.fdiv(u, v)),
            None if !(a.is_common() && b.is_common()) => quotient(writer, a, b, range),
            None => match b.sign() {
                Sign::Any => quotient(writer, a, b, range),
                Sign::NotNegative => quotient_by_positive(writer, a, b, range),
                Sign::NotPositive => negative(quotient_by_positive(writer, a, negative(b), opposite(range))),
            },
        },
        O::Absolute => absolute(writer, a, range),
        O::Minimum => minimum(writer, a, b, range),
        O::SquareRoot => square_root(writer, a, range),
        O::IntegerPower => power(writer, a, exponent(&b), range),
        _ => return None,
    })
}

/// The enclosure between the real numbers whose nearest doubles are `lo` and minus `minus_hi`, decorated with no more than
/// `known`, and than continuous where it is unbounded.
fn rounded(
    writer: &mut Writer<'_, '_>,
    lo: Value,
    minus_hi: Value,
    known: Value,
    range: Decorated,
) -> Enclosure {
    let sign = Sign::of(range.interval);
    let (lo, minus_hi) = (round_down(writer, lo, sign), round_down(writer, minus_hi, sign.opposite()));
    enclosing(writer, lo, minus_hi, known, range)
}

/// The enclosure with these ends, known to be no more than continuous where it is unbounded.
fn enclosing(
    writer: &mut Writer<'_, '_>,
    lo: Value,
    minus_hi: Value,
    decoration: Value,
    range: Decorated,
) -> Enclosure {
    let minus_infinity = writer.constant(f64::NEG_INFINITY);
    let continuous = writer.integers(known(Decoration::Continuous));
    let outermost = lesser(writer, lo, minus_hi);
    let bounded = writer.compare(FloatCC::LessThan, minus_infinity, outermost);
    let bound = writer.builder.ins().bor(bounded.0, continuous);
    let known = writer.builder.ins().band(decoration, bound);
    Enclosure { lo, minus_hi, known: Some(known), range }
}

/// The same enclosure, of which nothing is known where the mask holds.
fn trivial(writer: &mut Writer<'_, '_>, mask: Mask, a: Enclosure) -> Enclosure {
    let known = a.known(writer);
    Enclosure { known: Some(writer.builder.ins().band_not(known, mask.0)), ..a }
}

fn sum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    let lo = writer.builder.ins().fadd(a.lo, b.lo);
    let minus_hi = writer.builder.ins().fadd(a.minus_hi, b.minus_hi);
    let known = both(writer, a, b);
    rounded(writer, lo, minus_hi, known, range)
}

/// The product with a number, or the quotient by it: what the general rules come to where only one combination of ends can
/// be the least.
fn scaled(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    scale: f64,
    range: Decorated,
    combine: impl Fn(FuncInstBuilder<'_, '_>, Value, Value) -> Value,
) -> Enclosure {
    let a = if scale < 0.0 { negative(a) } else { a };
    let magnitude = writer.constant(scale.abs());
    let [lo, minus_hi] = [a.lo, a.minus_hi].map(|end| combine(writer.builder.ins(), end, magnitude));
    let known = a.known(writer);
    rounded(writer, lo, minus_hi, known, range)
}

fn product(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    // Zero times anything is zero: an infinite end only says that there is no bound.
    let [zeros_of_a, zeros_of_b] = [a, b].map(|a| ends(a).map(|end| writer.is_zero(end)));
    let combinations = COMBINATIONS.map(|[i, j]| {
        let product = writer.builder.ins().fmul(ends(a)[i], ends(b)[j]);
        (product, writer.either(zeros_of_a[i], zeros_of_b[j]))
    });
    from_combinations(writer, combinations, a, b, range)
}

fn quotient(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    // Zero over anything is zero, and so is the limit of anything over what grows without bound.
    let zeros = ends(a).map(|end| writer.is_zero(end));
    let combinations = COMBINATIONS.map(|[i, j]| {
        let quotient = writer.builder.ins().fdiv(ends(a)[i], ends(b)[j]);
        let undefined = writer.is_nan(quotient);
        (quotient, writer.either(zeros[i], undefined))
    });
    let [zero, minus_infinity] = [0.0, f64::NEG_INFINITY].map(|value| writer.constant(value));
    let quotient = from_combinations(writer, combinations, a, b, range);

    let straddles = both_ends(writer, FloatCC::LessThan, b);
    let below = writer.compare(FloatCC::LessThan, a.lo, zero);
    let above = writer.compare(FloatCC::LessThan, a.minus_hi, zero);
    let not_zero = writer.either(below, above);
    let entire = writer.both(straddles, not_zero);
    let lo = writer.choose(entire, minus_infinity, quotient.lo);
    let minus_hi = writer.choose(entire, minus_infinity, quotient.minus_hi);
    let quotient = Enclosure { lo, minus_hi, ..quotient };

    let nowhere = both_ends(writer, FloatCC::Equal, b);
    let holds_zero = both_ends(writer, FloatCC::LessThanOrEqual, b);
    let quotient = emptied(writer, nowhere, quotient);
    trivial(writer, holds_zero, quotient)
}

/// Bounded operands, the divisor not negative.
fn quotient_by_positive(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    b: Enclosure,
    range: Decorated,
) -> Enclosure {
    let [lo, minus_hi] = quotients(writer, a, b);
    let common = a.known(writer);
    let quotient = rounded(writer, lo, minus_hi, common, range);
    let [nowhere, holds_zero] = [b.minus_hi, b.lo].map(|end| writer.is_zero(end));
    let quotient = emptied(writer, nowhere, quotient);
    trivial(writer, holds_zero, quotient)
}

/// Where both the lower end and minus the upper end compare with zero as `condition` says.
fn both_ends(writer: &mut Writer<'_, '_>, condition: FloatCC, a: Enclosure) -> Mask {
    let zero = writer.constant(0.0);
    let [lo, minus_hi] = ends(a).map(|end| writer.compare(condition, end, zero));
    writer.both(lo, minus_hi)
}

/// Both ends as they are held.
fn ends(a: Enclosure) -> [Value; 2] {
    [a.lo, a.minus_hi]
}

/// Each end of one operand with each of another. What combines in the second and the third has the wrong sign, for one end of
/// the two has.
const COMBINATIONS: [[usize; 2]; 4] = [[0, 0], [0, 1], [1, 0], [1, 1]];

/// The interval from the least to the greatest of some results for [`COMBINATIONS`], each with where it is taken for zero;
/// empty where an operand is.
fn from_combinations(
    writer: &mut Writer<'_, '_>,
    combinations: [(Value, Mask); 4],
    a: Enclosure,
    b: Enclosure,
    range: Decorated,
) -> Enclosure {
    let mut straight = combinations.map(|(value, zero)| writer.clear(zero, value));
    let mut negated = combinations.map(|(value, zero)| {
        let value = writer.negated(value);
        writer.clear(zero, value)
    });
    for place in [1, 2] {
        std::mem::swap(&mut straight[place], &mut negated[place]);
    }
    let [lo, minus_hi] = [straight, negated].map(|values| least_of_four(writer, values));
    let known = both(writer, a, b);
    let enclosure = rounded(writer, lo, minus_hi, known, range);
    let empty = writer.compare(FloatCC::Unordered, a.lo, b.lo);
    emptied(writer, empty, enclosure)
}

fn absolute(writer: &mut Writer<'_, '_>, a: Enclosure, range: Decorated) -> Enclosure {
    let zero = writer.constant(0.0);
    // No more than one of the two is positive.
    let [above, below] = ends(a).map(|end| {
        let positive = writer.compare(FloatCC::LessThan, zero, end);
        writer.keep(positive, end)
    });
    let lo = writer.builder.ins().bor(above, below);
    let absolute = Enclosure { lo, minus_hi: lesser(writer, a.lo, a.minus_hi), known: a.known, range };
    let empty = writer.is_nan(a.lo);
    emptied(writer, empty, absolute)
}

fn minimum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    let minimum = Enclosure {
        lo: lesser(writer, a.lo, b.lo),
        minus_hi: greater(writer, a.minus_hi, b.minus_hi),
        known: Some(both(writer, a, b)),
        range,
    };
    let empty = writer.compare(FloatCC::Unordered, a.lo, b.lo);
    emptied(writer, empty, minimum)
}

fn square_root(writer: &mut Writer<'_, '_>, a: Enclosure, range: Decorated) -> Enclosure {
    let zero = writer.constant(0.0);
    let hi = writer.negated(a.minus_hi);
    let [lo, hi] = [a.lo, hi].map(|end| writer.builder.ins().sqrt(end));
    let minus_hi = writer.negated(hi);
    let from_zero = writer.compare(FloatCC::LessThanOrEqual, a.lo, zero);
    let lo = writer.clear(from_zero, lo);
    let known = a.known(writer);
    let root = rounded(writer, lo, minus_hi, known, range);
    let nowhere = writer.compare(FloatCC::LessThan, zero, a.minus_hi);
    let root = emptied(writer, nowhere, root);
    let somewhere_not = writer.compare(FloatCC::LessThan, a.lo, zero);
    trivial(writer, somewhere_not, root)
}

fn power(writer: &mut Writer<'_, '_>, a: Enclosure, exponent: u32, range: Decorated) -> Enclosure {
    let (lo, minus_hi) = if exponent.is_multiple_of(2) {
        let [plus, minus] = [0.0, -0.0].map(|value| writer.constant(value));
        let a = absolute(writer, a, range);
        let at_zero = writer.is_zero(a.minus_hi);
        let minus_hi = rounded_power(writer, a.minus_hi, minus, exponent);
        (rounded_power(writer, a.lo, plus, exponent), writer.clear(at_zero, minus_hi))
    } else {
        let ends = ends(a).map(|end| {
            let sign = signs_of(writer, end);
            rounded_power(writer, end, sign, exponent)
        });
        (ends[0], ends[1])
    };
    let known = a.known(writer);
    enclosing(writer, lo, minus_hi, known, range)
}

/// The magnitude of `base` to the power `exponent`, with the given sign, which is the base's or negative, rounded down after
/// every product.
fn rounded_power(writer: &mut Writer<'_, '_>, base: Value, sign: Value, exponent: u32) -> Value {
    powers(writer, base, exponent, |writer, u, v| {
        let product = writer.builder.ins().fmul(u, v);
        let signed = writer.builder.ins().bor(product, sign);
        round_down(writer, signed, Sign::Any)
    })
}
