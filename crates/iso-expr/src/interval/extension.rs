//! Interval extensions of operations.

use super::{Decorated, Decoration, Interval};

/// The interval extension of an operation, by arity.
#[derive(Clone, Copy, Debug)]
pub enum Extension {
    /// Of one operand.
    Unary(fn(Decorated) -> Decorated),
    /// Of two operands.
    Binary(fn(Decorated, Decorated) -> Decorated),
    /// Of three operands.
    Ternary(fn(Decorated, Decorated, Decorated) -> Decorated),
}

/// What holds for every function: it may be anything, anywhere.
const NOTHING_KNOWN: Decorated = Decorated { interval: Interval::ENTIRE, decoration: Decoration::Trivial };

macro_rules! unknown {
    ($($function:ident($($operand:ident),*);)*) => {
        $(pub(crate) fn $function($($operand: Decorated),*) -> Decorated { $(let _ = $operand;)* NOTHING_KNOWN })*
    };
}

unknown! {
    add(a, b); subtract(a, b); multiply(a, b); divide(a, b); negate(a); absolute(a); sign(a); minimum(a, b);
    maximum(a, b); integer_power(a, b); power(a, b); square_root(a); cube_root(a); hypotenuse(a, b); exp(a); exp2(a);
    exp_m1(a); ln(a); log2(a); log10(a); ln_1p(a); sin(a); cos(a); tan(a); asin(a); acos(a); atan(a); atan2(a, b);
    sinh(a); cosh(a); tanh(a); asinh(a); acosh(a); atanh(a); floor(a); ceil(a); round(a); truncate(a); modulo(a, b);
    less(a, b); less_or_equal(a, b); equal(a, b); select(a, b, c);
}
