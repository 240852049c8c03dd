//! The rules of simplification.
//!
//! Each holds in IEEE 754 arithmetic to the last bit, for infinities, signed zeros and undefined values too, and for real
//! numbers. That is why some that one would expect are missing: x + 0 is +0 where x is −0, x − x is undefined where x is
//! infinite, 0·x is −0 for negative x, and −(x − y) and y − x differ in sign where they are zero.

use super::{Simplifier, fold};
use crate::{Constant, Interval, Node, NodeId, Operation};

/// Rewrites applications of one operation.
pub(super) struct Rule {
    /// What the rule rewrites, as a formula: one instance, with numbers in the place of constants.
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "it documents the rule, and the tests hold the rule to it")
    )]
    pub(super) given: &'static str,
    /// What it gives, as a formula.
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "it documents the rule, and the tests hold the rule to it")
    )]
    pub(super) simpler: &'static str,
    /// What the operation is on these operands, if the rule applies to them. Commutative operations have their constant
    /// operand first.
    pub(super) apply: fn(&mut Simplifier<'_>, [NodeId; 3]) -> Option<NodeId>,
}

macro_rules! rules {
    ($($operation:ident { $($given:literal is $simpler:literal: $apply:expr;)* })*) => {
        /// The rules for `operation`, in the order in which they are tried.
        pub(super) fn of(operation: Operation) -> &'static [Rule] {
            match operation {
                $(Operation::$operation => &[$(Rule { given: $given, simpler: $simpler, apply: $apply }),*],)*
                _ => &[],
            }
        }
    };
}

