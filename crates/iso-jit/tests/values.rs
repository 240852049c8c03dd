//! Native values against the values of the table of operations, bit for bit.

use iso_expr::engine::Points;
use iso_expr::{Axis, Engine, Node, NodeId, Operation, Program, Scratch, Value};
use iso_jit::Jit;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Arguments of every kind: zeros, ordinary, huge, tiny and subnormal numbers, infinities, NaN.
const TELLING: [f64; 24] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    2.5,
    -2.5,
    3.0,
    -7.25,
    0.1,
    1e-3,
    100.0,
    1e15,
    -4503599627370497.5,
    1e200,
    -1e300,
    f64::MAX,
    1e-310,
    -5e-324,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// What the program computes by the table of operations.
fn expected(program: &Program, arguments: [f64; 3]) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    for node in program.nodes() {
        values.push(match node {
            Node::Variable(axis) => arguments[*axis as usize],
            Node::Constant(constant) => constant.value(),
            Node::Apply(operation, operands) => {
                let [a, b, c] = operands.map(|id| values[id.index()]);
                match operation.value() {
                    Value::Unary(function) => function(a),
                    Value::Binary(function) => function(a, b),
                    Value::Ternary(function) => function(a, b, c),
                }
            }
        });
    }
    program.outputs().iter().map(|id| values[id.index()]).collect()
}

/// The bits, any NaN counting as one.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| if value.is_nan() { f64::NAN } else { *value }.to_bits()).collect()
}

/// Checks the point kernel and the batch kernel at all `points` at once.
fn check(program: &Program, points: &[[f64; 3]]) {
    let jit = Jit::new().unwrap();
    let mut scratch = Scratch::default();
    let outputs = program.outputs().len();
    let expected: Vec<_> = points.iter().map(|point| expected(program, *point)).collect();

    let kernel = jit.point(program).unwrap();
    for (point, expected) in points.iter().zip(&expected) {
        let mut values = vec![0.0; outputs];
        kernel.evaluate(&mut scratch, point[0], point[1], point[2], &mut values);
        assert_eq!(bits(&values), bits(expected), "{values:?} is not {expected:?} at {point:?}");
    }

    let kernel = jit.batch(program).unwrap();
    let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
    let mut values = vec![0.0; outputs * points.len()];
    kernel.evaluate(&mut scratch, Points { x: &x, y: &y, z: &z }, &mut values);
    for (place, expected) in expected.iter().enumerate() {
        let values: Vec<_> = (0..outputs).map(|output| values[output * points.len() + place]).collect();
        assert_eq!(bits(&values), bits(expected), "{values:?} is not {expected:?} at {:?}", points[place]);
    }
}

/// All triples of telling numbers that begin with different ones, and some more.
fn telling_points() -> Vec<[f64; 3]> {
    let pairs = TELLING.iter().flat_map(|x| TELLING.iter().map(move |y| (*x, *y)));
    pairs.enumerate().map(|(place, (x, y))| [x, y, TELLING[place * 7 % TELLING.len()]]).collect()
}

#[test]
fn every_operation_has_its_value() {
    for operation in Operation::all() {
        let mut program = Program::new();
        let arguments = Axis::ALL.map(|axis| program.variable(axis));
        let outputs = if operation == Operation::IntegerPower {
            [2, 3, 6, 7, 100, Operation::LARGEST_POWER]
                .map(|exponent| program.integer_power(arguments[0], exponent))
                .to_vec()
        } else {
            vec![program.apply(operation, &arguments[..operation.arity()])]
        };
        program.set_outputs(outputs);
        check(&program, &telling_points());
    }
}

#[test]
fn variables_constants_and_repeated_outputs_are_outputs_too() {
    let mut program = Program::new();
    let (z, c) = (program.variable(Axis::Z), program.literal(-0.0));
    program.set_outputs(vec![z, c, z]);
    check(&program, &telling_points());
}

#[test]
fn live_values_survive_calls() {
    let mut program = Program::new();
    let mut values: Vec<NodeId> = Axis::ALL.map(|axis| program.variable(axis)).to_vec();
    for place in 0..60 {
        let scale = program.literal(f64::from(place) - 20.0);
        let scaled = program.apply(Operation::Multiply, &[values[place as usize % 3], scale]);
        values.push(program.apply(Operation::Sin, &[scaled]));
    }
    let mut sum = values[0];
    for value in values.clone() {
        let quotient = program.apply(Operation::Divide, &[sum, value]);
        sum = program.apply(Operation::Add, &[quotient, value]);
    }
    program.set_outputs(vec![sum, values[9]]);
    check(&program, &telling_points());
}

#[test]
fn batches_of_any_length_agree() {
    for operation in [Operation::Divide, Operation::Atan2] {
        let mut program = Program::new();
        let [x, y, z] = Axis::ALL.map(|axis| program.variable(axis));
        let product = program.apply(Operation::Multiply, &[x, z]);
        let quotient = program.apply(operation, &[product, y]);
        program.set_outputs(vec![quotient, product]);
        for length in 0..=40 {
            check(&program, &telling_points()[100..100 + length]);
        }
    }
}

/// A program of random operations, whose last five nodes are outputs.
fn programs() -> impl Strategy<Value = Program> {
    let operations: Vec<_> = Operation::all().collect();
    let step = (select(operations), any::<[Index; 3]>(), 2..20_u32, select(&TELLING));
    prop::collection::vec(step, 1..60).prop_map(|steps| {
        let mut program = Program::new();
        let mut nodes: Vec<_> = Axis::ALL.map(|axis| program.variable(axis)).to_vec();
        for (operation, operands, exponent, constant) in steps {
            let operands = operands.map(|index| *index.get(&nodes));
            nodes.push(match operation {
                Operation::IntegerPower => program.integer_power(operands[0], exponent),
                _ => program.apply(operation, &operands[..operation.arity()]),
            });
            nodes.push(program.literal(constant));
        }
        program.set_outputs(nodes.split_off(nodes.len().saturating_sub(5)));
        program
    })
}

proptest! {
    #[test]
    fn random_programs_agree(program in programs(), points in prop::collection::vec(prop::array::uniform3(prop_oneof![
        select(&TELLING), any::<f64>(), -3.0..3.0
    ]), 0..20)) {
        check(&program, &points);
    }
}
