//! What is known of a program's values before any box is seen: their enclosures over the largest boxes that a kernel takes.

use iso_expr::engine::Boxes;
use iso_expr::{Decorated, Decoration, Extension, Interval, Node, Program};

/// Boxes that reach no farther from the origin than some distance, and what that says of a program.
///
/// Extensions are isotone: over a smaller box an enclosure is no wider and a decoration no weaker. So what is bounded, never
/// negative or common over all of the domain needs no looking after in any box within.
pub(crate) struct Domain {
    /// No end of a box is farther from zero.
    pub(crate) reach: f64,
    /// The enclosure of each of the program's nodes over the domain.
    pub(crate) ranges: Vec<Decorated>,
}

/// The reaches that are considered, as powers of two. Products of many factors overflow over large domains, so that nothing is
/// known of them; pictures of larger boxes than those of a small domain are left to the interpreter.
const REACHES: [i32; 4] = [128, 64, 32, 16];

impl Domain {
    /// The domain over which most values of `program` are common; of several the largest.
    pub(crate) fn of(program: &Program) -> Self {
        let mut domains = REACHES.map(|exponent| {
            let reach = 2f64.powi(exponent);
            Self { reach, ranges: ranges(program, reach) }
        });
        // The first one among equals.
        domains.sort_by_key(|domain| std::cmp::Reverse(domain.common()));
        let [best, ..] = domains;
        best
    }

    /// The reach of a domain that holds all but unusual boxes.
    pub(crate) const NEAR: f64 = (1u64 << 16) as f64;

    /// The domain of that reach.
    pub(crate) fn near(program: &Program) -> Self {
        Self { reach: Self::NEAR, ranges: ranges(program, Self::NEAR) }
    }

    /// How many values are common.
    fn common(&self) -> usize {
        self.ranges.iter().filter(|range| range.decoration == Decoration::Common).count()
    }

    /// Whether none of the boxes is empty, and all lie inside a domain of this reach.
    pub(crate) fn holds_all(reach: f64, boxes: Boxes<'_>) -> bool {
        let mut are_inside = true;
        for (lo, hi) in boxes.lo.iter().zip(&boxes.hi) {
            for (lo, hi) in lo.iter().zip(*hi) {
                are_inside &= (-reach <= *lo) & (lo <= hi) & (*hi <= reach);
            }
        }
        are_inside
    }
}

/// Encloses every node over a cube.
fn ranges(program: &Program, reach: f64) -> Vec<Decorated> {
    let mut ranges: Vec<Decorated> = Vec::with_capacity(program.nodes().len());
    for node in program.nodes() {
        ranges.push(match node {
            Node::Variable(_) => Decorated::argument(-reach, reach),
            Node::Constant(constant) => Decorated::constant(constant.enclosure()),
            Node::Apply(operation, operands) => {
                let [a, b, c] = operands.map(|operand| ranges[operand.index()]);
                match operation.extension() {
                    Extension::Unary(extend) => extend(a),
                    Extension::Binary(extend) => extend(a, b),
                    Extension::Ternary(extend) => extend(a, b, c),
                }
            }
        });
    }
    ranges
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
    fn poles_and_edges_of_definition_are_not_common() {
        for formula in ["1/x", "sqrt(x - 1)", "floor(y)"] {
            let domain = domain(formula);
            let last = domain.ranges.last().unwrap();
            assert_ne!(last.decoration, Decoration::Common, "{formula}: {last:?}");
            assert_eq!(domain.reach, 2f64.powi(128), "{formula}");
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
