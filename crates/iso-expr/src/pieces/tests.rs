//! Pieces of known functions, and of random programs against their values at points.

use super::*;
use crate::engine::{Boxes, Enclosures};
use crate::random::Random;
use crate::{Axis, Engine, Interpreter, Scratch};

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).expect("the ends are in order")
}

/// The pieces of a function of x over `domain`.
fn pieces(build: impl FnOnce(&mut Program, NodeId) -> NodeId, domain: Interval) -> Vec<Interval> {
    let mut program = Program::new();
    let x = program.variable(Axis::X);
    let output = build(&mut program, x);
    program.set_outputs(vec![output]);
    program.pieces([domain; 3]).collect()
}

/// Whether one piece holds `value`.
fn hold(pieces: &[Interval], value: f64) -> bool {
    pieces.iter().any(|piece| piece.contains(value))
}

#[test]
fn a_program_without_branches_is_one_piece() {
    let found = pieces(|program, x| program.integer_power(x, 2), interval(-1.0, 2.0));
    assert!(
        matches!(found[..], [piece] if piece.contains(0.0) && piece.contains(4.0) && !piece.contains(-0.1))
    );
}

#[test]
fn a_reciprocal_has_a_piece_on_either_side_of_its_pole() {
    let reciprocal = |program: &mut Program, x| {
        let one = program.literal(1.0);
        program.apply(Operation::Divide, &[one, x])
    };
    let found = pieces(reciprocal, interval(-0.5, 0.25));
    assert_eq!(found.len(), 2);
    assert!(hold(&found, -2.0) && hold(&found, 4.0) && hold(&found, 1e300));
    assert!(!hold(&found, 0.0) && !hold(&found, -1.9) && !hold(&found, 3.9));
}

#[test]
fn a_floor_has_a_piece_for_each_integer() {
    let found = pieces(|program, x| program.apply(Operation::Floor, &[x]), interval(0.5, 2.5));
    assert_eq!(found, [0.0, 1.0, 2.0].map(Interval::point));
    let wide = pieces(|program, x| program.apply(Operation::Floor, &[x]), interval(0.5, 1e9));
    assert_eq!(wide, [interval(0.0, 1e9)]);
}

#[test]
fn a_remainder_has_a_piece_on_either_side_of_its_jump() {
    let remainder = |program: &mut Program, x| {
        let one = program.literal(1.0);
        program.apply(Operation::Modulo, &[x, one])
    };
    let found = pieces(remainder, interval(0.75, 1.25));
    assert_eq!(found.len(), 2);
    assert!(hold(&found, 0.75) && hold(&found, 0.25) && hold(&found, 0.0) && !hold(&found, 0.5));
}

#[test]
fn a_tangent_has_a_piece_on_either_side_of_its_pole() {
    let found = pieces(|program, x| program.apply(Operation::Tan, &[x]), interval(1.5, 1.7));
    assert_eq!(found.len(), 2);
    assert!(hold(&found, 1.5f64.tan()) && hold(&found, 1.7f64.tan()) && !hold(&found, 0.0));
}

#[test]
fn an_angle_has_a_piece_on_either_side_of_its_cut() {
    let angle = |program: &mut Program, x| {
        let left = program.literal(-1.0);
        program.apply(Operation::Atan2, &[x, left])
    };
    let found = pieces(angle, interval(-0.5, 0.5));
    assert_eq!(found.len(), 2);
    for y in [-0.5, -0.1, 0.0, 0.5f64] {
        assert!(hold(&found, y.atan2(-1.0)));
    }
    assert!(!hold(&found, 0.0) && !hold(&found, 2.0));
}

#[test]
fn choices_by_one_condition_go_together() {
    // if(x < 0, 1, 2)·if(x < 0, 10, 20) is 10 or 40, never 20.
    let product = |program: &mut Program, x| {
        let [zero, one, two, ten, twenty] = [0.0, 1.0, 2.0, 10.0, 20.0].map(|value| program.literal(value));
        let negative = program.apply(Operation::Less, &[x, zero]);
        let small = program.apply(Operation::Select, &[negative, one, two]);
        let large = program.apply(Operation::Select, &[negative, ten, twenty]);
        program.apply(Operation::Multiply, &[small, large])
    };
    let found = pieces(product, interval(-1.0, 1.0));
    assert!(hold(&found, 10.0) && hold(&found, 40.0) && !hold(&found, 20.0));
}

#[test]
fn a_branch_that_is_nowhere_defined_is_empty() {
    // √(if(x < 0, −1, 4))
    let root = |program: &mut Program, x| {
        let [zero, negative, four] = [0.0, -1.0, 4.0].map(|value| program.literal(value));
        let condition = program.apply(Operation::Less, &[x, zero]);
        let radicand = program.apply(Operation::Select, &[condition, negative, four]);
        program.apply(Operation::SquareRoot, &[radicand])
    };
    let found = pieces(root, interval(-1.0, 1.0));
    assert_eq!(found.len(), 2);
    assert!(found.iter().any(|piece| piece.is_empty()) && hold(&found, 2.0));
}

/// The operations with poles, jumps, cuts or edges, among a few without.
const BRANCHING: [Operation; 20] = [
    Operation::Add,
    Operation::Subtract,
    Operation::Multiply,
    Operation::Divide,
    Operation::Divide,
    Operation::Absolute,
    Operation::Minimum,
    Operation::SquareRoot,
    Operation::Ln,
    Operation::Tan,
    Operation::Atan2,
    Operation::Sign,
    Operation::Floor,
    Operation::Round,
    Operation::Modulo,
    Operation::Less,
    Operation::LessOrEqual,
    Operation::Equal,
    Operation::Select,
    Operation::IntegerPower,
];

/// Boxes with more pieces than this are left out.
const PIECES: usize = 512;

#[test]
fn the_value_at_each_point_of_a_box_lies_in_a_piece() {
    let mut random = Random::new(11);
    let (mut compared, mut branched) = (0, 0);
    for number in 0..3000 {
        let operations = 1 + random.below(8);
        let program = random.program_of(operations, &BRANCHING).simplified();
        let domain = [0, 1, 2].map(|_| {
            let lo = random.coordinate();
            Interval::new(lo, lo + random.between(0.0, 1.0)).expect("the ends are in order")
        });
        let pieces: Vec<Interval> = program.pieces(domain).take(PIECES).collect();
        if pieces.len() == PIECES {
            continue;
        }
        branched += usize::from(pieces.len() > 1);
        let kernel = Interpreter.boxes(&program).expect("the interpreter takes every program");
        for _ in 0..20 {
            let point = domain.map(|interval| random.inside(interval));
            let ends = point.map(|coordinate| [coordinate]);
            let (mut lo, mut hi, mut decoration) = ([0.0], [0.0], [Decoration::Trivial]);
            let slices = ends.each_ref().map(|end| &end[..]);
            kernel.evaluate(
                &mut Scratch::default(),
                Boxes { lo: slices, hi: slices },
                Enclosures { lo: &mut lo, hi: &mut hi, decoration: &mut decoration },
            );
            // Where it may be undefined there may be no value to hold.
            if decoration[0] >= Decoration::Defined {
                let value = Interval { lo: lo[0], hi: hi[0] };
                let held = pieces.iter().any(|piece| !piece.intersection(value).is_empty());
                assert!(
                    held,
                    "program {number} at {point:?} is in {value}, its pieces are {pieces:?}\n{program}"
                );
                compared += 1;
            }
        }
    }
    assert!(
        compared > 20_000 && branched > 500,
        "{compared} values and {branched} branched programs compared"
    );
}
