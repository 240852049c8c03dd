//! Rays side by side that are followed to their roots where F is monotone.

use glam::DVec3;
use pulp::Simd;

use super::form::ROUNDING;
use super::pixels::state;
use super::pursuit::Guess;
use crate::lanes::{Lanes, Mask, ROW, Row, parts};
use crate::normals::{Asked, put_units};
use crate::raster::RayRow;
use crate::{Hit, Span, Tile};

/// Rays that may each have a root in a part, and what is known of F along them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bundle {
    /// The columns and rows of the rays in the tile, and their places there.
    pub(super) columns: [u32; ROW],
    pub(super) rows: [u32; ROW],
    places: [u32; ROW],
    pub(super) rays: RayRow,
    /// Where the part's certificate holds inside the region: starts and ends.
    pub(super) reach: [Row; 2],
    /// Where a root is looked for: everything before it is free of roots.
    pub(super) wanted: [Row; 2],
    /// Where F is to be taken next, inside `reach`.
    pub(super) t: Row,
    /// F at the last place where its slope was taken, one over the slope, and how far t is from there: infinitely far, with the part's slope in the
    /// middle, before there is any.
    value: Row,
    inverse: Row,
    step: Row,
    pub(super) state: Row,
    /// Of rays that have a root, about where it is, what encloses it, and how far it is from where F was taken last.
    pub(super) root: Row,
    pub(super) bracket: [Row; 2],
    moved: Row,
    /// Whether there are rays with a root whose normals were not found on the way, where they are wanted.
    pub(super) lacks_normals: bool,
}

/// A ray is near its root where another step is expected to leave it known to within no more than so many times the tolerance.
const NEAR: f64 = 8.0;

/// What is to be taken of F next along the rays of a bundle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Need {
    /// Nothing: no ray is open.
    Nothing,
    /// What is wanted where rays meet the surface, for that is where they are likely to be.
    Last,
    /// Its value and its slope, to come nearer.
    Slopes,
}

/// What a double computed for F says about the root, all over a part.
#[derive(Clone, Copy)]
pub(super) struct Sight {
    /// One over the middle of the slopes of F.
    pub(super) inverse: f64,
    /// How far that is from one over any slope, as part of it.
    pub(super) unevenness: f64,
    /// How the slope changes with t, about.
    pub(super) turn: f64,
    /// How much a slope may differ from the one a unit of t away, as part of it, about.
    pub(super) bend: f64,
    /// How much more it may than by its turn.
    pub(super) sway: f64,
    /// How far rounding of F may move a root.
    pub(super) blur: f64,
    /// How wide the enclosure of a root may be.
    pub(super) tolerance: f64,
}

impl Bundle {
    /// Makes these the stretches in which roots are wanted, and in which the certificate holds, along all rays.
    #[inline(always)]
    pub(super) fn look_along(&mut self, [wanted, reach]: [Span; 2]) {
        let all = |Span { start, end }| [[start; ROW], [end; ROW]];
        (self.wanted, self.reach) = (all(wanted), all(reach));
    }

    /// Narrows those of each open ray to what is `within`, given its column and row. A ray without it is left out.
    pub(super) fn clip(&mut self, mut within: impl FnMut(usize, usize) -> Option<[Span; 2]>) {
        for lane in 0..ROW {
            if self.state[lane] != state::OPEN {
                continue;
            }
            match within(self.columns[lane] as usize, self.rows[lane] as usize) {
                Some([wanted, reach]) => {
                    (self.wanted[0][lane], self.wanted[1][lane]) = (wanted.start, wanted.end);
                    (self.reach[0][lane], self.reach[1][lane]) = (reach.start, reach.end);
                }
                None => self.state[lane] = state::FREE,
            }
        }
    }

    /// The place of the first ray where all are neighbours in a row and have a root, as in most bundles.
    #[inline]
    pub(super) fn first_of_hits(&self) -> Option<usize> {
        // Rays stand in the order of their places, and lanes that none fills are no hits.
        let [first, .., last] = self.places;
        let are_neighbours = last - first == ROW as u32 - 1;
        let are_hits = are_neighbours && self.state.iter().all(|state| *state == state::HIT);
        are_hits.then_some(first as usize)
    }

