//! Kernels over batches of points: a loop over groups of 128-bit lanes.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{AbiParam, InstBuilder, Signature, Value, types};
use cranelift_frontend::FunctionBuilder;
use iso_expr::{Argument, BatchKernel, Node, Program, Scratch};

use crate::code::{Blueprint, Compiled};
use crate::elementary;
use crate::host::{self, Limits};
use crate::lanes::{Lanes, Writer};
use crate::symbols::Calls;
use crate::values;

/// The points of one pair of lanes.
const PAIR: usize = 2;

/// The most pairs of lanes in one round of the loop.
const MOST_PAIRS: usize = 4;

/// The registers of 128 bits.
const REGISTERS: usize = 16;

/// The most points in one round.
const WIDEST: usize = PAIR * MOST_PAIRS;

/// The most operations of a program that is evaluated for several pairs of lanes at once, for longer code takes longer to
/// compile.
const LARGEST_SIDE_BY_SIDE: usize = 400;

/// The most operations for each function that takes all pairs at once, for which that decides how many pairs there are. A form of a
/// logarithm, 252 operations around one call, would take 5 ms longer to compile, and a picture no less time; the gyroid's would take 8 ms longer.
const MOST_BESIDE_A_FUNCTION: usize = 40;

/// Where each argument of `count` points stands, where the outputs go, and `count`, which is not less than the points of one round.
type Evaluate = unsafe extern "C" fn(*const *const f64, *mut f64, usize);

/// A kernel over batches of points, as native code.
pub(crate) struct NativeBatch {
    compiled: Compiled<Evaluate>,
    arguments: usize,
    outputs: usize,
    width: usize,
}

impl NativeBatch {
    pub(crate) fn new(blueprint: &BatchBlueprint<'_>, compiled: Compiled<Evaluate>) -> Self {
        let program = blueprint.program;
        let (arguments, outputs) = (program.arguments(), program.outputs().len());
        assert!(arguments <= Program::MOST_ARGUMENTS, "no program takes more arguments");
        Self { compiled, arguments, outputs, width: blueprint.width() }
    }

    /// Evaluates fewer points than one round has, but some: the last one is repeated to fill the round.
    fn evaluate_few(&self, scratch: &mut Scratch, arguments: &[&[f64]], count: usize, values: &mut [f64]) {
        let mut padded = [[0.0; WIDEST]; Program::MOST_ARGUMENTS];
        for (padded, argument) in padded.iter_mut().zip(arguments) {
            *padded = std::array::from_fn(|place| argument[place.min(count - 1)]);
        }
        let addresses = padded.each_ref().map(|argument| argument.as_ptr());
        let outputs = scratch.values(self.outputs * self.width);
        // SAFETY: of each argument `width` values, not more than `WIDEST`, are there, and room for as many of each output.
        unsafe { (self.compiled.function)(addresses.as_ptr(), outputs.as_mut_ptr(), self.width) };
        for (values, outputs) in values.chunks_exact_mut(count).zip(outputs.chunks_exact(self.width)) {
            values.copy_from_slice(&outputs[..count]);
        }
    }
}

impl BatchKernel for NativeBatch {
    fn evaluate(&self, scratch: &mut Scratch, arguments: &[&[f64]], values: &mut [f64]) {
        let count = arguments.first().map_or(0, |argument| argument.len());
        assert!(arguments.iter().all(|argument| argument.len() == count), "as many of each argument");
        assert_eq!(values.len(), self.outputs * count, "room for every output at every point");
        let arguments = &arguments[..self.arguments];
        if count >= self.width {
            let mut addresses = [std::ptr::null(); Program::MOST_ARGUMENTS];
            for (address, argument) in addresses.iter_mut().zip(arguments) {
                *address = argument.as_ptr();
            }
            // SAFETY: there are `count` of each argument that is taken, enough for one round, and room for as many of each
            // output; none of it overlaps what is written, which is borrowed mutably.
            unsafe { (self.compiled.function)(addresses.as_ptr(), values.as_mut_ptr(), count) };
        } else if count > 0 {
            self.evaluate_few(scratch, arguments, count, values);
        }
    }
}

