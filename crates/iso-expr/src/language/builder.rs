//! A program under construction, with what the language knows of its nodes.

use super::error::{FormulaError, FormulaErrorKind};
use super::limits;
use crate::{Axis, Constant, Node, NodeId, Operation, Program};

/// 2⁵³: an integer nearer to zero is a double, and no other one is rounded to it. 2⁵³ + 1 is rounded to this.
const BEYOND_INTEGERS: f64 = 9_007_199_254_740_992.0;

/// What is known of a node without evaluating the program.
#[derive(Clone, Copy, Debug, Default)]
struct Known {
    /// The value in doubles, where no coordinate counts.
    value: Option<f64>,
    /// The value as a real number, where that is an integer which doubles hold exactly.
    integer: Option<f64>,
    /// Whether it is the truth of a condition: 0, 1 or undefined.
    is_truth: bool,
}

/// Builds a program within the limit of operations.
#[derive(Debug, Default)]
pub(super) struct Builder {
    program: Program,
    /// For each node of the program, in order.
    known: Vec<Known>,
    operations: usize,
}

impl Builder {
    pub(super) fn variable(&mut self, axis: Axis) -> NodeId {
        let node = self.program.variable(axis);
        self.note(node, Known::default)
    }

    pub(super) fn constant(&mut self, constant: Constant) -> NodeId {
        let node = self.program.constant(constant);
        let value = constant.value();
        let integer = (constant.is_exact() && is_integer(value)).then_some(value);
        self.note(node, || Known { value: Some(value), integer, is_truth: false })
    }

    pub(super) fn literal(&mut self, value: f64) -> NodeId {
        self.constant(Constant::exact(value))
    }

    pub(super) fn apply(
        &mut self,
        operation: Operation,
        operands: &[NodeId],
    ) -> Result<NodeId, FormulaError> {
        let known = self.known_of(operation, operands);
        let before = self.program.nodes().len();
        let node = self.program.apply(operation, operands);
        if self.program.nodes().len() > before {
            self.operations += 1;
            let (given, allowed) = (self.operations, limits::MOST_OPERATIONS);
            if given > allowed {
                return Err(FormulaError::new(FormulaErrorKind::TooManyOperations { given, allowed }, 0..0));
            }
        }
        Ok(self.note(node, || known))
    }

    /// `base` to the power `exponent`, by the first rule that fits:
    /// an integer exponent multiplies, e to a power is the exponential function, and any other power is the general one.
    pub(super) fn power(&mut self, base: NodeId, exponent: NodeId) -> Result<NodeId, FormulaError> {
        match self.known[exponent.index()].integer {
            Some(integer) if integer < 0.0 => {
                let (one, power) = (self.literal(1.0), self.positive_power(base, -integer)?);
                self.apply(Operation::Divide, &[one, power])
            }
            Some(integer) => self.positive_power(base, integer),
            None if self.program.node(base) == Node::Constant(Constant::E) => {
                self.apply(Operation::Exp, &[exponent])
            }
            None => self.apply(Operation::Power, &[base, exponent]),
        }
    }

    /// `base` to an integer power that is not negative. One beyond the largest of the table is made of several:
    /// xⁿ = (x¹⁰²⁴)^⌊n/1024⌋ · x^(n mod 1024).
    fn positive_power(&mut self, base: NodeId, exponent: f64) -> Result<NodeId, FormulaError> {
        let largest = f64::from(Operation::LARGEST_POWER);
        let (mut square, mut remaining, mut product) = (base, exponent, None);
        while remaining > largest {
            let low = self.small_power(square, remaining % largest)?;
            product = self.product(product, low)?;
            square = self.small_power(square, largest)?.unwrap_or(square);
            remaining = (remaining / largest).floor();
        }
        let high = self.small_power(square, remaining)?;
        Ok(self.product(product, high)?.unwrap_or_else(|| self.literal(1.0)))
    }

    /// `base` to a power of the table; none for the power zero, which is no factor.
    fn small_power(&mut self, base: NodeId, exponent: f64) -> Result<Option<NodeId>, FormulaError> {
        if exponent < 2.0 {
            return Ok((exponent == 1.0).then_some(base));
        }
        let exponent = self.literal(exponent);
        self.apply(Operation::IntegerPower, &[base, exponent]).map(Some)
    }

