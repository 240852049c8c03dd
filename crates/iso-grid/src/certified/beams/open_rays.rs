//! Which rays of a tile are still followed.

use std::ops::Range;

use crate::area::Area;

/// Those whose first root is still looked for: a bit for each ray of a tile, by its place, so that neighbours are asked together.
#[derive(Debug, Default)]
pub(crate) struct OpenRays {
    /// The tile's columns.
    width: usize,
    /// One more than places up to the end take, so that two can be read together anywhere.
    words: Vec<u64>,
    is_any_closed: bool,
}

impl OpenRays {
    /// How many neighbours in a row are told by one number.
    pub(super) const TOGETHER: usize = u64::BITS as usize;

    /// All rays of a tile of so many columns and rows, in place of others.
    pub(super) fn open_all(&mut self, width: usize, height: usize) {
        self.width = width;
        self.is_any_closed = false;
        self.words.clear();
        self.words.resize(width * height / Self::TOGETHER + 2, u64::MAX);
    }

    /// The tile's columns.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Whether the ray of a place is among them.
    #[inline]
    pub(super) fn holds(&self, place: usize) -> bool {
        self.words[place / Self::TOGETHER] >> (place % Self::TOGETHER) & 1 > 0
    }

    /// Takes out the ray of a place.
    #[inline]
    pub(super) fn close(&mut self, place: usize) {
        self.close_neighbours(place..place + 1);
    }

    /// Takes out neighbours in a row, no more than [`OpenRays::TOGETHER`] of them, by their places.
    #[inline]
    pub(super) fn close_neighbours(&mut self, places: Range<usize>) {
        let (word, shift) = (places.start / Self::TOGETHER, places.start % Self::TOGETHER);
        let bits = first_bits(places.len());
        self.is_any_closed = true;
        self.words[word] &= !(bits << shift);
        // In two steps, for no shift is by all bits.
        self.words[word + 1] &= !(bits >> 1 >> (Self::TOGETHER - 1 - shift));
    }

    /// Of some columns of a row, no more than [`OpenRays::TOGETHER`], a bit for each ray that is among them, from the least significant on.
    #[inline]
    pub(super) fn in_row(&self, row: usize, columns: Range<usize>) -> u64 {
        let place = row * self.width + columns.start;
        let (word, shift) = (place / Self::TOGETHER, place % Self::TOGETHER);
        let [low, high] =
            [self.words[word] >> shift, self.words[word + 1] << 1 << (Self::TOGETHER - 1 - shift)];
        (low | high) & first_bits(columns.len())
    }

    /// Whether any ray of an area is among them.
    pub(super) fn is_any_in(&self, area: Area) -> bool {
        area.rows().any(|row| together(area.columns()).any(|columns| self.in_row(row, columns) > 0))
    }

    /// Whether all rays of the tile are.
    pub(super) fn are_all(&self) -> bool {
        !self.is_any_closed
    }
}

/// Columns in pieces of as many as are told by one number.
pub(super) fn together(columns: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let end = columns.end;
    columns.step_by(OpenRays::TOGETHER).map(move |first| first..end.min(first + OpenRays::TOGETHER))
}

/// The columns, the first of which is this one, whose bits are set.
pub(super) fn columns_of(first: usize, mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let next = (bits > 0).then(|| first + bits.trailing_zeros() as usize);
        bits &= bits.wrapping_sub(1);
        next
    })
}

/// So many bits, no more than there are.
#[inline]
fn first_bits(count: usize) -> u64 {
    u64::MAX.checked_shr((OpenRays::TOGETHER - count) as u32).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;

    use super::*;

    #[test]
    fn rays_are_open_until_they_are_closed() {
        let mut random = Random::new(3);
        let mut rays = OpenRays::default();
        for (width, height) in [(64, 64), (1, 1), (37, 20), (64, 3), (200, 5), (1000, 1), (65, 66)] {
            rays.open_all(width, height);
            let mut expected = vec![true; width * height];
            for _ in 0..200 {
                assert_eq!(rays.are_all(), expected.iter().all(|is_open| *is_open));
                assert!((0..width * height).all(|place| rays.holds(place) == expected[place]));
                let (column, row) = (random.below(width), random.below(height));
                let (across, down) = (1 + random.below(width - column), 1 + random.below(height - row));
                let area = Area { column, row, width: across, height: down };
                let is_any = area.places(width).any(|places| expected[places].contains(&true));
                assert_eq!(rays.is_any_in(area), is_any);
                assert_eq!(rays.in_row(row, column + across..column + across), 0);
                let first = row * width + column;
                for columns in together(column..column + across) {
                    let open: Vec<_> = columns_of(columns.start, rays.in_row(row, columns.clone())).collect();
                    assert!(open.into_iter().eq(columns.filter(|column| expected[row * width + column])));
                }
                if random.below(2) == 0 {
                    rays.close(first);
                    expected[first] = false;
                } else {
                    let places = first..first + across.min(OpenRays::TOGETHER);
                    rays.close_neighbours(places.clone());
                    expected[places].fill(false);
                }
            }
        }
    }
}
