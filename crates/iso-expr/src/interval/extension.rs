//! Interval extensions of operations, under the names by which the table of operations knows them.

use super::Decorated;

pub(crate) use super::angle::atan2;
pub(crate) use super::arithmetic::{absolute, add, divide, maximum, minimum, multiply, negate, subtract};
pub(crate) use super::elementary::{
    acos, acosh, asin, asinh, atan, atanh, cosh, exp, exp_m1, exp2, ln, ln_1p, log2, log10, sinh, tanh,
};
pub(crate) use super::modulo::modulo;
pub(crate) use super::periodic::{cos, sin, tan};
pub(crate) use super::power::{cube_root, hypotenuse, integer_power, power, square_root};
pub(crate) use super::steps::{ceil, equal, floor, less, less_or_equal, round, select, sign, truncate};

/// The interval extension of an operation, by arity.
///
/// Every extension contains the real values of its operation, is isotone (smaller operands give a smaller result), and
/// takes any operands, empty and unbounded ones included.
#[derive(Clone, Copy, Debug)]
pub enum Extension {
    /// Of one operand.
    Unary(fn(Decorated) -> Decorated),
    /// Of two operands.
    Binary(fn(Decorated, Decorated) -> Decorated),
    /// Of three operands.
    Ternary(fn(Decorated, Decorated, Decorated) -> Decorated),
}

impl Extension {
    /// The enclosure of the operation on these operands, of which only as many as its arity count.
    #[inline]
    pub fn of(self, [a, b, c]: [Decorated; 3]) -> Decorated {
        match self {
            Self::Unary(extend) => extend(a),
            Self::Binary(extend) => extend(a, b),
            Self::Ternary(extend) => extend(a, b, c),
        }
    }
}
