//! Simplification: constants are folded and rules applied, in one pass from the operands up.
//!
//! A simplified program computes the same doubles as before on every input, to the last bit, infinities, signed zeros and
//! undefined values included, and means the same real function.

mod fold;
mod rules;

#[cfg(test)]
mod tests;

use super::{Node, NodeId, Program};
use crate::Operation;
pub(super) use fold::folded;

impl Program {
    /// A program that computes the same outputs, to the last bit on every input, in fewer or cheaper operations.
    pub fn simplified(&self) -> Self {
        let mut program = Self::new();
        program.outputs = program.import_with(self, |program, node| Simplifier { program }.add(node));
        program.pruned()
    }

    /// The same, with the values of some operations replaced by what `replace` makes of their first two operands.
    pub(super) fn simplified_with(
        &self,
        replace: impl Fn(&mut Simplifier<'_>, NodeId, [NodeId; 2]) -> Option<NodeId>,
    ) -> Self {
        let (mut program, mut ids) = (Self::new(), self.iter().map(|(id, _)| id));
        program.outputs = program.import_with(self, |program, node| {
            let id = ids.next().expect("there is a number for each node");
            let replaced = match node {
                Node::Apply(_, [a, b, _]) => replace(&mut Simplifier { program }, id, [a, b]),
                _ => None,
            };
            replaced.unwrap_or_else(|| Simplifier { program }.add(node))
        });
        program.pruned()
    }

    /// The product of two constants, as a constant where it is finite.
    pub(crate) fn product_of_constants(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match folded(self, Operation::Multiply, &[a, b]) {
            Some(product) => self.constant(product),
            None => self.apply(Operation::Multiply, &[a, b]),
        }
    }
}

/// Adds operations to a program all of whose operations are simplified.
pub(super) struct Simplifier<'a> {
    program: &'a mut Program,
}

impl Simplifier<'_> {
    /// The value of a node whose operands are simplified.
    fn add(&mut self, node: Node) -> NodeId {
        match node {
            Node::Apply(operation, operands) => self.apply(operation, &operands[..operation.arity()]),
            leaf => self.program.intern(leaf),
        }
    }

    /// The value of `operation` on `operands`: a constant, what a rule makes of it, or the operation itself.
    ///
    /// Rules call this again for what they build. That ends soon, whatever the program's size: every rule has fewer
    /// operations or signs on its right than on its left, or moves on towards an operation that no rule leads back from.
    pub(super) fn apply(&mut self, operation: Operation, operands: &[NodeId]) -> NodeId {
        if let Some(constant) = folded(self.program, operation, operands) {
            return self.program.constant(constant);
        }
        let mut ordered = [operands[0]; 3];
        ordered[..operands.len()].copy_from_slice(operands);
        if rules::is_commutative(operation) && self.comes_later(ordered[0], ordered[1]) {
            ordered.swap(0, 1);
        }
        let simpler = rules::of(operation).iter().find_map(|rule| (rule.apply)(self, ordered));
        simpler.unwrap_or_else(|| self.program.apply(operation, &ordered[..operands.len()]))
    }

    /// Whether `a` is to stand after `b` where their order does not matter: constants first, then by place.
    fn comes_later(&self, a: NodeId, b: NodeId) -> bool {
        let is_constant = |id| matches!(self.program.node(id), Node::Constant(_));
        (!is_constant(a), a) > (!is_constant(b), b)
    }
}
