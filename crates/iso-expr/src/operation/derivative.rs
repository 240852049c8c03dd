//! Derivatives of operations, as programs.
//!
//! The rules are exact wherever the operation is differentiable. At a kink they give one of the one-sided derivatives or
//! a value between them; at a jump they give the derivative of the pieces.

mod share;

pub(crate) use share::MeanByShares;

use super::Operation;
use crate::{Node, NodeId, Program};

/// One application of an operation whose derivative is wanted.
#[derive(Debug)]
pub struct Chain<'a> {
    /// Where the derivative's nodes go. The operation and its operands are already there.
    pub program: &'a mut Program,
    /// The operands; only as many as the arity count.
    pub operands: [NodeId; 3],
    /// The derivative of each operand, `None` where it is zero.
    pub derivatives: [Option<NodeId>; 3],
    /// The node itself.
    pub result: NodeId,
}

impl Chain<'_> {
    fn literal(&mut self, value: f64) -> NodeId {
        self.program.literal(value)
    }

    fn apply(&mut self, operation: Operation, operands: &[NodeId]) -> NodeId {
        self.program.apply(operation, operands)
    }

    fn square(&mut self, base: NodeId) -> NodeId {
        self.program.integer_power(base, 2)
    }

    /// 1 − a²
    fn one_minus_square(&mut self, a: NodeId) -> NodeId {
        let (one, square) = (self.literal(1.0), self.square(a));
        self.apply(Operation::Subtract, &[one, square])
    }

    /// 1 + a²
    fn one_plus_square(&mut self, a: NodeId) -> NodeId {
        let (one, square) = (self.literal(1.0), self.square(a));
        self.apply(Operation::Add, &[one, square])
    }

    /// slope · a′
    fn times(&mut self, slope: impl FnOnce(&mut Self, NodeId) -> NodeId) -> Option<NodeId> {
        let derivative = self.derivatives[0]?;
        let slope = slope(self, self.operands[0]);
        self.product(slope, Some(derivative))
    }

    /// a′ / divisor
    fn over(&mut self, divisor: impl FnOnce(&mut Self, NodeId) -> NodeId) -> Option<NodeId> {
        let derivative = self.derivatives[0]?;
        let divisor = divisor(self, self.operands[0]);
        Some(self.apply(Operation::Divide, &[derivative, divisor]))
    }

    /// a′ / (a · ln(base))
    fn over_scaled(&mut self, base: f64) -> Option<NodeId> {
        self.over(|chain, a| {
            let base = chain.literal(base);
            let scale = chain.apply(Operation::Ln, &[base]);
            chain.apply(Operation::Multiply, &[a, scale])
        })
    }

    fn negated(&mut self, value: Option<NodeId>) -> Option<NodeId> {
        value.map(|value| self.apply(Operation::Negate, &[value]))
    }

    fn sum(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        self.program.sum(a, b)
    }

    fn difference(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.apply(Operation::Subtract, &[a, b])),
            (a, None) => a,
            (None, b) => self.negated(b),
        }
    }

    /// factor · derivative, with the constants multiplied first: no rounding is prescribed for a derivative, and so the
    /// constants of a polynomial fold into one.
    fn product(&mut self, factor: NodeId, derivative: Option<NodeId>) -> Option<NodeId> {
        let derivative = derivative?;
        if self.program.node(derivative) == Node::ONE {
            return Some(factor);
        }
        Some(match self.program.node(derivative) {
            Node::Constant(_) => self.apply(Operation::Multiply, &[derivative, factor]),
            Node::Apply(Operation::Multiply, [constant, rest, _]) if self.is_constant(constant) => {
                if self.is_constant(factor) {
                    let constant = self.program.product_of_constants(factor, constant);
                    self.apply(Operation::Multiply, &[constant, rest])
                } else {
                    let variable = self.apply(Operation::Multiply, &[factor, rest]);
                    self.apply(Operation::Multiply, &[constant, variable])
                }
            }
            _ => self.apply(Operation::Multiply, &[factor, derivative]),
        })
    }

    fn is_constant(&self, id: NodeId) -> bool {
        matches!(self.program.node(id), Node::Constant(_))
    }

    /// b where `condition` holds, else c, either of which may be zero.
    fn choice(&mut self, condition: NodeId, b: Option<NodeId>, c: Option<NodeId>) -> Option<NodeId> {
        if b.is_none() && c.is_none() {
            return None;
        }
        let zero = self.literal(0.0);
        Some(self.apply(Operation::Select, &[condition, b.unwrap_or(zero), c.unwrap_or(zero)]))
    }
}

