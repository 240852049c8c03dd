//! Constants: a double for evaluation, and an enclosure of the real number that it stands for.

use std::hash::{Hash, Hasher};

use crate::interval::Interval;

/// A constant of a program.
///
/// A literal is the double it reads as, taken exactly, so its enclosure is that one point. `pi`, `e` and constants folded
/// from several literals are real numbers that no double may equal: `value` is what IEEE arithmetic gives for them,
/// `enclosure` is certain to hold them.
///
/// Two constants are equal when all their bits are: −0 and +0 differ, and any NaN equals the same NaN.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    value: f64,
    enclosure: Interval,
}

impl Constant {
    /// The real number π.
    pub const PI: Self = Self::between(std::f64::consts::PI, std::f64::consts::PI.next_up());
    /// The real number τ = 2π.
    pub const TAU: Self = Self::between(std::f64::consts::TAU, std::f64::consts::TAU.next_up());
    /// The real number e, whose nearest double lies below it.
    pub const E: Self = Self::between(std::f64::consts::E, std::f64::consts::E.next_up());

    pub(crate) const ONE: Self = Self::between(1.0, 1.0);

    /// The double `value`, exactly. A NaN has the empty enclosure: it is no real number.
    pub fn exact(value: f64) -> Self {
        Self { value, enclosure: Interval::point(value) }
    }

    /// A real number that evaluates to `value` in IEEE arithmetic and lies in `enclosure`.
    pub const fn folded(value: f64, enclosure: Interval) -> Self {
        Self { value, enclosure }
    }

    const fn between(lo: f64, hi: f64) -> Self {
        Self { value: lo, enclosure: Interval { lo, hi } }
    }

    /// What IEEE arithmetic computes with.
    pub const fn value(self) -> f64 {
        self.value
    }

    /// An interval certain to hold the real number.
    pub const fn enclosure(self) -> Interval {
        self.enclosure
    }

    /// Whether the double `value()` is the real number itself.
    pub fn is_exact(self) -> bool {
        self.enclosure.lo == self.value && self.enclosure.hi == self.value
    }

    /// The constant with the other sign.
    pub const fn negated(self) -> Self {
        Self { value: -self.value, enclosure: Interval { lo: -self.enclosure.hi, hi: -self.enclosure.lo } }
    }

    fn bits(self) -> [u64; 3] {
        [self.value.to_bits(), self.enclosure.lo.to_bits(), self.enclosure.hi.to_bits()]
    }
}

impl PartialEq for Constant {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for Constant {}

impl Hash for Constant {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}
