//! Rays side by side that are followed to their roots where F is monotone.

use iso_expr::{BatchKernel, Scratch};
use pulp::{Simd, WithSimd};

use super::form::{Model, ROUNDING};
use super::pixels::{End, STEPS};
use crate::batch::PointBatch;
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::raster::RayRow;
use crate::{Hit, Span, Tile};

/// Rays that may each have a root in a part, and what is known of F along them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bundle {
    /// Which rays of the tile, and their columns and rows.
    places: [u32; ROW],
    columns: Row,
    rows: Row,
    rays: RayRow,
    /// Where the part's certificate holds inside the region: starts and ends.
    reach: [Row; 2],
    /// Where a root is looked for: everything before it is free of roots. In the end, what encloses it.
    wanted: [Row; 2],
    /// Where F is to be taken next, inside `reach`. In the end, about where the root is.
    t: Row,
    /// F at the last two places, NaN where that is unknown; how far t is from the last one; and how far t went there for each unit
    /// of F.
    values: [Row; 2],
    step: Row,
    secant: Row,
    state: Row,
}

/// How far a ray of a bundle has come: numbers, as whatever else is known of it.
mod state {
    /// There is no root where one is looked for, or no ray.
    pub(super) const FREE: f64 = 0.0;
    /// Another place is nearer to the root.
    pub(super) const OPEN: f64 = 1.0;
    /// There is one.
    pub(super) const HIT: f64 = 2.0;
    /// Single values do not tell.
    pub(super) const LOST: f64 = 3.0;
}

/// What a double computed for F says about the root, all over a part.
pub(super) struct Sight {
    /// One over the middle of the slopes of F.
    pub(super) inverse: f64,
    /// How far that is from one over any slope, as part of it.
    pub(super) unevenness: f64,
    /// How far rounding of F may move a root.
    pub(super) blur: f64,
    /// How wide the enclosure of a root may be.
    pub(super) tolerance: f64,
}

impl Bundle {
    /// Room for other rays.
    pub(super) fn clear(&mut self) {
        (self.columns, self.rows) = Default::default();
        self.state = [state::FREE; ROW];
    }

    /// Puts a ray in a lane: its place in the tile, its column and its row, where a root is wanted, and where the part's
    /// certificate holds.
    #[inline]
    pub(super) fn put(
        &mut self,
        lane: usize,
        (place, column, row): (usize, usize, usize),
        [wanted, reach]: [Span; 2],
    ) {
        self.places[lane] = place as u32;
        (self.columns[lane], self.rows[lane]) = (column as f64, row as f64);
        (self.wanted[0][lane], self.wanted[1][lane]) = (wanted.start, wanted.end);
        (self.reach[0][lane], self.reach[1][lane]) = (reach.start, reach.end);
        self.state[lane] = state::OPEN;
    }

    /// How each ray ended that may have a root.
    pub(super) fn ends(&self) -> impl Iterator<Item = (usize, End)> {
        (0..ROW).filter_map(|lane| {
            let wanted = Span { start: self.wanted[0][lane], end: self.wanted[1][lane] };
            let end = match self.state[lane] {
                state::FREE => return None,
                state::HIT => End::Hit(Hit { t: self.t[lane], bracket: wanted }),
                _ => End::Lost(wanted),
            };
            Some((self.places[lane] as usize, end))
        })
    }

