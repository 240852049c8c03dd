//! The sign of F − C where nothing is known but its values in doubles.

use std::ops::BitOr;

/// A set of signs: those that F − C takes at some points.
///
/// A positive and a negative number have one sign each. Zero has both, so that a surface through grid points is not lost,
/// and F = C and −F = −C give the same picture. NaN and the infinities are no values of F, and have none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Signs(u8);

impl Signs {
    pub(crate) const NONE: Self = Self(0b00);
    pub(crate) const NEGATIVE: Self = Self(0b01);
    pub(crate) const POSITIVE: Self = Self(0b10);
    pub(crate) const BOTH: Self = Self(0b11);

    /// The signs of one value. Without branches, for millions of samples pass through here.
    #[inline]
    pub(crate) fn of(value: f64) -> Self {
        let finite = u8::from(value.abs() < f64::INFINITY);
        Self(u8::from(value <= 0.0) & finite | (u8::from(value >= 0.0) & finite) << 1)
    }

    /// The paper's test: the points do not all have one sign, so the surface passes between them.
    pub(crate) fn differ(self) -> bool {
        self == Self::BOTH
    }
}

impl BitOr for Signs {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl FromIterator<Self> for Signs {
    fn from_iter<I: IntoIterator<Item = Self>>(signs: I) -> Self {
        signs.into_iter().fold(Self::NONE, BitOr::bitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn differ(values: &[f64]) -> bool {
        values.iter().map(|&value| Signs::of(value)).collect::<Signs>().differ()
    }

    #[test]
    fn values_of_unlike_sign_differ() {
        assert!(differ(&[1.0, -5e-324]));
        assert!(!differ(&[1.0, 5e-324, f64::MAX]));
        assert!(!differ(&[-1.0, -5e-324]));
    }

    #[test]
    fn zero_has_both_signs_whatever_its_own() {
        for zero in [0.0, -0.0] {
            assert!(differ(&[zero]));
            assert!(differ(&[1.0, zero]));
            assert!(differ(&[zero, -1.0]));
        }
    }

    #[test]
    fn what_is_no_number_has_no_sign() {
        for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!differ(&[value]));
            assert!(!differ(&[value, 1.0]));
            assert!(!differ(&[-1.0, value]));
            assert!(differ(&[-1.0, value, 1.0]));
        }
        assert!(!differ(&[]));
    }
}
