//! What holds of any program over any boxes: its values at points of a box lie in the enclosure over that box.

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{
    Axis, Decorated, Decoration, Engine, Interpreter, Interval, Node, NodeId, Operation, Program, Scratch,
};

/// What the interpreter's box kernel gives for the program's outputs, box by box.
pub(crate) fn enclose(
    program: &Program,
    scratch: &mut Scratch,
    boxes: &[[Interval; 3]],
) -> Vec<Vec<Decorated>> {
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
pub(crate) fn enclosures_hold_values(random: &mut Random, scratch: &mut Scratch, program: &Program) -> usize {
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