/// Takes what [`Evaluate`] names, and walks through it round by round. The last round ends with the last point, and so may
/// evaluate some points a second time, which changes nothing.
pub(crate) struct BatchBlueprint<'a> {
    program: &'a Program,
    pairs: usize,
}

impl<'a> BatchBlueprint<'a> {
    pub(crate) fn new(program: &'a Program) -> Self {
        Self { program, pairs: pairs(program) }
    }

    /// Points in one round.
    fn width(&self) -> usize {
        PAIR * self.pairs
    }
}

impl Blueprint for BatchBlueprint<'_> {
    const NAME: &'static str = "batch";
    const LIMITS: Limits = host::POINTS;
    type Function = Evaluate;

    fn sign(&self, signature: &mut Signature) {
        signature.params.extend([AbiParam::new(types::I64); 3]);
    }

    fn write(&self, builder: &mut FunctionBuilder<'_>, calls: &mut Calls<'_>) {
        let entry = builder.current_block().expect("writing begins in the entry block");
        let &[arguments, values, count] = builder.block_params(entry) else {
            unreachable!("three parameters were signed")
        };
        // All offsets are in bytes.
        let step = size_of::<f64>() * self.width();
        let stride = builder.ins().imul_imm_s(count, size_of::<f64>() as i64);
        let last = builder.ins().iadd_imm_s(stride, -(step as i64));
        let first = builder.ins().iconst(types::I64, 0);
        // Once for all rounds, which would be up to half as long again.
        let mut writer = Writer::new(builder, Lanes::Two);
        let starts: Vec<Value> =
            (0..self.program.arguments()).map(|number| writer.load_address(arguments, number)).collect();
        let (round, end) = (builder.create_block(), builder.create_block());
        let offset = builder.append_block_param(round, types::I64);
        builder.ins().jump(round, &[first.into()]);

        builder.switch_to_block(round);
        self.write_round(builder, calls, &starts, values, stride, offset);
        let next = builder.ins().iadd_imm_s(offset, step as i64);
        let beyond = builder.ins().icmp(IntCC::UnsignedGreaterThan, next, last);
        let next = builder.ins().select(beyond, last, next);
        let done = builder.ins().icmp(IntCC::Equal, offset, last);
        builder.ins().brif(done, end, &[], round, &[next.into()]);

        builder.switch_to_block(end);
        builder.ins().return_(&[]);
    }

    unsafe fn function(&self, start: *const u8) -> Self::Function {
        // SAFETY: the code has the C convention, with the parameters that were signed.
        unsafe { std::mem::transmute(start) }
    }
}

impl BatchBlueprint<'_> {
    /// Writes the evaluation of the points that stand `offset` bytes after the first, given where each argument starts.
    fn write_round(
        &self,
        builder: &mut FunctionBuilder<'_>,
        calls: &mut Calls<'_>,
        starts: &[Value],
        values: Value,
        stride: Value,
        offset: Value,
    ) {
        let mut writer = Writer::new(builder, Lanes::Two);
        let displacement = |pair: usize| (size_of::<f64>() * PAIR * pair) as i32;
        let argument = |writer: &mut Writer<'_, '_>, argument: Argument| {
            let address = writer.builder.ins().iadd(starts[argument.index()], offset);
            (0..self.pairs).map(|pair| writer.load(address, displacement(pair))).collect()
        };
        let outputs = values::evaluate(&mut writer, calls, self.program, self.pairs, argument);
        let mut address = writer.builder.ins().iadd(values, offset);
        for output in 0..self.program.outputs().len() {
            for (pair, outputs) in outputs.iter().enumerate() {
                writer.store(outputs[output], address, displacement(pair));
            }
            address = writer.builder.ins().iadd(address, stride);
        }
    }
}

