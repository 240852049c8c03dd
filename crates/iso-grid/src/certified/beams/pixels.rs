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

/// How many times its size a box for which rounding is bounded grows at each side, so that it holds neighbours too.
const AROUND: f64 = 2.0;

/// Rounding so many times smaller than the tolerance does not matter.
const SHARP: f64 = 64.0;

/// Shorter kernels are made for a part when it has so many rays.
const MANY: usize = 64;

/// A ray that may have a root.
#[derive(Clone, Copy, Debug, Default)]
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
    /// F at the last two places, NaN where that is unknown; how far `t` is from the last one; and how far t went there for each
    /// unit of F.
    values: [f64; 2],
    step: f64,
    secant: f64,
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

/// What rounding does to F on a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// The number of the kernels whose values are meant.
    kernels: u32,
    lo: DVec3,
    hi: DVec3,
    /// By how many [units](Program::ROUNDING_UNIT) a value at a point may be off.
    of_values: f64,
    /// What no derivative exceeds.
    gradient: DVec3,
}

impl Rounding {
    fn covers(&self, kernels: u32, lo: DVec3, hi: DVec3) -> bool {
        self.kernels == kernels && self.lo.cmple(lo).all() && hi.cmple(self.hi).all()
    }

    /// How far F computed at a computed point of one of the beam's rays may be from F at the point itself.
    fn error(&self, beam: &Beam, reach: Span) -> f64 {
        let way = reach.end * beam.directions.size;
        let points = self.gradient.dot(way + self.lo.abs().max(self.hi.abs()) + f64::MIN_POSITIVE);
        (1.0 + ROUNDING) * Program::ROUNDING_UNIT * (self.of_values + points)
    }
}

impl Sight {
    /// `None` where nothing is known.
    fn new(form: &Form, tolerance: f64, error: f64) -> Option<Self> {
        let slope = form.slope;
        let least = (1.0 - ROUNDING) * (slope.middle.abs() - slope.radius);
        let blur = (1.0 + ROUNDING) * error / least;
        (blur.is_finite() && least > 0.0).then(|| Self {
            inverse: 1.0 / slope.middle,
            unevenness: (1.0 + ROUNDING) * slope.radius / least,
            blur,
            tolerance: tolerance.max(2.0 * ROUNDINGS * blur),
        })
    }
}

/// What a value told of a pixel.
enum Verdict {
    /// There is no root where one is looked for.
    Free,
    /// There is one: `wanted` encloses it, and t is about where it is.
    Hit,
    /// Another place is nearer to the root.
    Open,
    /// Single values do not tell.
    Lost,
}

