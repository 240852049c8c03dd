//! Rectangles of a tile's columns and rows.

use std::ops::Range;

/// Some of the columns and rows of a tile, at least one of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) column: usize,
    pub(crate) row: usize,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

impl Area {
    pub(crate) fn columns(self) -> Range<usize> {
        self.column..self.column + self.width
    }

    pub(crate) fn rows(self) -> Range<usize> {
        self.row..self.row + self.height
    }

    /// How many columns or rows it has, whichever are more.
    pub(crate) fn side(self) -> usize {
        self.width.max(self.height)
    }

    /// The places of each row's rays in a tile of so many columns.
    pub(crate) fn places(self, width: usize) -> impl Iterator<Item = Range<usize>> {
        self.rows().map(move |row| row * width + self.column..row * width + self.column + self.width)
    }

    /// Columns and rows of the corners, left to right and top to bottom.
    pub(crate) fn corners(self) -> [(usize, usize); 4] {
        let (left, right) = (self.column, self.column + self.width.saturating_sub(1));
        let (top, bottom) = (self.row, self.row + self.height.saturating_sub(1));
        [(left, top), (right, top), (left, bottom), (right, bottom)]
    }

    /// How far a column and a row are from the middle. Exact.
    pub(crate) fn offset(self, column: usize, row: usize) -> (f64, f64) {
        let from_middle =
            |at: usize, start: usize, length: usize| (at as f64 - start as f64) - 0.5 * (length as f64 - 1.0);
        (from_middle(column, self.column, self.width), from_middle(row, self.row, self.height))
    }

    /// How far the middle is from the tile's first column and row. Exact.
    pub(crate) fn offset_of_first(self) -> (f64, f64) {
        let [across, along] = self.radii();
        (self.column as f64 + across, self.row as f64 + along)
    }

    /// How far columns and rows are from the middle at most. Exact.
    pub(crate) fn radii(self) -> [f64; 2] {
        [self.width, self.height].map(|length| 0.5 * (length as f64 - 1.0))
    }

    /// Blocks of no more than `side` columns and rows.
    pub(crate) fn blocks(self, side: usize) -> impl Iterator<Item = Self> {
        let Self { column, row, width, height } = self;
        (0..height).step_by(side).flat_map(move |down| {
            (0..width).step_by(side).map(move |right| Self {
                column: column + right,
                row: row + down,
                width: side.min(width - right),
                height: side.min(height - down),
            })
        })
    }

    /// The two or four parts of an area that is cut in the middle of its longer side, or of both when they are about equally
    /// long; a single ray stays as it is.
    pub(crate) fn quarters(self) -> impl Iterator<Item = Self> {
        let halves = |start: usize, length: usize, is_cut: bool| {
            let first = if is_cut { length.div_ceil(2) } else { length };
            [(start, first), (start + first, length - first)].into_iter().filter(|(_, length)| *length > 0)
        };
        let columns_are_cut = 2 * self.width > self.height;
        let rows_are_cut = 2 * self.height > self.width;
        halves(self.row, self.height, rows_are_cut).flat_map(move |(row, height)| {
            halves(self.column, self.width, columns_are_cut).map(move |(column, width)| Self {
                column,
                row,
                width,
                height,
            })
        })
    }
}
