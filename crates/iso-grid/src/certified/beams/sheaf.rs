//! Which rays of a part are pursued: those that are likely to meet the surface there, packed so that few lanes stay empty.

use std::ops::Range;

use pulp::Simd;

use super::bundle::Bundle;
use super::form::Model;
use super::pixels::state;
use super::pursuit::AT_ONCE;
use crate::Span;
use crate::area::Area;
use crate::lanes::{Lanes, ROW};

/// How far apart roots of neighbours must be, relative to where they are, so that roundings are much less.
const DISTINCT: f64 = 1e-9;

/// Such a part of a column is more than roundings of distinct roots come to.
const ROUNDED: f64 = 1e-3;

/// Which rays of a part are likely to have a root in its stretch, by its model.
pub(super) struct Start<'a> {
    model: &'a Model,
    /// The column and the row that the model counts from.
    middle: (f64, f64),
    stretch: Span,
    /// How many columns there are to a unit of t, if roots of neighbours are distinct.
    columns: Option<f64>,
}

impl<'a> Start<'a> {
    /// By a model that counts from this column and row.
    pub(super) fn new(model: &'a Model, middle: (f64, f64), stretch: Span) -> Self {
        let [least, most] = model.around(stretch);
        let size = least.abs() + most.abs() + model.t.abs();
        let columns = 1.0 / model.by_column;
        let are_steps_finite = columns.is_finite() && model.by_column.is_finite() && model.by_row.is_finite();
        let are_distinct = are_steps_finite && DISTINCT * size < model.by_column.abs();
        Self { model, middle, stretch, columns: are_distinct.then_some(columns) }
    }

    /// Where the model has the root of a ray.
    #[inline(always)]
    pub(super) fn at(&self, column: f64, row: f64) -> f64 {
        self.model.at(column - self.middle.0, row - self.middle.1)
    }

    /// The same for rays side by side, to the same bits.
    #[inline(always)]
    pub(super) fn at_all<S: Simd>(&self, [columns, rows]: [Lanes<S>; 2]) -> Lanes<S> {
        let Model { t, by_column, by_row, .. } = *self.model;
        let all = |number| columns.all_be(number);
        let (across, along) = (columns - all(self.middle.0), rows - all(self.middle.1));
        all(t) + (across * all(by_column) + along * all(by_row))
    }

    /// How far from there it may be.
    pub(super) fn uncertainty(&self) -> f64 {
        self.model.uncertainty
    }

    /// The stretch, and as much again before and behind it.
    pub(super) fn around(&self) -> Span {
        let Span { start, end } = self.stretch;
        Span { start: start - (end - start), end: end + (end - start) }
    }

    /// The columns that the model has roots of in the stretch, on both sides of a row; `None` where there is no end to them.
    pub(super) fn band(&self, row: f64) -> Option<Band> {
        let columns = self.columns?;
        let Span { start, end } = self.stretch;
        let Model { t, by_row, .. } = *self.model;
        let there = t + (row - self.middle.1) * by_row;
        Some(Band {
            middle: self.middle.0 + columns * (0.5 * (start + end) - there),
            radius: columns.abs() * 0.5 * (end - start),
            shear: -columns * by_row,
        })
    }

    /// Which of so many neighbours in a row, the first in this column and row, may have a root in the stretch: all that may, and few others.
    #[inline(always)]
    pub(super) fn likely(&self, first: (usize, usize), count: usize) -> Range<usize> {
        self.within(self.model.around(self.stretch), first, count)
    }

    /// Whether all rays of an area are likely to have a root.
    pub(super) fn is_sure_of(&self, area: Area) -> bool {
        area.corners().into_iter().all(|corner| self.is_sure(corner))
    }

    /// Which of those the model has a root of in the stretch, nearly. They are all likely.
    pub(super) fn sure(&self, first: (usize, usize), count: usize) -> Range<usize> {
        self.within([self.stretch.start, self.stretch.end], first, count)
    }