    /// Begins with the rays that may have roots between these two by a model; says whether there are any.
    #[inline(always)]
    fn begin<S: Simd>(
        &mut self,
        simd: S,
        Start { tile, model, middle, within: [least, most] }: &Start<'_>,
    ) -> bool {
        self.rays = tile.row(simd, &self.columns, &self.rows);
        self.values = [[f64::NAN; ROW]; 2];
        let all = |number| Lanes::all(simd, number);
        let mut are_open = false;
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (across, along) = (at(&self.columns) - all(middle.0), at(&self.rows) - all(middle.1));
            let t = all(model.t) + (across * all(model.by_column) + along * all(model.by_row));
            let is_far = t.is_less(all(*least)) | all(*most).is_less(t);
            t.between(at(&self.reach[0]), at(&self.reach[1])).put(&mut self.t, part);
            let state = is_far.select(all(state::FREE), at(&self.state));
            state.put(&mut self.state, part);
            are_open |= state.is_same(all(state::OPEN)).is_anywhere();
        }
        are_open
    }

    /// One step of the interval Newton method, for all slopes of the part at once, where `values` were computed for F at t. All
    /// roots in reach lie in its result, and if that lies in reach itself, there is one. Where it is about, values so far
    /// tell. Says whether rays are open still.
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S, values: &Row, sight: &Sight) -> bool {
        let all = |number| Lanes::all(simd, number);
        let [free, open] = [all(state::FREE), all(state::OPEN)];
        let [hit, lost] = [all(state::HIT), all(state::LOST)];
        let mut are_open = false;
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (t, value, before) = (at(&self.t), at(values), at(&self.state));
            let wanted = [at(&self.wanted[0]), at(&self.wanted[1])];
            let reach = [at(&self.reach[0]), at(&self.reach[1])];

            let offset = value * all(sight.inverse);
            let middle = t - offset;
            let rounding = all(ROUNDING) * (t + offset.abs());
            let radius = offset.abs() * all(sight.unevenness) + all(sight.blur) + rounding;
            let root = [middle - radius, middle + radius];
            let is_free = root[1].is_less(wanted[0]) | wanted[1].is_less(root[0]);
            let is_narrow = (radius + radius).is_at_most(all(sight.tolerance));
            let is_inside = reach[0].is_at_most(root[0]) & root[1].is_at_most(reach[1]);

            let nearer = self.interpolate((simd, part), [t, value, middle], sight);
            let next = nearer.between(reach[0], reach[1]);
            let step = next - t;
            let moves = step.is_less(all(0.0)) | all(0.0).is_less(step);

            let otherwise = is_narrow.select(is_inside.select(hit, lost), moves.select(open, lost));
            let state = is_free.select(free, otherwise);
            let was_open = before.is_same(open);
            let is_found = was_open & state.is_same(hit);
            let follows = is_found.select(nearer.between(root[0], root[1]), next);
            was_open.select(follows, t).put(&mut self.t, part);
            for (end, side) in self.wanted.iter_mut().enumerate() {
                is_found.select(root[end], wanted[end]).put(side, part);
            }
            step.put(&mut self.step, part);
            let state = was_open.select(state, before);
            state.put(&mut self.state, part);
            are_open |= state.is_same(open).is_anywhere();
        }
        are_open
    }

    /// About where the root is by the last values, the newest of which is `value`, taken at t: by inverse linear and quadratic
    /// interpolation (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4). `otherwise` after the first one, and
    /// when they tell of a slope that F does not have.
    #[inline(always)]
    fn interpolate<S: Simd>(
        &mut self,
        (simd, part): (S, usize),
        [t, value, otherwise]: [Lanes<S>; 3],
        sight: &Sight,
    ) -> Lanes<S> {
        let at = |row: &Row| Lanes::of(simd, row, part);
        let [before, last] = [at(&self.values[0]), at(&self.values[1])];
        let secant = at(&self.step) / (value - last);
        let bend = value * last * (secant - at(&self.secant)) / (value - before);
        last.put(&mut self.values[0], part);
        value.put(&mut self.values[1], part);
        secant.put(&mut self.secant, part);
        let inverse = Lanes::all(simd, sight.inverse);
        let most = Lanes::all(simd, sight.unevenness * sight.inverse.abs());
        let linear = value * secant;
        // A bend is a small correction, and none is known before the third value.
        let is_small = (bend + bend).abs().is_less(linear.abs());
        let interpolated = is_small.select(t - linear + bend, t - linear);
        (secant - inverse).abs().is_at_most(most).select(interpolated, otherwise)
    }
}

/// Where rays of a part begin to be pursued.
pub(super) struct Start<'a> {
    pub(super) tile: &'a Tile<'a>,
    pub(super) model: &'a Model,
    /// The column and the row that the model counts from.
    pub(super) middle: (f64, f64),
    /// By the model, roots lie between these.
    pub(super) within: [f64; 2],
}

/// The pursuit of some rays.
pub(super) struct Pursuit<'a> {
    pub(super) start: &'a Start<'a>,
    pub(super) bundles: &'a mut [Bundle],
    pub(super) sight: &'a Sight,
    pub(super) kernel: &'a dyn BatchKernel,
    pub(super) points: &'a mut PointBatch,
    pub(super) scratch: &'a mut Scratch,
}

/// How many bundles are pursued at once at most: as many as the nearest memory holds with all that is known of them.
pub(super) const AT_ONCE: usize = 32;

