//! What is known of a function on a box, as in IEEE 1788-2015, clause 11.

use super::Interval;

/// What is known of a function on the box over which it was enclosed, weakest first (IEEE 1788-2015, clause 11.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Decoration {
    /// Nothing: it may be undefined on some of the box.
    Trivial = 0,
    /// It is defined on the whole box.
    Defined = 1,
    /// It is defined on the whole box, and its restriction to the box is continuous.
    Continuous = 2,
    /// It is defined and continuous at every point of the box, which is bounded, and so is the enclosure.
    Common = 3,
}

/// An interval with what is known of the function that it encloses.
///
/// The decoration of a result is the weakest of the operands' decorations, of what the operation is on the operands'
/// intervals, and of [`Decoration::Continuous`] if the result is unbounded. An empty interval is always
/// [`Decoration::Trivial`].
///
/// The difference between the two strongest decorations matters at jumps: ⌊x⌋ on [1, 1.5] is constant, hence
/// `Continuous`, but not `Common`, for it is not continuous at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Decorated {
    /// The enclosure.
    pub interval: Interval,
    /// What is known of the function.
    pub decoration: Decoration,
}

impl Decorated {
    /// The enclosure of a function that is nowhere defined.
    pub const EMPTY: Self = Self { interval: Interval::EMPTY, decoration: Decoration::Trivial };

    /// An argument that runs from `lo` to `hi`: common where that is bounded, continuous where it is not. It is empty when
    /// no real number lies between the ends, as when one of them is NaN. Box kernels read their boxes by this rule.
    #[inline]
    pub fn argument(lo: f64, hi: f64) -> Self {
        Interval::new(lo, hi).map_or(Self::EMPTY, |interval| Self::enclosing(interval, Decoration::Common))
    }

    /// A constant that lies in `enclosure`.
    #[inline]
    pub fn constant(enclosure: Interval) -> Self {
        Self::argument(enclosure.lo, enclosure.hi)
    }

    /// `interval` with `decoration`, or `Continuous` where that promises a bounded enclosure and it is not.
    #[inline]
    pub(super) fn enclosing(interval: Interval, decoration: Decoration) -> Self {
        let bound = if interval.is_bounded() { Decoration::Common } else { Decoration::Continuous };
        Self { interval, decoration: decoration.min(bound) }
    }

    /// The same enclosure, of which no more than `decoration` is known.
    #[inline]
    pub(super) fn at_most(self, decoration: Decoration) -> Self {
        Self { interval: self.interval, decoration: self.decoration.min(decoration) }
    }

    /// The same enclosure, of which nothing is known unless `defined`.
    #[inline]
    pub(super) fn trivial_unless(self, defined: bool) -> Self {
        if defined { self } else { self.at_most(Decoration::Trivial) }
    }
}
