//! Sums written as compositions of polynomials.
//!
//! Enclosures of x⁴ − 5x² are wide, for both terms are large where they nearly cancel; (x² − 5/2)² − 25/4 is the same, and each step
//! is enclosed sharply. The higher the degree, the more is gained: between −1 and 1 the terms of Chebyshev's polynomial of degree 12 are up to 39,000
//! times as large as their sum, but it is one of degree 3 of one of degree 2 of one of degree 2.

mod polynomial;

use super::exact::{product, quotient, sum};
use super::{Node, NodeId, Program};
use crate::Operation;
use polynomial::Polynomial;

/// Sums of more terms stay as they are.
const MOST_TERMS: usize = 128;

/// So do those that would take constants so many times larger than all of their coefficients: what is near them is rounded that much more.
const GROWTH: f64 = 256.0;

/// Higher powers are no terms of polynomials.
const HIGHEST: u32 = 64;

/// No more than one in so many operations may be added to a program.
const ONE_IN: usize = 8;

/// A sum of numbers and of polynomials without constants, each of one node.
#[derive(Default)]
struct Sum {
    constants: Vec<f64>,
    /// The nodes, and the coefficients of each one's powers from 0 on.
    polynomials: Vec<(NodeId, Vec<f64>)>,
}

impl Sum {
    /// Adds a multiple of a power of a node; `None` where that is not exact.
    fn add(&mut self, base: NodeId, exponent: usize, factor: f64) -> Option<()> {
        let known = self.polynomials.iter().position(|(other, _)| *other == base);
        let place = known.unwrap_or_else(|| {
            self.polynomials.push((base, Vec::new()));
            self.polynomials.len() - 1
        });
        let coefficients = &mut self.polynomials[place].1;
        coefficients.resize(coefficients.len().max(exponent + 1), 0.0);
        coefficients[exponent] = sum(coefficients[exponent], factor)?;
        Some(())
    }

    /// Adds a number, to another one where that is exact.
    fn add_constant(&mut self, constant: f64) {
        match self.constants.iter_mut().find_map(|known| sum(*known, constant).map(|sum| (known, sum))) {
            Some((known, sum)) => *known = sum,
            None => self.constants.push(constant),
        }
    }

    /// The same sum with what each node goes through, step by step; `None` where that is but one step for each.
    fn composed(mut self) -> Option<Composed> {
        let (mut terms, mut size_before, mut shifts) = (Vec::new(), size(&self.constants), 0.0);
        for (base, coefficients) in std::mem::take(&mut self.polynomials) {
            // What cancels may be undefined somewhere.
            let polynomial = Polynomial::new(coefficients)?;
            size_before += polynomial.size();
            let mut steps = polynomial.steps();
            if let Some((last, inner)) = steps.split_last_mut() {
                shifts += inner.iter().map(|step| step.constant().abs()).sum::<f64>();
                self.add_constant(last.take_constant());
            }
            terms.push((base, steps));
        }
        let is_told_otherwise = terms.iter().any(|(_, steps)| steps.len() > 1);
        let has_grown = shifts + size(&self.constants) > GROWTH * size_before;
        (is_told_otherwise && !has_grown).then_some(Composed { terms, constants: self.constants })
    }
}

/// How large some numbers are together.
fn size(numbers: &[f64]) -> f64 {
    numbers.iter().map(|number| number.abs()).sum()
}

/// A sum of numbers and of what becomes of nodes that go through polynomials one after the other.
struct Composed {
    terms: Vec<(NodeId, Vec<Polynomial>)>,
    constants: Vec<f64>,
}

/// What a node is in a sum.
enum Part {
    Constant(f64),
    Power(NodeId, u32),
    /// A sum of multiples.
    Sum([Option<(NodeId, f64)>; 2]),
}