    fn product(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Result<Option<NodeId>, FormulaError> {
        match (a, b) {
            (Some(a), Some(b)) => self.apply(Operation::Multiply, &[b, a]).map(Some),
            (one, other) => Ok(one.or(other)),
        }
    }

    /// The truth of a node: itself if it is one, else whether it differs from zero.
    pub(super) fn truth(&mut self, node: NodeId) -> Result<NodeId, FormulaError> {
        if self.known[node.index()].is_truth {
            return Ok(node);
        }
        let zero = self.literal(0.0);
        let is_zero = self.apply(Operation::Equal, &[node, zero])?;
        self.not(is_zero)
    }

    /// The opposite of a truth.
    pub(super) fn not(&mut self, truth: NodeId) -> Result<NodeId, FormulaError> {
        let one = self.literal(1.0);
        let node = self.apply(Operation::Subtract, &[one, truth])?;
        Ok(self.as_truth(node))
    }

    /// Whether both truths hold.
    pub(super) fn and(&mut self, a: NodeId, b: NodeId) -> Result<NodeId, FormulaError> {
        let node = self.apply(Operation::Multiply, &[a, b])?;
        Ok(self.as_truth(node))
    }

    /// Whether one of two truths holds.
    pub(super) fn or(&mut self, a: NodeId, b: NodeId) -> Result<NodeId, FormulaError> {
        let node = self.apply(Operation::Maximum, &[a, b])?;
        Ok(self.as_truth(node))
    }

    /// The value of a node in doubles, where no coordinate counts.
    pub(super) fn value(&self, node: NodeId) -> Option<f64> {
        self.known[node.index()].value
    }

    /// The program whose one output is `output`, without what that does not need.
    pub(super) fn finish(mut self, output: NodeId) -> Program {
        self.program.set_outputs(vec![output]);
        self.program.pruned()
    }

    fn as_truth(&mut self, node: NodeId) -> NodeId {
        self.known[node.index()].is_truth = true;
        node
    }

    fn note(&mut self, node: NodeId, known: impl FnOnce() -> Known) -> NodeId {
        if node.index() == self.known.len() {
            self.known.push(known());
        }
        node
    }

    fn known_of(&self, operation: Operation, operands: &[NodeId]) -> Known {
        let known = |place: usize| self.known[operands[place].index()];
        let value = apply_known(operation, operands, |place| known(place).value);
        let integer = apply_known(operation, operands, |place| known(place).integer);
        let is_exact = match operation {
            Operation::Divide => {
                let divided = (known(0).integer).zip(known(1).integer);
                divided.is_some_and(|(dividend, divisor)| dividend % divisor == 0.0)
            }
            _ => keeps_integers(operation),
        };
        let integer = integer.filter(|value| is_exact && is_integer(*value));
        let is_truth = matches!(operation, Operation::Less | Operation::LessOrEqual | Operation::Equal);
        Known { value, integer, is_truth }
    }
}

/// The value of an operation, if those of all its operands are known.
fn apply_known(
    operation: Operation,
    operands: &[NodeId],
    known: impl Fn(usize) -> Option<f64>,
) -> Option<f64> {
    debug_assert_eq!(operands.len(), operation.arity());
    let mut values = [0.0; 3];
    for (place, value) in values.iter_mut().take(operands.len()).enumerate() {
        *value = known(place)?;
    }
    Some(operation.value().of(values))
}

/// Whether an operation on integers is exact in doubles wherever its result is an integer again.
fn keeps_integers(operation: Operation) -> bool {
    use Operation::*;
    matches!(
        operation,
        Add | Subtract
            | Multiply
            | Negate
            | Absolute
            | Sign
            | Minimum
            | Maximum
            | IntegerPower
            | Floor
            | Ceil
            | Round
            | Truncate
            | Modulo
            | Less
            | LessOrEqual
            | Equal
            | Select
    )
}

fn is_integer(value: f64) -> bool {
    value.trunc() == value && value.abs() < BEYOND_INTEGERS
}
