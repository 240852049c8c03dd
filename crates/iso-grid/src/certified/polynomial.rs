//! Polynomials along a ray, in the basis of Bernstein.
//!
//! On a stretch of a ray each coordinate is linear in u, the part of the stretch that lies behind, so a polynomial F is a
//! polynomial in u whose degree is that of F. Its coefficients in the basis (1 − u)ⁿ⁻ⁱ·uⁱ follow from sums and products
//! alone, without the cancellation that powers of u would bring, and enclose it far more tightly than interval arithmetic
//! on F does: the range lies between the least and the greatest of them, each over a binomial (Farouki, 'The Bernstein
//! polynomial basis: a centennial retrospective', 2012).

use iso_expr::interval::{round_down, round_up};
use iso_expr::{Interval, Node, NodeId, Operation, Program, by_squaring};

/// A program that is a polynomial in x, y and z, as sums and products.
#[derive(Debug)]
pub(super) struct Polynomial {
    terms: Vec<Term>,
    /// The degree of each term, and where its coefficients begin.
    degrees: Vec<usize>,
    places: Vec<usize>,
    /// The term that is F.
    output: usize,
    /// C(n, k) for n up to the degree, row by row.
    binomials: Vec<Vec<f64>>,
}

/// What a term is computed from; numbers are those of earlier terms.
#[derive(Clone, Copy, Debug)]
enum Term {
    Variable(usize),
    Constant(Interval),
    Sum(usize, usize),
    Difference(usize, usize),
    Product(usize, usize),
}

impl Polynomial {
    /// Polynomials of higher degree are left to interval arithmetic.
    pub(super) const LARGEST_DEGREE: usize = 32;

    /// The polynomial that `program` computes; `None` when it is none, or of too high a degree.
    pub(super) fn of(program: &Program) -> Option<Self> {
        let mut polynomial = Self {
            terms: Vec::new(),
            degrees: Vec::new(),
            places: Vec::new(),
            output: 0,
            binomials: binomials(Self::LARGEST_DEGREE),
        };
        let mut terms = Vec::with_capacity(program.nodes().len());
        for node in program.nodes() {
            let term = match *node {
                Node::Variable(argument) => polynomial.push(Term::Variable(argument.index()))?,
                Node::Constant(constant) => polynomial.push(Term::Constant(constant.enclosure()))?,
                Node::Apply(operation, operands) => polynomial.apply(program, &terms, operation, operands)?,
            };
            terms.push(term);
        }
        polynomial.output = terms[program.outputs()[0].index()];
        Some(polynomial)
    }

    /// The degree of F.
    pub(super) fn degree(&self) -> usize {
        self.degrees[self.output]
    }

    fn apply(
        &mut self,
        program: &Program,
        terms: &[usize],
        operation: Operation,
        operands: [NodeId; 3],
    ) -> Option<usize> {
        let [a, b, _] = operands.map(|operand| terms[operand.index()]);
        let second = program.node(operands[1]);
        match (operation, second) {
            (Operation::Add, _) => self.push(Term::Sum(a, b)),
            (Operation::Subtract, _) => self.push(Term::Difference(a, b)),
            (Operation::Multiply, _) => self.push(Term::Product(a, b)),
            (Operation::Negate, _) => {
                let zero = self.push(Term::Constant(Interval::point(0.0)))?;
                self.push(Term::Difference(zero, a))
            }
            (Operation::Divide, Node::Constant(divisor)) => {
                let reciprocal = Interval::point(1.0).over(divisor.enclosure());
                let reciprocal = self.push(Term::Constant(reciprocal))?;
                self.push(Term::Product(a, reciprocal))
            }
            (Operation::IntegerPower, Node::Constant(exponent)) => self.power(a, exponent.value() as u32),
            _ => None,
        }
    }

    fn power(&mut self, base: usize, exponent: u32) -> Option<usize> {
        by_squaring(Some(base), exponent, |a, b| self.push(Term::Product(a?, b.unwrap_or(a)?)))?
    }

    fn push(&mut self, term: Term) -> Option<usize> {
        let degree = match term {
            Term::Variable(_) => 1,
            Term::Constant(value) if value.is_bounded() => 0,
            Term::Constant(_) => return None,
            Term::Sum(a, b) | Term::Difference(a, b) => self.degrees[a].max(self.degrees[b]),
            Term::Product(a, b) => self.degrees[a] + self.degrees[b],
        };
        if degree > Self::LARGEST_DEGREE {
            return None;
        }
        let place = self.places.last().map_or(0, |place| place + self.degrees[self.degrees.len() - 1] + 1);
        self.terms.push(term);
        self.degrees.push(degree);
        self.places.push(place);
        Some(self.terms.len() - 1)
    }

