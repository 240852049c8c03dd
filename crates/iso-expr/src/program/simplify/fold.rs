//! Operations on constants.

use crate::program::exact::{product_is_exact, sum_is_exact};
use crate::{Constant, Decorated, Decoration, Node, NodeId, Operation, Program};

/// The constant that `operation` gives when all `operands` are constants. None when it is undefined, or its double is not
/// finite, for then both are best left to evaluation.
pub(in crate::program) fn folded(
    program: &Program,
    operation: Operation,
    operands: &[NodeId],
) -> Option<Constant> {
    let mut constants = [Constant::exact(0.0); 3];
    for (constant, operand) in constants.iter_mut().zip(operands) {
        let Node::Constant(operand) = program.node(*operand) else { return None };
        *constant = operand;
    }
    let operands @ [a, b, _] = constants.map(Constant::value);
    let value = operation.value().of(operands);
    if !value.is_finite() {
        return None;
    }
    if constants.iter().all(|constant| constant.is_exact()) && is_exact(operation, a, b, value) {
        return Some(Constant::exact(value));
    }
    let enclosures = constants.map(|constant| Decorated::constant(constant.enclosure()));
    let Decorated { interval, decoration } = operation.extension().of(enclosures);
    // Whether it is continuous in its operands does not matter, as they do not move.
    let is_number = decoration >= Decoration::Defined && interval.lo.is_finite() && interval.hi.is_finite();
    is_number.then(|| Constant::folded(value, interval))
}

/// Whether the finite double `value` is known to be the real result of `operation` on a and b, not only its rounding.
fn is_exact(operation: Operation, a: f64, b: f64, value: f64) -> bool {
    use Operation as Op;
    match operation {
        Op::Add => sum_is_exact(a, b, value),
        Op::Subtract => sum_is_exact(a, -b, value),
        Op::Multiply => product_is_exact(a, b, value),
        Op::Divide => product_is_exact(value, b, a),
        Op::IntegerPower => power_is_exact(a, b, value),
        Op::SquareRoot => product_is_exact(value, value, a),
        Op::CubeRoot => {
            let square = value * value;
            product_is_exact(value, value, square) && product_is_exact(square, value, a)
        }
        Op::Negate | Op::Absolute | Op::Sign | Op::Minimum | Op::Maximum => true,
        Op::Floor | Op::Ceil | Op::Round | Op::Truncate => true,
        Op::Less | Op::LessOrEqual | Op::Equal | Op::Select => true,
        _ => false,
    }
}

/// Whether the `exponent`-th power of `base` is `power`: no product on the way has more digits than the last one.
fn power_is_exact(base: f64, exponent: f64, power: f64) -> bool {
    let fraction_digits = f64::MANTISSA_DIGITS - 1;
    let significand = base.to_bits() & ((1 << fraction_digits) - 1) | 1 << fraction_digits;
    let digits = f64::MANTISSA_DIGITS - significand.trailing_zeros();
    let fits = digits == 1 || f64::from(digits) * exponent <= f64::from(f64::MANTISSA_DIGITS);
    fits && base.is_normal() && power.is_normal()
}

#[cfg(test)]
mod tests {
    use crate::{Ast, Constant, Node, Program};

    fn simplified(formula: &str) -> Program {
        Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified()
    }

    fn constant(formula: &str) -> Constant {
        let program = simplified(formula);
        let Node::Constant(constant) = program.node(program.outputs()[0]) else {
            panic!("{formula} became\n{program}");
        };
        constant
    }

    #[test]
    fn exact_results_are_exact_constants() {
        let cases = [
            ("3 + 4", 7.0),
            ("0.5 - 2", -1.5),
            ("1.5 * 2.5", 3.75),
            ("9 / 4", 2.25),
            ("sqrt(2.25)", 1.5),
            ("cbrt(-3.375)", -1.5),
            ("3^2", 9.0),
            ("(-1.5)^3", -3.375),
            ("2^-3", 0.125),
            ("2^1000 * 2^-1000", 1.0),
            ("0 * 3", 0.0),
            ("max(3, floor(2.5))", 3.0),
            ("if(2 < 3, 4, 5)", 4.0),
        ];
        for (formula, value) in cases {
            assert_eq!(constant(formula), Constant::exact(value), "{formula}");
        }
    }

    #[test]
    fn rounded_results_hold_the_real_number() {
        // Each with two neighbouring doubles that the real number lies between.
        let cases = [
            ("1 / 3", (1.0_f64 / 3.0).next_down(), (1.0_f64 / 3.0).next_up()),
            ("0.1 + 0.2", 0.3, 0.3_f64.next_up()),
            ("1e-200 * 1e-100 * 1e-20", 1e-320_f64.next_down(), 1e-320_f64.next_up()),
            ("2 * pi", std::f64::consts::TAU, std::f64::consts::TAU.next_up()),
            ("cbrt(4)", 1.587_401_051_968_199_4, 1.587_401_051_968_199_7),
            ("ln(2)", std::f64::consts::LN_2, std::f64::consts::LN_2.next_up()),
            (
                "3^40",
                12_157_665_459_056_928_801.0_f64.next_down(),
                12_157_665_459_056_928_801.0_f64.next_up(),
            ),
        ];
        for (formula, below, above) in cases {
            let constant = constant(formula);
            let enclosure = constant.enclosure();
            assert!(enclosure.lo <= below && above <= enclosure.hi, "{formula}: {enclosure}");
            assert!(enclosure.contains(constant.value()) && !constant.is_exact(), "{formula}: {enclosure}");
        }
    }

    #[test]
    fn what_is_undefined_or_not_finite_is_not_folded() {
        for formula in ["1 / 0", "sqrt(-1)", "ln(0)", "1e300 * 1e300", "asin(2)", "mod(1, 0)", "0 / 0"] {
            assert!(simplified(formula).operations() > 0, "{formula}");
        }
    }
}
