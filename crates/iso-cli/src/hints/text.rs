//! Parts of a formula as text in the language of formulas, the deepest parts left out.

use iso_expr::{Constant, Node, NodeId, Operation};

use super::Parts;

/// The largest depth to which a part is written out.
const DEPTH: usize = 6;

impl Parts<'_> {
    /// A part as it stands alone.
    pub(super) fn shown(&self, id: NodeId) -> String {
        self.text(id, DEPTH)
    }

    /// A part as it stands in a larger one.
    pub(super) fn operand(&self, id: NodeId) -> String {
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
            Node::Variable(argument) => return argument.to_string(),
            Node::Constant(constant) => return name(constant),
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

/// A constant as the language reads it.
fn name(constant: Constant) -> String {
    let named = [(Constant::PI, "pi"), (Constant::TAU, "tau"), (Constant::E, "e")];
    let name = named.into_iter().find(|(value, _)| *value == constant);
    name.map_or_else(|| constant.value().to_string(), |(_, name)| name.to_owned())
}

/// Whether it is written as a sign between or before its operands.
fn is_sign(operation: Operation) -> bool {
    !operation.name().starts_with(char::is_alphabetic)
}
