use crate::engine::{Boxes, Enclosures};
use crate::random::Random;
use crate::{Axis, Decorated, Decoration, Engine, Interpreter, Interval, Node, Operation, Program, Scratch};

/// A number held as the sum of two doubles (Dekker, A floating-point technique for extending the available precision,
/// Numerische Mathematik 18, 1971): some 106 bits, next to which the rounding of doubles is coarse.
#[derive(Clone, Copy)]
struct Twofold(f64, f64);

impl Twofold {
    /// The exact sum of two doubles.
    fn of_sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let of_b = sum - a;
        Self(sum, (a - (sum - of_b)) + (b - of_b))
    }

    fn plus(self, other: Self) -> Self {
        let Self(sum, rest) = Self::of_sum(self.0, other.0);
        let Self(low, least) = Self::of_sum(self.1, other.1);
        let Self(sum, rest) = Self::of_sum(sum, rest + low);
        Self::of_sum(sum, rest + least)
    }

    fn negated(self) -> Self {
        Self(-self.0, -self.1)
    }

    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product) + (self.0 * other.1 + self.1 * other.0);
        Self::of_sum(product, rest)
    }

    fn over(self, other: Self) -> Self {
        let mut quotient = Self(self.0 / other.0, 0.0);
        for _ in 0..2 {
            let rest = self.plus(quotient.times(other).negated());
            quotient = quotient.plus(Self(rest.0 / other.0, 0.0));
        }
        quotient
    }

    fn root(self) -> Self {
        let root = Self(self.0.sqrt(), 0.0);
        if root.0 == 0.0 { root } else { root.plus(self.over(root)).times(Self(0.5, 0.0)) }
    }

    fn is_below(self, other: Self) -> bool {
        self.0 < other.0 || self.0 == other.0 && self.1 < other.1
    }
}

const ARITHMETIC: [Operation; 10] = [
    Operation::Add,
    Operation::Subtract,
    Operation::Multiply,
    Operation::Divide,
    Operation::SquareRoot,
    Operation::IntegerPower,
    Operation::Negate,
    Operation::Absolute,
    Operation::Minimum,
    Operation::Maximum,
];

/// The program's output at `point`, nearly exactly.
fn exact(program: &Program, point: [f64; 3]) -> Twofold {
    let mut values: Vec<Twofold> = Vec::new();
    for node in program.nodes() {
        let value = match node {
            Node::Variable(axis) => Twofold(point[*axis as usize], 0.0),
            Node::Constant(constant) => Twofold(constant.value(), 0.0),
            Node::Apply(operation, operands) => {
                let [a, b, _] = operands.map(|operand| values[operand.index()]);
                match operation {
                    Operation::Add => a.plus(b),
                    Operation::Subtract => a.plus(b.negated()),
                    Operation::Multiply => a.times(b),
                    Operation::Divide => a.over(b),
                    Operation::SquareRoot => a.root(),
                    Operation::IntegerPower => (1..b.0 as u32).fold(a, |power, _| power.times(a)),
                    Operation::Negate => a.negated(),
                    Operation::Absolute if a.0 < 0.0 => a.negated(),
                    Operation::Absolute => a,
                    Operation::Minimum if a.is_below(b) => a,
                    Operation::Maximum if b.is_below(a) => a,
                    Operation::Minimum | Operation::Maximum => b,
                    _ => unreachable!("only arithmetic is drawn"),
                }
            }
        };
        values.push(value);
    }
    values[program.outputs()[0].index()]
}

fn enclose(program: &Program, sides: [Interval; 3]) -> Vec<Decorated> {
    let (lo, hi) = (sides.map(|side| [side.lo]), sides.map(|side| [side.hi]));
    let count = program.outputs().len();
    let (mut low, mut high, mut decoration) =
        (vec![0.0; count], vec![0.0; count], vec![Decoration::Trivial; count]);
    Interpreter.boxes(program).unwrap().evaluate(
        &mut Scratch::default(),
        Boxes { lo: lo.each_ref().map(|end| &end[..]), hi: hi.each_ref().map(|end| &end[..]) },
        Enclosures { lo: &mut low, hi: &mut high, decoration: &mut decoration },
    );
    let found = |place: usize| Decorated {
        interval: Interval { lo: low[place], hi: high[place] },
        decoration: decoration[place],
    };
    (0..count).map(found).collect()
}

