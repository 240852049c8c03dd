//! Sums and products of two doubles without error, and numbers of twice the precision for tables.

/// hi + lo, where |lo| is at most half of hi's last place.
#[derive(Clone, Copy)]
pub(super) struct Double {
    pub(super) hi: f64,
    pub(super) lo: f64,
}

impl Double {
    pub(super) const ZERO: Self = Self::from(0.0);

    pub(super) const fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// a + b, exactly (Knuth).
    #[inline(always)]
    pub(super) const fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let from_b = hi - a;
        Self { hi, lo: (a - (hi - from_b)) + (b - from_b) }
    }

    /// a + b, exactly, where a is zero, no smaller than b, or a multiple of b's last place (Dekker).
    #[inline(always)]
    pub(super) fn ordered_sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// a·b, exactly where nothing underflows.
    #[inline(always)]
    pub(super) fn product(a: f64, b: f64) -> Self {
        let hi = a * b;
        Self { hi, lo: a.mul_add(b, -hi) }
    }

    /// With the other sign where the highest bit of a word is set.
    #[inline(always)]
    pub(super) fn signed(self, sign: u64) -> Self {
        let [hi, lo] = [self.hi, self.lo].map(|a| f64::from_bits(a.to_bits() ^ sign));
        Self { hi, lo }
    }
}

/// For tables, which the compiler fills: relative errors are below 2⁻¹⁰⁰ where nothing cancels.
impl Double {
    pub(super) const fn plus(self, other: Self) -> Self {
        let sum = Self::sum(self.hi, other.hi);
        let lows = Self::sum(self.lo, other.lo);
        let sum = Self::sum(sum.hi, sum.lo + lows.hi);
        Self::sum(sum.hi, sum.lo + lows.lo)
    }

    pub(super) const fn times(self, other: Self) -> Self {
        let Self { hi, lo } = product(self.hi, other.hi);
        Self::sum(hi, lo + (self.hi * other.lo + self.lo * other.hi))
    }

    pub(super) const fn over(self, divisor: f64) -> Self {
        let first = self.hi / divisor;
        let rest = self.plus(product(-first, divisor));
        let second = rest.hi / divisor;
        let rest = rest.plus(product(-second, divisor));
        Self::sum(first, second).plus(Self::from(rest.hi / divisor))
    }

    /// The sums of aⁿ/n! over the n that leave 0, 1, 2 and 3 when divided by four, for a up to π/2.
    pub(super) const fn series(self) -> [Self; 4] {
        let (mut term, mut sums) = (Self::from(1.0), [Self::ZERO; 4]);
        let mut power = 0;
        while power < 32 {
            sums[power % 4] = sums[power % 4].plus(term);
            power += 1;
            term = term.times(self).over(power as f64);
        }
        sums
    }

    /// Of numbers up to 0.2.
    pub(super) const fn inverse_hyperbolic_tangent(self) -> Self {
        let square = self.times(self);
        let (mut power, mut sum) = (self, Self::ZERO);
        let mut degree = 1;
        while degree < 48 {
            sum = sum.plus(power.over(degree as f64));
            power = power.times(square);
            degree += 2;
        }
        sum
    }

    pub(super) const fn negated(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

/// a·b, exactly, without a fused multiplication, which constants cannot have (Dekker).
const fn product(a: f64, b: f64) -> Double {
    let (a1, a2) = halves(a);
    let (b1, b2) = halves(b);
    let hi = a * b;
    Double { hi, lo: ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2 }
}

/// The upper and the lower 26 bits of a significand (Veltkamp).
const fn halves(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}
