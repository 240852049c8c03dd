//! Which rays of a part are pursued: those that are likely to meet the surface there, packed so that few lanes stay empty.

use std::ops::Range;

use super::bundle::{AT_ONCE, Bundle};
use super::form::Model;
use super::pixels::state;
use crate::Span;
use crate::lanes::ROW;

/// How far apart roots of neighbours must be, relative to where they are, so that roundings are much less.
const DISTINCT: f64 = 1e-9;

/// Where rays of a part are likely to meet the surface.
pub(super) struct Start<'a> {
    model: &'a Model,
    /// The column and the row that the model counts from.
    middle: (f64, f64),
    /// By the model, roots lie between these.
    within: [f64; 2],
    /// How many columns there are to a unit of t, if roots of neighbours are distinct.
    columns: Option<f64>,
}

impl<'a> Start<'a> {
    /// By a model that counts from this column and row, where roots are wanted in a stretch.
    pub(super) fn new(model: &'a Model, middle: (f64, f64), stretch: Span) -> Self {
        let within = model.around(stretch);
        let most = DISTINCT * (within[0].abs() + within[1].abs());
        let columns = 1.0 / model.by_column;
        let are_distinct = most < model.by_column.abs() && columns.is_finite();
        Self { model, middle, within, columns: are_distinct.then_some(columns) }
    }

    /// Whether a ray whose root the model has here has none.
    #[inline(always)]
    fn is_far(&self, t: f64) -> bool {
        let [least, most] = self.within;
        (t < least) | (most < t)
    }

    /// Which of so many neighbours in a row may have likely roots, the first so far from the middle: all of those, and a few more.
    #[inline(always)]
    fn columns(&self, (across, along): (f64, f64), count: usize) -> Range<usize> {
        let [least, most] = self.within;
        let first = self.model.at(across, along);
        let Some(columns) = self.columns.filter(|_| first.is_finite()) else { return 0..count };
        let ends = [columns * (least - first), columns * (most - first)];
        // One more at both ends makes up for roundings. Casts saturate.
        let start = (ends[0].min(ends[1]) - 1.0) as usize;
        let end = (ends[0].max(ends[1]) + 2.0) as usize;
        start.min(count)..end.min(count)
    }
}

/// Bundles that are filled one after the other, so that few lanes stay empty, and pursued together.
#[derive(Debug, Default)]
pub(crate) struct Sheaf {
    bundles: Vec<Bundle>,
    /// How many rays are in them so far.
    rays: usize,
}

impl Sheaf {
    /// How many rays it holds at most.
    pub(super) const MOST: usize = AT_ONCE * ROW;

    /// How many more it holds.
    pub(super) fn room(&self) -> usize {
        Self::MOST - self.rays
    }

    /// Adds those of some neighbours in a row of a tile, the first in this column and this place, that are open and may have a root by the
    /// model. There is room for all.
    #[inline]
    pub(super) fn add(
        &mut self,
        ((column, row), place): ((usize, usize), usize),
        open: &[bool],
        start: &Start<'_>,
    ) {
        if self.bundles.is_empty() {
            // One more is written to than is filled.
            self.bundles = vec![Bundle::default(); AT_ONCE + 1];
        }
        let (across, along) = (column as f64 - start.middle.0, row as f64 - start.middle.1);
        let mut rays = self.rays;
        for number in start.columns((across, along), open.len()) {
            let t = start.model.at(across + number as f64, along);
            let (bundle, lane) = (&mut self.bundles[rays / ROW], rays % ROW);
            bundle.places[lane] = (place + number) as u32;
            (bundle.columns[lane], bundle.rows[lane]) = ((column + number) as f64, row as f64);
            bundle.t[lane] = t;
            // Written over by the next unless it is counted, for which of them are cannot be foreseen.
            rays += usize::from(open[number] & !start.is_far(t));
        }
        self.rays = rays;
    }

    /// Takes out its bundles, for roots that are wanted where the part's certificate holds.
    pub(super) fn take(&mut self, [wanted, reach]: [Span; 2]) -> &mut [Bundle] {
        let bundles = &mut self.bundles[..self.rays.div_ceil(ROW)];
        for bundle in &mut *bundles {
            bundle.state = [state::OPEN; ROW];
            bundle.wanted = [[wanted.start; ROW], [wanted.end; ROW]];
            bundle.reach = [[reach.start; ROW], [reach.end; ROW]];
        }
        if let [.., last] = &mut *bundles {
            let filled = (self.rays - 1) % ROW + 1;
            last.state[filled..].fill(state::FREE);
            // What stands behind may be of a larger tile.
            for row in [&mut last.columns, &mut last.rows, &mut last.t] {
                let first = row[0];
                row[filled..].fill(first);
            }
        }
        self.rays = 0;
        bundles
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;

    use super::*;

    #[test]
    fn bundles_hold_the_open_rays_that_are_likely_to_meet_the_surface_and_no_others() {
        let mut random = Random::new(5);
        let mut sheaf = Sheaf::default();
        let [mut fewest, mut most] = [usize::MAX, 0];
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
            let (mut expected, mut found) = (Vec::new(), Vec::new());
            for row in 0..3 {
                let first = 7 + row;
                sheaf.add(((first, row), 100 * row), &open, &start);
                expected.extend((0..width).filter(|number| open[*number]).filter_map(|number| {
                    let t = model.at((first + number) as f64 - 20.5, row as f64 - 3.5);
                    let [least, most] = model.around(stretch);
                    let is_far = t < least || most < t;
                    (!is_far).then_some((100 * row + number, first + number, row, t.to_bits()))
                }));
            }
            assert_eq!(sheaf.room(), Sheaf::MOST - expected.len());
            for bundle in sheaf.take([stretch; 2]) {
                assert!(bundle.state[0] == state::OPEN && bundle.wanted == bundle.reach);
                let rays: Vec<_> = bundle.columns.into_iter().zip(bundle.rows).collect();
                let are_free = bundle.state.iter().map(|state| *state == state::FREE);
                assert!(are_free.zip(&rays).all(|(is_free, ray)| !is_free || *ray == rays[0]));
                found.extend((0..ROW).filter(|lane| bundle.state[*lane] == state::OPEN).map(|lane| {
                    let [column, row] = [bundle.columns[lane] as usize, bundle.rows[lane] as usize];
                    (bundle.places[lane] as usize, column, row, bundle.t[lane].to_bits())
                }));
            }
            assert_eq!(found, expected, "{model:?}, {stretch:?}");
            (fewest, most) = (fewest.min(found.len()), most.max(found.len()));
        }
        assert!(fewest == 0 && most > 100, "{fewest}..{most}");
    }
}