impl Subdivision<'_> {
    /// Goes on with a stretch on which F is monotone along every ray.
    pub(super) fn follow(&mut self, part: &Part) {
        let form = &part.form;
        let roots = form.roots();
        let stretch = part.stretch;
        let narrowed = Span { start: stretch.start.max(roots.lo), end: stretch.end.min(roots.hi) };
        if narrowed.start > narrowed.end {
            return;
        }
        let part = &Part { stretch: narrowed, ..*part };
        let beam = self.beam(part.beam);
        let is_small = beam.area.width.max(beam.area.height) <= SMALL;
        let model = form.model(beam);
        if form.is_even() && (is_small || self.most_hit(part, &model)) {
            self.follow_each(part, &model);
        } else if !is_small {
            self.divide_beam(part);
        } else if narrowed.end - narrowed.start < 0.5 * (stretch.end - stretch.start) {
            self.examine(part.beam..part.beam + 1, (narrowed, 1), part.kernels);
        } else {
            self.divide(part);
        }
    }

    /// Whether few rays of a part may have a root, but are likely to have none. Of large parts only the corners are asked.
    fn most_hit(&self, part: &Part, model: &Model) -> bool {
        let Beam { area, radii: [across, along], .. } = *self.beam(part.beam);
        let Span { start, end } = part.stretch;
        if area.width.max(area.height) > LARGEST_COUNTED {
            let corners = [(-across, -along), (across, -along), (-across, along), (across, along)];
            return corners.into_iter().all(|(a, b)| (start..=end).contains(&model.at(a, b)));
        }
        let (least, most) = (start - model.uncertainty, end + model.uncertainty);
        let mut doubtful = 0;
        for (row, b) in area.rows().zip(halves_from(-along)) {
            let open = &self.memory.open[row * self.tile.width()..][area.columns()];
            for (is_open, a) in open.iter().zip(halves_from(-across)) {
                let t = model.at(a, b);
                let is_doubtful = (least <= t) & (t <= most) & ((t < start) | (end < t));
                doubtful += usize::from(is_open & is_doubtful);
            }
        }
        doubtful <= DOUBTFUL
    }

    /// Ends or goes on with each ray of a part by its root there.
    fn follow_each(&mut self, part: &Part, model: &Model) {
        let kernels = self.kernels_for(part);
        let Some(sight) = self.sight(part, kernels) else { return self.search_each(part) };
        let mut pixels = std::mem::take(&mut self.memory.pixels);
        let mut count = self.start(part, model, &mut pixels);
        for step in 1..=STEPS {
            if count == 0 {
                break;
            }
            count = self.approach(&mut pixels[..count], kernels, &sight, step == STEPS);
        }
        self.memory.pixels = pixels;
    }

    /// The number of the kernels for the rays of a part: shorter ones made for this part alone, where so many rays may gain.
    fn kernels_for(&mut self, part: &Part) -> u32 {
        let beam = self.beam(part.beam);
        let kernels = self.kernels(part.kernels);
        let may_gain = kernels.may_be_shortened() && !kernels.are_small();
        if !may_gain || beam.area.width * beam.area.height < MANY {
            return part.kernels;
        }
        let bounds = beam.bounds(part.form.reach, &self.certified.region).map(|(lo, hi)| outwards(lo, hi));
        let Some(shortened) = bounds.and_then(|bounds| kernels.shortened(bounds)) else {
            return part.kernels;
        };
        self.number_of(Arc::new(shortened))
    }

    /// What values by kernels of this number say over a part. `None` when rounding is not bounded there.
    fn sight(&mut self, part: &Part, kernels: u32) -> Option<Sight> {
        let form = &part.form;
        let tolerance = self.certified.accuracy * part.stretch.start.max(1.0).min(part.stretch.end);
        let bounds = self.beam(part.beam).bounds(form.reach, &self.certified.region)?;
        let known = self.rounding_around(kernels, bounds);
        let sight =
            |rounding: &Rounding, beam: &Beam| Sight::new(form, tolerance, rounding.error(beam, form.reach));
        let rough = known.and_then(|known| sight(&known, self.beam(part.beam)));
        // A bound on a larger box will do as long as it is nothing beside what is wanted.
        if rough.as_ref().is_some_and(|sight| SHARP * sight.blur < tolerance) {
            return rough;
        }
        let exact = self.rounding(kernels, bounds)?;
        sight(&exact, self.beam(part.beam))
    }

    /// What rounding does to F on a box and around it, if that is bounded: neighbouring parts share it.
    fn rounding_around(&mut self, kernels: u32, (lo, hi): (DVec3, DVec3)) -> Option<Rounding> {
        if let Some(known) = self.memory.rounding.filter(|known| known.covers(kernels, lo, hi)) {
            return Some(known);
        }
        let (region, room) = (&self.certified.region, AROUND * (hi - lo));
        let (least, most) = self.kernels(kernels).corners();
        let around = [(lo - room).max(region.min()).max(least), (hi + room).min(region.max()).min(most)];
        let found = self.rounding(kernels, (around[0].min(lo), around[1].max(hi)));
        self.memory.rounding = found.or(self.memory.rounding);
        found
    }

    /// What rounding does to F on a box.
    fn rounding(&mut self, kernels: u32, (lo, hi): (DVec3, DVec3)) -> Option<Rounding> {
        let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
        let of_part = &self.kernels[kernels as usize];
        let sides = outwards(lo, hi);
        let corners = [sides.map(|side| side.lo), sides.map(|side| side.hi)].map(DVec3::from_array);
        boxes.replace(std::iter::once((&corners[0], &corners[1])));
        boxes.evaluate(of_part.rounding(), scratch, 5);
        counters.box_evaluations += 1;
        counters.operations += of_part.charge(Kernel::RoundingBounds, 1);
        let decoration = |output| boxes.decorated(output, 0).decoration;
        let is_known = decoration(0) == Decoration::Common
            && (1..5).all(|output| decoration(output) >= Decoration::Defined);
        let magnitude = |output| boxes.interval(output, 0).magnitude();
        let gradient = DVec3::from_array([2, 3, 4].map(magnitude));
        let found = Rounding { kernels, lo, hi, of_values: magnitude(1), gradient };
        let is_bounded = is_known && found.of_values.is_finite() && gradient.is_finite();
        is_bounded.then_some(found)
    }

    /// Puts the rays of a part that are still followed and may have a root there in front of `pixels`, and counts them. Those that
    /// may have one so near to a face of the region that no point inside is known are searched each for its own.
    fn start(&mut self, part: &Part, model: &Model, pixels: &mut Vec<Pixel>) -> usize {
        let Beam { area, radii: [across, along], .. } = *self.beam(part.beam);
        let room = area.width * area.height;
        if pixels.len() < room {
            pixels.resize(room, Pixel::default());
        }
        let least = part.stretch.start - model.uncertainty;
        let most = part.stretch.end + model.uncertainty;
        let mut count = 0;
        for (row, b) in area.rows().zip(halves_from(-along)) {
            for (column, a) in area.columns().zip(halves_from(-across)) {
                let place = row * self.tile.width() + column;
                let t = model.at(a, b);
                if t < least || most < t || !self.memory.open[place] {
                    continue;
                }
                let pixel = &mut pixels[count];
                pixel.ray = self.tile.ray(column, row);
                (pixel.wanted, pixel.reach) = (part.stretch, part.form.reach);
                if !part.is_inside {
                    let clip = Clip::new(&self.certified.region, &pixel.ray);
                    let Some(Clip { outer, inner }) = clip else { continue };
                    pixel.wanted = common(pixel.wanted, outer);
                    pixel.reach = common(pixel.reach, inner);
                }
                if pixel.wanted.start > pixel.wanted.end {
                    continue;
                }
                if pixel.reach.start > pixel.reach.end {
                    let wanted = pixel.wanted;
                    self.search_one((column, row), wanted, part.kernels);
                    continue;
                }
                pixel.place = place;
                pixel.t = t.max(pixel.reach.start).min(pixel.reach.end);
                pixel.values = [f64::NAN; 2];
                count += 1;
            }
        }
        count
    }

    /// Takes F at each pixel's t, and counts the pixels that are nearer to their roots by that, which are then in front. The last
    /// time, those are searched each for its own.
    fn approach(&mut self, pixels: &mut [Pixel], kernels: u32, sight: &Sight, is_last: bool) -> usize {
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        let of_part = &self.kernels[kernels as usize];
        points.replace(pixels.iter().map(|pixel| (&pixel.ray, pixel.t)));
        counters.trace_evaluations += pixels.len() as u64;
        counters.operations += of_part.charge(Kernel::Values, pixels.len());
        let values = points.evaluate(of_part.points(), scratch, 1);
        let mut lost = Vec::new();
        let mut kept = 0;
        for number in 0..pixels.len() {
            let pixel = &mut pixels[number];
            match pixel.look(values[number], sight) {
                Verdict::Open if !is_last => {
                    if kept < number {
                        pixels[kept] = pixels[number];
                    }
                    kept += 1;
                }
                Verdict::Open | Verdict::Lost => lost.push((pixel.place, pixel.wanted)),
                Verdict::Free => {}
                Verdict::Hit => {
                    self.outcomes[pixel.place] = Outcome::Hit(Hit { t: pixel.t, bracket: pixel.wanted });
                    self.memory.open[pixel.place] = false;
                }
            }
        }
        for (place, wanted) in lost {
            let (column, row) = (place % self.tile.width(), place / self.tile.width());
            self.search_one((column, row), wanted, kernels);
        }
        kept
    }
}