    /// Whether the model has the root of a ray in the stretch.
    pub(super) fn is_sure(&self, (column, row): (usize, usize)) -> bool {
        let Span { start, end } = self.stretch;
        (start..=end).contains(&self.at(column as f64, row as f64))
    }

    /// Those of which the model has a root between these, and few others; no fewer than between others that lie between these.
    #[inline(always)]
    fn within(&self, [least, most]: [f64; 2], (column, row): (usize, usize), count: usize) -> Range<usize> {
        let first = self.at(column as f64, row as f64);
        if !first.is_finite() {
            return 0..count;
        }
        let Some(columns) = self.columns else {
            let change = count as f64 * self.model.by_column.abs();
            let are_far = first + change < least || most < first - change;
            return 0..if are_far { 0 } else { count };
        };
        let [one, other] = [columns * (least - first), columns * (most - first)];
        let (from, to) = if one < other { (one, other) } else { (other, one) };
        whole(from + (1.0 - ROUNDED), count)..whole(to + (1.0 + ROUNDED), count)
    }
}

/// Columns around a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    /// The middle one in that row.
    pub(super) middle: f64,
    /// How far others are from it at most.
    pub(super) radius: f64,
    /// How many columns the middle moves from row to row.
    pub(super) shear: f64,
}

/// What is left of a number without its fraction, from 0 to `most`; of a whole number it may be one less.
///
/// A cast would take several times as long, for it saturates and looks for NaN.
#[inline(always)]
fn whole(number: f64, most: usize) -> usize {
    const SHIFT: f64 = (1_u64 << 52) as f64;
    let most = most as f64 + 0.5;
    let number = if number < most { number } else { most };
    let number = if 0.5 < number { number } else { 0.5 };
    // Numbers of this size have no room for a fraction, and what is less stands in the lowest bits.
    (number - 0.5 + SHIFT).to_bits() as u32 as usize
}

/// Bundles that are filled one after the other, so that few lanes stay empty, and pursued together.
#[derive(Debug, Default)]
pub(crate) struct Sheaf {
    bundles: Vec<Bundle>,
    /// The columns and rows of its rays.
    columns: Vec<u32>,
    rows: Vec<u32>,
    /// How many rays there are so far.
    rays: usize,
}

impl Sheaf {
    /// How many rays it holds at most.
    pub(super) const MOST: usize = AT_ONCE * ROW;

    /// How many more it holds.
    pub(super) fn room(&self) -> usize {
        Self::MOST - self.rays
    }

    /// Adds those of some neighbours in a row of a tile, the first in this column, whose bits are set, from the least significant on. There
    /// is room for all.
    #[inline]
    pub(super) fn add(&mut self, (column, row): (usize, usize), mut bits: u64) {
        // More are written to than are filled.
        self.columns.resize(Self::MOST + ROW, 0);
        self.rows.resize(Self::MOST + ROW, 0);
        let (mut column, row) = (column as u32, row as u32);
        while bits > 0 {
            let skipped = bits.trailing_zeros();
            let count = (bits >> skipped).trailing_ones();
            column += skipped;
            for first in (0..count).step_by(ROW) {
                let place = self.rays + first as usize;
                let numbers: [u32; ROW] = std::array::from_fn(|number| column + first + number as u32);
                self.columns[place..][..ROW].copy_from_slice(&numbers);
                self.rows[place..][..ROW].fill(row);
            }
            self.rays += count as usize;
            column += count;
            bits = bits.checked_shr(skipped + count).unwrap_or(0);
        }
    }

