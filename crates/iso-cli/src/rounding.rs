//! How far rounding moves the values of a formula: each value is held against its enclosure at the same point.

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BatchKernel, BoxKernel, Decoration, Interval, Scratch};

/// A value in doubles, and how far it is from what exact arithmetic gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rounded {
    /// The value.
    pub(crate) value: f64,
    /// A bound of |value − exact value|: infinite where none is known, NaN where the formula is undefined.
    pub(crate) error: f64,
}

impl Rounded {
    /// The decimal digits of a double: log₁₀ 2⁵³.
    const DIGITS: f64 = 15.954_589_770_191_003;

    /// The value, and the bound that its enclosure gives.
    fn new(value: f64, enclosure: Interval) -> Self {
        let error = match (enclosure.is_empty(), value.is_finite()) {
            (true, _) => f64::NAN,
            (false, false) => f64::INFINITY,
            (false, true) => enclosure.minus(Interval::point(value)).magnitude(),
        };
        Self { value, error }
    }

    /// How many of a double's digits rounding may have spoilt: none for a value rounded once, all for a difference of
    /// which nothing is left. NaN where the formula is undefined.
    pub(crate) fn digits_lost(&self) -> f64 {
        match self.error {
            0.0 => 0.0,
            error if error.is_nan() => f64::NAN,
            error => (Self::DIGITS + (error / self.value.abs()).log10()).clamp(0.0, Self::DIGITS),
        }
    }
}

/// The values at `points` with their errors, laid out as for [`BatchKernel`]. Both kernels are of one program, which has
/// `outputs` outputs: a value, and its derivatives, which it has nowhere where it is undefined itself.
pub(crate) fn rounded(
    values: &dyn BatchKernel,
    enclosures: &dyn BoxKernel,
    scratch: &mut Scratch,
    points: [&[f64]; 3],
    outputs: usize,
) -> Vec<Rounded> {
    let count = outputs * points[0].len();
    let (mut found, mut lo, mut hi) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let mut decoration = vec![Decoration::Trivial; count];
    values.evaluate(scratch, &points, &mut found);
    let room = Enclosures { lo: &mut lo, hi: &mut hi, decoration: &mut decoration };
    enclosures.evaluate(scratch, Boxes { lo: points, hi: points }, room);
    let ends = lo.into_iter().zip(hi);
    let rows = points[0].len();
    let of = |(place, (lo, hi)): (usize, (f64, f64))| {
        let is_derivative = place >= rows;
        if is_derivative && found[place % rows].is_nan() {
            Rounded { value: f64::NAN, error: f64::NAN }
        } else {
            Rounded::new(found[place], Interval { lo, hi })
        }
    };
    ends.enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use iso_expr::{Ast, Engine, Interpreter};

    use super::*;

    fn at(formula: &str, x: f64) -> Rounded {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().clone();
        let (values, enclosures) =
            (Interpreter.batch(&program).unwrap(), Interpreter.boxes(&program).unwrap());
        let points = [&[x][..], &[0.0], &[0.0]];
        rounded(&*values, &*enclosures, &mut Scratch::default(), points, 1)[0]
    }

    #[test]
    fn what_is_exact_has_no_error() {
        assert_eq!(at("x", 0.1), Rounded { value: 0.1, error: 0.0 });
        assert_eq!(at("x", 0.1).digits_lost(), 0.0);
    }

    /// Kahan's example of a difference: 1 − cos x near 0 keeps nothing, 2 sin²(x/2) everything.
    #[test]
    fn cancellation_is_seen_and_its_bound_holds() {
        let exact = 5e-17; // x²/2 − x⁴/24, and the second term is below 1e-33
        let (lost, kept) = (at("1 - cos(x)", 1e-8), at("2*sin(x/2)^2", 1e-8));
        assert_eq!(lost.value, 0.0);
        assert!((lost.value - exact).abs() <= lost.error && (kept.value - exact).abs() <= kept.error + 1e-32);
        assert_eq!(lost.digits_lost(), Rounded::DIGITS);
        assert!(kept.digits_lost() < 1.0, "{}", kept.digits_lost());
    }

    #[test]
    fn what_is_undefined_has_no_bound_and_what_overflows_an_infinite_one() {
        assert!(at("sqrt(x)", -1.0).error.is_nan());
        assert!(at("1/x", 0.0).error.is_nan());
        assert_eq!(at("exp(x)", 1e4).error, f64::INFINITY);
    }
}
