//! Affine forms: how a program's values depend on where its arguments are, to first order, and how far they are off.
//!
//! A form stands for the numbers middle + ∑ slopeᵢ·eᵢ + r with −1 ≤ eᵢ ≤ 1 and |r| ≤ rest. The three eᵢ are the same for all forms,
//! so that what values have in common is known, and cancels (Comba and Stolfi, Affine arithmetic and its applications to computer
//! graphics, 1993). Over a beam of rays they are column, row and distance; that the beam lies askew does not matter.
//!
//! Forms are programs: each operation on them is a dozen or three on doubles. What these are off by rounding is part of the rest.

mod arithmetic;
mod choices;
mod functions;
mod smooth;
#[cfg(test)]
mod tests;

use super::{Argument, Node, NodeId, Program};
use crate::{Axis, Constant, Operation};

/// The parts of a form: the middle, three slopes and the rest.
const PARTS: usize = 5;

/// A bound of all roundings of an operation on forms, as part of the result's size: they are fewer than thirty, each no larger than
/// 2⁻⁵³ of what it rounds, which the result's size exceeds.
const ROUNDING: f64 = 1.0 / (1u64 << 48) as f64;

/// What is added to the sizes of products and quotients, so that the part of it above exceeds what underflow may cost.
const TINY: f64 = f64::from_bits(0x07b0_0000_0000_0000);

impl Program {
    /// How many numbers a form is: its middle, three slopes and its rest.
    pub const FORM: usize = PARTS;

    /// The most arguments that a program takes: three forms and a direction.
    pub const MOST_ARGUMENTS: usize = 3 * PARTS + 3;

    /// The program of the forms of this one's outputs, each of [`Program::FORM`] outputs. Its arguments are the forms of x, y and z,
    /// one after the other, and behind them the components of a direction, if this one [takes](Program::with_slope) them: they are
    /// numbers and the same everywhere. `None` where it takes an operation that has no form.
    ///
    /// Where all parts of an output's form are finite, computed in doubles: that output is defined on the whole set of (x, y, z)
    /// of which the arguments are forms, and what it is there for real arithmetic is one of the numbers of its form, for the same
    /// eᵢ. If all operations are [continuous](Program::has_forms), it is continuous there. A program of generalised derivatives has
    /// forms that hold both sides of their jumps.
    pub fn with_forms(&self) -> Option<Self> {
        let mut builder = Builder(Self::new());
        let arguments = Axis::ALL.map(|axis| builder.argument(axis));
        let mut forms: Vec<Form> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            forms.push(match *node {
                Node::Variable(argument) => match arguments.get(argument.index()) {
                    Some(form) => *form,
                    None => builder.number(argument.index() - arguments.len()),
                },
                Node::Constant(constant) => builder.constant(constant),
                Node::Apply(Operation::IntegerPower, [base, exponent, _]) => {
                    let exponent =
                        self.exponent(exponent).expect("programs check the exponents of integer powers");
                    builder.power(forms[base.index()], exponent)
                }
                Node::Apply(Operation::Ln, [argument, ..]) => {
                    match builder.logarithm_of_sum(self, argument, &forms) {
                        Some(logarithm) => logarithm,
                        None => builder.logarithm(forms[argument.index()]),
                    }
                }
                Node::Apply(Operation::Divide, [numerator, divisor, _]) => {
                    let numerator = forms[numerator.index()];
                    match builder.share_in_sum(self, divisor, &forms) {
                        Some(share) => builder.multiple(share, numerator),
                        None => builder.quotient(numerator, forms[divisor.index()]),
                    }
                }
                Node::Apply(Operation::Add, [a, b, _]) if let Some(mean) = self.mean_by_shares(a, b) => {
                    builder.mean(&mean, &forms)
                }
                Node::Apply(operation, operands) => {
                    let forms = operands.map(|operand| forms[operand.index()]);
                    builder.apply(operation, operands, forms)?
                }
            });
        }
        let mut program = builder.0;
        let outputs = self.outputs.iter().flat_map(|output| {
            let Form { middle, slopes: [a, b, c], rest, .. } = forms[output.index()];
            [Some(middle), a, b, c, rest]
        });
        let outputs: Vec<_> = outputs.collect();
        program.outputs =
            outputs.into_iter().map(|part| part.unwrap_or_else(|| program.literal(0.0))).collect();
        Some(program.pruned())
    }

    /// Whether all operations are continuous wherever they are defined, and have forms that are worth their while: of the logarithm of a
    /// sum of more than four exponentials, derivatives are made of quotients of which forms seldom say anything.
    pub fn has_forms(&self) -> bool {
        use Operation as O;
        self.nodes.iter().all(|node| match node {
            Node::Apply(O::Ln, [argument, ..]) => !self.has_quotients_for_shares(*argument),
            Node::Apply(operation, _) => {
                matches!(
                    operation,
                    O::Add | O::Subtract | O::Multiply | O::Divide | O::Negate | O::IntegerPower
                ) || matches!(
                    operation,
                    O::SquareRoot | O::CubeRoot | O::Hypotenuse | O::Exp | O::Sin | O::Cos
                ) || matches!(operation, O::Absolute | O::Minimum | O::Maximum)
            }
            _ => true,
        })
    }
}

