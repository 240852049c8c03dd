//! Native enclosures against the interpreter's, ends bit for bit and decorations.

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{Axis, Constant, Decorated, Decoration, Engine, Interpreter, Operation, Program, Scratch};
use iso_jit::Jit;

/// The enclosures of all outputs over all boxes, as bits, any NaN counting as one.
fn enclosures(
    engine: &dyn Engine,
    program: &Program,
    boxes: &[[Decorated; 3]],
) -> Vec<(u64, u64, Decoration)> {
    let ends = |end: fn(&Decorated) -> f64| {
        [0, 1, 2].map(|axis| boxes.iter().map(|ranges| end(&ranges[axis])).collect::<Vec<_>>())
    };
    let (lo, hi) = (ends(|range| range.interval.lo), ends(|range| range.interval.hi));
    let count = program.outputs().len() * boxes.len();
    let (mut output_lo, mut output_hi) = (vec![7.0; count], vec![7.0; count]);
    let mut decoration = vec![Decoration::Defined; count];
    engine.boxes(program).unwrap().evaluate(
        &mut Scratch::default(),
        Boxes { lo: lo.each_ref().map(|ends| &ends[..]), hi: hi.each_ref().map(|ends| &ends[..]) },
        Enclosures { lo: &mut output_lo, hi: &mut output_hi, decoration: &mut decoration },
    );
    let bits = |value: f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
    let ends = output_lo.into_iter().zip(output_hi).map(|(lo, hi)| (bits(lo), bits(hi)));
    ends.zip(decoration).map(|((lo, hi), decoration)| (lo, hi, decoration)).collect()
}

fn check(jit: &Jit, program: &Program, boxes: &[[Decorated; 3]]) {
    let native = enclosures(jit, program, boxes);
    let expected = enclosures(&Interpreter, program, boxes);
    for (place, (native, expected)) in native.iter().zip(&expected).enumerate() {
        let show = |(lo, hi, decoration): &(u64, u64, Decoration)| {
            format!("[{:e}, {:e}] {decoration:?}", f64::from_bits(*lo), f64::from_bits(*hi))
        };
        let ranges = boxes[place % boxes.len()];
        assert_eq!(
            native,
            expected,
            "{} is not {} over {ranges:?} in\n{program}",
            show(native),
            show(expected)
        );
    }
}

fn boxes(random: &mut Random, count: usize) -> Vec<[Decorated; 3]> {
    (0..count).map(|_| [random.argument(), random.argument(), random.argument()]).collect()
}

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
        check(&jit, &program, &boxes(&mut random, 5000));
        let zero = Decorated::argument(0.0, 0.0);
        let with_zero = boxes(&mut random, 100).into_iter().map(|[x, y, z]| [[zero, y, z], [x, zero, z]]);
        check(&jit, &program, &with_zero.flatten().collect::<Vec<_>>());
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
            check(&jit, &program, &boxes(&mut random, 200));
        }
    }
}

#[test]
fn batches_of_any_length_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(3));
    let program = random.program(20).with_gradient();
    let boxes = boxes(&mut random, 40);
    for length in 0..=boxes.len() {
        check(&jit, &program, &boxes[..length]);
    }
}

#[test]
fn random_programs_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(4));
    for _ in 0..300 {
        let operations = 1 + random.below(40);
        let program = random.program(operations);
        let boxes = boxes(&mut random, 25);
        check(&jit, &program, &boxes);
        check(&jit, &program.with_gradient(), &boxes);
    }
}

#[test]
fn programs_that_spill_agree() {
    let (jit, mut random) = (Jit::new().unwrap(), Random::new(5));
    for width in [20, 200, 1100] {
        let program = random.wide_program(width);
        check(&jit, &program, &boxes(&mut random, 30));
    }
}
