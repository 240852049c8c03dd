//! Differentiation: the chain rule, applied node by node.

use super::{Argument, Axis, NodeId, Program};
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
        let Derivatives { mut program, values, gradients } = self.differentiated(along_axes);
        let gradient = gradients[0].map(|slope| slope.unwrap_or_else(|| program.literal(0.0)));
        program.outputs = values.into_iter().chain(gradient).collect();
        program.pruned()
    }

    /// The program that computes this one's only output F, then its derivative along a direction, whose components are three more
    /// arguments: what the gradient times the direction comes to, by fewer operations.
    ///
    /// # Panics
    /// When the program has not just one output.
    pub fn with_slope(&self) -> Self {
        assert_eq!(self.outputs.len(), 1, "one function is differentiated at a time");
        let directions = Axis::ALL.map(|axis| Node::Variable(Argument::of_direction(axis)));
        let Derivatives { mut program, values, gradients } =
            self.differentiated(|program, argument| [Some(program.intern(directions[argument.index()]))]);
        let [slope] = gradients[0].map(|slope| slope.unwrap_or_else(|| program.literal(0.0)));
        program.outputs = vec![values[0], slope];
        program.pruned()
    }

    /// The program that computes what this one does, F and its [gradient](Self::with_gradient), and then ∂²F/∂x², ∂²F/∂x∂y, ∂²F/∂x∂z,
    /// ∂²F/∂y², ∂²F/∂y∂z and ∂²F/∂z², each a derivative of the gradient.
    ///
    /// # Panics
    /// When the program has not just these four outputs.
    pub fn with_hessian(&self) -> Self {
        assert_eq!(self.outputs.len(), 4, "a function and its gradient are differentiated");
        let Derivatives { mut program, values, gradients } = self.differentiated(along_axes);
        let [_, [xx, xy, xz], [_, yy, yz], [.., zz]] = gradients[..] else {
            unreachable!("F and its gradient are four outputs")
        };
        let hessian = [xx, xy, xz, yy, yz, zz].map(|slope| slope.unwrap_or_else(|| program.literal(0.0)));
        program.outputs = values.into_iter().chain(hessian).collect();
        program.pruned()
    }

    /// A copy of this program with derivatives of its outputs. `of_argument` gives those of an argument of F.
    fn differentiated<const N: usize>(
        &self,
        of_argument: impl Fn(&mut Self, Argument) -> [Option<NodeId>; N],
    ) -> Derivatives<N> {
        let mut program = Self::draft_from(self);
        // For each node of this program, in the same order.
        let mut places: Vec<NodeId> = Vec::with_capacity(self.nodes.len());
        let mut gradients: Vec<[Option<NodeId>; N]> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let copy = node.with_operands(|operand| places[operand.index()]);
            let place = program.intern(copy);
            gradients.push(match (node, copy) {
                (Node::Constant(_), _) => [None; N],
                (Node::Variable(argument), _) => of_argument(&mut program, *argument),
                (Node::Apply(operation, originals), Node::Apply(_, operands)) => {
                    std::array::from_fn(|along| {
                        let derivatives = originals.map(|operand| gradients[operand.index()][along]);
                        let mut chain = Chain { program: &mut program, operands, derivatives, result: place };
                        derivatives.iter().any(Option::is_some).then(|| operation.derivative(&mut chain))?
                    })
                }
                (Node::Apply(..), _) => unreachable!("a copy applies the same operation"),
            });
            places.push(place);
        }
        Derivatives {
            values: self.outputs.iter().map(|output| places[output.index()]).collect(),
            gradients: self.outputs.iter().map(|output| gradients[output.index()]).collect(),
            program,
        }
    }
}

/// The derivatives of an argument along x, y and z.
fn along_axes(program: &mut Program, argument: Argument) -> [Option<NodeId>; 3] {
    let one = program.literal(1.0);
    Axis::ALL.map(|axis| (argument == axis.into()).then_some(one))
}

/// A program with nodes for the derivatives of what it computes, its outputs yet to be named.
struct Derivatives<const N: usize> {
    program: Program,
    /// What is differentiated.
    values: Vec<NodeId>,
    /// The derivatives of each, along as many directions; `None` where they are zero everywhere.
    gradients: Vec<[Option<NodeId>; N]>,
}
