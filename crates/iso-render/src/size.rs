//! The size of a picture.

use thiserror::Error;

/// Width and height in pixels, both at least 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    width: u32,
    height: u32,
}

/// Why a picture cannot have a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SizeError {
    /// A side is zero.
    #[error("a picture needs at least one pixel each way, not {width}x{height}")]
    Empty {
        /// The width as given.
        width: u32,
        /// The height as given.
        height: u32,
    },
    /// There are more pixels than [`Size::MOST_PIXELS`].
    #[error("{width}x{height} are {} pixels; at most {} are allowed (such as 32768x32768)", u64::from(*width) * u64::from(*height), Size::MOST_PIXELS)]
    TooLarge {
        /// The width as given.
        width: u32,
        /// The height as given.
        height: u32,
    },
}

impl Size {
    /// The largest number of pixels in a picture.
    pub const MOST_PIXELS: u64 = 1 << 30;

    /// A picture `width` pixels wide and `height` pixels high.
    ///
    /// # Errors
    /// When a side is zero or there are too many pixels.
    pub fn new(width: u32, height: u32) -> Result<Self, SizeError> {
        if width == 0 || height == 0 {
            return Err(SizeError::Empty { width, height });
        }
        if u64::from(width) * u64::from(height) > Self::MOST_PIXELS {
            return Err(SizeError::TooLarge { width, height });
        }
        Ok(Self { width, height })
    }

    /// Pixels in a row.
    pub const fn width(self) -> u32 {
        self.width
    }

    /// Rows.
    pub const fn height(self) -> u32 {
        self.height
    }

    /// All pixels.
    pub const fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The place of a pixel in a buffer that holds rows from top to bottom.
    pub const fn offset(self, column: u32, row: u32) -> usize {
        row as usize * self.width as usize + column as usize
    }

    /// The column and the row of the pixel in this place of such a buffer.
    pub const fn place(self, offset: usize) -> (u32, u32) {
        ((offset % self.width as usize) as u32, (offset / self.width as usize) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_without_pixels_or_with_too_many_are_refused() {
        assert_eq!(Size::new(0, 3), Err(SizeError::Empty { width: 0, height: 3 }));
        assert!(matches!(Size::new(u32::MAX, u32::MAX), Err(SizeError::TooLarge { .. })));
        assert_eq!(Size::new(32768, 32768).map(Size::pixels), Ok(1 << 30));
    }

    #[test]
    fn pixels_lie_row_by_row() {
        let size = Size::new(3, 2).unwrap();
        let places: Vec<_> = (0..6).map(|offset| size.place(offset)).collect();
        assert_eq!(places, [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]);
        assert!(places.into_iter().map(|(column, row)| size.offset(column, row)).eq(0..6));
    }
}