/// The bound over a box; `None` where there is none.
fn bound(program: &Program, sides: [Interval; 3]) -> Option<f64> {
    let outputs = enclose(&program.with_rounding(), sides);
    let is_known = outputs[0].decoration == Decoration::Common
        && outputs.iter().all(|output| output.decoration >= Decoration::Defined);
    let bound = outputs[1].interval.hi * Program::ROUNDING_UNIT * (1.0 + 1e-12);
    (is_known && bound.is_finite()).then_some(bound)
}

/// How large a part of the bound the rounding at some points is, at most.
fn check(program: &Program, sides: [Interval; 3], random: &mut Random) -> Option<f64> {
    let bound = bound(program, sides)?;
    let mut largest: f64 = 0.0;
    for _ in 0..30 {
        let point = sides.map(|side| random.between(side.lo, side.hi));
        let Twofold(exact, rest) = exact(program, point);
        if exact.is_nan() {
            continue; // Products of doubles near the largest are too large for two.
        }
        let error = ((program.evaluate(point)[0] - exact) - rest).abs();
        assert!(error <= bound, "off by {error}, not {bound}, at {point:?} of\n{program}");
        if bound > 0.0 {
            largest = largest.max(error / bound);
        }
    }
    Some(largest)
}

fn sides(random: &mut Random, width: f64) -> [Interval; 3] {
    [(); 3].map(|()| {
        let lo = random.between(-3.0, 3.0);
        Interval { lo, hi: lo + width }
    })
}

#[test]
fn no_rounding_is_larger_than_the_bound() {
    let mut random = Random::new(7);
    let mut compared = 0;
    for round in 0..4000 {
        let program = random.program_of(1 + round % 25, &ARITHMETIC);
        let program = if program.outputs().len() == 1 { program } else { continue };
        let sides = sides(&mut random, [0.0, 1e-3, 0.1][round % 3]);
        compared += usize::from(check(&program, sides, &mut random).is_some());
    }
    assert!(compared > 1000, "only {compared} programs were compared");
}

#[test]
fn the_bound_of_one_operation_is_nearly_reached() {
    let mut random = Random::new(8);
    for operation in [Operation::Add, Operation::Subtract, Operation::Multiply, Operation::Divide] {
        let mut program = Program::new();
        let [x, y, _] = Axis::ALL.map(|axis| program.variable(axis));
        let output = program.apply(operation, &[x, y]);
        program.set_outputs(vec![output]);
        let shares = (0..40).filter_map(|_| {
            let sides = sides(&mut random, 1e-3);
            check(&program, sides, &mut random)
        });
        let largest = shares.fold(0.0, f64::max);
        assert!(largest > 0.6, "{operation:?} reaches {largest} of its bound");
    }
}

#[test]
fn every_operation_that_rounds_counts_with_its_size() {
    let mut random = Random::new(9);
    for operation in Operation::all().filter(|operation| *operation != Operation::IntegerPower) {
        let mut program = Program::new();
        let operands = Axis::ALL.map(|axis| program.variable(axis));
        let output = program.apply(operation, &operands[..operation.arity()]);
        program.set_outputs(vec![output]);
        for _ in 0..50 {
            let point = [(); 3].map(|()| random.between(0.1, 0.9));
            let value = program.evaluate(point)[0];
            let Some(bound) = bound(&program, point.map(Interval::point)) else { continue };
            // Only what picks an operand or gives an integer may be free of rounding.
            let is_exact = value == value.round() || point.contains(&value) || point.contains(&-value);
            let counts = bound >= Program::ROUNDING_UNIT * value.abs();
            assert!(
                counts || is_exact && bound == 0.0,
                "{operation:?} at {point:?} is off by {bound} at most"
            );
        }
    }
}

#[test]
fn a_constant_that_is_no_double_counts_with_what_it_is_off() {
    let mut program = Program::new();
    let pi = program.constant(crate::Constant::PI);
    program.set_outputs(vec![pi]);
    let bound = bound(&program, [Interval::point(0.0); 3]).unwrap();
    // π − its double.
    assert!((1.2246467991473532e-16..1e-15).contains(&bound), "{bound}");
}
