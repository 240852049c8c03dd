//! Tests that hold every operation of the table to what an interval extension must be.

mod containment;
mod decorations;
mod shape;

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Decorated, Decoration, Interval};
use crate::Operation;
use crate::random::Random;

/// The operations' operands are triples, of which only as many count as the arity.
type Box3 = [Decorated; 3];
type Point3 = [f64; 3];

fn extend(operation: Operation, operands: Box3) -> Decorated {
    operation.extension().of(operands)
}

/// The operation's value: the real one, rounded to nearest.
fn nearest(operation: Operation, operands @ [a, b, _]: Point3) -> f64 {
    match operation {
        // Multiplied out, a power is not the nearest double.
        Operation::IntegerPower => core_math::pow(a, b),
        _ => operation.value().of(operands),
    }
}

/// Operands of all sorts: those of [`Random::argument`], and boxes about the places where operations jump, turn or end.
fn random_box(random: &mut Random, operation: Operation) -> Box3 {
    let mut operands = [(); 3].map(|()| match random.below(3) {
        0 => critical_argument(random),
        _ => random.argument(),
    });
    if operation == Operation::IntegerPower {
        let exponent = match random.below(3) {
            0 => random.below(Operation::LARGEST_POWER as usize - 1) + 2,
            _ => random.below(6) + 2,
        };
        operands[1] = Decorated::constant(Interval::point(exponent as f64));
    }
    operands
}

/// A box that begins, ends or is centred at a multiple of π/2, an integer or a half, a power of two of any size, or 1.
fn critical_argument(random: &mut Random) -> Decorated {
    let power_of_two = 2f64.powi(random.below(2100) as i32 - 1074);
    let sign = random.choose(&[-1.0, 1.0]);
    let place = sign
        * match random.below(6) {
            0 => random.below(20) as f64 * FRAC_PI_2,
            1 => random.between(0.0, 1e6).floor() * FRAC_PI_2,
            2 => random.between(0.0, 1e15).floor() * PI,
            3 => random.below(20) as f64 / 2.0,
            4 => power_of_two,
            _ => 1.0,
        };
    let width = match random.below(5) {
        0 => 0.0,
        1 => place.abs().next_up() - place.abs(),
        2 => random.between(0.0, 1e-6),
        3 => random.between(0.0, 8.0),
        _ => place.abs() * random.between(0.0, 2.0),
    };
    match random.below(3) {
        0 => Decorated::argument(place, place + width),
        1 => Decorated::argument(place - width, place),
        _ => Decorated::argument(place - width, place + width),
    }
}

/// One point in each operand. A real zero has no sign.
fn random_point(random: &mut Random, operands: Box3) -> Point3 {
    operands.map(|operand| random.inside(operand.interval) + 0.0)
}

/// A box inside each operand.
fn random_part(random: &mut Random, operands: Box3) -> Box3 {
    operands.map(|operand| match random.below(4) {
        0 => operand,
        1 => Decorated::constant(Interval::point(random.inside(operand.interval))),
        2 => Decorated::argument(operand.interval.lo, random.inside(operand.interval)),
        _ => {
            let (p, q) = (random.inside(operand.interval), random.inside(operand.interval));
            Decorated::argument(p.min(q), p.max(q))
        }
    })
}

fn has_empty(operation: Operation, operands: Box3) -> bool {
    operands[..operation.arity()].iter().any(|operand| operand.interval.is_empty())
}

/// The operation with its operands, for messages.
fn show(operation: Operation, operands: Box3) -> String {
    let operands = operands[..operation.arity()].iter().map(|operand| format!(" {}", operand.interval));
    format!("{operation:?}{}", operands.collect::<String>())
}
