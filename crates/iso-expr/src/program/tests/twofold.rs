//! Nearly exact values of programs, for tests.

use crate::{Node, Operation, Program};

/// A number held as the sum of two doubles (Dekker, A floating-point technique for extending the available precision,
/// Numerische Mathematik 18, 1971): some 106 bits, next to which the rounding of doubles is coarse.
#[derive(Clone, Copy)]
pub(in crate::program) struct Twofold(pub(in crate::program) f64, pub(in crate::program) f64);

impl Twofold {
    /// The exact sum of two doubles.
    pub(in crate::program) fn of_sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let of_b = sum - a;
        Self(sum, (a - (sum - of_b)) + (b - of_b))
    }

    pub(in crate::program) fn plus(self, other: Self) -> Self {
        let Self(sum, rest) = Self::of_sum(self.0, other.0);
        let Self(low, least) = Self::of_sum(self.1, other.1);
        let Self(sum, rest) = Self::of_sum(sum, rest + low);
        Self::of_sum(sum, rest + least)
    }

    pub(in crate::program) fn negated(self) -> Self {
        Self(-self.0, -self.1)
    }

    pub(in crate::program) fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product) + (self.0 * other.1 + self.1 * other.0);
        Self::of_sum(product, rest)
    }

    pub(in crate::program) fn over(self, other: Self) -> Self {
        let mut quotient = Self(self.0 / other.0, 0.0);
        for _ in 0..2 {
            let rest = self.plus(quotient.times(other).negated());
            quotient = quotient.plus(Self(rest.0 / other.0, 0.0));
        }
        quotient
    }

    pub(in crate::program) fn root(self) -> Self {
        let root = Self(self.0.sqrt(), 0.0);
        if root.0 == 0.0 { root } else { root.plus(self.over(root)).times(Self(0.5, 0.0)) }
    }

    pub(in crate::program) fn is_below(self, other: Self) -> bool {
        self.0 < other.0 || self.0 == other.0 && self.1 < other.1
    }
}

/// The operations that [`exact`] knows.
pub(in crate::program) const ARITHMETIC: [Operation; 10] = [
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

/// The program's outputs at `point`, nearly exactly.
pub(in crate::program) fn exact(program: &Program, point: [f64; 3]) -> Vec<Twofold> {
    let mut values: Vec<Twofold> = Vec::new();
    for node in program.nodes() {
        let value = match node {
            Node::Variable(argument) => Twofold(point[argument.index()], 0.0),
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
    program.outputs().iter().map(|output| values[output.index()]).collect()
}
