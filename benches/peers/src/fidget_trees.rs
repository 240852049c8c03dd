//! Programs of this project as fidget's graphs.

use std::error::Error;

use fidget::Context;
use fidget::context::Node as FidgetNode;
use iso_expr::{Node, Operation, Program};

/// The same formula in fidget, operation by operation, its constants rounded to `f32`. fidget makes squares of products of
/// a node with itself.
///
/// # Errors
/// When fidget lacks an operation.
pub fn fidget_graph(program: &Program) -> Result<(Context, FidgetNode), Box<dyn Error>> {
    let program = program.with_powers_expanded();
    let mut context = Context::new();
    let mut places: Vec<FidgetNode> = Vec::with_capacity(program.nodes().len());
    for node in program.nodes() {
        let operands: Vec<_> = node.operands().iter().map(|operand| places[operand.index()]).collect();
        places.push(match node {
            Node::Variable(argument) => [context.x(), context.y(), context.z()][argument.index()],
            Node::Constant(constant) => context.constant(constant.value() as f32),
            Node::Apply(operation, _) => apply(&mut context, *operation, &operands)?,
        });
    }
    Ok((context, places[program.outputs()[0].index()]))
}

fn apply(
    context: &mut Context,
    operation: Operation,
    operands: &[FidgetNode],
) -> Result<FidgetNode, Box<dyn Error>> {
    let node = match (operation, operands) {
        (Operation::Add, &[a, b]) => context.add(a, b),
        (Operation::Subtract, &[a, b]) => context.sub(a, b),
        (Operation::Multiply, &[a, b]) => context.mul(a, b),
        (Operation::Divide, &[a, b]) => context.div(a, b),
        (Operation::Minimum, &[a, b]) => context.min(a, b),
        (Operation::Maximum, &[a, b]) => context.max(a, b),
        (Operation::Atan2, &[a, b]) => context.atan2(a, b),
        (Operation::Negate, &[a]) => context.neg(a),
        (Operation::Absolute, &[a]) => context.abs(a),
        (Operation::SquareRoot, &[a]) => context.sqrt(a),
        (Operation::Exp, &[a]) => context.exp(a),
        (Operation::Ln, &[a]) => context.ln(a),
        (Operation::Sin, &[a]) => context.sin(a),
        (Operation::Cos, &[a]) => context.cos(a),
        (Operation::Tan, &[a]) => context.tan(a),
        (Operation::Asin, &[a]) => context.asin(a),
        (Operation::Acos, &[a]) => context.acos(a),
        (Operation::Atan, &[a]) => context.atan(a),
        (Operation::Floor, &[a]) => context.floor(a),
        (Operation::Ceil, &[a]) => context.ceil(a),
        _ => return Err(format!("fidget has no operation like {}", operation.name()).into()),
    };
    Ok(node?)
}
