//! How far rounding moves the values of a formula: each value is held against its enclosure at the same point.

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BatchKernel, BoxKernel, Decorated, Decoration, Interval, Scratch};

/// A value in doubles, and how far it is from what exact arithmetic gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rounded {
    /// The value.
    pub(crate) value: f64,
    /// A bound of |value − exact value|: infinite where none is known, as where exact arithmetic may not define the formula, and NaN
    /// where it certainly does not.
    pub(crate) error: f64,
}

impl Rounded {
    /// The decimal digits of a double: log₁₀ 2⁵³.
    const DIGITS: f64 = 15.954_589_770_191_003;

    /// The value, and the bound that its enclosure gives.
    fn new(value: f64, Decorated { interval, decoration }: Decorated) -> Self {
        let is_bounded = value.is_finite() && decoration >= Decoration::Defined;
        let error = match (interval.is_empty(), is_bounded) {
            (true, _) => f64::NAN,
            (false, false) => f64::INFINITY,
            (false, true) => interval.minus(Interval::point(value)).magnitude(),
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
    let rows = points[0].len();
    let of = |place: usize| {
        let of_value = place % rows;
        if place != of_value && found[of_value].is_nan() {
            return Rounded { value: f64::NAN, error: f64::NAN };
        }
        // Where the formula may be undefined, so may its derivatives.
        let decoration = decoration[place].min(decoration[of_value]);
        Rounded::new(
            found[place],
            Decorated { interval: Interval { lo: lo[place], hi: hi[place] }, decoration },
        )
    };
    (0..count).map(of).collect()
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

    /// −0.2 − 0.8 in doubles is −1, but the doubles 0.2 and 0.8 together exceed 1 by 2⁻⁵⁴.
    #[test]
    fn what_exact_arithmetic_may_not_define_has_no_bound() {
        for (formula, value) in [
            ("acos(-0.2 - x)", std::f64::consts::PI),
            ("if(acos(-0.2 - x) <= 9, 1, 2)", 1.0),
            ("sqrt(x + 0.2 - 1)", 0.0),
        ] {
            assert_eq!(at(formula, 0.8), Rounded { value, error: f64::INFINITY }, "{formula}");
        }
    }

    /// Of a choice, the branch that is not taken need not be defined.
    #[test]
    fn what_is_defined_has_a_bound_whatever_is_not_beside_it() {
        for formula in ["if(x < 0.9, x, acos(-0.2 - x))", "floor(x)", "abs(x - 0.8)", "sqrt(x - 0.8)"] {
            assert!(at(formula, 0.8).error < 1e-15, "{formula}: {:?}", at(formula, 0.8));
        }
    }

    #[test]
    fn what_is_undefined_has_no_bound_and_what_overflows_an_infinite_one() {
        assert!(at("sqrt(x)", -1.0).error.is_nan());
        assert!(at("1/x", 0.0).error.is_nan());
        assert_eq!(at("exp(x)", 1e4).error, f64::INFINITY);
    }
}
