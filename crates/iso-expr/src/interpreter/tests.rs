use super::Interpreter;
use crate::engine::{Boxes, Enclosures, Points};
use crate::program::reference::assert_same;
use crate::random::Random;
use crate::{Axis, Decorated, Decoration, Engine, Interval, Node, NodeId, Operation, Program, Scratch};

/// Every kernel over points gives what the definition gives, at `points` taken as one batch.
fn check_points(program: &Program, scratch: &mut Scratch, points: &[[f64; 3]]) {
    let (point_kernel, batch_kernel) =
        (Interpreter.point(program).unwrap(), Interpreter.batch(program).unwrap());
    let [x, y, z] = Axis::ALL.map(|axis| points.iter().map(|point| point[axis as usize]).collect::<Vec<_>>());
    let outputs = program.outputs().len();
    let mut batch_values = vec![0.5; points.len() * outputs];
    batch_kernel.evaluate(scratch, Points { x: &x, y: &y, z: &z }, &mut batch_values);
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

/// What the interpreter's box kernel gives for the program's outputs, box by box.
fn enclose(program: &Program, scratch: &mut Scratch, boxes: &[[Interval; 3]]) -> Vec<Vec<Decorated>> {
    let ends = |end: fn(&Interval) -> f64| {
        Axis::ALL.map(|axis| boxes.iter().map(|sides| end(&sides[axis as usize])).collect::<Vec<_>>())
    };
    let (lo, hi) = (ends(|side| side.lo), ends(|side| side.hi));
    let count = boxes.len() * program.outputs().len();
    let (mut low, mut high, mut decoration) =
        (vec![0.5; count], vec![0.5; count], vec![Decoration::Common; count]);
    Interpreter.boxes(program).unwrap().evaluate(
        scratch,
        Boxes { lo: lo.each_ref().map(Vec::as_slice), hi: hi.each_ref().map(Vec::as_slice) },
        Enclosures { lo: &mut low, hi: &mut high, decoration: &mut decoration },
    );
    let enclosure = |place: usize| Decorated {
        interval: Interval { lo: low[place], hi: high[place] },
        decoration: decoration[place],
    };
    (0..boxes.len()).map(|index| (index..count).step_by(boxes.len()).map(enclosure).collect()).collect()
}

/// Whether doubles go on at `point` where real numbers are undefined, so that nothing is promised of them: an operation on
/// the way gives no finite number, or the angle of the origin.
fn is_undefined(program: &Program, point: [f64; 3]) -> bool {
    let values = program.evaluate_nodes(point);
    let is_zero = |operand: &NodeId| values[operand.index()] == 0.0;
    let is_angle_of_origin = |node: &Node| match node {
        Node::Apply(Operation::Atan2, operands) => operands.iter().all(is_zero),
        _ => false,
    };
    !values.iter().all(|value| value.is_finite()) || program.nodes().iter().any(is_angle_of_origin)
}

/// Random points of random boxes have their values inside the enclosures of `program`'s outputs. Gives how many were checked.
fn check_boxes(random: &mut Random, scratch: &mut Scratch, program: &Program) -> usize {
    let boxes: Vec<_> = (0..6).map(|_| [(); 3].map(|()| random.argument().interval)).collect();
    let mut checked = 0;
    for (sides, enclosures) in boxes.iter().zip(enclose(program, scratch, &boxes)) {
        for _ in 0..8 {
            if sides.iter().any(|side| side.is_empty()) {
                continue;
            }
            let point = sides.map(|side| random.inside(side));
            if is_undefined(program, point) {
                continue;
            }
            for (enclosure, value) in enclosures.iter().zip(program.evaluate(point)) {
                let Decorated { interval, .. } = enclosure;
                let (holds, sides) = (interval.contains(value), sides);
                assert!(holds, "{value:?} at {point:?} is outside {interval:?} over {sides:?}\n{program}");
                checked += 1;
            }
        }
    }
    checked
}

#[test]
fn enclosures_hold_the_values_at_points_of_their_boxes() {
    let mut random = Random::new(6);
    let mut scratch = Scratch::default();
    let mut checked = 0;
    for _ in 0..2000 {
        let operations = random.below(20);
        let program = random.program(operations).pruned();
        for program in [&program, &program.simplified(), &program.with_gradient()] {
            checked += check_boxes(&mut random, &mut scratch, program);
        }
    }
    assert!(checked > 20_000, "only {checked} values were finite");
}

#[test]
fn enclosures_do_not_depend_on_their_neighbours() {
    let mut random = Random::new(7);
    let mut scratch = Scratch::default();
    let bits = |enclosures: &[Decorated]| -> Vec<_> {
        let ends = |enclosure: &Decorated| [enclosure.interval.lo.to_bits(), enclosure.interval.hi.to_bits()];
        enclosures.iter().map(|enclosure| (ends(enclosure), enclosure.decoration)).collect()
    };
    for _ in 0..200 {
        let program = random.program(15).with_gradient();
        let boxes: Vec<_> = (0..9).map(|_| [(); 3].map(|()| random.argument().interval)).collect();
        let together = enclose(&program, &mut scratch, &boxes);
        for (sides, enclosures) in boxes.iter().zip(together) {
            let alone = enclose(&program, &mut scratch, &[*sides]);
            assert_eq!(bits(&enclosures), bits(&alone[0]), "over {sides:?} of\n{program}");
        }
    }
}