impl Program {
    /// A program for the same real function, undefined wherever this one's is, with polynomials written as compositions of polynomials, as far as the
    /// coefficients are doubles.
    pub(super) fn composed(&self) -> Self {
        let readers = self.readers();
        let is_outer = self.outer_sums(&readers);
        let composed = |id| self.sum_at(id, &readers)?.composed();
        let outer = self.iter().zip(is_outer);
        let sums: Vec<_> =
            outer.map(|((id, _), is_outer)| is_outer.then(|| composed(id)).flatten()).collect();
        if sums.iter().all(Option::is_none) {
            return self.clone();
        }
        let mut program = Self::new();
        let mut places: Vec<NodeId> = Vec::with_capacity(self.nodes.len());
        for (node, sum) in self.nodes.iter().zip(sums) {
            places.push(match sum {
                Some(sum) => program.compose(&sum, &places),
                None => program.intern(node.with_operands(|operand| places[operand.index()])),
            });
        }
        program.outputs = self.outputs.iter().map(|output| places[output.index()]).collect();
        let composed = program.simplified();
        // What a sum is multiplied by is distributed over its terms.
        let pays = ONE_IN * composed.operations() <= (ONE_IN + 1) * (self.operations() + 1);
        if pays { composed } else { self.clone() }
    }

    /// How many nodes and outputs read each node.
    fn readers(&self) -> Vec<u32> {
        let mut readers = vec![0; self.nodes.len()];
        let operands = self.nodes.iter().flat_map(Node::operands);
        operands.chain(&self.outputs).for_each(|read| readers[read.index()] += 1);
        readers
    }

    /// For each node whether it is a sum, and no part of another one.
    fn outer_sums(&self, readers: &[u32]) -> Vec<bool> {
        let mut are_outer = vec![false; self.nodes.len()];
        for (id, _) in self.iter() {
            // Parts stand before their sums.
            if let Part::Sum(parts) = self.part(id) {
                are_outer[id.index()] = true;
                let inner = parts.into_iter().flatten().map(|(part, _)| part.index());
                inner.filter(|part| readers[*part] == 1).for_each(|part| are_outer[part] = false);
            }
        }
        are_outer
    }

    fn part(&self, id: NodeId) -> Part {
        let number = |id: NodeId| match self.node(id) {
            Node::Constant(constant) if constant.is_exact() => Some(constant.value()),
            _ => None,
        };
        // What is multiplied by zero may be undefined somewhere.
        let factor = |id: NodeId| number(id).filter(|factor| *factor != 0.0);
        let unknown = Part::Power(id, 1);
        match self.node(id) {
            Node::Constant(_) => number(id).map_or(unknown, Part::Constant),
            Node::Apply(Operation::Add, [a, b, _]) => Part::Sum([Some((a, 1.0)), Some((b, 1.0))]),
            Node::Apply(Operation::Subtract, [a, b, _]) => Part::Sum([Some((a, 1.0)), Some((b, -1.0))]),
            Node::Apply(Operation::Negate, [a, ..]) => Part::Sum([Some((a, -1.0)), None]),
            Node::Apply(Operation::Multiply, [a, b, _]) if a == b => Part::Power(a, 2),
            Node::Apply(Operation::Multiply, [a, b, _]) => match (factor(a), factor(b)) {
                (Some(factor), _) => Part::Sum([Some((b, factor)), None]),
                (_, Some(factor)) => Part::Sum([Some((a, factor)), None]),
                _ => unknown,
            },
            Node::Apply(Operation::Divide, [a, b, _]) => {
                let factor = factor(b).and_then(|divisor| quotient(1.0, divisor));
                factor.map_or(unknown, |factor| Part::Sum([Some((a, factor)), None]))
            }
            Node::Apply(Operation::IntegerPower, [base, exponent, _]) => match self.exponent(exponent) {
                Some(exponent) if exponent <= HIGHEST => Part::Power(base, exponent),
                _ => unknown,
            },
            _ => unknown,
        }
    }