    /// Appends to `coefficients` those of F in the basis of Bernstein, one more than its degree, from `start` to `end`, which
    /// enclose two points. `terms` is working memory.
    pub(super) fn expand(
        &self,
        start: [Interval; 3],
        end: [Interval; 3],
        terms: &mut Vec<Interval>,
        coefficients: &mut Vec<Interval>,
    ) {
        terms.clear();
        for (number, term) in self.terms.iter().enumerate() {
            let (place, degree) = (self.places[number], self.degrees[number]);
            terms.resize(place + degree + 1, Interval::point(0.0));
            let (earlier, result) = terms.split_at_mut(place);
            let of = |term: usize| &earlier[self.places[term]..][..=self.degrees[term]];
            match *term {
                Term::Variable(axis) => result.copy_from_slice(&[start[axis], end[axis]]),
                Term::Constant(value) => result[0] = value,
                Term::Sum(a, b) => {
                    self.add(result, of(a), 1.0);
                    self.add(result, of(b), 1.0);
                }
                Term::Difference(a, b) => {
                    self.add(result, of(a), 1.0);
                    self.add(result, of(b), -1.0);
                }
                Term::Product(a, b) => multiply(result, of(a), of(b)),
            }
        }
        let scaled = &terms[self.places[self.output]..][..=self.degree()];
        let binomials = &self.binomials[self.degree()];
        coefficients.extend(scaled.iter().zip(binomials).map(|(coefficient, binomial)| Interval {
            lo: round_down(coefficient.lo / binomial),
            hi: round_up(coefficient.hi / binomial),
        }));
    }

    /// Adds `sign`·a to `result`, whose degree is no lower: a is first multiplied by a power of (1 − u) + u = 1.
    fn add(&self, result: &mut [Interval], a: &[Interval], sign: f64) {
        let row = &self.binomials[result.len() - a.len()];
        for (i, coefficient) in a.iter().enumerate() {
            let coefficient = if sign < 0.0 { coefficient.negated() } else { *coefficient };
            for (result, binomial) in result[i..].iter_mut().zip(row) {
                let term = Interval {
                    lo: round_down(coefficient.lo * binomial),
                    hi: round_up(coefficient.hi * binomial),
                };
                *result = result.plus(if *binomial == 1.0 { coefficient } else { term });
            }
        }
    }
}

/// The product of a and b, in the basis without binomials: as for powers of one variable.
fn multiply(result: &mut [Interval], a: &[Interval], b: &[Interval]) {
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            result[i + j] = result[i + j].plus(a.times(*b));
        }
    }
}

/// The triangle of Pascal, all of whose numbers here are doubles.
fn binomials(rows: usize) -> Vec<Vec<f64>> {
    let mut triangle = vec![vec![1.0]];
    for row in 0..rows {
        let above: &Vec<f64> = &triangle[row];
        let inner = above.windows(2).map(|pair| pair[0] + pair[1]);
        triangle.push(std::iter::once(1.0).chain(inner).chain([1.0]).collect());
    }
    triangle
}

#[cfg(test)]
mod tests {
    use iso_expr::Ast;

    use super::*;

    fn program(formula: &str) -> Program {
        Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
    }

    /// The coefficients of a formula from (0, 0, 0) to (1, 2, −1).
    fn coefficients(formula: &str) -> Vec<Interval> {
        let polynomial = Polynomial::of(&program(formula)).expect("the formula is a polynomial");
        let mut coefficients = Vec::new();
        let [start, end] = [[0.0; 3], [1.0, 2.0, -1.0]].map(|point| point.map(Interval::point));
        polynomial.expand(start, end, &mut Vec::new(), &mut coefficients);
        coefficients
    }

    #[test]
    fn coefficients_are_those_of_known_polynomials() {
        // By u: 3u² = 0 + 0 + 3, 1 − u, 2u·(−u) + u³ = −2u² + u³, 2³ u³, (u/4)², −u.
        let cases: [(&str, &[f64]); 7] = [
            ("3x^2", &[0.0, 0.0, 3.0]),
            ("1 - x", &[1.0, 0.0]),
            ("y*z + x^3", &[0.0, 0.0, -2.0 / 3.0, -1.0]),
            ("y^3", &[0.0, 0.0, 0.0, 8.0]),
            ("(x/4)^2", &[0.0, 0.0, 0.0625]),
            ("-x", &[0.0, -1.0]),
            ("7", &[7.0]),
        ];
        for (formula, expected) in cases {
            let found = coefficients(formula);
            assert_eq!(found.len(), expected.len(), "{formula}");
            for (found, expected) in found.iter().zip(expected) {
                let slack = Interval { lo: expected - 1e-15, hi: expected + 1e-15 };
                assert!(!found.intersection(slack).is_empty() && found.width() < 1e-13, "{formula}: {found}");
            }
        }
    }

    #[test]
    fn what_is_no_polynomial_is_refused() {
        for formula in ["sin(x)", "1/x", "abs(x)", "x^0.5", "x^33", "x^y", "max(x, y)", "x/0"] {
            assert!(Polynomial::of(&program(formula)).is_none(), "{formula}");
        }
    }
}
