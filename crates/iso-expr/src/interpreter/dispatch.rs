//! From an operation, known when the code runs, to a function, known when the interpreter is compiled.

use crate::operation::{Operation, Value, value};

/// What is done with the function that gives an operation's value.
pub(super) trait Visitor {
    /// What the visit gives.
    type Output;
    /// Visits a function of one operand.
    fn unary(self, value: impl Fn(f64) -> f64) -> Self::Output;
    /// Visits a function of two operands.
    fn binary(self, value: impl Fn(f64, f64) -> f64) -> Self::Output;
    /// Visits a function of three operands.
    fn ternary(self, value: impl Fn(f64, f64, f64) -> f64) -> Self::Output;
}

/// Hands the value of `operation` to `visitor`. Operations of a few machine instructions are handed over each as a type of
/// its own, so that the visitor's loops are compiled for them; for the others the call costs little beside the work.
#[inline]
pub(super) fn visit<V: Visitor>(operation: Operation, visitor: V) -> V::Output {
    match operation {
        Operation::Add => visitor.binary(|a, b| value::add(a, b)),
        Operation::Subtract => visitor.binary(|a, b| value::subtract(a, b)),
        Operation::Multiply => visitor.binary(|a, b| value::multiply(a, b)),
        Operation::Divide => visitor.binary(|a, b| value::divide(a, b)),
        Operation::Negate => visitor.unary(|a| value::negate(a)),
        Operation::Absolute => visitor.unary(|a| value::absolute(a)),
        Operation::Sign => visitor.unary(|a| value::sign(a)),
        Operation::Minimum => visitor.binary(|a, b| value::minimum(a, b)),
        Operation::Maximum => visitor.binary(|a, b| value::maximum(a, b)),
        Operation::SquareRoot => visitor.unary(|a| value::square_root(a)),
        Operation::Floor => visitor.unary(|a| value::floor(a)),
        Operation::Ceil => visitor.unary(|a| value::ceil(a)),
        Operation::Round => visitor.unary(|a| value::round(a)),
        Operation::Truncate => visitor.unary(|a| value::truncate(a)),
        Operation::Less => visitor.binary(|a, b| value::less(a, b)),
        Operation::LessOrEqual => visitor.binary(|a, b| value::less_or_equal(a, b)),
        Operation::Equal => visitor.binary(|a, b| value::equal(a, b)),
        Operation::Select => visitor.ternary(|a, b, c| value::select(a, b, c)),
        _ => match operation.value() {
            Value::Unary(value) => visitor.unary(|a| value(a)),
            Value::Binary(value) => visitor.binary(|a, b| value(a, b)),
            Value::Ternary(value) => visitor.ternary(|a, b, c| value(a, b, c)),
        },
    }
}