    /// What an outer sum comes to. Sums that others read too are taken as a whole, so that they are computed once. `None` where that is too much, or
    /// is not exact.
    fn sum_at(&self, outer: NodeId, readers: &[u32]) -> Option<Sum> {
        let mut found = Sum::default();
        let mut ahead = vec![(outer, 1.0)];
        while let Some((id, factor)) = ahead.pop() {
            match self.part(id) {
                Part::Constant(constant) => found.add_constant(product(factor, constant)?),
                Part::Power(base, exponent) => found.add(base, exponent as usize, factor)?,
                Part::Sum(parts) if id == outer || readers[id.index()] == 1 => {
                    for (part, by) in parts.into_iter().rev().flatten() {
                        ahead.push((part, product(factor, by)?));
                    }
                }
                Part::Sum(_) => found.add(id, 1, factor)?,
            }
            if found.polynomials.len() + ahead.len() > MOST_TERMS {
                return None;
            }
        }
        Some(found)
    }

    /// Adds a sum, whose nodes went to these places.
    fn compose(&mut self, Composed { terms, constants }: &Composed, places: &[NodeId]) -> NodeId {
        let mut so_far = None;
        for (base, steps) in terms {
            let (last, inner) = steps.split_last().expect("there is a step at least");
            let mut value = places[base.index()];
            for step in inner {
                let zero = self.literal(0.0);
                value = self.add_terms(None, value, step).unwrap_or(zero);
            }
            so_far = self.add_terms(so_far, value, last);
        }
        for constant in constants.iter().filter(|constant| **constant != 0.0) {
            so_far = Some(self.add_multiple(so_far, None, *constant));
        }
        so_far.unwrap_or_else(|| self.literal(0.0))
    }

    /// A polynomial of a node, and what is there before it.
    fn add_terms(&mut self, so_far: Option<NodeId>, node: NodeId, of: &Polynomial) -> Option<NodeId> {
        of.terms().fold(so_far, |so_far, (exponent, coefficient)| {
            let power = match exponent {
                0 => None,
                1 => Some(node),
                _ => Some(self.integer_power(node, exponent as u32)),
            };
            Some(self.add_multiple(so_far, power, coefficient))
        })
    }