rules! {
    Add {
        "-0 + x" is "x": |s, [a, b, _]| s.is(a, -0.0).then_some(b);
        "x + x" is "2x": |s, [a, b, _]| (a == b).then(|| s.scaled(2.0, a));
        "(-x) + y" is "y - x": |s, [a, b, _]| s.negated(a).map(|x| s.apply(Operation::Subtract, &[b, x]));
        "x + (-y)" is "x - y": |s, [a, b, _]| s.negated(b).map(|y| s.apply(Operation::Subtract, &[a, y]));
        "-3 + x" is "x - 3": |s, [a, b, _]| s.minus_negative(a).map(|c| s.apply(Operation::Subtract, &[b, c]));
    }
    Subtract {
        "x - 0" is "x": |s, [a, b, _]| s.is(b, 0.0).then_some(a);
        "-0 - x" is "-x": |s, [a, b, _]| s.is(a, -0.0).then(|| s.apply(Operation::Negate, &[b]));
        "x - (-y)" is "x + y": |s, [a, b, _]| s.negated(b).map(|y| s.apply(Operation::Add, &[a, y]));
        "x - (-3)" is "x + 3": |s, [a, b, _]| s.minus_negative(b).map(|c| s.apply(Operation::Add, &[a, c]));
    }
    Multiply {
        "1 * x" is "x": |s, [a, b, _]| s.is(a, 1.0).then_some(b);
        "-1 * x" is "-x": |s, [a, b, _]| s.is(a, -1.0).then(|| s.apply(Operation::Negate, &[b]));
        "x * x" is "x^2": |s, [a, b, _]| (a == b).then(|| s.power(a, 2));
        "x^3 * x^4" is "x^7": |s, [a, b, _]| s.joined_powers(a, b);
        "5 * (2x)" is "10x": |s, [a, b, _]| s.joined_factors(a, b);
        "3 * (-x)" is "-3 * x": |s, [a, b, _]| s.sign_into_first(Operation::Multiply, a, b);
        "(-x) * y" is "-(x * y)": |s, [a, b, _]| s.sign_of_first(Operation::Multiply, a, b);
        "x * (-y)" is "-(x * y)": |s, [a, b, _]| s.sign_of_second(Operation::Multiply, a, b);
    }
    Divide {
        "x / 8" is "0.125x": |s, [a, b, _]| s.reciprocal(b).map(|factor| s.scaled(factor, a));
        "3 / (-x)" is "-3 / x": |s, [a, b, _]| s.sign_into_first(Operation::Divide, a, b);
        "(-x) / 3" is "x / (-3)": |s, [a, b, _]| s.sign_into_second(Operation::Divide, a, b);
        "(-x) / y" is "-(x / y)": |s, [a, b, _]| s.sign_of_first(Operation::Divide, a, b);
        "x / (-y)" is "-(x / y)": |s, [a, b, _]| s.sign_of_second(Operation::Divide, a, b);
    }
    Negate {
        "-(-x)" is "x": |s, [a, ..]| s.negated(a);
        "-(3x)" is "-3 * x": |s, [a, ..]| s.minus_into_first(Operation::Multiply, a);
        "-(3 / x)" is "-3 / x": |s, [a, ..]| s.minus_into_first(Operation::Divide, a);
        "-(x / 3)" is "x / (-3)": |s, [a, ..]| s.minus_into_second(Operation::Divide, a);
    }
    Absolute {
        "abs(-x)" is "abs(x)": |s, [a, ..]| s.even(Operation::Absolute, a);
        "abs(x^2)" is "x^2": |s, [a, ..]| s.is_never_negative(a).then_some(a);
    }
    Minimum {
        "min(x, x)" is "x": |_, [a, b, _]| (a == b).then_some(a);
    }
    Maximum {
        "max(x, x)" is "x": |_, [a, b, _]| (a == b).then_some(a);
    }
    IntegerPower {
        "(-x)^2" is "x^2": |s, [a, b, _]| s.even_power(a, b);
        "(-x)^3" is "-(x^3)": |s, [a, b, _]| s.odd_power(a, b);
        "(x^4)^3" is "x^12": |s, [a, b, _]| s.power_of_power(a, b);
    }
    Floor { "floor(ceil(x))" is "ceil(x)": |s, [a, ..]| s.is_whole(a).then_some(a); }
    Ceil { "ceil(round(x))" is "round(x)": |s, [a, ..]| s.is_whole(a).then_some(a); }
    Round { "round(trunc(x))" is "trunc(x)": |s, [a, ..]| s.is_whole(a).then_some(a); }
    Truncate { "trunc(floor(x))" is "floor(x)": |s, [a, ..]| s.is_whole(a).then_some(a); }
    Sign { "sign(-x)" is "-sign(x)": |s, [a, ..]| s.odd(Operation::Sign, a); }
    CubeRoot { "cbrt(-x)" is "-cbrt(x)": |s, [a, ..]| s.odd(Operation::CubeRoot, a); }
    Asin { "asin(-x)" is "-asin(x)": |s, [a, ..]| s.odd(Operation::Asin, a); }
    Sin { "sin(-x)" is "-sin(x)": |s, [a, ..]| s.odd(Operation::Sin, a); }
    Cos { "cos(-x)" is "cos(x)": |s, [a, ..]| s.even(Operation::Cos, a); }
    Tan { "tan(-x)" is "-tan(x)": |s, [a, ..]| s.odd(Operation::Tan, a); }
    Atan { "atan(-x)" is "-atan(x)": |s, [a, ..]| s.odd(Operation::Atan, a); }
    Sinh { "sinh(-x)" is "-sinh(x)": |s, [a, ..]| s.odd(Operation::Sinh, a); }
    Cosh { "cosh(-x)" is "cosh(x)": |s, [a, ..]| s.even(Operation::Cosh, a); }
    Asinh { "asinh(-x)" is "-asinh(x)": |s, [a, ..]| s.odd(Operation::Asinh, a); }
    Atanh { "atanh(-x)" is "-atanh(x)": |s, [a, ..]| s.odd(Operation::Atanh, a); }
    Tanh { "tanh(-x)" is "-tanh(x)": |s, [a, ..]| s.odd(Operation::Tanh, a); }
    Less { "-x < -y" is "y < x": |s, [a, b, _]| s.mirrored(Operation::Less, a, b); }
    LessOrEqual { "-x <= -y" is "y <= x": |s, [a, b, _]| s.mirrored(Operation::LessOrEqual, a, b); }
    Select {
        "if(2, x, y)" is "x": |s, [a, b, _]| s.is_surely_nonzero(a).then_some(b);
        "if(0, x, y)" is "y": |s, [a, _, c]| (s.is(a, 0.0) || s.is(a, -0.0)).then_some(c);
    }
}

/// Whether the order of the two operands makes no difference to the last bit.
pub(super) fn is_commutative(operation: Operation) -> bool {
    matches!(operation, Operation::Add | Operation::Multiply | Operation::Equal | Operation::Hypotenuse)
}

