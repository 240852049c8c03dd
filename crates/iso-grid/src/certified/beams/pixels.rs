//! The roots of single rays of a beam along which F is monotone.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decoration, Interval, Program};

use super::area::Area;
use super::form::{Form, ROUNDING};
use super::subdivision::{Part, Subdivision};
use crate::certified::clip::Clip;
use crate::certified::kernels::Kernels;
use crate::{Hit, Kernel, Outcome, Span, Workspace};

/// How many values of F a ray is given at most before it is searched for its own.
const STEPS: usize = 10;

/// An enclosure of a root no wider than this many times what rounding of F alone makes it is as narrow as it gets.
const ROUNDINGS: f64 = 2.0;

/// Shorter kernels are made for a part when it has so many rays.
const MANY: usize = 64;

/// A ray that may have a root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixel {
    /// Which ray of the tile.
    place: usize,
    /// Where F is known to be monotone inside the region.
    reach: Span,
    /// Where a root is looked for: everything before it is free of roots.
    wanted: Span,
    /// Near the root, inside `reach`.
    t: f64,
    /// F at the last place, and how far that is from `t`.
    value: f64,
    step: f64,
}

/// What a double computed for F says about the root, all over a part.
struct Sight {
    /// One over the middle of the slopes of F.
    inverse: f64,
    /// How far that is from one over any slope, as part of it.
    unevenness: f64,
    /// How far rounding of F may move a root.
    blur: f64,
    /// How wide the enclosure of a root may be.
    tolerance: f64,
}

/// What a value told of a pixel.
enum Verdict {
    /// There is no root where one is looked for.
    Free,
    /// There is one, narrowly enclosed.
    Hit(Hit),
    /// Another place is nearer to the root.
    Open,
    /// Single values do not tell.
    Lost,
}

impl Subdivision<'_> {
    /// Ends or goes on with each ray of a part by its root there.
    pub(super) fn follow_each(&mut self, mut part: Part, form: &Form) {
        part.kernels = self.kernels_for(&part, form);
        let part = &part;
        let Some(sight) = self.sight(part, form) else { return self.search_each(part) };
        let mut pixels = std::mem::take(&mut self.workspace.pixels);
        pixels.clear();
        self.start(part, form, &mut pixels);
        for step in 1..=STEPS {
            if pixels.is_empty() {
                break;
            }
            self.approach(part, &mut pixels, &sight, step == STEPS);
        }
        self.workspace.pixels = pixels;
    }

    /// The kernels for the rays of a part: shorter ones made for this part alone, where so many rays may gain.
    fn kernels_for(&self, part: &Part, form: &Form) -> Arc<Kernels> {
        let Area { width, height, .. } = part.beam.area;
        let kernels = &part.kernels;
        if !kernels.may_be_shortened() || width * height < MANY {
            return Arc::clone(kernels);
        }
        let bounds = part.beam.bounds(form.reach, &self.certified.region).map(|(lo, hi)| outwards(lo, hi));
        let shortened = bounds.and_then(|bounds| kernels.shortened(bounds));
        shortened.map_or_else(|| Arc::clone(kernels), Arc::new)
    }

    /// What values say over a part. `None` when rounding is not bounded there.
    fn sight(&mut self, part: &Part, form: &Form) -> Option<Sight> {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        let (lo, hi) = part.beam.bounds(form.reach, &self.certified.region)?;
        let sides = outwards(lo, hi);
        boxes.clear();
        boxes.push(sides.map(|side| side.lo).into(), sides.map(|side| side.hi).into());
        boxes.evaluate(part.kernels.rounding(), scratch, 5);
        counters.box_evaluations += 1;
        counters.operations += part.kernels.operations(Kernel::RoundingBounds);
        let decoration = |output| boxes.decorated(output, 0).decoration;
        let is_known = decoration(0) == Decoration::Common
            && (1..5).all(|output| decoration(output) >= Decoration::Defined);
        let magnitude = |output| boxes.interval(output, 0).magnitude();
        let gradient = DVec3::from_array([2, 3, 4].map(magnitude));
        let way = form.reach.end * part.beam.directions.largest();
        let points = gradient.dot(way + lo.abs().max(hi.abs()) + f64::MIN_POSITIVE);
        let error = (1.0 + ROUNDING) * Program::ROUNDING_UNIT * (magnitude(1) + points);

        let slope = form.slope;
        let least = (1.0 - ROUNDING) * (slope.middle.abs() - slope.radius);
        let blur = (1.0 + ROUNDING) * error / least;
        let tolerance = self.certified.accuracy * part.stretch.start.max(1.0).min(part.stretch.end);
        let is_finite = blur.is_finite() && least > 0.0;
        (is_known && is_finite).then(|| Sight {
            inverse: 1.0 / slope.middle,
            unevenness: (1.0 + ROUNDING) * slope.radius / least,
            blur,
            tolerance: tolerance.max(2.0 * ROUNDINGS * blur),
        })
    }

    /// The rays of a part that are still followed. Those that may have a root so near to a face of the region that no
    /// point inside is known are searched each for its own.
    fn start(&mut self, part: &Part, form: &Form, pixels: &mut Vec<Pixel>) {
        let Part { beam, stretch, is_inside, .. } = part;
        for row in beam.area.rows() {
            for column in beam.area.columns() {
                let place = row * self.bundle.area.width + column;
                if !self.open[place] {
                    continue;
                }
                let (mut wanted, mut reach) = (*stretch, form.reach);
                if !is_inside {
                    let clip = Clip::new(&self.certified.region, &self.bundle.rays[place]);
                    let Some(Clip { outer, inner }) = clip else { continue };
                    wanted = common(wanted, outer);
                    reach = common(reach, inner);
                }
                if wanted.start > wanted.end {
                    continue;
                }
                if reach.start > reach.end {
                    self.search_one(place, wanted, &part.kernels);
                    continue;
                }
                let (across, along) = beam.area.offset(column, row);
                let t = form.estimate(across, along).max(reach.start).min(reach.end);
                pixels.push(Pixel { place, reach, wanted, t, value: f64::NAN, step: f64::NAN });
            }
        }
    }

    /// Takes F at each pixel's t, and keeps the pixels that are nearer to their roots by that. The last time, those
    /// are searched each for its own.
    fn approach(&mut self, part: &Part, pixels: &mut Vec<Pixel>, sight: &Sight, is_last: bool) {
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        points.clear();
        points.extend(pixels.iter().map(|pixel| self.bundle.rays[pixel.place].at(pixel.t)));
        counters.trace_evaluations += pixels.len() as u64;
        counters.operations += pixels.len() as u64 * part.kernels.operations(Kernel::Values);
        let values = points.evaluate(part.kernels.points(), scratch, 1);
        let mut lost = Vec::new();
        let mut kept = 0;
        for number in 0..pixels.len() {
            let mut pixel = pixels[number];
            match pixel.look(values[number], sight) {
                Verdict::Open if !is_last => {
                    pixels[kept] = pixel;
                    kept += 1;
                }
                Verdict::Open | Verdict::Lost => lost.push(pixel),
                Verdict::Free => {}
                Verdict::Hit(hit) => {
                    self.outcomes[pixel.place] = Outcome::Hit(hit);
                    self.open[pixel.place] = false;
                }
            }
        }
        pixels.truncate(kept);
        for pixel in lost {
            self.search_one(pixel.place, pixel.wanted, &part.kernels);
        }
    }
}

