//! Depth maps of all programs in one measure, and how far they are from each other.

/// The signed distance of each pixel's surface from the plane through the origin, growing away from the eye; NaN where
/// nothing is seen. Rows from top to bottom.
#[derive(Clone, Debug)]
pub struct Depths(pub Vec<f64>);

/// How a depth map differs from the reference.
#[derive(Clone, Copy, Debug, Default)]
pub struct DepthError {
    /// The largest distance, over the pixels in which both see the surface.
    pub largest: f64,
    /// The mean distance over the same pixels.
    pub mean: f64,
    /// In how many pixels just one of both sees the surface.
    pub mismatches: usize,
}

impl Depths {
    /// How far these depths are from the reference, over the pixels that it has `decided`.
    pub fn error_against(&self, reference: &Self, decided: &[bool]) -> DepthError {
        let (mut sum, mut shared) = (0.0, 0_usize);
        let mut error = DepthError::default();
        for ((depth, expected), decided) in self.0.iter().zip(&reference.0).zip(decided) {
            match (decided, depth.is_nan(), expected.is_nan()) {
                (false, ..) | (true, true, true) => {}
                (true, false, false) => {
                    let distance = (depth - expected).abs();
                    error.largest = error.largest.max(distance);
                    sum += distance;
                    shared += 1;
                }
                (true, ..) => error.mismatches += 1,
            }
        }
        error.mean = if shared > 0 { sum / shared as f64 } else { f64::NAN };
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_counted_where_both_see_and_mismatches_where_one_does() {
        let reference = Depths(vec![1.0, 2.0, f64::NAN, f64::NAN, 5.0]);
        let given = Depths(vec![1.5, 2.25, f64::NAN, 3.0, f64::NAN]);
        let error = given.error_against(&reference, &[true; 5]);
        assert_eq!((error.largest, error.mean, error.mismatches), (0.5, 0.375, 2));
        let error = given.error_against(&reference, &[false, true, true, true, false]);
        assert_eq!((error.largest, error.mean, error.mismatches), (0.25, 0.25, 1));
    }
}
