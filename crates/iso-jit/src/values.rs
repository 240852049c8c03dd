//! Values of operations, written as instructions: bit for bit what [`Operation::value`] gives.

use std::collections::HashMap;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{InstBuilder, Value};
use cranelift_codegen::packed_option::ReservedValue;
use iso_expr::{Argument, Node, NodeId, Operation, Program};

use crate::elementary;
use crate::lanes::Writer;
use crate::symbols::Calls;
use crate::together::Order;

/// Whether an operation's value is written out by [`apply`]; the others are left to functions.
pub(crate) fn is_written_out(operation: Operation) -> bool {
    use Operation as O;
    matches!(
        operation,
        O::Add | O::Subtract | O::Multiply | O::Divide | O::Negate | O::Absolute | O::SquareRoot
    ) || matches!(operation, O::Minimum | O::Maximum | O::Sign)
        || matches!(operation, O::Less | O::LessOrEqual | O::Equal | O::Select)
        || is_rounding(operation)
}

/// Whether the operation rounds to an integer, which not every machine does by itself.
fn is_rounding(operation: Operation) -> bool {
    use Operation as O;
    matches!(operation, O::Floor | O::Ceil | O::Round | O::Truncate)
}

/// What functions of many numbers are taken of where there are fewer: none of their values takes long.
const UNUSED: f64 = 2.0;

/// Writes `count` evaluations of `program` side by side, so that the processor works on all of them at once; where these leave
/// lanes of a function empty, it takes several operations in one call. `argument` gives an argument of each when it is first
/// needed. Gives the outputs of each.
pub(crate) fn evaluate(
    writer: &mut Writer<'_, '_>,
    calls: &mut Calls<'_>,
    program: &Program,
    count: usize,
    mut argument: impl FnMut(&mut Writer<'_, '_>, Argument) -> Vec<Value>,
) -> Vec<Vec<Value>> {
    let of_evaluation = vec![Value::reserved_value(); program.nodes().len()];
    let mut values: Vec<Vec<Value>> = vec![of_evaluation; count];
    // How many operands a function takes at once, and of how many operations that is.
    let taken_at_once = elementary::WIDTH / writer.lanes.count();
    let in_a_call = taken_at_once / count;
    let waves = if in_a_call == 1 { waves(program) } else { HashMap::new() };
    // The sines and cosines of what both are taken of, from when one is needed on.
    let mut both = HashMap::new();
    for step in Order::in_calls(program, in_a_call).steps() {
        let of = |operand: NodeId| values.iter().map(move |values| values[operand.index()]);
        let results: Vec<Value> = match program.node(step[0]) {
            Node::Variable(number) => argument(writer, number),
            Node::Constant(constant) => vec![writer.constant(constant.value()); count],
            Node::Apply(operation @ (Operation::Sin | Operation::Cos), [operand, ..])
                if waves.get(&operand) == Some(&[true; 2])
                    && let Some(function) = calls.both_in_lanes(writer.builder.func) =>
            {
                let results: &Vec<Value> = both.entry(operand).or_insert_with(|| {
                    let operands: Vec<_> = of(operand).collect();
                    writer.call_in_place(function, &operands, 2 * count)
                });
                let (sines, cosines) = results.split_at(count);
                if operation == Operation::Sin { sines.to_vec() } else { cosines.to_vec() }
            }
            Node::Apply(operation, operands) => match calls.in_lanes(writer.builder.func, operation) {
                Some(function) => {
                    let operands = step.iter().flat_map(|id| of(program.node(*id).operands()[0]));
                    let mut operands: Vec<_> = operands.collect();
                    let taken = operands.len();
                    operands.resize(taken_at_once, writer.constant(UNUSED));
                    writer.call_in_place(function, &operands, taken)
                }
                None => {
                    let [a, b, c] = operands.map(of);
                    let operands = a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]);
                    operands.map(|operands| apply(writer, calls, operation, operands)).collect()
                }
            },
        };
        for (id, results) in step.iter().zip(results.chunks(count)) {
            values.iter_mut().zip(results).for_each(|(values, result)| values[id.index()] = *result);
        }
    }
    let outputs = |values: Vec<Value>| program.outputs().iter().map(|id| values[id.index()]).collect();
    values.into_iter().map(outputs).collect()
}

