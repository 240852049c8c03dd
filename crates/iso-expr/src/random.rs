//! Random programs and arguments from a seed, for tests, fuzzing and stress runs.
//!
//! The same seed gives the same sequence on every machine. Operations are drawn from [`Operation::all`], so that a new one
//! is tested as soon as it stands in the table.

use std::vec::IntoIter;

use crate::{Axis, Decorated, Interval, NodeId, Operation, Program};

/// Doubles at which arithmetic changes its ways.
const SPECIAL: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    f64::EPSILON,
    1.0 - f64::EPSILON / 2.0,
    std::f64::consts::PI,
    std::f64::consts::FRAC_PI_2,
    9_007_199_254_740_992.0,
];

/// Constants as they stand in formulas, of which much can be simplified.
const SIMPLE: [f64; 12] = [0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0, 0.5, 0.25, 10.0];

/// By how much the generator's state grows with each number: 2⁶⁴ over the golden ratio, made odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// A generator of pseudo-random numbers: SplitMix64 (Steele, Lea and Flood, 'Fast splittable pseudorandom number
/// generators', 2014).
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
    choices: IntoIter<u16>,
}

impl Random {
    /// The generator whose sequence `seed` determines.
    pub fn new(seed: u64) -> Self {
        Self { state: seed, choices: Vec::new().into_iter() }
    }

    /// The generator whose first numbers `bytes` determine, two bytes for each, so that a fuzzer that changes a byte changes
    /// one choice.
    pub fn led_by(bytes: &[u8]) -> Self {
        let choices: Vec<u16> = bytes.as_chunks().0.iter().map(|&pair| u16::from_le_bytes(pair)).collect();
        Self { choices: choices.into_iter(), ..Self::new(0) }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = match self.choices.next() {
            Some(choice) => u64::from(choice).wrapping_mul(STEP),
            None => self.state.wrapping_add(STEP),
        };
        let mut bits = self.state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// An integer from 0 to `bound` − 1, all about equally likely. `bound` is positive.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    /// A double from `lo` to `hi`, all stretches of one length about equally likely.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 * (f64::EPSILON / 2.0);
        lo + (hi - lo) * unit
    }

    /// One of `choices`.
    pub fn choose<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// Any double: ordinary, huge, tiny, subnormal, infinite, NaN, a zero of either sign, an integer or a half, or one of
    /// their neighbours.
    pub fn double(&mut self) -> f64 {
        match self.below(10) {
            0..3 => self.between(-4.0, 4.0),
            3 => self.between(-1.0, 1.0) * self.between(-9.0, 9.0).exp2(),
            4 => self.below(41) as f64 / 2.0 - 10.0,
            5 => f64::from_bits(self.bits()),
            6 => self.between(-1.0, 1.0) * self.between(-330.0, 0.0).exp2().powi(3),
            7 => self.between(-1.0, 1.0) * self.between(0.0, 330.0).exp2().powi(3),
            8 => self.choose(&SPECIAL),
            _ => {
                let center = self.below(9) as f64 - 4.0;
                let center = if self.below(2) == 0 { center } else { self.choose(&SPECIAL) };
                if self.below(2) == 0 { center.next_up() } else { center.next_down() }
            }
        }
    }

    /// An ordinary double, of the size that coordinates have.
    pub fn coordinate(&mut self) -> f64 {
        if self.below(4) == 0 { self.below(17) as f64 / 4.0 - 2.0 } else { self.between(-2.0, 2.0) }
    }

