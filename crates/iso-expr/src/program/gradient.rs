//! Differentiation: the chain rule, applied node by node.

use super::{Axis, NodeId, Program};
use crate::Node;
use crate::operation::Chain;

impl Program {
    /// The program that computes this one's only output F, then ∂F/∂x, ∂F/∂y and ∂F/∂z.
    ///
    /// The derivatives are programs like any other, made of [`Operation::derivative`](crate::Operation::derivative) by the
    /// chain rule from the arguments to the output ('forward mode'). A derivative that is zero everywhere is the literal 0.
    ///
    /// # Panics
    /// When the program has not just one output.
    pub fn with_gradient(&self) -> Self {
        assert_eq!(self.outputs.len(), 1, "one function is differentiated at a time");
        let mut program = Self::new();
        // For each node of this program, in the same order.
        let mut places: Vec<NodeId> = Vec::with_capacity(self.nodes.len());
        let mut gradients: Vec<[Option<NodeId>; 3]> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let copy = node.with_operands(|operand| places[operand.index()]);
            let place = program.intern(copy);
            gradients.push(match (node, copy) {
                (Node::Constant(_), _) => [None; 3],
                (Node::Variable(along), _) => {
                    let one = program.literal(1.0);
                    Axis::ALL.map(|axis| (axis == *along).then_some(one))
                }
                (Node::Apply(operation, originals), Node::Apply(_, operands)) => Axis::ALL.map(|axis| {
                    let derivatives = originals.map(|operand| gradients[operand.index()][axis as usize]);
                    let mut chain = Chain { program: &mut program, operands, derivatives, result: place };
                    derivatives.iter().any(Option::is_some).then(|| operation.derivative(&mut chain))?
                }),
                (Node::Apply(..), _) => unreachable!("a copy applies the same operation"),
            });
            places.push(place);
        }
        let value = self.outputs[0].index();
        let gradient = gradients[value].map(|slope| slope.unwrap_or_else(|| program.literal(0.0)));
        program.outputs = std::iter::once(places[value]).chain(gradient).collect();
        program.pruned()
    }
}