    /// The rays that have a root, and what encloses it.
    pub(super) fn hits(&self) -> impl Iterator<Item = (usize, Hit)> {
        self.in_state(|state| state == state::HIT).map(|lane| {
            (self.places[lane] as usize, Hit { t: self.root[lane], bracket: along(&self.bracket, lane) })
        })
    }

    /// The rays that have a root and no normal among these, where it is wanted, and where.
    pub(super) fn without_normals(&self, normals: &[DVec3]) -> impl Iterator<Item = Asked> {
        let is_without = |(place, _): &(usize, Hit)| normals[*place].x.is_nan();
        self.hits().filter(is_without).map(|(place, Hit { t, .. })| Asked { place, t })
    }

    /// The rays that may have a root, which is to be looked for otherwise, and where.
    pub(super) fn lost(&self) -> impl Iterator<Item = (usize, Span)> {
        self.in_state(|state| state == state::LOST || state == state::OPEN)
            .map(|lane| (self.places[lane] as usize, along(&self.wanted, lane)))
    }

    /// The lanes of the rays in some state.
    fn in_state(&self, is_meant: impl Fn(f64) -> bool) -> impl Iterator<Item = usize> {
        (0..ROW).filter(move |lane| is_meant(self.state[*lane]))
    }

    /// Begins with its open rays, where they are likely to have a root; says whether there are any.
    #[inline(always)]
    pub(super) fn begin<S: Simd>(
        &mut self,
        simd: S,
        tile: &Tile<'_>,
        (guess, sight): (&Guess<'_>, &Sight),
    ) -> bool {
        let (columns, rows, width) = (doubles(&self.columns), doubles(&self.rows), tile.width() as u32);
        for lane in 0..ROW {
            self.places[lane] = self.rows[lane] * width + self.columns[lane];
        }
        let mut is_any_open = Mask::none(simd);
        for part in 0..parts::<S>() {
            is_any_open = is_any_open | self.are_open(simd, part);
        }
        let are_open = is_any_open.is_any();
        if are_open {
            self.set_off(simd, (tile, [&columns, &rows]), (guess, sight));
        }
        are_open
    }

    /// Begins along the rays in these columns and rows, which may stand between those of the tile.
    #[inline(always)]
    fn set_off<S: Simd>(
        &mut self,
        simd: S,
        (tile, [columns, rows]): (&Tile<'_>, [&Row; 2]),
        (guess, sight): (&Guess<'_>, &Sight),
    ) {
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let t = guess.at([at(columns), at(rows)]);
            t.between(at(&self.reach[0]), at(&self.reach[1])).put(&mut self.t, part);
        }
        tile.put_rays(simd, [columns, rows], &mut self.rays);
        (self.step, self.inverse) = ([f64::INFINITY; ROW], [sight.inverse; ROW]);
    }

    /// Rays in these columns and rows, along which F may be taken anywhere in a stretch.
    #[inline(always)]
    pub(super) fn feelers<S: Simd>(
        simd: S,
        (tile, [columns, rows]): (&Tile<'_>, [&Row; 2]),
        stretch: Span,
        (guess, sight): (&Guess<'_>, &Sight),
    ) -> Self {
        let mut feelers = Self { state: [state::OPEN; ROW], ..Self::default() };
        feelers.look_along([stretch; 2]);
        feelers.set_off(simd, (tile, [columns, rows]), (guess, sight));
        feelers
    }

    #[inline(always)]
    fn are_open<S: Simd>(&self, simd: S, part: usize) -> Mask<S> {
        Lanes::of(simd, &self.state, part).is_same(Lanes::all(simd, state::OPEN))
    }

    /// A step towards the roots, by the values and the slopes of F at t: to the root of a parabola that bends as slopes turn at first, and then by
    /// inverse cubic interpolation (Hermite) between there and the last place. By the nearest of the part's slopes where F would have one that it does
    /// not have. Says what is needed next.
    #[inline(always)]
    pub(super) fn approach<S: Simd>(
        &mut self,
        simd: S,
        [values, slopes]: [&Row; 2],
        (sight, is_first): (&Sight, bool),
    ) -> Need {
        let all = |number| Lanes::all(simd, number);
        let one = all(1.0);
        let most = sight.unevenness * sight.inverse.abs();
        let [least, most] = [sight.inverse - most, sight.inverse + most].map(all);
        let near = all(NEAR * sight.tolerance);
        let mut is_any_far = Mask::none(simd);
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (t, value, before) = (at(&self.t), at(values), at(&self.step));
            let inverse = (one / at(slopes)).between(least, most);
            let linear = value * inverse;
            // How far the next place is from the root, about, as part of the step and of its square.
            let (bend, [by_step, by_square]) = if is_first {
                // The root of a parabola as a series (Catalan's numbers), whose next term is 42 times the fifth power.
                let share = linear * inverse * all(0.5 * sight.turn);
                let squared = share * share;
                let series = one + share * (all(2.0) + share * (all(5.0) + share * all(14.0)));
                (-(linear * share * series), [all(42.0) * squared * squared * share.abs(), all(sight.sway)])
            } else {
                let (value_there, inverse_there) = (at(&self.value), at(&self.inverse));
                let per_value = one / (value - value_there);
                let (secant, share) = (before * per_value, value * per_value);
                let curl = inverse_there + inverse - (secant + secant);
                let bend = share * (value * (inverse - secant) - value_there * share * curl);
                let change = before * all(sight.bend);
                (bend, [all(0.0), all(sight.bend) * (change * change).at_most(one)])
            };
            // A bend is a small correction, or is not a number where F was the same before.
            let is_small = (bend + bend).abs().is_less(linear.abs());
            let nearer = is_small.select(t - linear + bend, t - linear);
            let next = nearer.between(at(&self.reach[0]), at(&self.reach[1]));
            let step = next - t;
            let rest = step.abs() * (by_step + step.abs() * by_square);
            let is_far = !(rest * all(sight.unevenness)).is_at_most(near);
            is_any_far = is_any_far | (self.are_open(simd, part) & is_far);
            next.put(&mut self.t, part);
            value.put(&mut self.value, part);
            inverse.put(&mut self.inverse, part);
            step.put(&mut self.step, part);
        }
        if is_any_far.is_any() { Need::Slopes } else { Need::Last }
    }

    /// One step of the interval Newton method, for all slopes of the part at once, where `values` were computed for F at t: the first one, or
    /// another. All roots in reach lie in its result, and if that lies in reach itself, there is one. Where it is about, the last slopes tell. Says
    /// what is needed next.
    #[inline(always)]
    pub(super) fn conclude<S: Simd>(
        &mut self,
        simd: S,
        values: &Row,
        (sight, is_first): (&Sight, bool),
    ) -> Need {
        let all = |number| Lanes::all(simd, number);
        let [free, open] = [all(state::FREE), all(state::OPEN)];
        let [hit, lost] = [all(state::HIT), all(state::LOST)];
        let mut is_any_open = Mask::none(simd);
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (t, value) = (at(&self.t), at(values));

            let offset = value * all(sight.inverse);
            let middle = t - offset;
            let rounding = all(ROUNDING) * (t + offset.abs());
            let radius = offset.abs() * all(sight.unevenness) + all(sight.blur) + rounding;
            let root = [middle - radius, middle + radius];
            let is_free = root[1].is_less(at(&self.wanted[0])) | at(&self.wanted[1]).is_less(root[0]);
            let is_narrow = (radius + radius).is_at_most(all(sight.tolerance));
            let is_inside = at(&self.reach[0]).is_at_most(root[0]) & root[1].is_at_most(at(&self.reach[1]));
            let decided = is_narrow.select(is_inside.select(hit, lost), open);

            let was_open = self.are_open(simd, part);
            let state = was_open.select(is_free.select(free, decided), at(&self.state));
            is_any_open = is_any_open | state.is_same(open);
            state.put(&mut self.state, part);
            let nearest = (t - value * at(&self.inverse)).between(root[0], root[1]);
            // What is not known yet may be written over.
            let put = |row: &mut Row, numbers: Lanes<S>| match is_first {
                true => numbers.put(row, part),
                false => was_open.put(numbers, row, part),
            };
            put(&mut self.root, nearest);
            self.bracket.iter_mut().zip(root).for_each(|(row, end)| put(row, end));
            // Of rays that were decided before, too: they go on with the others of their bundle.
            (at(&self.root) - t).abs().put(&mut self.moved, part);
        }
        if is_any_open.is_any() { self.go_on(simd, values, sight) } else { Need::Nothing }
    }

    /// A step towards the roots of rays that are still open, by the values of F at t and its last slopes. Says what is needed next.
    #[inline(always)]
    fn go_on<S: Simd>(&mut self, simd: S, values: &Row, sight: &Sight) -> Need {
        let all = |number| Lanes::all(simd, number);
        let near = all(NEAR * sight.tolerance);
        let [mut is_any_open, mut is_any_far] = [Mask::none(simd); 2];
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (t, since_slopes, is_open) = (at(&self.t), at(&self.step), self.are_open(simd, part));
            let nearer = t - at(values) * at(&self.inverse);
            let next = nearer.between(at(&self.reach[0]), at(&self.reach[1]));
            let step = next - t;
            let moves = step.is_less(all(0.0)) | all(0.0).is_less(step);
            // About as far as `next` is from the root, as slopes change.
            let rest = (step * since_slopes * all(sight.bend)).abs();
            let is_far = near.is_less(rest * all(sight.unevenness));
            is_any_open = is_any_open | (is_open & moves);
            is_any_far = is_any_far | (is_open & moves & is_far);
            (is_open & !moves).put(all(state::LOST), &mut self.state, part);
            next.put(&mut self.t, part);
            (since_slopes + step).put(&mut self.step, part);
        }
        match (is_any_far.is_any(), is_any_open.is_any()) {
            (true, _) => Need::Slopes,
            (_, true) => Need::Last,
            _ => Need::Nothing,
        }
    }

    /// Puts the normals of rays in their places that meet the surface within `distance` of where these gradients were taken: their directions,
    /// where squares neither overflow nor underflow.
    #[inline(always)]
    pub(super) fn put_normals<S: Simd>(
        &mut self,
        simd: S,
        (gradients, distance): ([&Row; 3], f64),
        normals: &mut [DVec3],
    ) {
        let mut units = [[0.0; ROW]; 4];
        put_units(simd, gradients, &mut units);
        let [x, y, z, are_plain] = &units;
        let (all, mut is_there) = (|number| Lanes::all(simd, number), Row::default());
        let mut is_any_lacking = Mask::none(simd);
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let is_hit = at(&self.state).is_same(all(state::HIT));
            let is_near = at(&self.moved).is_at_most(all(distance)) & all(0.0).is_less(at(are_plain));
            is_any_lacking = is_any_lacking | (is_hit & !is_near);
            (is_near & is_hit).select(all(1.0), all(0.0)).put(&mut is_there, part);
        }
        self.lacks_normals = is_any_lacking.is_any();
        for lane in (0..ROW).filter(|lane| is_there[*lane] > 0.0) {
            normals[self.places[lane] as usize] = DVec3::new(x[lane], y[lane], z[lane]);
        }
    }
}

/// The stretch of the ray in a lane.
fn along([starts, ends]: &[Row; 2], lane: usize) -> Span {
    Span { start: starts[lane], end: ends[lane] }
}

/// Columns or rows as doubles.
#[inline(always)]
fn doubles(numbers: &[u32; ROW]) -> Row {
    let mut doubles = Row::default();
    // As signed ones, for which processors have an instruction.
    doubles.iter_mut().zip(numbers).for_each(|(double, number)| *double = f64::from(*number as i32));
    doubles
}

#[cfg(test)]
mod tests;
