//! How narrowly roots are enclosed.

use std::fmt;

use crate::Span;

/// How narrowly the [certified](crate::Certified) method encloses roots. Whatever it is, what is said stays proven; wider enclosures take fewer steps.
/// Normals are found within that width of the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// As a picture needs it: of neighbouring rays of a [raster](crate::Raster), which are proven together, to a
    /// [share](Self::SHARE_OF_PIXEL) of the distance between them. Rays that are searched each for its own, and contacts, are told as by
    /// [`Accuracy::NARROW`].
    Pixels,
    /// To this width, relative to t and to 1 where t is smaller. A coarse one leaves more contacts and near misses open. Where rounding does not let
    /// a root be enclosed so narrowly, and wherever this is not positive, it is enclosed as narrowly as rounding lets it.
    Relative(f64),
}

/// The width that numbers have unless asked otherwise.
const NARROW: f64 = 1e-12;

impl Accuracy {
    /// As numbers are wanted that something else is computed from.
    pub const NARROW: Self = Self::Relative(NARROW);

    /// The share of a pixel that counts in pictures, as in Direct3D 11, which places what it draws by eight bits of a pixel.
    pub const SHARE_OF_PIXEL: f64 = 1.0 / 256.0;

    /// The width relative to t along rays that are searched each for its own.
    pub(crate) fn of_single_rays(self) -> f64 {
        match self {
            Self::Pixels => NARROW,
            Self::Relative(width) => width,
        }
    }

    /// How wide the enclosure of a root in a stretch of neighbouring rays may be that are so far apart.
    pub(crate) fn of_neighbours(self, Span { start, end }: Span, distance: f64) -> f64 {
        let width = self.of_single_rays() * start.max(1.0).min(end);
        match self {
            Self::Pixels => width.max(Self::SHARE_OF_PIXEL * distance),
            Self::Relative(_) => width,
        }
    }
}

/// In words.
impl fmt::Display for Accuracy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pixels => write!(formatter, "1/{} of a pixel", Self::SHARE_OF_PIXEL.recip()),
            Self::Relative(width) => write!(formatter, "{width:e} of the distance"),
        }
    }
}
