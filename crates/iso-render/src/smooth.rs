//! Smooth edges: pictures drawn larger and averaged.

use crate::color::{Color, color_from_srgb, srgb_from_color};
use crate::{Layer, Mosaic, Picture, Size, SizeError};

/// How many pixels, across and down, are drawn for each pixel of the finished picture.
///
/// Along its silhouette a surface covers pixels in part. Each finished pixel is the average, in linear light, of a square
/// of drawn ones: a box filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Smoothing(u32);

impl Smoothing {
    /// Every pixel is drawn once, and is what its ray says.
    pub const NONE: Self = Self(1);
    /// The most pixels, across and down, that are averaged.
    pub const MOST: u32 = 16;

    /// Averages squares of `factor` by `factor` pixels; `None` unless it is from 1 to [`Smoothing::MOST`].
    pub fn new(factor: u32) -> Option<Self> {
        (1..=Self::MOST).contains(&factor).then_some(Self(factor))
    }

    /// The size in which a picture is drawn that shall have `size`.
    ///
    /// # Errors
    /// When there are too many pixels.
    pub fn drawn(self, size: Size) -> Result<Size, SizeError> {
        Size::new(size.width().saturating_mul(self.0), size.height().saturating_mul(self.0))
    }

    /// Turns a picture that was drawn in the size of [`Smoothing::drawn`] into the finished one.
    ///
    /// Only its colours and what covers the background are averaged, for distances, normals, points and statuses have no average: those
    /// layers go. The counts stay those of the drawn pixels.
    pub fn finish(self, picture: &mut Picture) {
        if self == Self::NONE {
            return;
        }
        let drawn = picture.size;
        let size = Size::new(drawn.width() / self.0, drawn.height() / self.0)
            .expect("the finished picture has pixels");
        let places = (0..size.height()).flat_map(|row| (0..size.width()).map(move |column| (column, row)));
        let squares = places.map(|(column, row)| self.square(drawn, column, row));
        let (color, coverage) = if picture.coverage.is_empty() {
            (
                squares.map(|square| srgb_from_color(average(&picture.color, square))).collect(),
                Layer::default(),
            )
        } else {
            let covered = |square| average_of_covered(&picture.color, &picture.coverage, square);
            let (color, coverage): (Vec<_>, Vec<_>) = squares.map(covered).unzip();
            (color.into(), coverage.into())
        };
        (picture.size, picture.color, picture.coverage) = (size, color, coverage);
        picture.depth = Mosaic::default();
        picture.normals = Mosaic::default();
        picture.points = Mosaic::default();
        picture.statuses.clear();
    }

    /// The drawn pixels that belong to a finished one.
    fn square(self, drawn: Size, column: u32, row: u32) -> impl Iterator<Item = usize> + Clone {
        let factor = self.0;
        (0..factor).flat_map(move |line| {
            let start = drawn.offset(column * factor, row * factor + line);
            start..start + factor as usize
        })
    }
}

/// The average of some pixels.
fn average(colors: &[[u8; 3]], pixels: impl Iterator<Item = usize>) -> Color {
    let (sum, count) = pixels
        .fold((Color::ZERO, 0.0), |(sum, count), pixel| (sum + color_from_srgb(colors[pixel]), count + 1.0));
    sum / count
}

/// The average of those of some pixels that are covered, and of their coverage, rounded to nearest.
fn average_of_covered(
    colors: &[[u8; 3]],
    coverage: &[u8],
    pixels: impl Iterator<Item = usize> + Clone,
) -> ([u8; 3], u8) {
    let (sum, count) =
        pixels.clone().fold((0, 0), |(sum, count), pixel| (sum + u32::from(coverage[pixel]), count + 1));
    let color = match sum {
        0 => Color::ZERO,
        _ => average(colors, pixels.filter(|pixel| coverage[*pixel] > 0)),
    };
    (srgb_from_color(color), ((sum + count / 2) / count) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Layers;

    #[test]
    fn squares_of_pixels_are_averaged_in_linear_light() {
        let smoothing = Smoothing::new(2).unwrap();
        let drawn = smoothing.drawn(Size::new(2, 1).unwrap()).unwrap();
        assert_eq!((drawn.width(), drawn.height()), (4, 2));
        let mut picture = Picture::empty(drawn);
        // The left square is half black and half white, the right one of one colour.
        let (black, white, plain) = ([0; 3], [255; 3], [12, 34, 56]);
        picture.color = vec![black, white, plain, plain, white, black, plain, plain].into();
        smoothing.finish(&mut picture);
        // Half of the light is byte 188 in sRGB.
        assert_eq!(*picture.color, [[188; 3], plain]);
        assert_eq!((picture.size.width(), picture.size.height()), (2, 1));
    }

    #[test]
    fn colours_are_those_of_what_is_covered() {
        let smoothing = Smoothing::new(2).unwrap();
        let mut picture = Picture::empty(Size::new(6, 2).unwrap());
        // A quarter of the first square is covered, all of the second, and nothing of the third.
        let (nothing, shown, other) = ([0; 3], [200, 100, 50], [9, 9, 9]);
        let row = [nothing, shown, other, other, nothing, nothing];
        let below = [nothing, nothing, other, other, nothing, nothing];
        picture.color = [row, below].concat().into();
        picture.coverage =
            picture.color.iter().map(|color| if *color == nothing { 0 } else { 255 }).collect();
        smoothing.finish(&mut picture);
        assert_eq!(*picture.color, [shown, other, nothing]);
        assert_eq!(*picture.coverage, [64, 255, 0]);
    }

    #[test]
    fn no_smoothing_changes_nothing() {
        let size = Size::new(3, 2).unwrap();
        let mut picture = Picture::empty(size);
        picture.make_room(Layers { depth: true, ..Layers::COLOR }).unwrap();
        Smoothing::NONE.finish(&mut picture);
        assert_eq!((picture.size, picture.depth.len(), picture.color.len()), (size, 6, 6));
    }

    #[test]
    fn factors_are_bounded() {
        assert!(Smoothing::new(0).is_none() && Smoothing::new(17).is_none());
        let smoothing = Smoothing::new(16).unwrap();
        assert!(smoothing.drawn(Size::new(32768, 32768).unwrap()).is_err());
    }
}
