//! Native enclosures against the interpreter's, ends bit for bit and decorations.

#[path = "properties/boxes.rs"]
mod agreement;

use agreement::{boxes, enclosures_agree};
use iso_expr::random::Random;
use iso_expr::{Ast, Axis, CompileError, Constant, Decorated, Operation, Program};
use iso_jit::{Jit, Kind};

#[test]
fn every_operation_has_its_extension() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(1));
    for operation in Operation::all() {
        let mut program = Program::new();
        let variables = Axis::ALL.map(|axis| program.variable(axis));
        let outputs = if operation == Operation::IntegerPower {
            [2, 3, 4, 6, 7, 100, 101, Operation::LARGEST_POWER]
                .map(|exponent| program.integer_power(variables[0], exponent))
                .to_vec()
        } else {
            vec![program.apply(operation, &variables[..operation.arity()])]
        };
        program.set_outputs(outputs);
        enclosures_agree(&jit, &program, &boxes(&mut random, 5000));
        let zero = Decorated::argument(0.0, 0.0);
        let with_zero = boxes(&mut random, 100).into_iter().map(|[x, y, z]| [[zero, y, z], [x, zero, z]]);
        enclosures_agree(&jit, &program, &with_zero.flatten().collect::<Vec<_>>());
    }
}

#[test]
fn operations_on_constants_have_their_extensions() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(2));
    for operation in
        [Operation::Add, Operation::Multiply, Operation::Divide, Operation::Maximum, Operation::Power]
    {
        for _ in 0..60 {
            let mut program = Program::new();
            let x = program.variable(Axis::X);
            let constant = match random.below(4) {
                0 => Constant::PI,
                1 => Constant::folded(0.5, random.argument().interval),
                _ => Constant::exact(random.double()),
            };
            let constant = program.constant(constant);
            let outputs = vec![
                program.apply(operation, &[x, constant]),
                program.apply(operation, &[constant, x]),
                program.apply(operation, &[constant, constant]),
                constant,
            ];
            program.set_outputs(outputs);
            enclosures_agree(&jit, &program, &boxes(&mut random, 200));
        }
    }
}

#[test]
fn batches_of_any_length_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(3));
    let program = random.program(20).with_gradient();
    let boxes = boxes(&mut random, 40);
    for length in 0..=boxes.len() {
        enclosures_agree(&jit, &program, &boxes[..length]);
    }
}

#[test]
fn random_programs_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(4));
    for _ in 0..300 {
        let operations = 1 + random.below(40);
        let program = random.program(operations);
        let boxes = boxes(&mut random, 25);
        enclosures_agree(&jit, &program, &boxes);
        enclosures_agree(&jit, &program.with_gradient(), &boxes);
    }
}

/// Ends next to poles and edges of definition, and at what is assumed of divisors: 2⁻⁶⁰, the square of 2⁻³⁰.
fn boxes_near_poles(random: &mut Random, count: usize) -> Vec<[Decorated; 3]> {
    let mut end = || {
        let end = random.choose(&[0.0, 2f64.powi(-30), 2f64.powi(-60), 1e-200, 5e-324, 1.0]);
        match random.below(5) {
            0 => random.between(-2.0, 2.0),
            1 => -end,
            2 => end.next_up(),
            3 => end.next_down(),
            _ => end,
        }
    };
    let mut side = || {
        let (a, b) = (end(), end());
        Decorated::argument(a.min(b), a.max(b))
    };
    (0..count).map(|_| [side(), side(), side()]).collect()
}

#[test]
fn what_is_assumed_of_divisors_and_radicands_is_checked() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(7));
    for formula in [
        "1/(x^2 + y^2)",
        "z/(-x^2 - y^2)",
        "x/abs(y)",
        "1/(x^2 + y^2 + z^2)^2 - 1/((x - 1)^2 + y^2)",
        "sqrt(x)",
        "sqrt(x - 1) * y",
        "z/sqrt(x) + sqrt(-y)",
        "sqrt(-x^2)",
        "1/(0*x^2)",
    ] {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0);
        let boxes = boxes_near_poles(&mut random, 400);
        enclosures_agree(&jit, &program, &boxes);
        let gradient = program.with_gradient();
        enclosures_agree(&jit, &gradient, &boxes);
        enclosures_agree(&jit, &gradient.with_hessian(), &boxes[..100]);
    }
}

#[test]
fn programs_that_spill_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(5));
    for width in [20, 200, 1100] {
        let program = random.wide_program(width);
        enclosures_agree(&jit, &program, &boxes(&mut random, 30));
    }
}

#[test]
fn programs_too_large_to_compile_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(6));
    let program = random.wide_program(1_600);
    let refusal = jit.listing(&program, Kind::Boxes).err().unwrap();
    assert!(matches!(refusal, CompileError::TooLarge { engine: "jit", given: 3_200, .. }), "{refusal}");
    enclosures_agree(&jit, &program, &boxes(&mut random, 5));
}
