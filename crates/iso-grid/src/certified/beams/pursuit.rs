//! The pursuit of the rays of a part to their roots, where F is monotone along them.

use glam::DVec3;
use iso_expr::{BatchKernel, Scratch};
use pulp::{Simd, WithSimd};

use super::bundle::{Bundle, Need, Sight};
use super::cubic::{Cubic, Patch};
use super::pixels::STEPS;
use super::sheaf::Start;
use crate::area::Area;
use crate::lanes::{Lanes, ROW, Row};
use crate::point_rows::{Coordinates, PointRows, row_of};
use crate::{Span, Tile};

/// The pursuit of some rays.
pub(super) struct Pursuit<'a> {
    pub(super) tile: &'a Tile<'a>,
    /// What holds them.
    pub(super) area: Area,
    pub(super) start: &'a Start<'a>,
    pub(super) bundles: &'a mut [Bundle],
    /// Where roots are wanted, and where the certificate holds, if that is the same along all rays and the bundles do not know it.
    pub(super) common: Option<[Span; 2]>,
    pub(super) sight: &'a Sight,
    pub(super) slopes: &'a dyn BatchKernel,
    pub(super) last: Last<'a>,
    pub(super) points: &'a mut PointRows,
    pub(super) scratch: &'a mut Scratch,
}

/// What is taken where rays are likely to meet the surface.
pub(super) enum Last<'a> {
    /// F alone.
    Value(&'a dyn BatchKernel),
    /// F and its gradient, for the normals of a tile.
    Gradient(&'a dyn BatchKernel, &'a mut [DVec3]),
}

/// How many bundles are pursued at once at most: as many as the nearest memory holds with all that is known of them.
pub(super) const AT_ONCE: usize = 32;

/// How many points a pursuit took: those where slopes were taken, and the others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken {
    pub(super) slopes: usize,
    pub(super) last: usize,
}

/// About where the roots of rays are.
pub(super) enum Guess<'a> {
    /// Where the part's linear model has them.
    Linear(&'a Start<'a>),
    /// Where a cubic has them.
    Cubic(Cubic),
}

impl Guess<'_> {
    /// About where those of the rays in these columns and rows are.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, places: [Lanes<S>; 2]) -> Lanes<S> {
        match self {
            Self::Linear(start) => start.at_all(places),
            Self::Cubic(cubic) => cubic.at(places),
        }
    }

    /// Whether roots are likely to be so near that nothing nearer is needed.
    fn is_near(&self, sight: &Sight) -> bool {
        match self {
            Self::Linear(start) => start.uncertainty() <= sight.tolerance,
            Self::Cubic(cubic) => cubic.rest * sight.unevenness + sight.blur <= 0.5 * sight.tolerance,
        }
    }
}

/// Of so many bundles the roots of a few rays tell where those of the others are.
const MANY: usize = 12;

/// How many times more narrowly the roots are found that a cubic is laid through.
const FINER: f64 = 64.0;

/// In so many steps these are found, or the part's slopes say little there.
const ROUNDS: usize = 3;

/// Rays meet a part in a band across its columns where that is narrower than this share of them.
const BAND: f64 = 0.7;

