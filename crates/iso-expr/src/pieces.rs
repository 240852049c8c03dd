//! Enclosures piece by piece: what a program may give on either side of its poles, jumps and edges.
//!
//! Over a box with a pole of 1/x inside, the interval extension of 1/x is all of ℝ, although no value near zero is ever
//! taken. Following each branch of such a step by itself keeps that knowledge: 1/x gives one unbounded interval for x < 0
//! and another for x > 0, a floor gives each of its integers, a comparison holds or does not. The values of the program
//! on the box, wherever it is defined there, lie in the union of all pieces. This is the arithmetic of unions of
//! intervals (Hansen and Walster, Global Optimization Using Interval Analysis, 2004, chapter 4).

use crate::{Decorated, Decoration, Interval, Node, NodeId, Operation, Program};

/// The pieces of a program's first output over a box, one for each way through its branches. Their number can grow
/// exponentially with the number of branching steps: take no more than you can pay for, each is one evaluation.
#[derive(Debug)]
pub struct Pieces<'a> {
    program: &'a Program,
    domain: [Interval; 3],
    values: Vec<Decorated>,
    /// Which branch is followed at each branching step met so far; `None` when every way has been followed.
    way: Option<Vec<Branch>>,
}

/// The branch followed at one step.
#[derive(Clone, Copy, Debug)]
struct Branch {
    taken: usize,
    count: usize,
}

impl Program {
    /// The pieces of the first output over the box `domain`. A piece is empty where the program is undefined on its
    /// branch.
    pub fn pieces(&self, domain: [Interval; 3]) -> Pieces<'_> {
        Pieces {
            program: self,
            domain,
            values: Vec::with_capacity(self.nodes().len()),
            way: Some(Vec::new()),
        }
    }
}

impl Iterator for Pieces<'_> {
    type Item = Interval;

    fn next(&mut self) -> Option<Interval> {
        let mut fork = Fork { way: self.way.take()?, depth: 0 };
        self.values.clear();
        for node in self.program.nodes() {
            let value = match *node {
                Node::Variable(argument) => common(self.domain[argument.index()]),
                Node::Constant(constant) => common(constant.enclosure()),
                Node::Apply(operation, operands) => fork.apply(operation, operands, &self.values),
            };
            self.values.push(value);
        }
        self.way = following(fork.way);
        Some(self.values[self.program.outputs()[0].index()].interval)
    }
}

/// The next way in the order of an odometer, or `None` after the last one.
fn following(mut way: Vec<Branch>) -> Option<Vec<Branch>> {
    while let Some(last) = way.last_mut() {
        last.taken += 1;
        if last.taken < last.count {
            return Some(way);
        }
        way.pop();
    }
    None
}

/// One evaluation's way through the branches.
struct Fork {
    way: Vec<Branch>,
    depth: usize,
}

/// Steps with more branches than this are not followed branch by branch: they keep their plain enclosure.
const WIDEST_FORK: usize = 4;

impl Fork {
    /// The branch to follow here, of `count`.
    fn choose(&mut self, count: usize) -> usize {
        if self.depth == self.way.len() {
            self.way.push(Branch { taken: 0, count });
        }
        self.depth += 1;
        self.way[self.depth - 1].taken
    }

    fn apply(&mut self, operation: Operation, operands: [NodeId; 3], values: &[Decorated]) -> Decorated {
        let [a, b, c] = operands.map(|operand| values[operand.index()]);
        match operation {
            Operation::Divide => self.divide(a, b),
            Operation::Modulo => self.modulo(a, b),
            Operation::Tan => self.tan(a),
            Operation::Atan2 => self.atan2(a, b),
            Operation::Select => self.select(a, b, c),
            Operation::Sign
            | Operation::Floor
            | Operation::Ceil
            | Operation::Round
            | Operation::Truncate
            | Operation::Less
            | Operation::LessOrEqual
            | Operation::Equal => self.step(operation.extension().of([a, b, c])),
            _ => operation.extension().of([a, b, c]),
        }
    }

    /// Quotients by the divisors below and above zero.
    fn divide(&mut self, a: Decorated, b: Decorated) -> Decorated {
        let Interval { lo, hi } = b.interval;
        let divisor = if lo < 0.0 && hi > 0.0 {
            [Interval { lo, hi: 0.0 }, Interval { lo: 0.0, hi }][self.choose(2)]
        } else {
            b.interval
        };
        binary(Operation::Divide, a, common(divisor))
    }

    /// Each integer of a function that takes no other values.
    fn step(&mut self, values: Decorated) -> Decorated {
        let Interval { lo, hi } = values.interval;
        if lo < hi && hi - lo < WIDEST_FORK as f64 {
            let count = (hi - lo) as usize + 1;
            common(Interval::point(lo + self.choose(count) as f64))
        } else {
            values
        }
    }

    /// a − b·⌊a/b⌋ for each value of the floor.
    fn modulo(&mut self, a: Decorated, b: Decorated) -> Decorated {
        let remainder = binary(Operation::Modulo, a, b);
        if b.interval.contains_zero() {
            return remainder;
        }
        let quotient = binary(Operation::Divide, a, b);
        let turns = self.step(unary(Operation::Floor, quotient));
        let shifted = binary(Operation::Subtract, a, binary(Operation::Multiply, b, turns));
        common(remainder.interval.intersection(shifted.interval))
    }

    /// Up to a pole and on from it.
    fn tan(&mut self, a: Decorated) -> Decorated {
        /// Below π, so that an interval no wider holds no more than one pole.
        const ONE_POLE: f64 = 3.0;
        let plain = unary(Operation::Tan, a);
        let Interval { lo, hi } = a.interval;
        if plain.interval != Interval::ENTIRE || hi - lo > ONE_POLE {
            return plain;
        }
        let end = |end| unary(Operation::Tan, common(Interval::point(end))).interval;
        common(match self.choose(2) {
            0 => Interval { lo: end(lo).lo, hi: f64::INFINITY },
            _ => Interval { lo: f64::NEG_INFINITY, hi: end(hi).hi },
        })
    }

    /// On either side of the cut along the negative half of the axis of `b`.
    fn atan2(&mut self, a: Decorated, b: Decorated) -> Decorated {
        let Interval { lo, hi } = a.interval;
        if !(lo < 0.0 && hi >= 0.0 && b.interval.lo < 0.0) {
            return binary(Operation::Atan2, a, b);
        }
        match self.choose(2) {
            0 => binary(Operation::Atan2, common(Interval { lo: 0.0, hi }), b),
            _ => {
                let mirrored = binary(Operation::Atan2, common(Interval { lo: 0.0, hi: -lo }), b);
                unary(Operation::Negate, mirrored)
            }
        }
    }

    /// Either choice, where the condition may hold or not.
    fn select(&mut self, condition: Decorated, then: Decorated, otherwise: Decorated) -> Decorated {
        let Interval { lo, hi } = condition.interval;
        if lo == hi || !condition.interval.contains_zero() {
            return Operation::Select.extension().of([condition, then, otherwise]);
        }
        [then, otherwise][self.choose(2)]
    }
}

/// Decorations do not matter in a piece, which may be anything on the rest of the box.
fn common(interval: Interval) -> Decorated {
    Decorated { interval, decoration: Decoration::Common }
}

fn unary(operation: Operation, a: Decorated) -> Decorated {
    operation.extension().of([a; 3])
}

fn binary(operation: Operation, a: Decorated, b: Decorated) -> Decorated {
    operation.extension().of([a, b, b])
}

#[cfg(test)]
mod tests;