    /// A multiple of something, or a number, and what is there before it.
    fn add_multiple(&mut self, so_far: Option<NodeId>, of: Option<NodeId>, factor: f64) -> NodeId {
        let size = self.literal(factor.abs());
        let size = match of {
            Some(of) if factor.abs() == 1.0 => of,
            Some(of) => self.apply(Operation::Multiply, &[size, of]),
            None => size,
        };
        match so_far {
            Some(before) if factor < 0.0 => self.apply(Operation::Subtract, &[before, size]),
            Some(before) => self.apply(Operation::Add, &[before, size]),
            None if factor < 0.0 => self.apply(Operation::Negate, &[size]),
            None => size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::tests::twofold::{Twofold, exact};
    use crate::random::Random;
    use crate::{Ast, Interval};

    fn read(text: &str) -> Program {
        Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
    }

    const CHEBYSHEV: &str =
        "t(u) := 2048u^12 - 6144u^10 + 6912u^8 - 3584u^6 + 840u^4 - 72u^2 + 1; t(x) + t(y) + t(z) = 0";

    #[test]
    fn compositions_are_the_same_functions() {
        let mut random = Random::new(1);
        for formula in [
            CHEBYSHEV,
            "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8",
            "128(x^8 + y^8 + z^8) - 256(x^6 + y^6 + z^6) + 160(x^4 + y^4 + z^4) - 32(x^2 + y^2 + z^2) + 3",
            "(sin(x) + 2y)^2/4 - (sin(x) + 2y) + 3sqrt(z^4 + 2z^2 + 2) - 7 = 0.3",
            "-(x^2 + 6x) - 3(y^2 - y)/2 + x*y*z - pi",
            "min(x^2 + x + y^3, exp(z^2 - 3z)) - max(x, y^4 + y^2)^2",
            "x^2 + 3x + y = 0*sqrt(9 - x^2 - y^2 - z^2)",
            "x^4 + 2x^3 + x^2 + y^2 + z^2 - 1",
        ] {
            let (whole, composed) = (read(formula), read(formula).composed());
            assert_ne!(whole, composed, "{formula}");
            assert_eq!(composed.composed(), composed, "{formula}");
            for _ in 0..200 {
                let point = [(); 3].map(|()| random.between(-1.5, 1.5));
                // Those that call functions are compared by their enclosures.
                let enclosures = [&whole, &composed].map(|program| {
                    program.enclosures(point.map(Interval::point))[program.outputs()[0].index()].interval
                });
                let [a, b] = enclosures;
                assert!(a.lo <= b.hi && b.lo <= a.hi, "{formula} at {point:?}: {a}, {b}\n{composed}");
                assert!(a.width() < 1e-6 && b.width() < 1e-6, "{formula} at {point:?}: {a}, {b}");
            }
        }
    }

    #[test]
    fn polynomials_are_the_same_to_far_more_digits_than_doubles_have() {
        let mut random = Random::new(2);
        for formula in [CHEBYSHEV, "x^4 - 5x^2 + y^6 - 3y^3 + 4z^2 + 2z"] {
            let (whole, composed) = (read(formula), read(formula).composed());
            for _ in 0..200 {
                let point = [(); 3].map(|()| random.between(-1.5, 1.5));
                let [a, b] = [&whole, &composed].map(|program| exact(program, point)[0]);
                let Twofold(difference, _) = a.plus(b.negated());
                assert!(difference.abs() < 1e-24, "{formula} at {point:?}: {difference}");
            }
        }
    }

    #[test]
    fn compositions_are_enclosed_sharply_by_few_operations() {
        let (whole, composed) = (read(CHEBYSHEV), read(CHEBYSHEV).composed());
        assert!(2 * composed.operations() < whole.operations(), "{composed}");
        let sides = [Interval { lo: 0.6, hi: 0.7 }; 3];
        let width =
            |program: &Program| program.enclosures(sides)[program.outputs()[0].index()].interval.width();
        assert!(width(&composed) < 0.01 * width(&whole), "{} and {}", width(&composed), width(&whole));
    }

    #[test]
    fn compositions_are_undefined_where_the_function_is() {
        let composed = read("x^2 + 3x + y = 0*sqrt(9 - x^2 - y^2 - z^2)").composed();
        let [inside, outside] = [[1.0, 1.0, 1.0], [3.0, 1.0, 0.0]].map(|point| composed.evaluate(point)[0]);
        assert_eq!(inside, 5.0);
        assert!(outside.is_nan());
    }

    #[test]
    fn others_stay_as_they_are() {
        for formula in [
            "x^2 + y^2 + z^2 - 1",
            "x^4 + y^4 + z^4 - 1",
            "x^3 + x^2 - y",
            // What is read elsewhere too is computed once.
            "r := x^2 + y^2 + z^2; (r + 2y - 1)*((r - 2y - 1)^2 - 8z^2)",
            // What cancels may be undefined.
            "1/x + y^2 + 2y - 1/x",
            // Coefficients would be rounded.
            "0.3x^2 + 0.1x + y",
            "sin(x) + x*y",
            "x^8 + 4x^6 + y^2 - 1",
            // What is far away would be rounded.
            "x^2 + 65536x + 65536y + z",
            "x^2 + 2251799813685248x + 2251799813685248y",
            // A factor would be written for each of many terms.
            "0.3(sin(x) + sin(2x) + sin(3x) + sin(4x) + sin(5x) + sin(6x) + sin(7x) + sin(8x)) + y^2 + 2y",
        ] {
            assert_eq!(read(formula).composed(), read(formula), "{formula}");
        }
    }
}