    /// Takes out its bundles.
    pub(super) fn take(&mut self) -> &mut [Bundle] {
        let count = self.rays.div_ceil(ROW);
        // Lanes that no ray fills repeat the last one.
        if let Some(last) = self.rays.checked_sub(1) {
            for numbers in [&mut self.columns, &mut self.rows] {
                let number = numbers[last];
                numbers[self.rays..count * ROW].fill(number);
            }
        }
        self.bundles.resize(count.max(self.bundles.len()), Bundle::default());
        let bundles = &mut self.bundles[..count];
        let (columns, rows) = (self.columns.as_chunks().0, self.rows.as_chunks().0);
        for ((bundle, columns), rows) in bundles.iter_mut().zip(columns).zip(rows) {
            (bundle.columns, bundle.rows) = (*columns, *rows);
            (bundle.state, bundle.lacks_normals) = ([state::OPEN; ROW], false);
        }
        if let [.., last] = &mut *bundles {
            last.state[(self.rays - 1) % ROW + 1..].fill(state::FREE);
        }
        self.rays = 0;
        bundles
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;
    use pulp::Scalar;

    use super::*;
    use crate::lanes::parts;

    /// How far beyond the likely ones a ray may be that is taken along.
    const NEARLY: f64 = 1.01 * ROUNDED;

    #[test]
    fn bundles_hold_the_open_rays_that_are_likely_to_meet_the_surface_and_few_others() {
        let mut random = Random::new(5);
        let mut sheaf = Sheaf::default();
        let [mut fewest, mut most, mut others] = [usize::MAX, 0, 0];
        for round in 0..2000 {
            let width = 1 + random.below(70);
            let mut steps =
                [(); 2].map(|()| random.between(-1.0, 1.0) * 10_f64.powi(-(random.below(18) as i32)));
            steps[round % 2] *= f64::from(u8::from(round % 5 > 0));
            let [by_column, by_row] = steps;
            let t = if round % 50 == 0 { f64::NAN } else { random.between(4.0, 6.0) };
            let uncertainty = random.between(0.0, 0.3);
            let model = match round % 40 {
                // All on the edge, as far as doubles tell.
                1 => Model { t: 5.0, by_column: -1e-18, by_row: 0.0, uncertainty: 0.0 },
                _ => Model { t, by_column, by_row, uncertainty },
            };
            let stretch = Span { start: 5.0, end: random.between(5.0, 6.0) };
            let start = Start::new(&model, (20.5, 3.5), stretch);
            let open: Vec<_> = (0..width).map(|_| random.below(4) > 0).collect();
            let [mut likely, mut nearly] = [vec![], vec![]];
            for row in 0..3 {
                let first = 7 + row;
                let numbers = start.likely((first, row), width);
                let bits =
                    numbers.filter(|number| open[*number]).fold(0_u128, |bits, number| bits | 1 << number);
                // All that are told by one number, and then the others.
                sheaf.add((first, row), bits as u64);
                sheaf.add((first + 64, row), (bits >> 64) as u64);
                for column in (first..first + width).filter(|column| open[column - first]) {
                    let t = model.at(column as f64 - 20.5, row as f64 - 3.5);
                    let [least, most] = model.around(stretch);
                    // Where roots of neighbours are not told apart, all of a row are taken that has some.
                    let margin = model.by_column.abs() * if by_column.abs() < 1e-7 { 70.0 } else { NEARLY };
                    for (rays, margin) in [(&mut likely, 0.0), (&mut nearly, margin)] {
                        let is_far = t < least - margin || most + margin < t;
                        rays.extend((!is_far).then_some((column as u32, row as u32)));
                    }
                }
            }
            let taken = Sheaf::MOST - sheaf.room();
            let mut found = Vec::new();
            for bundle in sheaf.take() {
                assert_eq!(bundle.state[0], state::OPEN);
                let rays: Vec<_> = bundle.columns.into_iter().zip(bundle.rows).collect();
                let (open, free): (Vec<_>, Vec<_>) =
                    (0..ROW).partition(|lane| bundle.state[*lane] == state::OPEN);
                assert!(free.iter().all(|lane| bundle.state[*lane] == state::FREE));
                assert!(free.iter().all(|lane| rays[*lane] == rays[open.len() - 1]));
                found.extend(open.iter().map(|lane| rays[*lane]));
            }
            assert_eq!(found.len(), taken);
            assert!(found.is_sorted_by_key(|(column, row)| (row, column)));
            assert!(likely.iter().all(|ray| found.contains(ray)), "{model:?}, {stretch:?}");
            assert!(found.iter().all(|ray| nearly.contains(ray)), "{model:?}, {stretch:?}");
            (fewest, most) = (fewest.min(found.len()), most.max(found.len()));
            others += found.len() - likely.len();
        }
        assert!(fewest == 0 && most > 100 && others < 2000, "{fewest}..{most}, {others}");
    }

    #[test]
    fn starts_side_by_side_are_those_one_by_one() {
        let mut random = Random::new(7);
        let simd = Scalar::new();
        for _ in 0..1000 {
            let [t, by_column, by_row, column, row] = [(); 5].map(|()| random.between(-9.0, 9.0));
            let model = Model { t, by_column, by_row, uncertainty: 0.1 };
            let start = Start::new(&model, (2.5, -3.5), Span { start: 5.0, end: 6.0 });
            let mut found = [0.0; ROW];
            for part in 0..parts::<Scalar>() {
                start.at_all([column, row].map(|number| Lanes::all(simd, number))).put(&mut found, part);
            }
            assert_eq!(found.map(f64::to_bits), [start.at(column, row).to_bits(); ROW]);
        }
    }

    #[test]
    fn bands_are_where_the_model_has_roots_in_the_stretch() {
        let mut random = Random::new(8);
        for _ in 0..500 {
            let [t, by_column, by_row] = [(); 3].map(|()| random.between(0.1, 5.0));
            let model = Model { t, by_column, by_row: by_row - 2.5, uncertainty: 0.1 };
            let stretch = Span { start: 5.0, end: random.between(5.1, 6.0) };
            let start = Start::new(&model, (20.5, 3.5), stretch);
            let [row, other] = [(); 2].map(|()| random.between(0.0, 60.0));
            let Band { middle, radius, shear } = start.band(row).unwrap();
            let there = middle + shear * (other - row);
            for (column, expected) in [(there - radius, stretch.start), (there + radius, stretch.end)] {
                assert!((start.at(column, other) - expected).abs() < 1e-10);
            }
        }
        let flat = Model { t: 5.5, by_column: 0.0, by_row: 1.0, uncertainty: 0.1 };
        assert!(Start::new(&flat, (3.5, 5.0), Span { start: 5.0, end: 6.0 }).band(2.0).is_none());
    }

    #[test]
    fn where_the_model_has_no_numbers_all_rays_are_likely() {
        let stretch = Span { start: 5.0, end: 6.0 };
        for [t, by_column, by_row] in [
            [5.5, f64::INFINITY, 0.0],
            [5.5, 0.1, f64::INFINITY],
            [5.5, f64::NAN, 0.0],
            [f64::NEG_INFINITY, 0.1, 0.0],
            [f64::NAN, 0.1, 0.1],
        ] {
            let model = Model { t, by_column, by_row, uncertainty: 0.1 };
            for first in [(0, 0), (3, 5)] {
                let start = Start::new(&model, (3.5, 5.0), stretch);
                assert_eq!(start.likely(first, 7), 0..7, "{model:?}");
            }
        }
    }

    #[test]
    fn rays_that_are_sure_to_have_a_root_are_likely_to_have_one() {
        let mut random = Random::new(6);
        let mut most = 0;
        for round in 0..5000 {
            let mut size = || random.between(-1.0, 1.0) * 10_f64.powi(-(random.below(14) as i32));
            let model =
                Model { t: 5.0 + size(), by_column: size(), by_row: size(), uncertainty: size().abs() };
            let stretch = Span { start: 5.0, end: 5.0 + size().abs() };
            let start = Start::new(&model, (20.5, 3.5), stretch);
            let (first, count) = ((round % 40, round % 9), 1 + round % 64);
            let (likely, sure) = (start.likely(first, count), start.sure(first, count));
            let is_within = likely.start <= sure.start && sure.end <= likely.end && likely.end <= count;
            assert!(sure.is_empty() || is_within, "{sure:?} of {likely:?}: {model:?}, {stretch:?}");
            let has_root = |number: &usize| start.is_sure((first.0 + number, first.1));
            assert!((0..count).filter(has_root).all(|number| sure.contains(&number)));
            most = most.max(sure.len());
        }
        assert!(most > 30, "{most}");
    }
}
