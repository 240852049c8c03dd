//! Polynomials of one variable, computed with exactly or not at all.

use crate::program::exact::{product, quotient, sum};

/// c₀ + c₁·u + c₂·u² + …, its coefficients in this order. The last one is not zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Polynomial(Vec<f64>);

impl Polynomial {
    /// `None` where all coefficients are zero.
    pub(super) fn new(mut coefficients: Vec<f64>) -> Option<Self> {
        let length = 1 + coefficients.iter().rposition(|coefficient| *coefficient != 0.0)?;
        coefficients.truncate(length);
        Some(Self(coefficients))
    }

    /// How many powers occur, the constant aside.
    fn powers(&self) -> usize {
        self.terms().filter(|(power, _)| *power > 0).count()
    }

    /// How large its coefficients are together.
    pub(super) fn size(&self) -> f64 {
        self.0.iter().map(|coefficient| coefficient.abs()).sum()
    }

    /// Its constant.
    pub(super) fn constant(&self) -> f64 {
        self.0[0]
    }

    /// Its constant, which is taken away.
    pub(super) fn take_constant(&mut self) -> f64 {
        std::mem::take(&mut self.0[0])
    }

    fn degree(&self) -> usize {
        self.0.len() - 1
    }

    /// The powers that occur, and what they are multiplied by, from the highest one on.
    pub(super) fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        self.0.iter().copied().enumerate().rev().filter(|(_, coefficient)| *coefficient != 0.0)
    }

    /// Polynomials that are this one when each is applied to what the one before it gives, all but the last one of the least degrees: this one
    /// alone if it is no such composition.
    ///
    /// A constant goes with each of them where that leaves fewer terms: a square is completed, and Chebyshev's polynomials become those of lower
    /// degrees that they are composed of.
    pub(super) fn steps(self) -> Vec<Self> {
        let (mut steps, mut rest) = (Vec::new(), self.clone());
        while let Some([inner, outer]) = rest.split() {
            steps.extend(inner.steps());
            rest = outer;
        }
        // Powers of powers are powers.
        if steps.iter().all(|step| step.terms().count() == 1) {
            return vec![self];
        }
        steps.push(rest);
        steps
    }

    /// h and g such that this is g(h(u)).
    fn split(&self) -> Option<[Self; 2]> {
        let degree = self.degree();
        if degree == 2 {
            let [shifted, outer] = self.balanced(Self(vec![0.0, 1.0]), self.clone())?;
            return (shifted.0[0] != 0.0).then_some([shifted, outer]);
        }
        (2..degree).filter(|inner| degree.is_multiple_of(*inner)).find_map(|inner_degree| {
            let inner = self.inner(inner_degree)?;
            let outer = self.in_powers_of(&inner)?;
            let balanced = self.balanced(inner.clone(), outer.clone());
            // Where it leaves no fewer terms, they cancel.
            balanced.filter(|[_, shifted]| shifted.powers() < outer.powers()).or(Some([inner, outer]))
        })
    }

    /// The only polynomial of this degree with the leading coefficient 1 and no constant that this one may be made of: the leading coefficients
    /// of its power are those of this one (Kozen and Landau, Polynomial decomposition algorithms, Journal of Symbolic Computation 7, 1989).
    fn inner(&self, degree: usize) -> Option<Self> {
        let (whole, power) = (self.degree(), self.degree() / degree);
        let mut inner = vec![0.0; degree + 1];
        inner[degree] = 1.0;
        for below in 1..degree {
            let wanted = quotient(self.0[whole - below], self.0[whole])?;
            let so_far = Self(inner.clone()).power(power)?.0[whole - below];
            inner[degree - below] = quotient(sum(wanted, -so_far)?, power as f64)?;
        }
        Some(Self(inner))
    }

    /// g such that this is g(h(u)), where h is `inner`.
    fn in_powers_of(&self, inner: &Self) -> Option<Self> {
        let (degree, mut rest) = (inner.degree(), self.0.clone());
        let mut outer = Vec::new();
        loop {
            // By long division the rest becomes quotient·h + remainder, of which the latter is to be a number.
            for place in (degree..rest.len()).rev() {
                let below =
                    inner.0.iter().enumerate().take(degree).filter(|(_, coefficient)| **coefficient != 0.0);
                for (below, coefficient) in below {
                    let place = place - degree + below;
                    rest[place] = sum(rest[place], -product(rest[place + degree - below], *coefficient)?)?;
                }
            }
            outer.push(rest[0]);
            if rest[1..degree].iter().any(|coefficient| *coefficient != 0.0) {
                return None;
            }
            if rest.len() == degree + 1 {
                outer.push(rest[degree]);
                return Self::new(outer);
            }
            rest.drain(..degree);
        }
    }

    /// The same composition with a constant added to `inner`, by which the second coefficient of `outer` vanishes.
    fn balanced(&self, mut inner: Self, outer: Self) -> Option<[Self; 2]> {
        let degree = outer.degree();
        let constant = quotient(outer.0[degree - 1], product(degree as f64, outer.0[degree])?)?;
        inner.0[0] = constant;
        // Horner's method, again and again.
        let mut shifted = outer.0;
        for first in 0..degree {
            for place in (first..degree).rev() {
                shifted[place] = sum(shifted[place], -product(constant, shifted[place + 1])?)?;
            }
        }
        Some([inner, Self::new(shifted)?])
    }

    fn power(&self, exponent: usize) -> Option<Self> {
        (1..exponent).try_fold(self.clone(), |power, _| power.times(self))
    }

    fn times(&self, other: &Self) -> Option<Self> {
        let mut coefficients = vec![0.0; self.degree() + other.degree() + 1];
        for (power, a) in self.terms() {
            for (more, b) in other.terms() {
                let coefficient = &mut coefficients[power + more];
                *coefficient = sum(*coefficient, product(a, b)?)?;
            }
        }
        Self::new(coefficients)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[f64]) -> Polynomial {
        Polynomial::new(coefficients.to_vec()).unwrap()
    }

    /// g(h(u)).
    fn composition(outer: &Polynomial, inner: &Polynomial) -> Polynomial {
        let mut value = vec![0.0];
        for coefficient in outer.0.iter().rev() {
            let mut next = vec![0.0; value.len() + inner.degree()];
            for (power, a) in value.iter().enumerate() {
                for (more, b) in inner.0.iter().enumerate() {
                    next[power + more] += a * b;
                }
            }
            next[0] += coefficient;
            value = next;
        }
        polynomial(&value)
    }

    fn chebyshev(degree: usize) -> Polynomial {
        let (mut before, mut last) = (vec![1.0], vec![0.0, 1.0]);
        for _ in 1..degree {
            let mut next = vec![0.0; last.len() + 1];
            last.iter().enumerate().for_each(|(power, coefficient)| next[power + 1] = 2.0 * coefficient);
            before.iter().enumerate().for_each(|(power, coefficient)| next[power] -= coefficient);
            (before, last) = (last, next);
        }
        polynomial(&last)
    }

    #[test]
    fn squares_are_completed() {
        assert_eq!(
            polynomial(&[7.0, 6.0, 1.0]).steps(),
            [polynomial(&[3.0, 1.0]), polynomial(&[-2.0, 0.0, 1.0])]
        );
        let quartic = polynomial(&[0.0, 0.0, -5.0, 0.0, 1.0]).steps();
        assert_eq!(quartic, [polynomial(&[-2.5, 0.0, 1.0]), polynomial(&[-6.25, 0.0, 1.0])]);
        let inside = [&[0.5, 1.0][..], &[-0.25, 0.0, 1.0], &[0.0, 0.0, 1.0]].map(polynomial);
        assert_eq!(polynomial(&[0.0, 0.0, 1.0, 2.0, 1.0]).steps(), inside);
    }

    #[test]
    fn chebyshev_polynomials_are_made_of_those_of_their_prime_factors() {
        for degree in 2..25 {
            let whole = chebyshev(degree);
            let steps = whole.clone().steps();
            let degrees: Vec<_> = steps.iter().map(Polynomial::degree).collect();
            assert_eq!(degrees.iter().product::<usize>(), degree, "{steps:?}");
            assert!(degrees.iter().all(|degree| (2..*degree).all(|part| degree % part != 0)), "{steps:?}");
            let again =
                steps.iter().skip(1).fold(steps[0].clone(), |inner, outer| composition(outer, &inner));
            assert_eq!(again, whole);
            // Each step has as few terms as Chebyshev's polynomials have.
            assert!(steps.iter().all(|step| step.terms().count() <= step.degree() / 2 + 1), "{steps:?}");
        }
    }

    #[test]
    fn others_stay_as_they_are() {
        for coefficients in [
            // Of prime degree, or no composition.
            &[0.0, 1.0, 1.0, 1.0][..],
            &[0.0, 1.0, 0.0, 0.0, 1.0],
            &[1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            // Powers of powers.
            &[0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0],
            &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0, 0.0, 1.0],
            // Already a square.
            &[0.3, 0.0, 2.0],
            // Coefficients would be rounded.
            &[0.0, 0.1, 0.3],
            &[0.0, 0.0, 0.7, 0.0, 0.3],
            &[0.0, f64::MAX, f64::MIN_POSITIVE],
        ] {
            assert_eq!(polynomial(coefficients).steps(), [polynomial(coefficients)]);
        }
    }
}
