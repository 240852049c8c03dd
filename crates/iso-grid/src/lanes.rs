//! Doubles side by side, as many as the processor computes with at once.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use pulp::Simd;

/// How many numbers stand in a row of memory: a multiple of all that any processor takes at once.
pub(crate) const ROW: usize = 8;

/// Numbers in memory, of which some at a time are computed with.
pub(crate) type Row = [f64; ROW];

/// Some numbers. Each operation is that of doubles, rounded to nearest, for each of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    numbers: S::f64s,
}

/// What was found out of some numbers, for each of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask<S: Simd> {
    simd: S,
    mask: S::m64s,
}

/// Whether processors have an instruction for the greater of two numbers, and for the lesser, that takes the second where one is NaN.
const TAKES_SECOND: bool = cfg!(any(target_arch = "x86", target_arch = "x86_64"));

/// Into how many parts a row falls.
#[inline(always)]
pub(crate) const fn parts<S: Simd>() -> usize {
    ROW / S::F64_LANES
}

impl<S: Simd> Lanes<S> {
    /// The same number everywhere.
    #[inline(always)]
    pub(crate) fn all(simd: S, number: f64) -> Self {
        Self { simd, numbers: simd.splat_f64s(number) }
    }

    /// Another number everywhere, beside these.
    #[inline(always)]
    pub(crate) fn all_be(self, number: f64) -> Self {
        Self::all(self.simd, number)
    }

    /// A part of a row.
    #[inline(always)]
    pub(crate) fn of(simd: S, row: &Row, part: usize) -> Self {
        Self { simd, numbers: S::as_simd_f64s(row).0[part] }
    }

    /// The same part of two rows.
    #[inline(always)]
    pub(crate) fn of_both(simd: S, [a, b]: &[Row; 2], part: usize) -> [Self; 2] {
        [Self::of(simd, a, part), Self::of(simd, b, part)]
    }

    /// Puts the numbers in their place in a row.
    #[inline(always)]
    pub(crate) fn put(self, row: &mut Row, part: usize) {
        S::as_mut_simd_f64s(row).0[part] = self.numbers;
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Self { numbers: self.simd.abs_f64s(self.numbers), ..self }
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        Self { numbers: self.simd.sqrt_f64s(self.numbers), ..self }
    }

    /// Where the numbers are less than others. NaN never is.
    #[inline(always)]
    pub(crate) fn is_less(self, than: Self) -> Mask<S> {
        Mask { simd: self.simd, mask: self.simd.less_than_f64s(self.numbers, than.numbers) }
    }

    /// Where the numbers are less than others or the same. NaN never is.
    #[inline(always)]
    pub(crate) fn is_at_most(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, mask: self.simd.less_than_or_equal_f64s(self.numbers, other.numbers) }
    }

    /// Where the numbers are the same as others. NaN never is.
    #[inline(always)]
    pub(crate) fn is_same(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, mask: self.simd.equal_f64s(self.numbers, other.numbers) }
    }

    /// The sum of the numbers, which are whole and small.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        self.simd.reduce_sum_f64s(self.numbers)
    }

    /// The nearest numbers between two others; NaN where the numbers themselves are NaN.
    #[inline(always)]
    pub(crate) fn between(self, least: Self, most: Self) -> Self {
        self.at_least(least).at_most(most)
    }

    /// The numbers, or others where these are greater; NaN where these numbers are NaN.
    #[inline(always)]
    pub(crate) fn at_least(self, least: Self) -> Self {
        if TAKES_SECOND && !S::IS_SCALAR {
            return Self { numbers: self.simd.max_f64s(least.numbers, self.numbers), ..self };
        }
        self.is_less(least).select(least, self)
    }

    /// The numbers, or others where these are less; NaN where these numbers are NaN.
    #[inline(always)]
    pub(crate) fn at_most(self, most: Self) -> Self {
        if TAKES_SECOND && !S::IS_SCALAR {
            return Self { numbers: self.simd.min_f64s(most.numbers, self.numbers), ..self };
        }
        most.is_less(self).select(most, self)
    }
}

impl<S: Simd> Mask<S> {
    /// So of none.
    #[inline(always)]
    pub(crate) fn none(simd: S) -> Self {
        let zero = Lanes::all(simd, 0.0);
        zero.is_less(zero)
    }

    /// The numbers of the first where this is so, and those of the second elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { numbers: self.simd.select_f64s(self.mask, yes.numbers, no.numbers), ..yes }
    }

    /// Puts numbers in their place in a row where this is so. Of the others, which stay, −0 becomes 0.
    #[inline(always)]
    pub(crate) fn put(self, numbers: Lanes<S>, row: &mut Row, part: usize) {
        // Without the zero compilers make a masked store of it, which takes processors by AMD a dozen cycles and more (Fog, Instruction tables).
        let others = Lanes::of(self.simd, row, part) + numbers.all_be(0.0);
        self.select(numbers, others).put(row, part);
    }

    /// Whether it is so of any number.
    #[inline(always)]
    pub(crate) fn is_any(self) -> bool {
        self.simd.first_true_m64s(self.mask) < S::F64_LANES
    }
}

impl<S: Simd> Not for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self { mask: self.simd.not_m64s(self.mask), ..self }
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { numbers: self.simd.neg_f64s(self.numbers), ..self }
    }
}

/// Implements an operator by what the processor does for all numbers at once.
macro_rules! operators {
    ($($of:ident: $operator:ident::$name:ident by $field:ident, $method:ident;)*) => {$(
        impl<S: Simd> $operator for $of<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self { $field: self.simd.$method(self.$field, other.$field), ..self }
            }
        }
    )*};
}

operators! {
    Lanes: Add::add by numbers, add_f64s;
    Lanes: Sub::sub by numbers, sub_f64s;
    Lanes: Mul::mul by numbers, mul_f64s;
    Lanes: Div::div by numbers, div_f64s;
    Mask: BitAnd::bitand by mask, and_m64s;
    Mask: BitOr::bitor by mask, or_m64s;
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Scalar, WithSimd};

    use super::*;

    /// The numbers of a row, or others where those are greater, and where they are less.
    struct Ends([Row; 2]);

    impl WithSimd for Ends {
        type Output = [[u64; ROW]; 2];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut found = [Row::default(); 2];
            for part in 0..parts::<S>() {
                let [numbers, others] = Lanes::of_both(simd, &self.0, part);
                numbers.at_least(others).put(&mut found[0], part);
                numbers.at_most(others).put(&mut found[1], part);
            }
            found.map(|row| row.map(f64::to_bits))
        }
    }

    #[test]
    fn the_greater_and_the_lesser_are_the_same_bits_on_any_processor() {
        let numbers = [1.0, 2.0, f64::NAN, -0.0, 0.0, f64::NEG_INFINITY, -1.0, f64::NAN];
        let others = [2.0, 1.0, 1.0, 0.0, -0.0, -1.0, f64::INFINITY, -1.0];
        let one_by_one = Ends([numbers, others]).with_simd(Scalar::new());
        assert_eq!(Arch::new().dispatch(Ends([numbers, others])), one_by_one);
        let [greater, lesser] = one_by_one.map(|row| row.map(f64::from_bits));
        assert_eq!([greater[0], greater[1], lesser[0], lesser[1]], [2.0, 2.0, 1.0, 1.0]);
        assert!([greater, lesser].iter().all(|row| row[2].is_nan() && row[7].is_nan()));
    }
}