impl WithSimd for Pursuit<'_> {
    /// How many values of F it took.
    type Output = usize;

    /// Pursues all rays until they are free, hit or lost.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { start, bundles, sight, kernel, points, scratch } = self;
        let mut evaluations = 0;
        let (mut open, mut count) = ([0; AT_ONCE], 0);
        for (number, bundle) in bundles.iter_mut().enumerate() {
            if bundle.begin(simd, start) {
                open[count] = number;
                count += 1;
            }
        }
        for _ in 0..STEPS {
            if count == 0 {
                break;
            }
            for (coordinates, number) in points.rows(count).zip(&open) {
                let Bundle { rays, t, .. } = &bundles[*number];
                rays.at(simd, t, coordinates);
            }
            evaluations += count * ROW;
            let values = points.evaluate(kernel, scratch, 1);
            let (rows, _) = values.as_chunks();
            let mut kept = 0;
            for (place, values) in rows.iter().enumerate() {
                let number = open[place];
                if bundles[number].look(simd, values, sight) {
                    open[kept] = number;
                    kept += 1;
                }
            }
            count = kept;
        }
        evaluations
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use iso_expr::{Ast, Engine, Interpreter};
    use pulp::{Arch, Scalar};

    use super::*;
    use crate::Raster;

    /// Where the ray of a place meets the sphere.
    fn root_of(place: usize) -> f64 {
        let [x, y] = [place % 8, place / 8].map(|at| 0.05 * (at as f64 - 3.5));
        5.0 - (1.0 - x * x - y * y).sqrt()
    }

    /// Where rays parallel to z end that look for the unit sphere, by what processors do that `run` chooses.
    fn ends_on_a_sphere(run: impl Fn(Pursuit<'_>) -> usize) -> Vec<(usize, Result<Hit, Span>)> {
        let program = Ast::parse("x^2 + y^2 + z^2").unwrap().lower(&[]).unwrap().minus_level(1.0);
        let raster = Raster::Parallel {
            middle: DVec3::new(0.0, 0.0, 5.0),
            right: DVec3::new(0.05, 0.0, 0.0),
            down: DVec3::new(0.0, 0.05, 0.0),
            direction: DVec3::NEG_Z,
        };
        let tile = Tile::of(&raster, [-3.5, -3.5], 8, 8);
        let model = Model { t: 4.1, by_column: 0.0, by_row: 0.0, uncertainty: 0.2 };
        let sight = Sight { inverse: -0.5, unevenness: 0.3, blur: 1e-15, tolerance: 1e-12 };
        let mut bundles = vec![Bundle::default(); 9];
        for (row, bundle) in bundles.iter_mut().enumerate().take(8) {
            bundle.clear();
            for column in 0..8 {
                // The last row's roots lie before what is wanted, the fifth's before where F may be looked at, and the sixth's right
                // before that.
                let from = if row == 7 { 4.3 } else { 3.9 };
                let wanted = Span { start: from, end: 4.6 };
                let begin = match row {
                    5 => 4.1,
                    6 => root_of(8 * row + column) + 1e-13,
                    _ => from,
                };
                let reach = Span { start: begin, end: 4.7 };
                if (row, column) != (2, 3) {
                    bundle.put(column, (8 * row + column, column, row), [wanted, reach]);
                }
            }
        }
        let start = &Start {
            tile: &tile,
            model: &model,
            middle: (3.5, 3.5),
            within: model.around(Span { start: 4.0, end: 4.4 }),
        };
        let kernel = &*Interpreter.batch(&program).unwrap();
        let (mut points, mut scratch) = (PointBatch::default(), Scratch::default());
        let evaluations = run(Pursuit {
            start,
            bundles: &mut bundles,
            sight: &sight,
            kernel,
            points: &mut points,
            scratch: &mut scratch,
        });
        assert!((3 * 64..8 * 64).contains(&evaluations), "{evaluations}");
        let hit = |end| match end {
            End::Hit(hit) => Ok(hit),
            End::Lost(stretch) => Err(stretch),
        };
        bundles.iter().flat_map(Bundle::ends).map(|(place, end)| (place, hit(end))).collect()
    }

    #[test]
    fn rays_end_where_they_meet_the_sphere_on_any_processor() {
        let found = ends_on_a_sphere(|pursuit| Arch::new().dispatch(pursuit));
        assert_eq!(found, ends_on_a_sphere(|pursuit| pursuit.with_simd(Scalar::new())));
        #[cfg(target_arch = "x86_64")]
        if let Some(processor) = pulp::x86::V3::try_new() {
            assert_eq!(found, ends_on_a_sphere(|pursuit| Simd::vectorize(processor, pursuit)));
        }
        assert_eq!(found.len(), 64 - 8 - 1, "the last row is free, and one lane has no ray");
        for (place, hit) in found {
            let root = root_of(place);
            match hit {
                Ok(Hit { t, bracket: Span { start, end } }) => {
                    assert!(start <= t && t <= end && end - start <= 1e-12, "{place}");
                    // The closed form is rounded, too.
                    assert!(start - 1e-15 <= root && root <= end + 1e-15, "{place}");
                    assert!(place / 8 < 5, "{place}");
                }
                Err(stretch) => {
                    assert!(place / 8 >= 5, "{place}");
                    assert_eq!(stretch, Span { start: 3.9, end: 4.6 }, "what is wanted is as before");
                }
            }
        }
    }
}