/// What rules ask of nodes.
impl Simplifier<'_> {
    fn constant(&self, id: NodeId) -> Option<Constant> {
        if let Node::Constant(constant) = self.program.node(id) { Some(constant) } else { None }
    }

    /// Whether the node is just the double `value`; −0 is not 0.
    fn is(&self, id: NodeId, value: f64) -> bool {
        self.constant(id).is_some_and(|constant| constant == Constant::exact(value))
    }

    /// The operands of the node, if `operation` is applied there.
    fn operands(&self, id: NodeId, operation: Operation) -> Option<[NodeId; 3]> {
        match self.program.node(id) {
            Node::Apply(applied, operands) if applied == operation => Some(operands),
            _ => None,
        }
    }

    /// x where the node is −x.
    fn negated(&self, id: NodeId) -> Option<NodeId> {
        self.operands(id, Operation::Negate).map(|[operand, ..]| operand)
    }

    /// The base and the exponent of an integer power; the node itself and 1 for any other node.
    fn base_and_exponent(&self, id: NodeId) -> (NodeId, u32) {
        let power = self.operands(id, Operation::IntegerPower);
        let parts = power.and_then(|[base, exponent, _]| Some((base, self.program.exponent(exponent)?)));
        parts.unwrap_or((id, 1))
    }

    /// −c where the node is a constant c.
    fn minus_constant(&mut self, id: NodeId) -> Option<NodeId> {
        self.constant(id).map(|constant| self.program.constant(constant.negated()))
    }

    /// −c where the node is a negative constant c.
    fn minus_negative(&mut self, id: NodeId) -> Option<NodeId> {
        let constant = self.constant(id)?;
        let is_negative = constant.value() < 0.0 && constant.enclosure().hi < 0.0;
        if is_negative { self.minus_constant(id) } else { None }
    }

    /// 1/c where the node is a power of two c, so that to divide by c and to multiply by 1/c round the same number.
    fn reciprocal(&self, id: NodeId) -> Option<f64> {
        let divisor = self.constant(id)?;
        let reciprocal = divisor.value().recip();
        (divisor.is_exact() && is_power_of_two(divisor.value()) && reciprocal.is_finite())
            .then_some(reciprocal)
    }

    fn is_surely_nonzero(&self, id: NodeId) -> bool {
        self.constant(id).is_some_and(|constant| {
            let Interval { lo, hi } = constant.enclosure();
            (constant.value() > 0.0 && lo > 0.0) || (constant.value() < 0.0 && hi < 0.0)
        })
    }

    /// Whether the node is neither a negative number nor −0, wherever it is defined.
    fn is_never_negative(&self, id: NodeId) -> bool {
        match self.program.node(id) {
            Node::Apply(Operation::IntegerPower, _) => self.base_and_exponent(id).1.is_multiple_of(2),
            Node::Apply(Operation::Absolute | Operation::Exp | Operation::Exp2 | Operation::Cosh, _) => true,
            _ => false,
        }
    }

    fn is_whole(&self, id: NodeId) -> bool {
        use Operation::{Ceil, Floor, Round, Truncate};
        matches!(self.program.node(id), Node::Apply(Floor | Ceil | Round | Truncate, _))
    }
}

