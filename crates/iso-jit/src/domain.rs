//! What is known of a program's values before any box is seen: their enclosures over the largest boxes that a kernel takes.

use iso_expr::engine::Boxes;
use iso_expr::{Decorated, Decoration, Interval, Node, Operation, Program};

use Decoration::Common;

/// Boxes that reach no farther from the origin than some distance, and what that says of a program.
///
/// Extensions are isotone: over a smaller box an enclosure is no wider and a decoration no weaker. So what is bounded, never
/// negative or common over all of the domain needs no looking after in any box within.
pub(crate) struct Domain {
    /// No end of a box is farther from zero.
    pub(crate) reach: f64,
    /// The enclosure of each of the program's nodes over the domain, as far as what is assumed of it holds.
    pub(crate) ranges: Vec<Decorated>,
    /// What is assumed of the operands of each node.
    pub(crate) assumptions: Vec<Option<Assumption>>,
}

/// What makes a result common, though it is not for all that an operand may be. Each box tells whether it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Assumption {
    /// The number of the operand.
    pub(crate) operand: usize,
    /// On the side of zero on which it is, or is to be, it is at least so far from zero.
    pub(crate) least: f64,
}

/// A divisor that is farther from zero leaves quotients far from overflowing; one that is nearer has a pole next to it.
const LEAST_DIVISOR: f64 = 1.0 / (1u64 << 60) as f64;

impl Assumption {
    /// What is to be assumed of common operands, if anything.
    fn about(operation: Operation, operands: [Decorated; 3]) -> Option<Self> {
        let [a, b, _] = operands.map(|operand| operand.interval);
        if operands[..operation.arity()].iter().any(|operand| operand.decoration != Common) {
            return None;
        }
        match operation {
            Operation::Divide if b.contains_zero() && Sign::of(b) != Sign::Any => {
                Some(Self { operand: 1, least: LEAST_DIVISOR })
            }
            Operation::SquareRoot if a.lo < 0.0 && a.hi > 0.0 => Some(Self { operand: 0, least: 0.0 }),
            _ => None,
        }
        .filter(|assumption| operands[assumption.operand].interval.magnitude() > LEAST_DIVISOR)
    }

    /// The operand as far as it holds.
    fn narrowed(self, Decorated { interval: Interval { lo, hi }, decoration }: Decorated) -> Decorated {
        let least = self.least;
        let interval =
            if hi > 0.0 { Interval { lo: lo.max(least), hi } } else { Interval { lo, hi: -least } };
        Decorated { interval, decoration }
    }
}

/// The reaches that are considered, as powers of two. Products of many factors overflow over large domains, so that nothing is
/// known of them; larger boxes than those of a small domain are left to assembled kernels.
const REACHES: [i32; 4] = [128, 64, 32, 16];

impl Domain {
    /// The domain over which most values of `program` are common; of several the largest.
    pub(crate) fn of(program: &Program) -> Self {
        let may_assume = program
            .nodes()
            .iter()
            .any(|node| matches!(node, Node::Apply(Operation::Divide | Operation::SquareRoot, _)));
        let choices = if may_assume { &[false, true][..] } else { &[false] };
        let domains = choices.iter().flat_map(|assumes| {
            REACHES.map(|exponent| Self::reaching(program, 2f64.powi(exponent), *assumes))
        });
        // The first one among equals, so that nothing is assumed in vain.
        domains
            .reduce(|best, next| if next.common() > best.common() { next } else { best })
            .expect("there are several reaches")
    }

    /// The domain of a reach, with assumptions or without.
    fn reaching(program: &Program, reach: f64, assumes: bool) -> Self {
        let count = program.nodes().len();
        let mut domain =
            Self { reach, ranges: Vec::with_capacity(count), assumptions: Vec::with_capacity(count) };
        for node in program.nodes() {
            domain.add(node, assumes);
        }
        domain
    }

    /// Encloses the next node.
    fn add(&mut self, node: &Node, assumes: bool) {
        let mut assumption = None;
        let range = match node {
            Node::Variable(_) => Decorated::argument(-self.reach, self.reach),
            Node::Constant(constant) => Decorated::constant(constant.enclosure()),
            Node::Apply(operation, operands) => {
                let mut operands = operands.map(|operand| self.ranges[operand.index()]);
                assumption = Assumption::about(*operation, operands).filter(|_| assumes);
                if let Some(assumption) = assumption {
                    let operand = &mut operands[assumption.operand];
                    *operand = assumption.narrowed(*operand);
                }
                operation.extension().of(operands)
            }
        };
        self.ranges.push(range);
        self.assumptions.push(assumption);
    }

