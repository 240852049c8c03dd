//! Native values against the interpreter's, bit for bit.

#[path = "properties/values.rs"]
mod values;

use iso_expr::random::Random;
use iso_expr::{Axis, Engine, Interpreter, Operation, Program, Scratch};
use iso_jit::Jit;
use values::{bits, points, values_agree};

#[test]
fn every_operation_has_its_value() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(1));
    for operation in Operation::all() {
        let mut program = Program::new();
        let variables = Axis::ALL.map(|axis| program.variable(axis));
        let outputs = if operation == Operation::IntegerPower {
            [2, 3, 6, 7, 100, Operation::LARGEST_POWER]
                .map(|exponent| program.integer_power(variables[0], exponent))
                .to_vec()
        } else {
            vec![program.apply(operation, &variables[..operation.arity()])]
        };
        program.set_outputs(outputs);
        let mut points = points(&mut random, 400);
        // Equal operands, and zeros of both signs.
        points.extend((0..20).map(|_| [random.double(); 3]));
        points.extend([[0.0, -0.0, 1.0], [-0.0, 0.0, 1.0], [f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0]]);
        values_agree(&jit, &program, &points);
    }
}

#[test]
fn variables_constants_and_repeated_outputs_are_outputs_too() {
    let (jit, mut program) = (Jit::new().unwrap(), Program::new());
    let (z, zero) = (program.variable(Axis::Z), program.literal(-0.0));
    program.set_outputs(vec![z, zero, z]);
    values_agree(&jit, &program, &points(&mut Random::new(2), 10));
    program.set_outputs(Vec::new());
    values_agree(&jit, &program, &points(&mut Random::new(2), 10));
}

#[test]
fn live_values_survive_calls() {
    let (jit, mut program) = (Jit::new().unwrap(), Program::new());
    let variables = Axis::ALL.map(|axis| program.variable(axis));
    let mut values = variables.to_vec();
    for place in 0..60 {
        let scale = program.literal(f64::from(place) - 20.0);
        let scaled = program.apply(Operation::Multiply, &[variables[place as usize % 3], scale]);
        values.push(program.apply(Operation::Sin, &[scaled]));
    }
    let mut sum = values[0];
    for value in values.clone() {
        let quotient = program.apply(Operation::Divide, &[sum, value]);
        sum = program.apply(Operation::Add, &[quotient, value]);
    }
    program.set_outputs(vec![sum, values[9]]);
    values_agree(&jit, &program, &points(&mut Random::new(3), 100));
}

#[test]
fn batches_of_any_length_agree() {
    let (jit, points) = (Jit::new().unwrap(), points(&mut Random::new(4), 40));
    for operation in [Operation::Divide, Operation::Atan2] {
        let mut program = Program::new();
        let [x, y, z] = Axis::ALL.map(|axis| program.variable(axis));
        let product = program.apply(Operation::Multiply, &[x, z]);
        let quotient = program.apply(operation, &[product, y]);
        program.set_outputs(vec![quotient, product]);
        for length in 0..=points.len() {
            values_agree(&jit, &program, &points[..length]);
        }
    }
}

#[test]
fn random_programs_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(5));
    for _ in 0..400 {
        let operations = 1 + random.below(60);
        let program = random.program(operations);
        let points = points(&mut random, 25);
        values_agree(&jit, &program, &points);
        values_agree(&jit, &program.with_gradient(), &points);
    }
}

/// Point kernels evaluate two of them by one instruction.
#[test]
fn divisions_and_roots_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(10));
    let mut operations = vec![Operation::Divide; 3];
    operations.extend([Operation::SquareRoot, Operation::SquareRoot, Operation::Add, Operation::Subtract]);
    operations.extend([Operation::Multiply, Operation::Absolute, Operation::Maximum, Operation::Select]);
    for round in 0..400 {
        let mut program = random.program_of(2 + round % 60, &operations);
        if round % 2 == 0 {
            // So that no value that differs is lost on the way to the end.
            program.set_outputs(program.iter().map(|(id, _)| id).collect());
        }
        values_agree(&jit, &program, &points(&mut random, 40));
    }
}

#[test]
fn programs_that_spill_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(6));
    for width in [20, 100, 1500] {
        let program = random.wide_program(width);
        values_agree(&jit, &program, &points(&mut random, 30));
    }
}

#[test]
fn a_function_agrees_with_the_point_kernel() {
    let mut random = Random::new(7);
    let jit = Jit::new().unwrap();
    for _ in 0..50 {
        let program = random.program(20);
        let (function, kernel) = (jit.function(&program).unwrap(), jit.point(&program).unwrap());
        for [x, y, z] in points(&mut random, 20) {
            let mut value = [0.0];
            kernel.evaluate(&mut Scratch::default(), x, y, z, &mut value);
            assert_eq!(bits(&[function.call(x, y, z)]), bits(&value));
        }
    }
}

/// Programs of affine forms take fifteen arguments.
#[test]
fn forms_agree_whatever_the_formula() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(9));
    let operations: Vec<_> = Operation::all().filter(|operation| has_form(*operation)).collect();
    for round in 0..150 {
        let program = random.program_of(1 + round % 12, &operations);
        let forms = program.with_forms().expect("all of these have forms");
        let count = 1 + round % 5;
        let ordinary = round % 3 > 0;
        let number = |_| if ordinary { random.between(-1.0, 1.0) } else { random.double() };
        let arguments: Vec<f64> = (0..15 * count).map(number).collect();
        let arguments: Vec<&[f64]> = arguments.chunks(count).collect();
        let [native, reference] = [&jit as &dyn Engine, &Interpreter].map(|engine| {
            let mut values = vec![0.0; Program::FORM * count];
            engine.batch(&forms).unwrap().evaluate(&mut Scratch::default(), &arguments, &mut values);
            bits(&values)
        });
        assert_eq!(native, reference, "{program}");
    }
}

/// Whether the forms of one operation exist.
fn has_form(operation: Operation) -> bool {
    let mut program = Program::new();
    let variables = Axis::ALL.map(|axis| program.variable(axis));
    let output = match operation {
        Operation::IntegerPower => program.integer_power(variables[0], 3),
        _ => program.apply(operation, &variables[..operation.arity()]),
    };
    program.set_outputs(vec![output]);
    program.with_forms().is_some()
}
