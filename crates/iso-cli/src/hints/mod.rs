//! Where a formula is written in a form that loses digits, though an equal form does not. Nothing is rewritten: what is
//! computed stays what was written.
//!
//! The forms are those of N. J. Higham, *Accuracy and Stability of Numerical Algorithms* (2nd edition, 2002), chapters 1, 5 and 27.

mod polynomial;
mod text;

#[cfg(test)]
mod tests;

use std::fmt;

use iso_expr::{Node, NodeId, Operation, Program};

/// A part of a formula, and how else it could be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Hint {
    /// The part as it is.
    pub(crate) written: String,
    /// An equal form that keeps more digits.
    pub(crate) instead: String,
    /// Where the forms are not equal.
    pub(crate) unless: Option<String>,
    /// Where digits are lost.
    pub(crate) reason: &'static str,
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { written, instead, unless, reason } = self;
        write!(f, "{written} may lose digits: {reason}; {instead} keeps more of them")?;
        match unless {
            Some(exception) => write!(f, ", but is another function where {exception}"),
            None => Ok(()),
        }
    }
}

/// The hints for a program as it was lowered, before it is simplified; inner parts first.
pub(crate) fn hints(program: &Program) -> Vec<Hint> {
    let parts = Parts(program);
    let mut hints: Vec<(NodeId, Hint)> =
        program.iter().filter_map(|(id, _)| Some((id, parts.hint(id)?))).collect();
    hints.extend(polynomial::hints(&parts));
    hints.sort_by_key(|(id, _)| id.index());
    hints.into_iter().map(|(_, hint)| hint).collect()
}

/// The parts of a formula.
struct Parts<'a>(&'a Program);

