//! Kernels over one point.

use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Value, types};
use cranelift_codegen::packed_option::ReservedValue;
use cranelift_frontend::FunctionBuilder;
use iso_expr::{Node, NodeId, PointKernel, Program, Scratch};

use crate::code::{Blueprint, Compiled};
use crate::host::{self, Limits};
use crate::lanes::{Lanes, Writer};
use crate::symbols::Calls;
use crate::together::Order;
use crate::values;

/// A program's one output at (x, y, z), as native code.
pub struct NativeFunction(pub(crate) Compiled<extern "C" fn(f64, f64, f64) -> f64>);

impl NativeFunction {
    /// The output at (x, y, z).
    #[inline]
    pub fn call(&self, x: f64, y: f64, z: f64) -> f64 {
        (self.0.function)(x, y, z)
    }
}

/// Takes x, y and z; gives the program's one output.
pub(crate) struct FunctionBlueprint<'a>(pub(crate) &'a Program);

impl Blueprint for FunctionBlueprint<'_> {
    const NAME: &'static str = "function";
    const LIMITS: Limits = host::POINTS;
    type Function = extern "C" fn(f64, f64, f64) -> f64;

    fn sign(&self, signature: &mut Signature) {
        signature.params.extend([AbiParam::new(types::F64); 3]);
        signature.returns.push(AbiParam::new(types::F64));
    }

    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>) {
        let &[x, y, z] = parameters(builder) else { unreachable!("three parameters were signed") };
        let outputs = outputs(builder, calls, self.0, [x, y, z]);
        builder.ins().return_(&outputs);
    }

    unsafe fn function(&self, start: *const u8) -> Self::Function {
        // SAFETY: the code has the C convention, with the parameters and the result that were signed.
        unsafe { std::mem::transmute(start) }
    }
}

/// A kernel over one point, as native code.
pub(crate) struct NativePoint {
    compiled: Compiled<WritesOutputs>,
    outputs: usize,
}

/// Takes x, y and z, and where the outputs go.
type WritesOutputs = unsafe extern "C" fn(f64, f64, f64, *mut f64);

impl NativePoint {
    pub(crate) fn new(program: &Program, compiled: Compiled<WritesOutputs>) -> Self {
        Self { compiled, outputs: program.outputs().len() }
    }
}

impl PointKernel for NativePoint {
    fn evaluate(&self, _: &mut Scratch, x: f64, y: f64, z: f64, values: &mut [f64]) {
        // Unlike `assert_eq`, it keeps the length in its register and jumps to the code at once.
        assert!(values.len() == self.outputs, "room for every output");
        // SAFETY: the code writes as many doubles as the program has outputs, for which there is room.
        unsafe { (self.compiled.function)(x, y, z, values.as_mut_ptr()) }
    }
}

/// Takes x, y, z, and a pointer behind which it writes the program's outputs, one after the other.
pub(crate) struct PointBlueprint<'a>(pub(crate) &'a Program);

impl Blueprint for PointBlueprint<'_> {
    const NAME: &'static str = "point";
    const LIMITS: Limits = host::POINTS;
    type Function = WritesOutputs;

    fn sign(&self, signature: &mut Signature) {
        signature.params.extend([AbiParam::new(types::F64); 3]);
        signature.params.push(AbiParam::new(types::I64));
    }

    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>) {
        let &[x, y, z, values] = parameters(builder) else { unreachable!("four parameters were signed") };
        let outputs = outputs(builder, calls, self.0, [x, y, z]);
        for (place, output) in outputs.into_iter().enumerate() {
            builder.ins().store(MemFlagsData::trusted(), output, values, 8 * place as i32);
        }
        builder.ins().return_(&[]);
    }

    unsafe fn function(&self, start: *const u8) -> Self::Function {
        // SAFETY: the code has the C convention, with the parameters that were signed.
        unsafe { std::mem::transmute(start) }
    }
}

/// Writes the evaluation of `program` at one point.
fn outputs(
    builder: &mut FunctionBuilder<'_>,
    calls: &mut Calls<'_>,
    program: &Program,
    arguments: [Value; 3],
) -> Vec<Value> {
    let mut writer = Writer::new(builder, Lanes::One);
    // Nodes are not always written in their order.
    let mut values = vec![Value::reserved_value(); program.nodes().len()];
    for step in Order::in_pairs(program).steps() {
        let of = |operand: NodeId| values[operand.index()];
        let (id, other) = (step[0], step.get(1));
        match (program.node(id), other) {
            (Node::Variable(argument), _) => values[id.index()] = arguments[argument.index()],
            (Node::Constant(constant), _) => values[id.index()] = writer.constant(constant.value()),
            (Node::Apply(operation, operands), None) => {
                values[id.index()] = values::apply(&mut writer, calls, operation, operands.map(of));
            }
            (Node::Apply(operation, operands), Some(&other)) => {
                let mut pairs = operands.map(of);
                for (place, pair) in pairs.iter_mut().enumerate().take(operation.arity()) {
                    let both = [operands[place], program.node(other).operands()[place]];
                    *pair = match both.map(|operand| program.node(operand)) {
                        [Node::Constant(a), Node::Constant(b)] => writer.constants([a.value(), b.value()]),
                        _ => writer.pair(both.map(of)),
                    };
                }
                let results = values::apply(&mut writer, calls, operation, pairs);
                [values[id.index()], values[other.index()]] = writer.singles(results);
            }
        }
    }
    program.outputs().iter().map(|output| values[output.index()]).collect()
}

fn parameters<'a>(builder: &'a FunctionBuilder<'_>) -> &'a [Value] {
    let entry = builder.current_block().expect("writing begins in the entry block");
    builder.block_params(entry)
}