/// The nodes of a form. Parts that are missing are zero.
#[derive(Clone, Copy)]
struct Form {
    middle: NodeId,
    slopes: [Option<NodeId>; 3],
    rest: Option<NodeId>,
    /// No number of the form exceeds it, but for roundings.
    size: NodeId,
}

/// Adds operations on forms to a program.
struct Builder(Program);

impl Builder {
    fn argument(&mut self, axis: Axis) -> Form {
        let first = PARTS * axis as usize;
        let [middle, a, b, c, rest] =
            [0, 1, 2, 3, 4].map(|part| self.0.intern(Node::Variable(Argument((first + part) as u8))));
        let form = Form { middle, slopes: [a, b, c].map(Some), rest: Some(rest), size: middle };
        Form { size: self.magnitude(form), ..form }
    }

    /// The form of one of the arguments that are numbers.
    fn number(&mut self, place: usize) -> Form {
        let argument = Argument((3 * PARTS + place) as u8);
        let middle = self.0.intern(Node::Variable(argument));
        Form { middle, slopes: [None; 3], rest: None, size: self.magnitude_of(middle) }
    }

    fn constant(&mut self, constant: Constant) -> Form {
        let width = constant.enclosure().width();
        let middle = self.0.literal(constant.value());
        let rest = (!constant.is_exact()).then(|| self.0.literal(width));
        let size = self.0.literal(constant.value().abs() + width);
        Form { middle, slopes: [None; 3], rest, size }
    }

    fn apply(&mut self, operation: Operation, operands: [NodeId; 3], [a, b, c]: [Form; 3]) -> Option<Form> {
        Some(match operation {
            Operation::Add => self.sum(a, b),
            Operation::Subtract => self.difference(a, b),
            Operation::Negate => self.negative(a),
            Operation::Multiply if operands[0] == operands[1] => self.square(a),
            Operation::Multiply => self.product(a, b),
            Operation::SquareRoot => self.square_root(a),
            Operation::CubeRoot => self.cube_root(a),
            Operation::Hypotenuse => self.hypotenuse(a, b),
            Operation::Exp => self.exponential(a),
            Operation::Sin => self.sine(a),
            Operation::Cos => self.cosine(a),
            Operation::Absolute => self.absolute(a),
            Operation::Minimum => self.extremum(a, b, Operation::Subtract),
            Operation::Maximum => self.extremum(a, b, Operation::Add),
            Operation::Sign => self.sign(a),
            Operation::Less | Operation::LessOrEqual => self.order(a, b),
            Operation::Equal => self.equality(a, b),
            Operation::Select => self.choice(a, b, c),
            _ => return None,
        })
    }

    /// How far numbers of a form are from its middle at most; `None` where it is one number.
    fn deviation(&mut self, form: Form) -> Option<NodeId> {
        let [a, b, c] = form.slopes.map(|slope| slope.map(|slope| self.magnitude_of(slope)));
        let first = self.0.sum(a, b);
        let second = self.0.sum(c, form.rest);
        self.0.sum(first, second)
    }

    /// What numbers of a form do not exceed.
    fn magnitude(&mut self, form: Form) -> NodeId {
        let middle = self.magnitude_of(form.middle);
        let deviation = self.deviation(form);
        self.0.sum(Some(middle), deviation).expect("one of them is there")
    }

    /// How far a form stays away from zero if that is positive, rounding considered.
    fn distance(&mut self, middle: NodeId, deviation: NodeId) -> NodeId {
        let middle = self.magnitude_of(middle);
        let rounding = self.scaled(ROUNDING, middle);
        let distance = self.of(Operation::Subtract, middle, deviation);
        self.of(Operation::Subtract, distance, rounding)
    }

    /// Adds a bound of all roundings to the rest of a form of this size.
    fn rounded(&mut self, rest: Option<NodeId>, size: NodeId) -> Option<NodeId> {
        let rounding = self.scaled(ROUNDING, size);
        self.0.sum(rest, Some(rounding))
    }
}

/// Operations on doubles.
impl Builder {
    fn of(&mut self, operation: Operation, a: NodeId, b: NodeId) -> NodeId {
        self.0.apply(operation, &[a, b])
    }

    fn times(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.of(Operation::Multiply, a, b)
    }

    fn scaled(&mut self, by: f64, a: NodeId) -> NodeId {
        let factor = self.0.literal(by);
        self.times(factor, a)
    }

    fn negated(&mut self, a: NodeId) -> NodeId {
        self.0.apply(Operation::Negate, &[a])
    }

    fn magnitude_of(&mut self, a: NodeId) -> NodeId {
        match self.0.node(a) {
            Node::Constant(constant) => self.0.literal(constant.value().abs()),
            _ => self.0.apply(Operation::Absolute, &[a]),
        }
    }

    /// a where the condition is 1, b where it is 0.
    fn either(&mut self, condition: NodeId, a: NodeId, b: NodeId) -> NodeId {
        self.0.apply(Operation::Select, &[condition, a, b])
    }

    /// 1 where it is positive, 0 where it is not.
    fn is_positive(&mut self, a: NodeId) -> NodeId {
        let zero = self.0.literal(0.0);
        self.of(Operation::Less, zero, a)
    }

    /// a where a condition is 1; else not a number, and so are all forms that are made of it.
    fn provided(&mut self, condition: NodeId, a: NodeId) -> NodeId {
        let undefined = self.0.literal(f64::NAN);
        self.either(condition, a, undefined)
    }
}
