//! Where a formula is written in a form that loses digits, though an equal form does not. Nothing is rewritten: what is
//! computed stays what was written.
//!
//! The forms are those of N. J. Higham, *Accuracy and Stability of Numerical Algorithms* (2nd edition, 2002), chapters 1 and 27.

use std::fmt;

use iso_expr::{Node, NodeId, Operation, Program};

/// A part of a formula, and how else it could be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Hint {
    /// The part as it is.
    pub(crate) written: String,
    /// An equal form that keeps more digits.
    pub(crate) instead: String,
    /// Where digits are lost.
    pub(crate) reason: &'static str,
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { written, instead, reason } = self;
        write!(f, "{written} may lose digits: {reason}; {instead} keeps them")
    }
}

/// The hints for a program as it was lowered, before it is simplified; inner parts first.
pub(crate) fn hints(program: &Program) -> Vec<Hint> {
    let parts = Parts(program);
    program.iter().filter_map(|(id, _)| parts.hint(id)).collect()
}

/// The largest depth to which a part is written out.
const DEPTH: usize = 6;

struct Parts<'a>(&'a Program);

impl Parts<'_> {
    fn hint(&self, id: NodeId) -> Option<Hint> {
        let (instead, reason) = self
            .exponential_less_one(id)
            .or_else(|| self.one_less_cosine(id))
            .or_else(|| self.logarithm_of_one_and(id))
            .or_else(|| self.root_of_squares(id))
            .or_else(|| self.difference_of_squares(id))
            .or_else(|| self.difference_of_roots(id))?;
        Some(Hint { written: self.text(id, DEPTH), instead, reason })
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
        let (one, cosine) = self.binary(id, Operation::Subtract)?;
        let angle = self.unary(cosine, Operation::Cos).filter(|_| self.is_one(one))?;
        Some((
            format!("2*sin({}/2)^2", self.operand(angle)),
            "where the angle is near 0, the difference cancels",
        ))
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
        let (a, b) = (self.operand(self.root_of(left)?), self.operand(self.root_of(right)?));
        Some((format!("({a} - {b})*({a} + {b})"), "squares are rounded before they cancel"))
    }

    fn difference_of_roots(&self, id: NodeId) -> Option<(String, &'static str)> {
        let (left, right) = self.binary(id, Operation::Subtract)?;
        let (a, b) = (self.unary(left, Operation::SquareRoot)?, self.unary(right, Operation::SquareRoot)?);
        let numerator = format!("({} - {})", self.operand(a), self.operand(b));
        let instead = format!("{numerator}/({} + {})", self.shown(left), self.shown(right));
        Some((instead, "roots are rounded before they cancel"))
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

    /// A part as it stands alone.
    fn shown(&self, id: NodeId) -> String {
        self.text(id, DEPTH)
    }

    /// A part as it stands in a larger one.
    fn operand(&self, id: NodeId) -> String {
        self.nested(id, DEPTH)
    }

    fn nested(&self, id: NodeId, depth: usize) -> String {
        let text = self.text(id, depth);
        let is_compound = matches!(self.0.node(id), Node::Apply(operation, _) if is_sign(operation));
        if is_compound && depth > 0 { format!("({text})") } else { text }
    }

    fn text(&self, id: NodeId, depth: usize) -> String {
        let node = self.0.node(id);
        let operation = match node {
            Node::Variable(axis) => return axis.name().to_owned(),
            Node::Constant(constant) => return constant.value().to_string(),
            Node::Apply(..) if depth == 0 => return "…".to_owned(),
            Node::Apply(operation, _) => operation,
        };
        match node.operands() {
            [a] if operation == Operation::Negate => format!("-{}", self.nested(*a, depth - 1)),
            [a, b] if is_sign(operation) => {
                let (a, b) = (self.nested(*a, depth - 1), self.nested(*b, depth - 1));
                match operation {
                    Operation::Add | Operation::Subtract => format!("{a} {} {b}", operation.name()),
                    _ => format!("{a}{}{b}", operation.name()),
                }
            }
            operands => {
                let operands: Vec<String> =
                    operands.iter().map(|&operand| self.text(operand, depth - 1)).collect();
                format!("{}({})", operation.name(), operands.join(", "))
            }
        }
    }
}

/// Whether it is written as a sign between or before its operands.
fn is_sign(operation: Operation) -> bool {
    !operation.name().starts_with(char::is_alphabetic)
}

#[cfg(test)]
mod tests {
    use iso_expr::Ast;

    use super::*;

    fn program(formula: &str) -> Program {
        Ast::parse(formula).unwrap().lower(&[]).unwrap().program().clone()
    }

    /// Forms with digits to lose, and what to write instead.
    const FORMS: [(&str, &str, &str); 9] = [
        ("exp(x*y) - 1", "exp(x*y) - 1", "expm1(x*y)"),
        ("z + (1 - exp(x))", "1 - exp(x)", "-expm1(x)"),
        ("1 - cos(x)", "1 - cos(x)", "2*sin(x/2)^2"),
        ("ln(1 + x*y)", "ln(1 + (x*y))", "log1p(x*y)"),
        ("ln(x + 1)", "ln(x + 1)", "log1p(x)"),
        ("ln(1 - x)", "ln(1 - x)", "log1p(-x)"),
        ("sqrt(x^2 + y*y) - 3", "sqrt((x^2) + (y*y))", "hypot(x, y)"),
        ("x^2 - (y + z)^2", "(x^2) - ((y + z)^2)", "(x - (y + z))*(x + (y + z))"),
        ("sqrt(x) - sqrt(y + 1)", "sqrt(x) - sqrt(y + 1)", "(x - (y + 1))/(sqrt(x) + sqrt(y + 1))"),
    ];

    #[test]
    fn forms_that_lose_digits_are_found() {
        for (formula, written, instead) in FORMS {
            let found = hints(&program(formula));
            let [hint] = &found[..] else { panic!("{formula}: {found:?}") };
            assert_eq!((hint.written.as_str(), hint.instead.as_str()), (written, instead), "{formula}");
        }
    }

    /// Both texts are in the language and compute the same, up to rounding.
    #[test]
    fn what_is_offered_is_equal() {
        use iso_expr::{Engine, Interpreter, Scratch};
        let value = |formula: &str| {
            let mut value = [0.0];
            let kernel = Interpreter.point(&program(formula)).unwrap();
            kernel.evaluate(&mut Scratch::default(), 0.4, 0.3, 0.2, &mut value);
            value[0]
        };
        for (_, written, instead) in FORMS {
            let (written, instead) = (value(written), value(instead));
            assert!((written - instead).abs() <= 1e-15 * (1.0 + written.abs()), "{written} {instead}");
        }
    }

    #[test]
    fn good_forms_are_left_alone() {
        for formula in
            ["expm1(x) - y", "exp(x) - 2", "log1p(x)", "hypot(x, y)", "x^2 + y^2 + z^2 - 1", "2 - cos(x)"]
        {
            assert_eq!(hints(&program(formula)), [], "{formula}");
        }
    }
}