/// How many pairs of lanes are evaluated side by side, so that operations need not wait for each other: as many as registers hold
/// the values of. Where functions are called, they take most of the time, and one pair is enough, unless many of them take all pairs at
/// once.
///
/// Measured beside one pair: a chain of 300 operations takes 16 instead of 43 ns a point with four pairs, the paper's polynomial
/// 0.82 of the time with four, its gradient 0.81 with two, the sextic of Barth 0.88 with two, but its gradient 1.17.
fn pairs(program: &Program) -> usize {
    if program.operations() > LARGEST_SIDE_BY_SIDE {
        return 1;
    }
    let operations = || {
        program.nodes().iter().filter_map(|node| match node {
            Node::Apply(operation, _) => Some(*operation),
            _ => None,
        })
    };
    let in_lanes = operations().filter(|operation| elementary::function(*operation).is_some()).count();
    if in_lanes * MOST_BESIDE_A_FUNCTION >= program.operations() {
        return MOST_PAIRS;
    }
    if operations().any(|operation| !values::is_written_out(operation)) {
        return 1;
    }
    match REGISTERS / most_alive(program).max(1) {
        0 | 1 => 1,
        2 | 3 => 2,
        _ => MOST_PAIRS,
    }
}

/// How many values are needed at the same time at most, constants aside.
fn most_alive(program: &Program) -> usize {
    let is_constant = |place: usize| matches!(program.nodes()[place], Node::Constant(_));
    let mut last_reader = vec![0; program.nodes().len()];
    for (id, node) in program.iter() {
        node.operands().iter().for_each(|operand| last_reader[operand.index()] = id.index());
    }
    // Outputs are written at the end.
    program.outputs().iter().for_each(|output| last_reader[output.index()] = usize::MAX);
    let is_argument = |node: &&Node| matches!(node, Node::Variable(_));
    let (mut alive, mut most) = (program.nodes().iter().filter(is_argument).count(), 0);
    for (id, node) in program.iter() {
        for (place, operand) in node.operands().iter().enumerate() {
            let is_repeated = node.operands()[..place].contains(operand);
            let ends = last_reader[operand.index()] == id.index() && !is_constant(operand.index());
            alive -= usize::from(ends && !is_repeated);
        }
        alive += usize::from(matches!(node, Node::Apply(..)));
        most = most.max(alive);
    }
    most
}

#[cfg(test)]
mod tests {
    use iso_expr::{Ast, Operation};

    use super::*;

    fn program(formula: &str) -> Program {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        program.with_powers_expanded()
    }

    #[test]
    fn values_are_alive_until_they_were_read_for_the_last_time() {
        for (formula, expected) in
            [("x + y + z", 3), ("x*x", 1), ("x + 1", 1), ("(x + y) * (x - y)", 3), ("x^4 + 2", 1)]
        {
            assert_eq!(most_alive(&program(formula)), expected, "{formula}");
        }
        let gradient = program("x*y*z").with_gradient();
        assert!(most_alive(&gradient) >= gradient.outputs().len());
    }

    #[test]
    fn pairs_share_the_registers() {
        assert_eq!(pairs(&program("x + y + z")), 4);
        assert_eq!(pairs(&program("x + y + atan(z)")), 1);
        let in_lanes = if elementary::function(Operation::Ln).is_some() { MOST_PAIRS } else { 1 };
        assert_eq!(pairs(&program("x + y + ln(z)")), in_lanes);
        let powers =
            (1..12).map(|power| format!("(x + {power})*(y - z)^{power}")).collect::<Vec<_>>().join(" + ");
        assert_eq!(pairs(&program(&powers).with_gradient()), 1);
        assert_eq!(pairs(&program(&format!("ln({powers} + x)"))), 1);
    }
}