pub(super) fn add(chain: &mut Chain<'_>) -> Option<NodeId> {
    let [a, b, _] = chain.derivatives;
    chain.sum(a, b)
}

pub(super) fn subtract(chain: &mut Chain<'_>) -> Option<NodeId> {
    let [a, b, _] = chain.derivatives;
    chain.difference(a, b)
}

/// a·b′ + a′·b. The 0·√m that cuts a function where m is negative is its own derivative: it is there where m is zero, where the root has
/// none.
pub(super) fn multiply(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    if chain.program.margin_of(chain.result).is_some() {
        return da.or(db).map(|_| chain.result);
    }
    let (left, right) = (chain.product(b, da), chain.product(a, db));
    chain.sum(left, right)
}

/// (a′ − (a/b)·b′) / b. Where a′ is zero, −(1/b)·((a/b)·b′), for along all axes that divides by b once, and the factors come in an order in which
/// they are of moderate size; or −(a/b)·(b′/b) over a sum of exponentials, of which b′/b has shares.
pub(super) fn divide(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let quotient = chain.result;
    let Some(da) = da else {
        let growth = if chain.program.is_sum_of_exponentials(b) {
            let relative = chain.relative(db?, b);
            chain.product(quotient, Some(relative))
        } else {
            let one = chain.literal(1.0);
            let reciprocal = if a == one { quotient } else { chain.apply(Operation::Divide, &[one, b]) };
            let growth = chain.product(quotient, db);
            chain.product(reciprocal, growth)
        };
        return chain.negated(growth);
    };
    let correction = chain.product(quotient, db);
    let numerator = chain.difference(Some(da), correction)?;
    Some(chain.apply(Operation::Divide, &[numerator, b]))
}

pub(super) fn negate(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.negated(chain.derivatives[0])
}

pub(super) fn absolute(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| chain.apply(Operation::Sign, &[a]))
}

pub(super) fn minimum(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let first = chain.apply(Operation::Less, &[a, b]);
    chain.choice(first, da, db)
}

pub(super) fn maximum(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let first = chain.apply(Operation::Less, &[b, a]);
    chain.choice(first, da, db)
}

/// n·aⁿ⁻¹·a′
pub(super) fn integer_power(chain: &mut Chain<'_>) -> Option<NodeId> {
    let derivative = chain.derivatives[0]?;
    let [a, exponent, _] = chain.operands;
    let power = chain.program.exponent(exponent).expect("programs check the exponents of integer powers");
    let lower = match power - 1 {
        1 => a,
        lower => chain.program.integer_power(a, lower),
    };
    let rest = chain.product(lower, Some(derivative));
    chain.product(exponent, rest)
}

/// b·aᵇ⁻¹·a′ + aᵇ·ln(a)·b′
pub(super) fn power(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let of_base = da.and_then(|da| {
        let one = chain.literal(1.0);
        let lower = chain.apply(Operation::Subtract, &[b, one]);
        let power = chain.apply(Operation::Power, &[a, lower]);
        let rest = chain.product(power, Some(da));
        chain.product(b, rest)
    });
    let of_exponent = db.and_then(|db| {
        let logarithm = chain.apply(Operation::Ln, &[a]);
        let slope = chain.apply(Operation::Multiply, &[chain.result, logarithm]);
        chain.product(slope, Some(db))
    });
    chain.sum(of_base, of_exponent)
}

/// a′ / (2√a)
pub(super) fn square_root(chain: &mut Chain<'_>) -> Option<NodeId> {
    let root = chain.result;
    chain.over(|chain, _| {
        let two = chain.literal(2.0);
        chain.apply(Operation::Multiply, &[two, root])
    })
}

/// a′ / (3·∛a²)
pub(super) fn cube_root(chain: &mut Chain<'_>) -> Option<NodeId> {
    let root = chain.result;
    chain.over(|chain, _| {
        let (three, square) = (chain.literal(3.0), chain.square(root));
        chain.apply(Operation::Multiply, &[three, square])
    })
}

/// (a·a′ + b·b′) / hypot(a, b)
pub(super) fn hypotenuse(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let (of_a, of_b) = (chain.product(a, da), chain.product(b, db));
    let numerator = chain.sum(of_a, of_b)?;
    Some(chain.apply(Operation::Divide, &[numerator, chain.result]))
}

pub(super) fn exp(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.exponential_product(chain.result, chain.derivatives[0]?)
}

