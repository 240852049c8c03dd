//! How far rounding moves the value of a program: a bound that is a program itself.

use super::{NodeId, Program};
use crate::operation::Chain;
use crate::{Node, Operation};

impl Program {
    /// The unit in which [`Program::with_rounding`] counts: half the distance of neighbouring doubles from 1 on, 2⁻⁵³.
    pub const ROUNDING_UNIT: f64 = 0.5 * f64::EPSILON;

    /// By how much [`Program::with_rounding`] may be too low, since roundings have roundings themselves: 1 + 2⁻⁴⁰.
    pub const ROUNDING_SLACK: f64 = 1.0 + 1.0 / (1_u64 << 40) as f64;

    /// The program that computes this one's only output F, then a bound of how far F is from its exact value when it is computed
    /// in doubles, in [units](Self::ROUNDING_UNIT) of rounding, and then ∂F/∂x, ∂F/∂y and ∂F/∂z.
    ///
    /// It is meant for boxes. Over a box on which F is continuous and bounded, its operations included
    /// ([`Decoration::Common`](crate::Decoration::Common)), and the other outputs are defined, what any engine computes for F at a
    /// point of the box is no farther from F at that point than the upper end of the second output, times the unit and
    /// the [slack](Self::ROUNDING_SLACK).
    ///
    /// The bound is ∑ |∂F/∂v|·|v| over all rounded operations with result v. To see that it holds, let the operations be rounded
    /// one after the other, all later ones being exact: each changes F by the rounding of its result, at most half an ulp,
    /// times a derivative at values which the enclosures hold, as they are rounded outwards.
    /// The derivatives by all results come from one pass from F to the arguments ('reverse mode'; so Bauer, Computational
    /// graphs and rounding error, SIAM Journal on Numerical Analysis 11, 1974).
    ///
    /// # Panics
    /// When the program has not just one output.
    pub fn with_rounding(&self) -> Self {
        assert_eq!(self.outputs.len(), 1, "the rounding of one function is bounded at a time");
        let mut program = Self::draft_from(self);
        let mut places: Vec<NodeId> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let copy = node.with_operands(|operand| places[operand.index()]);
            places.push(program.intern(copy));
        }
        // The derivative of F by each node, as far as the later ones contribute.
        let mut slopes: Vec<Option<NodeId>> = vec![None; self.nodes.len()];
        slopes[self.outputs[0].index()] = Some(program.literal(1.0));
        let mut gradient = [None; 3];
        let mut bound = None;
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let Some(slope) = slopes[index] else { continue };
            if let Some(rounding) = program.rounding(node, places[index]) {
                let term = match (node, program.node(slope)) {
                    (Node::Apply(..), Node::Apply(Operation::Divide, [numerator, sum, _]))
                        if program.is_part_of_exponentials(places[index], sum) =>
                    {
                        program.rounding_in_sum(numerator, sum)
                    }
                    _ => {
                        let slope = program.apply(Operation::Absolute, &[slope]);
                        program.apply(Operation::Multiply, &[slope, rounding])
                    }
                };
                bound = program.sum(bound, Some(term));
            }
            match *node {
                Node::Constant(_) => {}
                Node::Variable(argument) => gradient[argument.index()] = Some(slope),
                Node::Apply(operation, originals) => {
                    let operands = originals.map(|operand| places[operand.index()]);
                    for (number, original) in originals.into_iter().enumerate().take(operation.arity()) {
                        let mut derivatives = [None; 3];
                        derivatives[number] = Some(slope);
                        let mut chain =
                            Chain { program: &mut program, operands, derivatives, result: places[index] };
                        let through_this = operation.derivative(&mut chain);
                        let so_far = slopes[original.index()];
                        slopes[original.index()] = program.sum(so_far, through_this);
                    }
                }
            }
        }
        let value = places[self.outputs[0].index()];
        let rest = [bound, gradient[0], gradient[1], gradient[2]];
        let rest = rest.map(|output| output.unwrap_or_else(|| program.literal(0.0)));
        program.outputs = std::iter::once(value).chain(rest).collect();
        program.pruned()
    }

    /// How far the double of a node may be from the node's exact value for its operands' doubles, in units of rounding; `None`
    /// where it is that value.
    fn rounding(&mut self, node: &Node, place: NodeId) -> Option<NodeId> {
        let operation = match *node {
            Node::Constant(constant) if constant.is_exact() => return None,
            Node::Constant(constant) => {
                return Some(self.literal(constant.enclosure().width() / Self::ROUNDING_UNIT));
            }
            Node::Variable(_) => return None,
            Node::Apply(operation, _) => operation,
        };
        let size = self.apply(Operation::Absolute, &[place]);
        match operation {
            Operation::Negate
            | Operation::Absolute
            | Operation::Sign
            | Operation::Minimum
            | Operation::Maximum
            | Operation::Floor
            | Operation::Ceil
            | Operation::Round
            | Operation::Truncate
            | Operation::Less
            | Operation::LessOrEqual
            | Operation::Equal
            | Operation::Select => None,
            // Sums are exact where they underflow.
            Operation::Add | Operation::Subtract => Some(size),
            Operation::IntegerPower => {
                let Node::Apply(_, [_, exponent, _]) = self.node(place) else {
                    unreachable!("a copy applies the same operation")
                };
                let exponent =
                    self.exponent(exponent).expect("programs check the exponents of integer powers");
                let roundings = self.literal(f64::from(exponent - 1));
                let size = self.not_underflowing(size);
                Some(self.apply(Operation::Multiply, &[roundings, size]))
            }
            _ => Some(self.not_underflowing(size)),
        }
    }

    /// The same of an operation whose result is a part of `sum`, which has positive terms, times |numerator / sum|, a slope: the part is no
    /// larger than the sum, which a quotient of enclosures does not show, and of sums of exponentials over large boxes far from it.
    fn rounding_in_sum(&mut self, numerator: NodeId, sum: NodeId) -> NodeId {
        let [one, least] = [1.0, f64::MIN_POSITIVE].map(|value| self.literal(value));
        let below = self.apply(Operation::Divide, &[least, sum]);
        let part = self.apply(Operation::Maximum, &[one, below]);
        let numerator = self.apply(Operation::Absolute, &[numerator]);
        self.apply(Operation::Multiply, &[numerator, part])
    }

    /// Rounding below the least normal number is no finer than there.
    fn not_underflowing(&mut self, size: NodeId) -> NodeId {
        let least = self.literal(f64::MIN_POSITIVE);
        self.apply(Operation::Maximum, &[size, least])
    }
}

#[cfg(test)]
pub(super) mod tests;