impl Pixel {
    /// One step of the interval Newton method, for all slopes of the part at once, and one of the secant method, where
    /// `value` was computed for F at t. All roots in reach lie in the result of the first, and if that lies in
    /// reach itself, there is one; the second tells where it is about.
    fn look(&mut self, value: f64, sight: &Sight) -> Verdict {
        let Sight { inverse, unevenness, blur, tolerance } = *sight;
        let offset = value * inverse;
        let middle = self.t - offset;
        let rounding = ROUNDING * (self.t + offset.abs());
        let radius = offset.abs() * unevenness + blur + rounding;
        let root = Span { start: middle - radius, end: middle + radius };
        if root.end < self.wanted.start || self.wanted.end < root.start {
            return Verdict::Free;
        }
        // The slope between the last two places, if it is one that F may have.
        let secant = self.step / (value - self.value);
        let is_slope = (secant - inverse).abs() <= unevenness * inverse.abs();
        let nearer = if is_slope { self.t - value * secant } else { middle };
        if 2.0 * radius <= tolerance {
            let is_inside = self.reach.start <= root.start && root.end <= self.reach.end;
            let t = nearer.max(root.start).min(root.end);
            return if is_inside { Verdict::Hit(Hit { t, bracket: root }) } else { Verdict::Lost };
        }
        let next = nearer.max(self.reach.start).min(self.reach.end);
        let step = next - self.t;
        if step == 0.0 || !nearer.is_finite() {
            return Verdict::Lost;
        }
        (self.t, self.value, self.step) = (next, value, step);
        Verdict::Open
    }
}

/// The sides of a box in which the points of its rays lie, which are computed by two roundings: it is two doubles larger at each
/// side.
fn outwards(lo: DVec3, hi: DVec3) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval { lo: round_down(round_down(lo[axis])), hi: round_up(round_up(hi[axis])) })
}

/// What is in both; it ends before it starts when nothing is.
fn common(a: Span, b: Span) -> Span {
    Span { start: a.start.max(b.start), end: a.end.min(b.end) }
}
