use super::Interpreter;
use crate::program::reference::assert_same;
use crate::random::Random;
use crate::{Axis, Engine, Operation, Program, Scratch};

/// Every kernel over points gives what the definition gives, at `points` taken as one batch.
fn check_points(program: &Program, scratch: &mut Scratch, points: &[[f64; 3]]) {
    let (point_kernel, batch_kernel) =
        (Interpreter.point(program).unwrap(), Interpreter.batch(program).unwrap());
    let [x, y, z] = Axis::ALL.map(|axis| points.iter().map(|point| point[axis as usize]).collect::<Vec<_>>());
    let outputs = program.outputs().len();
    let mut batch_values = vec![0.5; points.len() * outputs];
    batch_kernel.evaluate(scratch, &[&x, &y, &z], &mut batch_values);
    let mut point_values = vec![0.5; outputs];
    for (index, point) in points.iter().enumerate() {
        point_kernel.evaluate(scratch, point[0], point[1], point[2], &mut point_values);
        for (output, expected) in program.evaluate(*point).into_iter().enumerate() {
            let context = || format!("output {output} at {point:?} of\n{program}");
            assert_same(point_values[output], expected, context);
            assert_same(batch_values[output * points.len() + index], expected, context);
        }
    }
}

fn points(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [(); 3].map(|()| random.double())).collect()
}

#[test]
fn every_operation_has_its_value_in_every_kernel() {
    let mut random = Random::new(1);
    let mut scratch = Scratch::default();
    for operation in Operation::all() {
        for _ in 0..20 {
            let mut program = Program::new();
            let variables = Axis::ALL.map(|axis| program.variable(axis));
            let node = random.application(&mut program, &variables, operation);
            program.set_outputs(vec![node]);
            check_points(&program, &mut scratch, &points(&mut random, 70));
        }
    }
}

#[test]
fn random_programs_have_their_values_in_every_kernel() {
    let mut random = Random::new(2);
    let mut scratch = Scratch::default();
    for length in [0, 1, 2, 3, 15, 16, 17, 255, 256, 257, 1000].into_iter().cycle().take(150) {
        let operations = random.below(80);
        let program = random.program(operations);
        check_points(&program, &mut scratch, &points(&mut random, length));
    }
}

#[test]
fn programs_that_need_many_registers_have_their_values_in_every_kernel() {
    let mut random = Random::new(3);
    let program = random.wide_program(3000);
    check_points(&program, &mut Scratch::default(), &points(&mut random, 100));
}

#[test]
fn outputs_may_be_arguments_constants_and_one_another() {
    let mut program = Program::new();
    let (x, seven) = (program.variable(Axis::X), program.literal(7.0));
    let sum = program.apply(Operation::Add, &[x, seven]);
    let double = program.apply(Operation::Add, &[sum, sum]);
    program.set_outputs(vec![x, seven, sum, sum, double]);
    check_points(&program, &mut Scratch::default(), &points(&mut Random::new(4), 40));
}

#[test]
fn a_hundred_thousand_operations_work() {
    let mut random = Random::new(5);
    let cheap = [Operation::Add, Operation::Multiply, Operation::Minimum, Operation::IntegerPower];
    let program = random.program_of(100_000, &cheap);
    check_points(&program, &mut Scratch::default(), &points(&mut random, 20));
}
