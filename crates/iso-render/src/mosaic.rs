//! Layers that are kept tile by tile.

use std::fmt;

use bytemuck::Pod;

use crate::layer::Layer;
use crate::size::Size;

/// Width and height of a tile: small enough to balance cores, large enough to fill batches.
pub(crate) const TILE: u32 = 64;

/// A rectangle of pixels that is drawn at once: a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) column: u32,
    pub(crate) row: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Area {
    /// The tiles of a picture, row by row.
    pub(crate) fn tiles(size: Size) -> Vec<Self> {
        let starts = |length: u32| (0..length).step_by(TILE as usize);
        starts(size.height())
            .flat_map(|row| starts(size.width()).map(move |column| Self::around(size, column, row)))
            .collect()
    }

    /// The tile that a pixel lies in.
    fn around(size: Size, column: u32, row: u32) -> Self {
        let (column, row) = (column - column % TILE, row - row % TILE);
        let (width, height) = (TILE.min(size.width() - column), TILE.min(size.height() - row));
        Self { column, row, width, height }
    }

    /// Where its pixels begin among those of its row of tiles, tile by tile.
    fn start(self) -> usize {
        self.column as usize * self.height as usize
    }

    fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A number or vector for each pixel of a picture, NaN where nothing was found.
///
/// Pixels lie tile by tile, as they are drawn. Tiles in which nothing was found are noted as such, and their memory is not touched.
#[derive(Clone)]
pub struct Mosaic<T: Pod> {
    /// `None` when the layer is not kept.
    size: Option<Size>,
    pixels: Layer<T>,
    /// Which tiles, row by row, hold anything.
    are_held: Vec<bool>,
}

/// What stands for nothing in a [`Mosaic`].
pub trait Nothing: Pod {
    /// NaN.
    const NOTHING: Self;
}

impl Nothing for f64 {
    const NOTHING: Self = Self::NAN;
}

impl Nothing for glam::Vec3 {
    const NOTHING: Self = Self::NAN;
}

impl Nothing for glam::DVec3 {
    const NOTHING: Self = Self::NAN;
}

impl<T: Nothing> Mosaic<T> {
    /// How many pixels there are: none when the layer is not kept.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// All pixels, row by row.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = T> {
        (0..self.len()).map(|pixel| self.get(pixel))
    }

    /// The pixel of this number, row by row; below [`Mosaic::len`].
    pub fn get(&self, pixel: usize) -> T {
        let size = self.size.expect("there are no pixels of a layer that is not kept");
        let (column, row) = size.place(pixel);
        let tile = Area::around(size, column, row);
        let number = row / TILE * size.width().div_ceil(TILE) + column / TILE;
        if !self.are_held[number as usize] {
            return T::NOTHING;
        }
        let strip = tile.row as usize * size.width() as usize;
        let inside = ((row - tile.row) * tile.width + column - tile.column) as usize;
        self.pixels[strip + tile.start() + inside]
    }

    /// Gives it the pixels of a picture of this size, which mean nothing, or none, and keeps its memory where it has as many; `None` when
    /// memory does not suffice.
    pub(crate) fn make_room(&mut self, size: Option<Size>) -> Option<()> {
        self.pixels.make_room(size.map_or(0, Size::pixels))?;
        if self.size != size {
            self.size = size;
            self.are_held = vec![false; size.map_or(0, |size| Area::tiles(size).len())];
        }
        Some(())
    }

    /// Its rows of tiles, from top to bottom, and then empty ones.
    pub(crate) fn strips<'a>(&'a mut self) -> impl FnMut() -> Strip<'a, T> {
        let width = self.size.map_or(1, |size| size.width());
        let mut pixels = self.pixels.chunks_mut(width as usize * TILE as usize);
        let mut are_held = self.are_held.chunks_mut(width.div_ceil(TILE) as usize);
        move || Strip {
            pixels: pixels.next().unwrap_or_default(),
            are_held: are_held.next().unwrap_or_default(),
        }
    }
}

/// No pixels: a layer that is not kept.
impl<T: Nothing> Default for Mosaic<T> {
    fn default() -> Self {
        Self { size: None, pixels: Layer::default(), are_held: Vec::new() }
    }
}

impl<T: Nothing + fmt::Debug> fmt::Debug for Mosaic<T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.iter()).finish()
    }
}

/// A row of tiles; empty when the layer is not kept.
pub(crate) struct Strip<'a, T> {
    pixels: &'a mut [T],
    are_held: &'a mut [bool],
}

impl<T> Strip<'_, T> {
    /// Puts the pixels of a tile in their place, row by row, if the layer is kept.
    pub(crate) fn put(&mut self, tile: Area, pixels: impl Iterator<Item = T>) {
        if let Some(is_held) = self.are_held.get_mut((tile.column / TILE) as usize) {
            *is_held = true;
            let places = &mut self.pixels[tile.start()..][..tile.pixels()];
            places.iter_mut().zip(pixels).for_each(|(place, pixel)| *place = pixel);
        }
    }

    /// Notes that nothing was found in any of its tiles.
    pub(crate) fn clear(&mut self) {
        self.are_held.fill(false);
    }
}

#[cfg(test)]
mod tests {
    use std::iter::{repeat, repeat_with};

    use super::*;

    /// Pictures of one tile and of several, the last ones smaller.
    #[test]
    fn pixels_lie_in_their_rows_and_those_of_other_tiles_are_nothing() {
        for (width, height) in [(1, 1), (64, 64), (65, 3), (130, 200)] {
            let size = Size::new(width, height).unwrap();
            let mut mosaic = Mosaic::default();
            assert!(mosaic.is_empty());
            for is_held in [|_| true, |tile: usize| tile.is_multiple_of(2), |tile: usize| tile % 3 == 1] {
                mosaic.make_room(Some(size)).unwrap();
                let mut strips: Vec<_> =
                    repeat_with(mosaic.strips()).take(height.div_ceil(TILE) as usize).collect();
                strips.iter_mut().for_each(Strip::clear);
                let tiles = Area::tiles(size).into_iter().enumerate();
                for (_, tile) in tiles.filter(|(number, _)| is_held(*number)) {
                    let strip = &mut strips[(tile.row / TILE) as usize];
                    let rows = tile.row..tile.row + tile.height;
                    let pixels = rows.flat_map(|row| {
                        let start = size.offset(tile.column, row);
                        (start..start + tile.width as usize).map(|pixel| pixel as f64)
                    });
                    strip.put(tile, pixels);
                }
                drop(strips);
                assert_eq!(mosaic.len(), size.pixels());
                let across = width.div_ceil(TILE);
                for (pixel, found) in mosaic.iter().enumerate() {
                    let (column, row) = size.place(pixel);
                    let tile = row / TILE * across + column / TILE;
                    let expected = if is_held(tile as usize) { pixel as f64 } else { f64::NAN };
                    assert_eq!(found.to_bits(), expected.to_bits());
                }
            }
        }
    }

    #[test]
    fn layers_that_are_not_kept_take_nothing() {
        let size = Size::new(70, 70).unwrap();
        let mut mosaic = Mosaic::default();
        mosaic.make_room(Some(size)).unwrap();
        mosaic.make_room(None).unwrap();
        let tile = Area::tiles(size)[1];
        let mut strip = mosaic.strips()();
        strip.put(tile, repeat(1.0));
        strip.clear();
        assert!(mosaic.is_empty());
        assert_eq!(mosaic.iter().len(), 0);
    }
}
