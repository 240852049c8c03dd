//! Sums, products and quotients of doubles that are doubles themselves.

/// Below this magnitude, the error of a product may itself be too small for a double.
const LEAST_WITH_EXACT_ERROR: f64 = 1e-290;

/// Whether a + b is `sum` (the error of a sum by Knuth, 'The Art of Computer Programming', volume 2, theorem 4.2.2 B).
pub(super) fn sum_is_exact(a: f64, b: f64, sum: f64) -> bool {
    let of_b = sum - a;
    let of_a = sum - of_b;
    (a - of_a) + (b - of_b) == 0.0
}

/// Whether a · b is `product`: a fused product has one rounding, which is exact when the error is a double.
pub(super) fn product_is_exact(a: f64, b: f64, product: f64) -> bool {
    let error_is_a_double = product.abs() >= LEAST_WITH_EXACT_ERROR || a == 0.0 || b == 0.0;
    error_is_a_double && a.mul_add(b, -product) == 0.0
}

/// a + b, if that is a double.
pub(super) fn sum(a: f64, b: f64) -> Option<f64> {
    Some(a + b).filter(|sum| sum_is_exact(a, b, *sum))
}

/// a · b, if that is a double.
pub(super) fn product(a: f64, b: f64) -> Option<f64> {
    Some(a * b).filter(|product| product_is_exact(a, b, *product))
}

/// a / b, if that is a double.
pub(super) fn quotient(a: f64, b: f64) -> Option<f64> {
    Some(a / b).filter(|quotient| product_is_exact(*quotient, b, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_rounded_is_not_said() {
        assert_eq!((sum(0.5, 0.25), sum(1.0, 1e-17), sum(0.1, 0.2)), (Some(0.75), None, None));
        assert_eq!((product(0.5, 0.1), product(0.1, 0.1), product(1e-200, 1e-200)), (Some(0.05), None, None));
        assert_eq!((quotient(0.3, 2.0), quotient(1.0, 3.0), quotient(1.0, 0.0)), (Some(0.15), None, None));
        assert_eq!((sum(f64::MAX, f64::MAX), product(f64::MAX, 2.0)), (None, None));
        assert_eq!((product(0.0, 5.0), quotient(0.0, 0.0), quotient(1e-320, 1e10)), (Some(0.0), None, None));
    }
}
