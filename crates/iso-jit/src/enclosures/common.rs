//! Extensions where the result is known to be common over every box that the kernel takes: operands are bounded and not empty,
//! nothing overflows, and there is no decoration to compute.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{InstBuilder, Value};
use iso_expr::{Decorated, Operation};

use super::rounding::{least, round_down, round_down_negative, signs_of};
use super::{Enclosure, exponent, greater, lesser, negative, nonzero_point, opposite, powers};
use crate::domain::Sign;
use crate::lanes::Writer;

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
            (_, Some(scale)) => scaled(writer, a, scale, range),
            (Some(scale), _) => scaled(writer, b, scale, range),
            _ => product(writer, a, b, range),
        },
        O::Divide => quotient(writer, a, b, range),
        O::Absolute => absolute(writer, a, range),
        O::Minimum => minimum(writer, a, b, range),
        O::SquareRoot => square_root(writer, a, range),
        O::IntegerPower => power(writer, a, exponent(&b), range),
        _ => return None,
    })
}

/// The enclosure between the real numbers whose nearest doubles are `lo` and minus `minus_hi`.
fn rounded(writer: &mut Writer<'_, '_>, lo: Value, minus_hi: Value, range: Decorated) -> Enclosure {
    let sign = Sign::of(range.interval);
    let (lo, minus_hi) = (round_down(writer, lo, sign), round_down(writer, minus_hi, sign.opposite()));
    Enclosure { lo, minus_hi, known: None, range }
}

fn sum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    let lo = writer.builder.ins().fadd(a.lo, b.lo);
    let minus_hi = writer.builder.ins().fadd(a.minus_hi, b.minus_hi);
    rounded(writer, lo, minus_hi, range)
}

/// The product with a number.
fn scaled(writer: &mut Writer<'_, '_>, a: Enclosure, scale: f64, range: Decorated) -> Enclosure {
    let a = if scale < 0.0 { negative(a) } else { a };
    let magnitude = writer.constant(scale.abs());
    let [lo, minus_hi] = [a.lo, a.minus_hi].map(|end| writer.builder.ins().fmul(end, magnitude));
    rounded(writer, lo, minus_hi, range)
}

/// Chooses the ends whose product is least by their signs, instead of comparing all four products.
fn product(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    match (a.sign(), b.sign()) {
        (Sign::NotPositive, _) => negative(product(writer, negative(a), b, opposite(range))),
        (_, Sign::NotPositive) => negative(product(writer, a, negative(b), opposite(range))),
        (Sign::NotNegative, Sign::NotNegative) => product_of_positive(writer, a, b, range),
        (Sign::NotNegative, Sign::Any) => product_with_positive(writer, b, a, range),
        (Sign::Any, Sign::NotNegative) => product_with_positive(writer, a, b, range),
        (Sign::Any, Sign::Any) => product_of_any(writer, a, b, range),
    }
}

/// Neither is negative.
fn product_of_positive(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    b: Enclosure,
    range: Decorated,
) -> Enclosure {
    let lo = writer.builder.ins().fmul(a.lo, b.lo);
    let hi = writer.negated(a.minus_hi);
    let minus_hi = writer.builder.ins().fmul(hi, b.minus_hi);
    // 0·(−0) is −0, but exactly zero.
    let is_zero = writer.is_zero(b.minus_hi);
    let minus_hi = writer.clear(is_zero, minus_hi);
    rounded(writer, lo, minus_hi, range)
}

/// `b` is not negative: the least product has b's upper end where a's lower one is negative, else b's lower one. Zero factors are
/// held so that the zeros come out positive.
fn product_with_positive(
    writer: &mut Writer<'_, '_>,
    a: Enclosure,
    b: Enclosure,
    range: Decorated,
) -> Enclosure {
    let zero = writer.constant(0.0);
    let hi = writer.negated(b.minus_hi);
    let [lo, minus_hi] = [a.lo, a.minus_hi].map(|end| {
        let is_negative = writer.compare(FloatCC::LessThan, end, zero);
        let factor = writer.choose(is_negative, hi, b.lo);
        writer.builder.ins().fmul(end, factor)
    });
    rounded(writer, lo, minus_hi, range)
}

/// For each end of `a` there is one end of `b` with which the product is least, and the other makes it greatest.
fn product_of_any(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    let zero = writer.constant(0.0);
    let below = writer.compare(FloatCC::LessThan, a.lo, zero);
    let above = writer.compare(FloatCC::LessThan, zero, a.minus_hi);
    // The upper end is negative where minus the upper end is positive. Where the end u of `a` is negative, u·b is at least
    // |u|·(−b.hi), else |u|·b.lo; and −u·b the other way round.
    let [from_lo, from_hi] = [(a.lo, below), (a.minus_hi, above)].map(|(end, is_negative)| {
        let size = writer.magnitude(end);
        let is_zero = writer.is_zero(end);
        [(b.minus_hi, b.lo), (b.lo, b.minus_hi)].map(|(factor, other)| {
            let factor = writer.choose(is_negative, factor, other);
            let product = writer.builder.ins().fmul(size, factor);
            writer.clear(is_zero, product)
        })
    });
    let lo = least(writer, from_lo[0], from_hi[0]);
    let minus_hi = least(writer, from_lo[1], from_hi[1]);
    rounded(writer, lo, minus_hi, range)
}

