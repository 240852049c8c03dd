//! The roots of single rays of a beam along which F is monotone.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decoration, Interval, Program};

use super::beam::Beam;
use super::form::{Form, Model, ROUNDING};
use super::subdivision::{Part, Subdivision};
use crate::certified::clip::Clip;
use crate::{Hit, Kernel, Outcome, Ray, Span, Workspace};

/// How many values of F a ray is given at most before it is searched for its own.
const STEPS: usize = 10;

/// An enclosure of a root no wider than this many times what rounding of F alone makes it is as narrow as it gets.
const ROUNDINGS: f64 = 2.0;

/// Beams of so many columns and rows are not cut just since not all of their rays have a root.
const SMALL: usize = 4;

/// Of beams of more columns or rows only the corners are asked whether they hit.
const LARGEST_COUNTED: usize = 16;

/// A larger beam is cut when more rays are likely to be followed in vain.
const DOUBTFUL: usize = 16;

/// Shorter kernels are made for a part when it has so many rays.
const MANY: usize = 64;

/// A ray that may have a root.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixel {
    /// Which ray of the tile.
    place: usize,
    ray: Ray,
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
    /// Goes on with a stretch on which F is monotone along every ray.
    pub(super) fn follow(&mut self, part: &Part, form: &Form) {
        let roots = form.roots();
        let stretch = part.stretch;
        let narrowed = Span { start: stretch.start.max(roots.lo), end: stretch.end.min(roots.hi) };
        if narrowed.start > narrowed.end {
            return;
        }
        let part = Part { stretch: narrowed, ..*part };
        let area = self.memory.beams[part.beam].area;
        let is_small = area.width.max(area.height) <= SMALL;
        let model = form.model();
        if form.is_even() && (is_small || self.most_hit(&part, &model)) {
            self.follow_each(part, form, &model);
        } else if !is_small {
            self.divide_beam(part.beam, narrowed);
        } else if narrowed.end - narrowed.start < 0.5 * (stretch.end - stretch.start) {
            self.examine(part.beam..part.beam + 1, narrowed, 1);
        } else {
            self.divide(&part);
        }
    }

    /// Whether few rays of a part may have a root, but are likely to have none. Of large parts only the corners are asked.
    fn most_hit(&self, part: &Part, model: &Model) -> bool {
        let Beam { area, radii: [across, along], .. } = self.memory.beams[part.beam];
        let Span { start, end } = part.stretch;
        if area.width.max(area.height) > LARGEST_COUNTED {
            let corners = [(-across, -along), (across, -along), (-across, along), (across, along)];
            return corners.into_iter().all(|(a, b)| (start..=end).contains(&model.at(a, b)));
        }
        let mut doubtful = 0;
        for row in area.rows() {
            let open = &self.memory.open[row * self.tile.width()..];
            for column in area.columns() {
                let (a, b) = area.offset(column, row);
                let t = model.at(a, b);
                let may_hit = start - model.uncertainty <= t && t <= end + model.uncertainty;
                doubtful += usize::from(open[column] && may_hit && !(start <= t && t <= end));
            }
        }
        doubtful <= DOUBTFUL
    }

    /// Ends or goes on with each ray of a part by its root there.
    fn follow_each(&mut self, mut part: Part, form: &Form, model: &Model) {
        part.kernels = self.kernels_for(&part, form);
        let part = &part;
        let Some(sight) = self.sight(part, form) else { return self.search_each(part) };
        let mut pixels = std::mem::take(&mut self.memory.pixels);
        pixels.clear();
        self.start(part, form, model, &mut pixels);
        for step in 1..=STEPS {
            if pixels.is_empty() {
                break;
            }
            self.approach(part, &mut pixels, &sight, step == STEPS);
        }
        self.memory.pixels = pixels;
    }

    /// The number of the kernels for the rays of a part: shorter ones made for this part alone, where so many rays may gain.
    fn kernels_for(&mut self, part: &Part, form: &Form) -> usize {
        let beam = &self.memory.beams[part.beam];
        let kernels = &self.kernels[part.kernels];
        if !kernels.may_be_shortened() || beam.area.width * beam.area.height < MANY {
            return part.kernels;
        }
        let bounds = beam.bounds(form.reach, &self.certified.region).map(|(lo, hi)| outwards(lo, hi));
        let Some(shortened) = bounds.and_then(|bounds| kernels.shortened(bounds)) else { return part.kernels };
        self.kernels.push(Arc::new(shortened));
        self.kernels.len() - 1
    }

    /// What values say over a part. `None` when rounding is not bounded there.
    fn sight(&mut self, part: &Part, form: &Form) -> Option<Sight> {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        let (beam, kernels) = (&self.memory.beams[part.beam], &self.kernels[part.kernels]);
        let (lo, hi) = beam.bounds(form.reach, &self.certified.region)?;
        let sides = outwards(lo, hi);
        boxes.clear();
        boxes.push(sides.map(|side| side.lo).into(), sides.map(|side| side.hi).into());
        boxes.evaluate(kernels.rounding(), scratch, 5);
        counters.box_evaluations += 1;
        counters.operations += kernels.operations(Kernel::RoundingBounds);
        let decoration = |output| boxes.decorated(output, 0).decoration;
        let is_known = decoration(0) == Decoration::Common
            && (1..5).all(|output| decoration(output) >= Decoration::Defined);
        let magnitude = |output| boxes.interval(output, 0).magnitude();
        let gradient = DVec3::from_array([2, 3, 4].map(magnitude));
        let way = form.reach.end * beam.directions.size;
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

    /// The rays of a part that are still followed and may have a root there. Those that may have one so near to a face of the
    /// region that no point inside is known are searched each for its own.
    fn start(&mut self, part: &Part, form: &Form, model: &Model, pixels: &mut Vec<Pixel>) {
        let area = self.memory.beams[part.beam].area;
        for row in area.rows() {
            for column in area.columns() {
                let place = row * self.tile.width() + column;
                let (across, along) = area.offset(column, row);
                let t = model.at(across, along);
                let Span { start, end } = part.stretch;
                let misses = t + model.uncertainty < start || end < t - model.uncertainty;
                if misses || !self.memory.open[place] {
                    continue;
                }
                let ray = self.tile.ray(column, row);
                let (mut wanted, mut reach) = (part.stretch, form.reach);
                if !part.is_inside {
                    let Some(Clip { outer, inner }) = Clip::new(&self.certified.region, &ray) else { continue };
                    wanted = common(wanted, outer);
                    reach = common(reach, inner);
                }
                if wanted.start > wanted.end {
                    continue;
                }
                if reach.start > reach.end {
                    self.search_one((column, row), wanted, part.kernels);
                    continue;
                }
                let t = t.max(reach.start).min(reach.end);
                pixels.push(Pixel { place, ray, reach, wanted, t, value: f64::NAN, step: f64::NAN });
            }
        }
    }

    /// Takes F at each pixel's t, and keeps the pixels that are nearer to their roots by that. The last time, those
    /// are searched each for its own.
    fn approach(&mut self, part: &Part, pixels: &mut Vec<Pixel>, sight: &Sight, is_last: bool) {
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        let kernels = &self.kernels[part.kernels];
        points.clear();
        points.extend(pixels.iter().map(|pixel| pixel.ray.at(pixel.t)));
        counters.trace_evaluations += pixels.len() as u64;
        counters.operations += pixels.len() as u64 * kernels.operations(Kernel::Values);
        let values = points.evaluate(kernels.points(), scratch, 1);
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
                    self.memory.open[pixel.place] = false;
                }
            }
        }
        pixels.truncate(kept);
        for pixel in lost {
            let (column, row) = (pixel.place % self.tile.width(), pixel.place / self.tile.width());
            self.search_one((column, row), pixel.wanted, part.kernels);
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