    /// The reach of a domain that holds all but unusual boxes.
    pub(crate) const NEAR: f64 = (1u64 << 16) as f64;

    /// How many values are common.
    fn common(&self) -> usize {
        self.ranges.iter().filter(|range| range.decoration == Common).count()
    }

    /// Whether an interval is not empty and lies inside a domain of this reach.
    pub(crate) fn holds(reach: f64, lo: f64, hi: f64) -> bool {
        (-reach <= lo) & (lo <= hi) & (hi <= reach)
    }

    /// Whether none of the boxes is empty, and all lie inside a domain of this reach.
    pub(crate) fn holds_all(reach: f64, boxes: Boxes<'_>) -> bool {
        let mut are_inside = true;
        for (lo, hi) in boxes.lo.iter().zip(&boxes.hi) {
            for (lo, hi) in lo.iter().zip(*hi) {
                are_inside &= Self::holds(reach, *lo, *hi);
            }
        }
        are_inside
    }
}

/// On which side of zero some numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Sign {
    /// On both, or nothing is known.
    Any,
    /// None is negative.
    NotNegative,
    /// None is positive.
    NotPositive,
}

impl Sign {
    /// That of the numbers in `range`.
    pub(crate) fn of(range: Interval) -> Self {
        if range.lo >= 0.0 {
            Self::NotNegative
        } else if range.hi <= 0.0 {
            Self::NotPositive
        } else {
            Self::Any
        }
    }

    /// That of the same numbers with the other sign.
    pub(crate) fn opposite(self) -> Self {
        match self {
            Self::Any => Self::Any,
            Self::NotNegative => Self::NotPositive,
            Self::NotPositive => Self::NotNegative,
        }
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::Ast;

    use super::*;

    fn domain(formula: &str) -> Domain {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        Domain::of(&program)
    }

    #[test]
    fn the_domain_is_as_large_as_the_degree_allows() {
        // 8 · 128 is 1024, where doubles end.
        for (formula, exponent) in
            [("x^2 + y^4", 128), ("x^8 + y", 64), ("x^12 y^3 - 1", 64), ("x^20", 32), ("x^50 + y", 16)]
        {
            let domain = domain(formula);
            assert_eq!(domain.reach, 2f64.powi(exponent), "{formula}");
            assert_eq!(domain.common(), domain.ranges.len(), "{formula}");
        }
    }

    #[test]
    fn poles_and_steps_are_not_common() {
        for formula in ["1/x", "1/(x*y)", "floor(y)", "sqrt(floor(y))"] {
            let domain = domain(formula);
            let last = domain.ranges.last().unwrap();
            assert_ne!(last.decoration, Common, "{formula}: {last:?}");
            assert_eq!(domain.reach, 2f64.powi(128), "{formula}");
            assert!(domain.assumptions.iter().all(Option::is_none), "{formula}");
        }
    }

    #[test]
    fn divisors_of_one_sign_and_radicands_are_assumed_to_be_of_use() {
        let divisor = Assumption { operand: 1, least: LEAST_DIVISOR };
        let radicand = Assumption { operand: 0, least: 0.0 };
        for (formula, expected) in [
            ("1/x^2", vec![divisor]),
            ("x/(-y^2 - z^2)", vec![divisor]),
            ("sqrt(x - 1)", vec![radicand]),
            ("1/sqrt(x)", vec![radicand, divisor]),
            ("x/(y^2 + 1) + sqrt(z^2)", vec![]),
        ] {
            let domain = domain(formula);
            assert_eq!(domain.common(), domain.ranges.len(), "{formula}");
            let assumed: Vec<_> = domain.assumptions.into_iter().flatten().collect();
            assert_eq!(assumed, expected, "{formula}");
        }
    }

    #[test]
    fn signs_of_ranges() {
        let sign = |lo, hi| Sign::of(Interval { lo, hi });
        assert_eq!(sign(0.0, 2.0), Sign::NotNegative);
        assert_eq!(sign(-2.0, -0.0), Sign::NotPositive);
        assert_eq!(sign(-1.0, 2.0), Sign::Any);
        assert_eq!(Sign::of(Interval::EMPTY), Sign::Any);
        assert_eq!(sign(1.0, 2.0).opposite(), sign(-2.0, -1.0));
    }
}