/// The divisor is never zero.
fn quotient(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    if b.sign() == Sign::NotPositive {
        return negative(quotient(writer, a, negative(b), opposite(range)));
    }
    let [lo, minus_hi] = quotients(writer, a, b);
    rounded(writer, lo, minus_hi, range)
}

/// The nearest doubles of the least quotient and minus the greatest one of bounded numbers, the divisor not being negative.
/// Where the divisor is zero, the limits from above; not a number where all of it is.
pub(super) fn quotients(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure) -> [Value; 2] {
    let zero = writer.constant(0.0);
    let hi = writer.negated(b.minus_hi);
    [a.lo, a.minus_hi].map(|end| {
        let is_negative = writer.compare(FloatCC::LessThan, end, zero);
        let divisor = writer.choose(is_negative, b.lo, hi);
        writer.builder.ins().fdiv(end, divisor)
    })
}

fn absolute(writer: &mut Writer<'_, '_>, a: Enclosure, range: Decorated) -> Enclosure {
    let [lo, minus_hi] = magnitudes(writer, a);
    Enclosure { lo, minus_hi, known: None, range }
}

/// The least absolute value, and minus the greatest.
fn magnitudes(writer: &mut Writer<'_, '_>, a: Enclosure) -> [Value; 2] {
    match a.sign() {
        Sign::NotNegative => [a.lo, a.minus_hi],
        Sign::NotPositive => [a.minus_hi, a.lo],
        Sign::Any => {
            let zero = writer.constant(0.0);
            // No more than one of the two is positive.
            let positive = greater(writer, a.lo, a.minus_hi);
            [greater(writer, positive, zero), lesser(writer, a.lo, a.minus_hi)]
        }
    }
}

fn minimum(writer: &mut Writer<'_, '_>, a: Enclosure, b: Enclosure, range: Decorated) -> Enclosure {
    let lo = lesser(writer, a.lo, b.lo);
    let minus_hi = greater(writer, a.minus_hi, b.minus_hi);
    Enclosure { lo, minus_hi, known: None, range }
}

/// The radicand is never negative.
fn square_root(writer: &mut Writer<'_, '_>, a: Enclosure, range: Decorated) -> Enclosure {
    let hi = writer.negated(a.minus_hi);
    let [lo, hi] = [a.lo, hi].map(|end| writer.builder.ins().sqrt(end));
    let minus_hi = writer.negated(hi);
    rounded(writer, lo, minus_hi, range)
}

fn power(writer: &mut Writer<'_, '_>, a: Enclosure, exponent: u32, range: Decorated) -> Enclosure {
    if exponent.is_multiple_of(2) {
        even_power(writer, a, exponent, range)
    } else {
        odd_power(writer, a, exponent, range)
    }
}

fn even_power(writer: &mut Writer<'_, '_>, a: Enclosure, exponent: u32, range: Decorated) -> Enclosure {
    let [least, minus_greatest] = magnitudes(writer, a);
    let lo = powers(writer, least, exponent, |writer, u, v| {
        let product = writer.builder.ins().fmul(u, v);
        round_down(writer, product, Sign::NotNegative)
    });
    let sign = writer.constant(-0.0);
    let minus_hi = powers(writer, minus_greatest, exponent, |writer, u, v| {
        let product = writer.builder.ins().fmul(u, v);
        let signed = writer.builder.ins().bor(product, sign);
        round_down_negative(writer, signed)
    });
    let is_zero = writer.is_zero(minus_greatest);
    let minus_hi = writer.clear(is_zero, minus_hi);
    Enclosure { lo, minus_hi, known: None, range }
}

fn odd_power(writer: &mut Writer<'_, '_>, a: Enclosure, exponent: u32, range: Decorated) -> Enclosure {
    let [lo, minus_hi] = [(a.lo, a.sign()), (a.minus_hi, a.sign().opposite())].map(|(end, sign)| {
        let bit = signs_of(writer, end);
        powers(writer, end, exponent, |writer, u, v| {
            let product = writer.builder.ins().fmul(u, v);
            let signed = writer.builder.ins().bor(product, bit);
            round_down(writer, signed, sign)
        })
    });
    Enclosure { lo, minus_hi, known: None, range }
}