/// What rules build.
impl Simplifier<'_> {
    fn scaled(&mut self, factor: f64, a: NodeId) -> NodeId {
        let factor = self.program.literal(factor);
        self.apply(Operation::Multiply, &[factor, a])
    }

    fn minus(&mut self, a: NodeId) -> NodeId {
        self.apply(Operation::Negate, &[a])
    }

    fn power(&mut self, base: NodeId, exponent: u32) -> NodeId {
        let exponent = self.program.literal(f64::from(exponent));
        self.apply(Operation::IntegerPower, &[base, exponent])
    }

    /// xᵐ·xⁿ where n is a power of two above m, for then binary powering multiplies these same two factors last.
    fn joined_powers(&mut self, a: NodeId, b: NodeId) -> Option<NodeId> {
        let ((base, m), (other_base, n)) = (self.base_and_exponent(a), self.base_and_exponent(b));
        let is_last_product = m.max(n).is_power_of_two() && m != n && m + n <= Operation::LARGEST_POWER;
        (base == other_base && is_last_product).then(|| self.power(base, m + n))
    }

    /// (xᵐ)ⁿ where m is a power of two, for then binary powering goes on from xᵐ.
    fn power_of_power(&mut self, a: NodeId, exponent: NodeId) -> Option<NodeId> {
        let ((base, m), n) = (self.base_and_exponent(a), self.program.exponent(exponent)?);
        let goes_on = m > 1 && m.is_power_of_two() && m * n <= Operation::LARGEST_POWER;
        goes_on.then(|| self.power(base, m * n))
    }

    /// c·(d·x), where d is a power of two and neither factor makes a number smaller: d·x is then exact, or overflows only
    /// when the whole does. The same holds for whole d when c is a power of two: rounding d·x scales with it.
    fn joined_factors(&mut self, outer: NodeId, b: NodeId) -> Option<NodeId> {
        let [inner, x, _] = self.operands(b, Operation::Multiply)?;
        let (c, d) = (self.constant(outer)?.value(), self.constant(inner)?.value());
        let is_exact = is_power_of_two(d) || (is_power_of_two(c) && d.trunc() == d);
        if !(is_exact && c.abs() >= 1.0 && d.abs() >= 1.0) {
            return None;
        }
        let factor = fold::folded(self.program, Operation::Multiply, &[outer, inner])?;
        let factor = self.program.constant(factor);
        Some(self.apply(Operation::Multiply, &[factor, x]))
    }

    /// (−x) ∘ y = −(x ∘ y)
    fn sign_of_first(&mut self, operation: Operation, a: NodeId, b: NodeId) -> Option<NodeId> {
        let x = self.negated(a)?;
        let result = self.apply(operation, &[x, b]);
        Some(self.minus(result))
    }

    /// x ∘ (−y) = −(x ∘ y)
    fn sign_of_second(&mut self, operation: Operation, a: NodeId, b: NodeId) -> Option<NodeId> {
        let y = self.negated(b)?;
        let result = self.apply(operation, &[a, y]);
        Some(self.minus(result))
    }

    /// c ∘ (−x) = (−c) ∘ x
    fn sign_into_first(&mut self, operation: Operation, a: NodeId, b: NodeId) -> Option<NodeId> {
        let x = self.negated(b)?;
        let minus_c = self.minus_constant(a)?;
        Some(self.apply(operation, &[minus_c, x]))
    }

    /// (−x) ∘ c = x ∘ (−c)
    fn sign_into_second(&mut self, operation: Operation, a: NodeId, b: NodeId) -> Option<NodeId> {
        let x = self.negated(a)?;
        let minus_c = self.minus_constant(b)?;
        Some(self.apply(operation, &[x, minus_c]))
    }

    /// −(c ∘ x) = (−c) ∘ x
    fn minus_into_first(&mut self, operation: Operation, a: NodeId) -> Option<NodeId> {
        let [c, x, _] = self.operands(a, operation)?;
        let minus_c = self.minus_constant(c)?;
        Some(self.apply(operation, &[minus_c, x]))
    }

    /// −(x ∘ c) = x ∘ (−c)
    fn minus_into_second(&mut self, operation: Operation, a: NodeId) -> Option<NodeId> {
        let [x, c, _] = self.operands(a, operation)?;
        let minus_c = self.minus_constant(c)?;
        Some(self.apply(operation, &[x, minus_c]))
    }

    /// f(−x) = −f(x)
    fn odd(&mut self, operation: Operation, a: NodeId) -> Option<NodeId> {
        let x = self.negated(a)?;
        let result = self.apply(operation, &[x]);
        Some(self.minus(result))
    }

    /// f(−x) = f(x)
    fn even(&mut self, operation: Operation, a: NodeId) -> Option<NodeId> {
        self.negated(a).map(|x| self.apply(operation, &[x]))
    }

    /// (−x)ⁿ = xⁿ and |x|ⁿ = xⁿ for even n
    fn even_power(&mut self, a: NodeId, exponent: NodeId) -> Option<NodeId> {
        let x = self.negated(a).or_else(|| Some(self.operands(a, Operation::Absolute)?[0]))?;
        let n = self.program.exponent(exponent)?;
        n.is_multiple_of(2).then(|| self.power(x, n))
    }

    /// (−x)ⁿ = −xⁿ for odd n
    fn odd_power(&mut self, a: NodeId, exponent: NodeId) -> Option<NodeId> {
        let (x, n) = (self.negated(a)?, self.program.exponent(exponent)?);
        let power = (!n.is_multiple_of(2)).then(|| self.power(x, n))?;
        Some(self.minus(power))
    }

    /// −x ∘ −y = y ∘ x for a comparison
    fn mirrored(&mut self, operation: Operation, a: NodeId, b: NodeId) -> Option<NodeId> {
        let (x, y) = (self.negated(a)?, self.negated(b)?);
        Some(self.apply(operation, &[y, x]))
    }
}

fn is_power_of_two(value: f64) -> bool {
    const FRACTION: u64 = (1 << (f64::MANTISSA_DIGITS - 1)) - 1;
    value.is_normal() && value.to_bits() & FRACTION == 0
}
