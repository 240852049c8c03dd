//! Values of operations in IEEE 754 doubles: what every engine must give, bit for bit.
//!
//! The functions have the C calling convention so that native code calls the very same ones.

use super::by_squaring;

/// The value of an operation, by arity.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// Of one operand.
    Unary(extern "C" fn(f64) -> f64),
    /// Of two operands.
    Binary(extern "C" fn(f64, f64) -> f64),
    /// Of three operands.
    Ternary(extern "C" fn(f64, f64, f64) -> f64),
}

impl Value {
    /// The value for these operands, of which only as many as the arity count.
    #[inline]
    pub fn of(self, [a, b, c]: [f64; 3]) -> f64 {
        match self {
            Self::Unary(value) => value(a),
            Self::Binary(value) => value(a, b),
            Self::Ternary(value) => value(a, b, c),
        }
    }
}

macro_rules! values {
    ($($function:ident($($operand:ident),*) = $value:expr;)*) => {
        $(pub(crate) extern "C" fn $function($($operand: f64),*) -> f64 { $value })*
    };
}

values! {
    add(a, b) = a + b;
    subtract(a, b) = a - b;
    multiply(a, b) = a * b;
    divide(a, b) = a / b;
    negate(a) = -a;
    absolute(a) = a.abs();
    sign(a) = if a > 0.0 { 1.0 } else if a < 0.0 { -1.0 } else { a };
    minimum(a, b) = if a.is_nan() || a < b { a } else { b };
    maximum(a, b) = if a.is_nan() || a > b { a } else { b };
    square_root(a) = a.sqrt();
    cube_root(a) = core_math::cbrt(a);
    // The C function gives infinity for an infinite and a NaN side; an undefined side is undefined here.
    hypotenuse(a, b) = if a.is_nan() || b.is_nan() { f64::NAN } else { core_math::hypot(a, b) };
    exp(a) = core_math::exp(a);
    exp2(a) = core_math::exp2(a);
    exp_m1(a) = core_math::expm1(a);
    ln(a) = core_math::log(a);
    log2(a) = core_math::log2(a);
    log10(a) = core_math::log10(a);
    ln_1p(a) = core_math::log1p(a);
    sin(a) = core_math::sin(a);
    cos(a) = core_math::cos(a);
    tan(a) = core_math::tan(a);
    asin(a) = core_math::asin(a);
    acos(a) = core_math::acos(a);
    atan(a) = core_math::atan(a);
    // The C function tells −0 from 0 to know on which side of a cut it is; a real zero is on neither.
    atan2(a, b) = core_math::atan2(a + 0.0, b + 0.0);
    sinh(a) = core_math::sinh(a);
    cosh(a) = core_math::cosh(a);
    tanh(a) = core_math::tanh(a);
    asinh(a) = core_math::asinh(a);
    acosh(a) = core_math::acosh(a);
    atanh(a) = core_math::atanh(a);
    floor(a) = a.floor();
    ceil(a) = a.ceil();
    round(a) = a.round_ties_even();
    truncate(a) = a.trunc();
    less(a, b) = truth(a, b, a < b);
    less_or_equal(a, b) = truth(a, b, a <= b);
    equal(a, b) = truth(a, b, a == b);
    select(a, b, c) = if a.is_nan() { a } else if a != 0.0 { b } else { c };
}

/// A comparison that is undefined where one of its sides is.
fn truth(a: f64, b: f64, holds: bool) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(u8::from(holds)) }
}

/// `base` multiplied by itself [by squaring](by_squaring).
pub(crate) extern "C" fn integer_power(base: f64, exponent: f64) -> f64 {
    by_squaring(base, exponent as u32, |a, b| a * b.unwrap_or(a)).unwrap_or(1.0)
}

/// The C function, but undefined for every negative base, and for an undefined base or exponent.
pub(crate) extern "C" fn power(base: f64, exponent: f64) -> f64 {
    if base.is_nan() || exponent.is_nan() || base < 0.0 { f64::NAN } else { core_math::pow(base, exponent) }
}

/// The exact remainder, moved to the sign of `b`.
pub(crate) extern "C" fn modulo(a: f64, b: f64) -> f64 {
    let remainder = a % b;
    if remainder != 0.0 && (remainder < 0.0) != (b < 0.0) { remainder + b } else { remainder }
}
