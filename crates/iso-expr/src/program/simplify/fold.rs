//! Operations on constants.

use crate::{Constant, Decorated, Decoration, Extension, Node, NodeId, Operation, Program, Value};

/// The constant that `operation` gives when all `operands` are constants. None when it is undefined, or its double is not
/// finite, for then both are best left to evaluation.
pub(super) fn folded(program: &Program, operation: Operation, operands: &[NodeId]) -> Option<Constant> {
    let mut constants = [Constant::exact(0.0); 3];
    for (constant, operand) in constants.iter_mut().zip(operands) {
        let Node::Constant(operand) = program.node(*operand) else { return None };
        *constant = operand;
    }
    let [a, b, c] = constants.map(Constant::value);
    let value = match operation.value() {
        Value::Unary(value) => value(a),
        Value::Binary(value) => value(a, b),
        Value::Ternary(value) => value(a, b, c),
    };
    if !value.is_finite() {
        return None;
    }
    if constants.iter().all(|constant| constant.is_exact()) && is_exact(operation, a, b, value) {
        return Some(Constant::exact(value));
    }
    let [a, b, c] = constants.map(|constant| Decorated::constant(constant.enclosure()));
    let Decorated { interval, decoration } = match operation.extension() {
        Extension::Unary(extend) => extend(a),
        Extension::Binary(extend) => extend(a, b),
        Extension::Ternary(extend) => extend(a, b, c),
    };
    // Whether it is continuous in its operands does not matter, as they do not move.
    let is_number = decoration >= Decoration::Defined && interval.lo.is_finite() && interval.hi.is_finite();
    is_number.then(|| Constant::folded(value, interval))
}

/// Below this magnitude, the error of a product may itself be too small for a double.
const LEAST_WITH_EXACT_ERROR: f64 = 1e-290;

/// Whether the finite double `value` is known to be the real result of `operation` on a and b, not only its rounding.
fn is_exact(operation: Operation, a: f64, b: f64, value: f64) -> bool {
    use Operation as Op;
    match operation {
        Op::Add => sum_is_exact(a, b, value),
        Op::Subtract => sum_is_exact(a, -b, value),
        Op::Multiply => product_is_exact(a, b, value),
        Op::Divide => product_is_exact(value, b, a),
        Op::SquareRoot => product_is_exact(value, value, a),
        Op::Negate | Op::Absolute | Op::Sign | Op::Minimum | Op::Maximum => true,
        Op::Floor | Op::Ceil | Op::Round | Op::Truncate => true,
        Op::Less | Op::LessOrEqual | Op::Equal | Op::Select => true,
        _ => false,
    }
}

/// Whether a + b is `sum` (the error of a sum by Knuth, 'The Art of Computer Programming', volume 2, theorem 4.2.2 B).
fn sum_is_exact(a: f64, b: f64, sum: f64) -> bool {
    let of_b = sum - a;
    let of_a = sum - of_b;
    (a - of_a) + (b - of_b) == 0.0
}

/// Whether a · b is `product`: a fused product has one rounding, which is exact when the error is a double.
fn product_is_exact(a: f64, b: f64, product: f64) -> bool {
    let error_is_a_double = product.abs() >= LEAST_WITH_EXACT_ERROR || a == 0.0 || b == 0.0;
    error_is_a_double && a.mul_add(b, -product) == 0.0
}