impl Pixel {
    /// One step of the interval Newton method, for all slopes of the part at once, where `value` was computed for F at t. All
    /// roots in reach lie in its result, and if that lies in reach itself, there is one. Where it is about, values so far tell.
    #[inline]
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
        let nearer = self.interpolate(value, sight).unwrap_or(middle);
        if 2.0 * radius <= tolerance {
            let is_inside = self.reach.start <= root.start && root.end <= self.reach.end;
            if !is_inside {
                return Verdict::Lost;
            }
            self.t = nearer.max(root.start).min(root.end);
            self.wanted = root;
            return Verdict::Hit;
        }
        let next = nearer.max(self.reach.start).min(self.reach.end);
        self.step = next - self.t;
        self.t = next;
        if self.step == 0.0 || !nearer.is_finite() { Verdict::Lost } else { Verdict::Open }
    }

    /// About where the root is by the last values, the newest of which is `value`, taken at t: by inverse linear and quadratic
    /// interpolation (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4). `None` after the first one, and
    /// when they tell of a slope that F does not have.
    #[inline]
    fn interpolate(&mut self, value: f64, sight: &Sight) -> Option<f64> {
        let [before, last] = self.values;
        let secant = self.step / (value - last);
        let bend = value * last * (secant - self.secant) / (value - before);
        (self.values, self.secant) = ([last, value], secant);
        let is_slope = (secant - sight.inverse).abs() <= sight.unevenness * sight.inverse.abs();
        is_slope.then(|| {
            let linear = value * secant;
            // A bend is a small correction, and none is known before the third value.
            if 2.0 * bend.abs() < linear.abs() { self.t - linear + bend } else { self.t - linear }
        })
    }
}

/// The sides of a box in which the points of its rays lie, which are computed by two roundings: it is two doubles larger at each
/// side.
fn outwards(lo: DVec3, hi: DVec3) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval { lo: round_down(round_down(lo[axis])), hi: round_up(round_up(hi[axis])) })
}

/// Numbers from a whole or half one on, one apart. Exact.
fn halves_from(first: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |number| Some(number + 1.0))
}

/// What is in both; it ends before it starts when nothing is.
fn common(a: Span, b: Span) -> Span {
    Span { start: a.start.max(b.start), end: a.end.min(b.end) }
}