    /// An argument's range: one point, thin, ordinary, wide, huge, unbounded, straddling zero, ending at zero, empty.
    pub fn argument(&mut self) -> Decorated {
        let center = self.coordinate();
        let (a, b) = match self.below(12) {
            0 => (center, center),
            1 => (center, center.next_up()),
            2 => (center, center + self.between(0.0, 1e-9)),
            3..6 => (center, center + self.between(0.0, 1.0)),
            6 => (self.between(-100.0, 0.0), self.between(0.0, 100.0)),
            7 => (f64::NEG_INFINITY, center),
            8 => (center, f64::INFINITY),
            9 => (0.0, center),
            10 => (self.double(), self.double()),
            _ => self.choose(&[
                (f64::NEG_INFINITY, f64::INFINITY),
                (f64::MIN, f64::MAX),
                (-0.0, 0.0),
                (f64::NAN, f64::NAN),
                (f64::MAX, f64::INFINITY),
            ]),
        };
        Decorated::argument(a.min(b), a.max(b))
    }

    /// A double inside `interval`, which is not empty: an end, zero, or anything between.
    pub fn inside(&mut self, interval: Interval) -> f64 {
        let (lo, hi) = (interval.lo.max(f64::MIN), interval.hi.min(f64::MAX));
        let value = match self.below(8) {
            0 => lo,
            1 => hi,
            2 => 0.0,
            3 => self.double(),
            4 => self.coordinate(),
            _ => {
                // The width of the widest interval overflows.
                let share = self.between(0.0, 1.0);
                lo * (1.0 - share) + hi * share
            }
        };
        if value.is_nan() { lo } else { value.clamp(lo, hi) }
    }

    /// A program with one output and about `operations` operations, of any kind.
    pub fn program(&mut self, operations: usize) -> Program {
        self.program_of(operations, &Operation::all().collect::<Vec<_>>())
    }

    /// A program with one output and about `operations` operations, each one of `allowed`.
    pub fn program_of(&mut self, operations: usize, allowed: &[Operation]) -> Program {
        let mut program = Program::new();
        let mut nodes: Vec<NodeId> = Axis::ALL.map(|axis| program.variable(axis)).to_vec();
        for _ in 0..operations {
            let operation = self.choose(allowed);
            let node = self.application(&mut program, &nodes, operation);
            nodes.push(node);
        }
        program.set_outputs(vec![nodes[nodes.len() - 1]]);
        program
    }

    /// A program that computes `width` different values before it uses the first of them, so that no machine has enough
    /// registers.
    pub fn wide_program(&mut self, width: usize) -> Program {
        let mut program = Program::new();
        let variables = Axis::ALL.map(|axis| program.variable(axis));
        let mut values = Vec::with_capacity(width);
        for place in 0..width {
            let shift = program.literal(place as f64 + 0.5);
            let operation = self.choose(&[Operation::Add, Operation::Multiply, Operation::Maximum]);
            values.push(program.apply(operation, &[variables[place % 3], shift]));
        }
        let mut total = values[0];
        for value in values {
            let operation = self.choose(&[Operation::Subtract, Operation::Divide, Operation::Minimum]);
            total = program.apply(operation, &[value, total]);
        }
        program.set_outputs(vec![total]);
        program
    }

    /// Adds `operation` to `program`, on some of `nodes`, which are not empty, and on constants.
    pub fn application(&mut self, program: &mut Program, nodes: &[NodeId], operation: Operation) -> NodeId {
        if operation == Operation::IntegerPower {
            let base = self.operand(program, nodes);
            let exponents = [2, 3, 4, 5, 6, 7, 8, 15, 100, Operation::LARGEST_POWER];
            return program.integer_power(base, self.choose(&exponents));
        }
        let operands: Vec<_> = (0..operation.arity()).map(|_| self.operand(program, nodes)).collect();
        program.apply(operation, &operands)
    }

    /// A constant, or a node, the latest ones rather than the early ones.
    fn operand(&mut self, program: &mut Program, nodes: &[NodeId]) -> NodeId {
        match self.below(8) {
            0 => {
                let constant = match self.below(5) {
                    0..3 => self.choose(&SIMPLE),
                    3 => self.coordinate(),
                    _ => self.double(),
                };
                program.literal(constant)
            }
            1..4 => nodes[self.below(nodes.len())],
            _ => nodes[nodes.len() - 1 - self.below(nodes.len().min(5))],
        }
    }
}