impl Parts<'_> {
    /// What is to be said of the part at `id` alone.
    fn hint(&self, id: NodeId) -> Option<Hint> {
        let (instead, reason) = self
            .exponential_less_one(id)
            .or_else(|| self.one_less_cosine(id))
            .or_else(|| self.logarithm_of_one_and(id))
            .or_else(|| self.root_of_squares(id))
            .or_else(|| self.difference_of_squares(id))
            .or_else(|| self.difference_of_roots(id))?;
        Some(Hint { written: self.shown(id), instead, unless: self.both_roots_vanish(id), reason })
    }

    fn exponential_less_one(&self, id: NodeId) -> Option<(String, &'static str)> {
        let reason = "where the exponent is near 0, the difference cancels";
        let (left, right) = self.binary(id, Operation::Subtract)?;
        match (self.unary(left, Operation::Exp), self.unary(right, Operation::Exp)) {
            (Some(exponent), _) if self.is_one(right) => {
                Some((format!("expm1({})", self.shown(exponent)), reason))
            }
            (_, Some(exponent)) if self.is_one(left) => {
                Some((format!("-expm1({})", self.shown(exponent)), reason))
            }
            _ => None,
        }
    }

    fn one_less_cosine(&self, id: NodeId) -> Option<(String, &'static str)> {
        let reason = "where the angle is near 0, the difference cancels";
        let (left, right) = self.binary(id, Operation::Subtract)?;
        match (self.unary(left, Operation::Cos), self.unary(right, Operation::Cos)) {
            (Some(angle), _) if self.is_one(right) => {
                Some((format!("-2*sin({}/2)^2", self.operand(angle)), reason))
            }
            (_, Some(angle)) if self.is_one(left) => {
                Some((format!("2*sin({}/2)^2", self.operand(angle)), reason))
            }
            _ => None,
        }
    }

    fn logarithm_of_one_and(&self, id: NodeId) -> Option<(String, &'static str)> {
        let argument = self.unary(id, Operation::Ln)?;
        let instead =
            match (self.binary(argument, Operation::Add), self.binary(argument, Operation::Subtract)) {
                (Some((one, rest)), _) | (Some((rest, one)), _) if self.is_one(one) => {
                    format!("log1p({})", self.shown(rest))
                }
                (_, Some((one, rest))) if self.is_one(one) => format!("log1p(-{})", self.operand(rest)),
                _ => return None,
            };
        Some((instead, "where the logarithm is near 0, its argument is rounded to a number near 1"))
    }

    fn root_of_squares(&self, id: NodeId) -> Option<(String, &'static str)> {
        let (left, right) = self.binary(self.unary(id, Operation::SquareRoot)?, Operation::Add)?;
        let (a, b) = (self.root_of(left)?, self.root_of(right)?);
        let instead = format!("hypot({}, {})", self.shown(a), self.shown(b));
        Some((instead, "squares overflow above 1e154 and vanish below 1e-162"))
    }

    fn difference_of_squares(&self, id: NodeId) -> Option<(String, &'static str)> {
        let (left, right) = self.binary(id, Operation::Subtract)?;
        let (a, b) = match (self.root_of(left), self.root_of(right)) {
            (Some(a), Some(b)) => (self.operand(a), self.operand(b)),
            (Some(a), None) => (self.operand(a), self.root_of_constant(right)?.to_string()),
            (None, Some(b)) => (self.root_of_constant(left)?.to_string(), self.operand(b)),
            (None, None) => return None,
        };
        Some((format!("({a} - {b})*({a} + {b})"), "squares are rounded before they cancel"))
    }

    fn difference_of_roots(&self, id: NodeId) -> Option<(String, &'static str)> {
        let (a, b) = self.radicands(id)?;
        let (left, right) = self.binary(id, Operation::Subtract)?;
        let numerator = format!("({} - {})", self.operand(a), self.operand(b));
        let instead = format!("{numerator}/({} + {})", self.shown(left), self.shown(right));
        Some((instead, "roots are rounded before they cancel"))
    }

    /// Where a difference of roots is 0 − 0, and its other form 0/0.
    fn both_roots_vanish(&self, id: NodeId) -> Option<String> {
        let (a, b) = self.radicands(id)?;
        Some(format!("{} and {} are 0", self.operand(a), self.operand(b)))
    }

    /// What a difference of two roots takes the roots of.
    fn radicands(&self, id: NodeId) -> Option<(NodeId, NodeId)> {
        let (left, right) = self.binary(id, Operation::Subtract)?;
        Some((self.unary(left, Operation::SquareRoot)?, self.unary(right, Operation::SquareRoot)?))
    }

    /// What the node at `id` is the square of.
    fn root_of(&self, id: NodeId) -> Option<NodeId> {
        match self.0.node(id) {
            Node::Apply(Operation::IntegerPower, [base, exponent, _])
                if self.value(exponent) == Some(2.0) =>
            {
                Some(base)
            }
            Node::Apply(Operation::Multiply, [left, right, _]) if left == right => Some(left),
            _ => None,
        }
    }

    /// The root of a constant that is the square of a short number.
    fn root_of_constant(&self, id: NodeId) -> Option<f64> {
        /// Numbers with so few bits have squares that are doubles.
        const SHORT: f64 = 1e6;
        let square = self.value(id).filter(|square| *square > 0.0)?;
        let root = square.sqrt();
        let is_short = root <= SHORT && (root * 64.0).fract() == 0.0;
        (is_short && root * root == square).then_some(root)
    }

    fn unary(&self, id: NodeId, wanted: Operation) -> Option<NodeId> {
        match self.0.node(id) {
            Node::Apply(operation, [operand, ..]) if operation == wanted => Some(operand),
            _ => None,
        }
    }

    fn binary(&self, id: NodeId, wanted: Operation) -> Option<(NodeId, NodeId)> {
        match self.0.node(id) {
            Node::Apply(operation, [left, right, _]) if operation == wanted => Some((left, right)),
            _ => None,
        }
    }

    fn value(&self, id: NodeId) -> Option<f64> {
        match self.0.node(id) {
            Node::Constant(constant) => Some(constant.value()),
            _ => None,
        }
    }

    fn is_one(&self, id: NodeId) -> bool {
        self.value(id) == Some(1.0)
    }
}
