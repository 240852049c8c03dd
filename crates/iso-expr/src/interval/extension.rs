//! Interval extensions of operations, under the names by which the table of operations knows them.

use super::Decorated;
use super::elementary::{logarithm_by_ends, rising_by_ends};
use crate::Operation;

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

/// How an extension follows from the operation's correctly rounded values at both ends of its operand, which may be had at less cost
/// together than one by one.
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
pub enum ByEnds {
    /// Of a function that rises everywhere.
    Rising,
    /// Of a logarithm, which rises from −∞ at zero.
    Logarithm,
}

impl ByEnds {
    /// How the extension of `operation` follows; `None` where no engine asks for it.
    pub fn of(operation: Operation) -> Option<Self> {
        match operation {
            Operation::Exp | Operation::CubeRoot => Some(Self::Rising),
            Operation::Ln => Some(Self::Logarithm),
            _ => None,
        }
    }

    /// The enclosure over `a`, given the values at its lower and its upper end; those of a logarithm where there are none are not read.
    #[inline]
    pub fn extension(self, a: Decorated, values: [f64; 2]) -> Decorated {
        match self {
            Self::Rising => rising_by_ends(a, values),
            Self::Logarithm => logarithm_by_ends(a, 0.0, values),
        }
    }
}
