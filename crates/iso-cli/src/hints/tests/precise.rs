//! Formulas in arithmetic of many more digits than doubles have, next to which all rounding of doubles is visible.

use astro_float::{BigFloat, Consts, RoundingMode};
use iso_expr::{Node, Operation, Program};

/// Bits of every intermediate value.
const PRECISION: usize = 512;
const ROUNDING: RoundingMode = RoundingMode::ToEven;

/// The formula's value at `point`, to some 150 digits where little cancels.
pub(super) fn value(program: &Program, point: [f64; 3]) -> BigFloat {
    let mut constants = Consts::new().expect("memory suffices");
    let mut values: Vec<BigFloat> = Vec::new();
    for node in program.nodes() {
        let value = match node {
            Node::Variable(argument) => exactly(point[argument.index()]),
            Node::Constant(constant) => {
                assert!(constant.is_exact(), "no formula of these tests has another constant");
                exactly(constant.value())
            }
            Node::Apply(operation, operands) => {
                let operand = |place: usize| &values[operands[place].index()];
                apply(*operation, operand, &mut constants)
            }
        };
        values.push(value);
    }
    values.swap_remove(program.outputs()[0].index())
}

/// |`computed` − `exact`|.
pub(super) fn error(computed: f64, exact: &BigFloat) -> BigFloat {
    exactly(computed).sub(exact, PRECISION, ROUNDING).abs()
}

pub(super) fn exactly(value: f64) -> BigFloat {
    BigFloat::from_f64(value, PRECISION)
}

pub(super) fn product(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.mul(b, PRECISION, ROUNDING)
}

pub(super) fn sum(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.add(b, PRECISION, ROUNDING)
}

pub(super) fn difference(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.sub(b, PRECISION, ROUNDING)
}

/// `base` multiplied by itself, `exponent` factors in all.
fn power(base: &BigFloat, exponent: &BigFloat) -> BigFloat {
    let (mut power, mut factors) = (base.clone(), exactly(1.0));
    while factors.cmp(exponent).is_some_and(|order| order < 0) {
        (power, factors) = (product(&power, base), sum(&factors, &exactly(1.0)));
    }
    power
}

fn apply<'a>(
    operation: Operation,
    operand: impl Fn(usize) -> &'a BigFloat,
    constants: &mut Consts,
) -> BigFloat {
    let (precision, rounding, one) = (PRECISION, ROUNDING, exactly(1.0));
    let a = operand(0);
    match operation {
        Operation::Add => sum(a, operand(1)),
        Operation::Subtract => difference(a, operand(1)),
        Operation::Multiply => product(a, operand(1)),
        Operation::Divide => a.div(operand(1), precision, rounding),
        Operation::Negate => a.neg(),
        Operation::IntegerPower => power(a, operand(1)),
        Operation::SquareRoot => a.sqrt(precision, rounding),
        Operation::Hypotenuse => {
            let squares = [a, operand(1)].map(|side| product(side, side));
            sum(&squares[0], &squares[1]).sqrt(precision, rounding)
        }
        Operation::Exp => a.exp(precision, rounding, constants),
        Operation::ExpM1 => difference(&a.exp(precision, rounding, constants), &one),
        Operation::Ln => a.ln(precision, rounding, constants),
        Operation::Ln1P => sum(a, &one).ln(precision, rounding, constants),
        Operation::Sin => a.sin(precision, rounding, constants),
        Operation::Cos => a.cos(precision, rounding, constants),
        _ => panic!("no formula of these tests has {operation:?}"),
    }
}
