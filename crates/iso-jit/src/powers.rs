//! Integer powers written out as products.

use iso_expr::{Node, NodeId, Operation, Program};

/// The same program with every integer power as products, in the order that defines its value. Powers of one base share
/// their squares.
pub(crate) fn expanded(program: &Program) -> Program {
    let mut expanded = Program::new();
    let mut places: Vec<NodeId> = Vec::with_capacity(program.nodes().len());
    for node in program.nodes() {
        let place = |id: &NodeId| places[id.index()];
        let id = match node {
            Node::Variable(axis) => expanded.variable(*axis),
            Node::Constant(constant) => expanded.constant(*constant),
            Node::Apply(Operation::IntegerPower, [base, exponent, _]) => {
                let Node::Constant(exponent) = program.node(*exponent) else {
                    unreachable!("the exponent of an integer power is a constant")
                };
                power(&mut expanded, place(base), exponent.value() as u32)
            }
            Node::Apply(operation, _) => {
                let operands: Vec<_> = node.operands().iter().map(place).collect();
                expanded.apply(*operation, &operands)
            }
        };
        places.push(id);
    }
    expanded.set_outputs(program.outputs().iter().map(|id| places[id.index()]).collect());
    expanded
}

/// By squaring from the exponent's lowest bit up.
fn power(program: &mut Program, base: NodeId, mut exponent: u32) -> NodeId {
    let (mut square, mut product) = (base, None);
    loop {
        if exponent & 1 == 1 {
            product = Some(
                product.map_or(square, |product| program.apply(Operation::Multiply, &[product, square])),
            );
        }
        exponent >>= 1;
        if exponent == 0 {
            return product.unwrap_or_else(|| program.literal(1.0));
        }
        square = program.apply(Operation::Multiply, &[square, square]);
    }
}