pub(super) fn exp2(chain: &mut Chain<'_>) -> Option<NodeId> {
    let result = chain.result;
    chain.times(|chain, _| {
        let two = chain.literal(2.0);
        let scale = chain.apply(Operation::Ln, &[two]);
        chain.apply(Operation::Multiply, &[result, scale])
    })
}

pub(super) fn exp_m1(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| chain.apply(Operation::Exp, &[a]))
}

pub(super) fn ln(chain: &mut Chain<'_>) -> Option<NodeId> {
    Some(chain.relative(chain.derivatives[0]?, chain.operands[0]))
}

pub(super) fn log2(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over_scaled(2.0)
}

pub(super) fn log10(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over_scaled(10.0)
}

pub(super) fn ln_1p(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(|chain, a| {
        let one = chain.literal(1.0);
        chain.apply(Operation::Add, &[one, a])
    })
}

pub(super) fn sin(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| chain.apply(Operation::Cos, &[a]))
}

pub(super) fn cos(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| {
        let sine = chain.apply(Operation::Sin, &[a]);
        chain.apply(Operation::Negate, &[sine])
    })
}

/// (1 + tan²a)·a′
pub(super) fn tan(chain: &mut Chain<'_>) -> Option<NodeId> {
    let result = chain.result;
    chain.times(|chain, _| chain.one_plus_square(result))
}

pub(super) fn asin(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(|chain, a| {
        let radicand = chain.one_minus_square(a);
        chain.apply(Operation::SquareRoot, &[radicand])
    })
}

pub(super) fn acos(chain: &mut Chain<'_>) -> Option<NodeId> {
    let rising = asin(chain);
    chain.negated(rising)
}

pub(super) fn atan(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(Chain::one_plus_square)
}

/// (b·a′ − a·b′) / (a² + b²)
pub(super) fn atan2(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let (of_a, of_b) = (chain.product(b, da), chain.product(a, db));
    let numerator = chain.difference(of_a, of_b)?;
    let (a_squared, b_squared) = (chain.square(a), chain.square(b));
    let radius_squared = chain.apply(Operation::Add, &[a_squared, b_squared]);
    Some(chain.apply(Operation::Divide, &[numerator, radius_squared]))
}

pub(super) fn sinh(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| chain.apply(Operation::Cosh, &[a]))
}

pub(super) fn cosh(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.times(|chain, a| chain.apply(Operation::Sinh, &[a]))
}

/// (1 − tanh²a)·a′
pub(super) fn tanh(chain: &mut Chain<'_>) -> Option<NodeId> {
    let result = chain.result;
    chain.times(|chain, _| chain.one_minus_square(result))
}

pub(super) fn asinh(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(|chain, a| {
        let radicand = chain.one_plus_square(a);
        chain.apply(Operation::SquareRoot, &[radicand])
    })
}

/// a′ / √((a − 1)(a + 1)), written so that it is undefined where acosh is
pub(super) fn acosh(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(|chain, a| {
        let one = chain.literal(1.0);
        let (below, above) =
            (chain.apply(Operation::Subtract, &[a, one]), chain.apply(Operation::Add, &[a, one]));
        let (below, above) =
            (chain.apply(Operation::SquareRoot, &[below]), chain.apply(Operation::SquareRoot, &[above]));
        chain.apply(Operation::Multiply, &[below, above])
    })
}

pub(super) fn atanh(chain: &mut Chain<'_>) -> Option<NodeId> {
    chain.over(Chain::one_minus_square)
}

pub(super) fn sign(_: &mut Chain<'_>) -> Option<NodeId> {
    None
}

pub(super) use sign as floor;
pub(super) use sign as ceil;
pub(super) use sign as round;
pub(super) use sign as truncate;
pub(super) use sign as less;
pub(super) use sign as less_or_equal;
pub(super) use sign as equal;

/// a′ − ⌊a/b⌋·b′
pub(super) fn modulo(chain: &mut Chain<'_>) -> Option<NodeId> {
    let ([a, b, _], [da, db, _]) = (chain.operands, chain.derivatives);
    let of_b = db.and_then(|db| {
        let quotient = chain.apply(Operation::Divide, &[a, b]);
        let turns = chain.apply(Operation::Floor, &[quotient]);
        chain.product(turns, Some(db))
    });
    chain.difference(da, of_b)
}

pub(super) fn select(chain: &mut Chain<'_>) -> Option<NodeId> {
    let [_, db, dc] = chain.derivatives;
    chain.choice(chain.operands[0], db, dc)
}

#[cfg(test)]
mod tests;