/// Whether sines and cosines are taken of the nodes that one of them is taken of.
fn waves(program: &Program) -> HashMap<NodeId, [bool; 2]> {
    let mut waves: HashMap<NodeId, [bool; 2]> = HashMap::new();
    for node in program.nodes() {
        if let Node::Apply(operation @ (Operation::Sin | Operation::Cos), [operand, ..]) = node {
            waves.entry(*operand).or_default()[usize::from(*operation == Operation::Cos)] = true;
        }
    }
    waves
}

/// Writes one operation. Only as many operands as its arity count.
pub(crate) fn apply(
    writer: &mut Writer<'_, '_>,
    calls: &mut Calls<'_>,
    operation: Operation,
    operands: [Value; 3],
) -> Value {
    use Operation as O;
    if !is_written_out(operation) || is_rounding(operation) && !calls.rounds_natively {
        let function = calls.value(writer.builder.func, operation);
        return writer.call(function, &operands[..operation.arity()]);
    }
    let [a, b, c] = operands;
    match operation {
        O::Add => writer.builder.ins().fadd(a, b),
        O::Subtract => writer.builder.ins().fsub(a, b),
        O::Multiply => writer.builder.ins().fmul(a, b),
        O::Divide => writer.builder.ins().fdiv(a, b),
        O::Negate => writer.builder.ins().fneg(a),
        O::Absolute => writer.builder.ins().fabs(a),
        O::SquareRoot => writer.builder.ins().sqrt(a),
        O::Floor => writer.builder.ins().floor(a),
        O::Ceil => writer.builder.ins().ceil(a),
        O::Round => writer.builder.ins().nearest(a),
        O::Truncate => writer.builder.ins().trunc(a),
        O::Sign => sign(writer, a),
        O::Minimum => extremum(writer, a, [a, b], b),
        O::Maximum => extremum(writer, a, [b, a], b),
        O::Less => truth(writer, FloatCC::LessThan, a, b),
        O::LessOrEqual => truth(writer, FloatCC::LessThanOrEqual, a, b),
        O::Equal => truth(writer, FloatCC::Equal, a, b),
        O::Select => select(writer, a, b, c),
        called => unreachable!("{called:?} is called"),
    }
}

/// a where it is positive or negative no more: 1, −1, or a itself when it is zero or NaN.
fn sign(writer: &mut Writer<'_, '_>, a: Value) -> Value {
    let [zero, one, minus_one] = [0.0, 1.0, -1.0].map(|value| writer.constant(value));
    let negative = writer.compare(FloatCC::LessThan, a, zero);
    let positive = writer.compare(FloatCC::LessThan, zero, a);
    let unless_positive = writer.choose(negative, minus_one, a);
    writer.choose(positive, one, unless_positive)
}

/// a where it is NaN or `less` is in ascending order, else b. Written so that the inner choice is one instruction on x86.
fn extremum(writer: &mut Writer<'_, '_>, a: Value, less: [Value; 2], b: Value) -> Value {
    let chosen = writer.compare(FloatCC::LessThan, less[0], less[1]);
    let extremum = writer.choose(chosen, a, b);
    let undefined = writer.is_nan(a);
    writer.choose(undefined, a, extremum)
}

/// 1 where the condition holds, 0 where it does not, NaN where a side is.
fn truth(writer: &mut Writer<'_, '_>, condition: FloatCC, a: Value, b: Value) -> Value {
    let [zero, one, nan] = [0.0, 1.0, f64::NAN].map(|value| writer.constant(value));
    let holds = writer.compare(condition, a, b);
    let undefined = writer.compare(FloatCC::Unordered, a, b);
    let truth = writer.choose(holds, one, zero);
    writer.choose(undefined, nan, truth)
}

/// b where a is not zero, c where it is, a where it is NaN.
fn select(writer: &mut Writer<'_, '_>, a: Value, b: Value, c: Value) -> Value {
    let zero = writer.constant(0.0);
    let refused = writer.compare(FloatCC::Equal, a, zero);
    let undefined = writer.is_nan(a);
    let chosen = writer.choose(refused, c, b);
    writer.choose(undefined, a, chosen)
}