impl Pursuit<'_> {
    /// The columns and rows in which the rays of its bundles are likely to be; `None` where there are few.
    fn patch(&self) -> Option<Patch> {
        let ([first, ..], [.., last]) = (&*self.bundles, &*self.bundles) else { return None };
        let [first, last] = [first.rows[0], last.rows[ROW - 1]].map(f64::from);
        let (column, _) = self.area.offset_of_first();
        let (row, along) = (0.5 * (first + last), 0.5 * (last - first));
        let [across, _] = self.area.radii();
        let whole = Patch { middle: [column, row], radii: [across, along], shear: 0.0 };
        let patch = self.start.band(row).filter(|band| band.radius < BAND * across).map_or(whole, |band| {
            Patch { middle: [band.middle, row], radii: [band.radius, along], shear: band.shear }
        });
        let [across, along] = patch.radii;
        (across.min(along) >= 1.0).then_some(patch)
    }

    /// About where the roots of all rays are, by those of a few; `None` where the model tells that as well.
    #[inline(always)]
    fn feel<S: Simd>(&mut self, simd: S, taken: &mut Taken) -> Option<Cubic> {
        let guess = Guess::Linear(self.start);
        if self.bundles.len() < MANY || guess.is_near(self.sight) || !self.tile.is_dense() {
            return None;
        }
        let patch = self.patch()?;
        let sight = &Sight { tolerance: self.sight.tolerance / FINER, ..*self.sight };
        let stretch = self.start.around();
        let [mut first, mut second] = patch.places().map(|[columns, rows]| {
            Bundle::feelers(simd, (self.tile, [&columns, &rows]), stretch, (&guess, sight))
        });
        let mut is_first = true;
        for _ in 0..ROUNDS {
            let mut coordinates = self.points.replace(2);
            first.rays.at(simd, &first.t, row_of(&mut coordinates, 0));
            second.rays.at(simd, &second.t, row_of(&mut coordinates, 1));
            let rays = [&first, &second].into_iter().map(|bundle| &bundle.rays.directions);
            let (rows, _) = slopes(self.points, (self.tile, rays), self.slopes, self.scratch);
            taken.slopes += 2 * ROW;
            let needs = [
                first.approach(simd, [&rows[0], &rows[2]], (sight, is_first)),
                second.approach(simd, [&rows[1], &rows[3]], (sight, is_first)),
            ];
            if !needs.contains(&Need::Slopes) {
                break;
            }
            is_first = false;
        }
        Some(patch.cubic(simd, [&first.t, &second.t])).filter(|cubic| cubic.rest < self.start.uncertainty())
    }

    /// Begins with all bundles, and puts the points at which F is to be taken first; says which bundles have open rays, and how many these are.
    #[inline(always)]
    fn begin<S: Simd>(&mut self, simd: S, guess: &Guess<'_>) -> ([usize; AT_ONCE], usize) {
        let (mut open, mut count) = ([0; AT_ONCE], 0);
        let mut coordinates = self.points.replace(self.bundles.len());
        for (number, bundle) in self.bundles.iter_mut().enumerate() {
            if let Some(stretches) = self.common {
                bundle.look_along(stretches);
            }
            if bundle.begin(simd, self.tile, (guess, self.sight)) {
                bundle.rays.at(simd, &bundle.t, row_of(&mut coordinates, count));
                open[count] = number;
                count += 1;
            }
        }
        self.points.truncate(count);
        (open, count)
    }
}

/// F and its slopes along rays at all points.
#[inline(always)]
fn slopes<'a, 'b>(
    points: &'a mut PointRows,
    (tile, directions): (&Tile<'_>, impl Iterator<Item = &'b [Row; 3]>),
    kernel: &dyn BatchKernel,
    scratch: &mut Scratch,
) -> (&'a [Row], Coordinates<'a>) {
    match tile.direction() {
        Some(direction) => points.aim(direction),
        None => points.aim_each(directions),
    }
    points.slopes(kernel, scratch)
}

impl WithSimd for Pursuit<'_> {
    type Output = Taken;

    /// Pursues all rays until they are free, hit or lost.
    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Taken {
        let mut taken = Taken::default();
        let cubic = self.feel(simd, &mut taken);
        let guess = cubic.map_or(Guess::Linear(self.start), Guess::Cubic);
        let (mut open, mut count) = self.begin(simd, &guess);
        let Self { tile, bundles, sight, slopes: kernel, mut last, points, scratch, .. } = self;
        let mut need = if guess.is_near(sight) { Need::Last } else { Need::Slopes };
        let [mut is_first, mut is_first_look] = [true; 2];
        for _ in 0..STEPS {
            if count == 0 {
                break;
            }
            let (rows, mut coordinates) = match (need, &last) {
                (Need::Slopes, _) => {
                    let directions = open.iter().map(|number| &bundles[*number].rays.directions);
                    slopes(points, (tile, directions), kernel, scratch)
                }
                (_, Last::Value(kernel)) => points.evaluate(*kernel, scratch, 1),
                (_, Last::Gradient(kernel, _)) => points.evaluate(*kernel, scratch, 4),
            };
            *(if need == Need::Slopes { &mut taken.slopes } else { &mut taken.last }) += count * ROW;
            let (mut kept, mut far) = (0, 0);
            for place in 0..count {
                let number = open[place];
                let bundle = &mut bundles[number];
                let next = match need {
                    Need::Slopes => {
                        bundle.approach(simd, [&rows[place], &rows[count + place]], (sight, is_first))
                    }
                    _ => bundle.conclude(simd, &rows[place], (sight, is_first_look)),
                };
                if let (Need::Last, Last::Gradient(_, normals)) = (need, &mut last) {
                    let gradients = [1, 2, 3].map(|axis| &rows[axis * count + place]);
                    bundle.put_normals(simd, (gradients, sight.tolerance), normals);
                }
                if next != Need::Nothing {
                    bundle.rays.at(simd, &bundle.t, row_of(&mut coordinates, kept));
                    open[kept] = number;
                    kept += 1;
                    far += usize::from(next == Need::Slopes);
                }
            }
            is_first &= need != Need::Slopes;
            is_first_look &= need == Need::Slopes;
            need = if 2 * far > kept { Need::Slopes } else { Need::Last };
            count = kept;
            points.truncate(count);
        }
        taken
    }
}

#[cfg(test)]
mod tests;
