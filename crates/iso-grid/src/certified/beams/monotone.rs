//! The roots of single rays of a beam along which F is monotone.

use super::beam::Beam;
use super::form::{Form, Model, ROUNDING};
use super::pixels::{Known, Pixel, Verdict, halves_from};
use super::rounding::Rounding;
use super::subdivision::{Part, Subdivision};
use crate::Span;
use crate::certified::clip::Clip;

/// An enclosure of a root no wider than this many times what rounding of F alone makes it is as narrow as it gets.
const ROUNDINGS: f64 = 2.0;

/// Beams of so many columns and rows are not cut just since not all of their rays have a root.
const SMALL: usize = 4;

/// Of beams of more columns or rows only the corners are asked whether they hit.
const LARGEST_COUNTED: usize = 16;

/// A larger beam is cut when more rays are likely to be followed in vain.
const DOUBTFUL: usize = 16;

/// Rounding so many times smaller than the tolerance does not matter.
const SHARP: f64 = 64.0;

/// What values of F along a ray tell of its root.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Secants {
    /// F at the last two places, NaN where that is unknown; how far the pixel's t is from the last one; and how far t went there for
    /// each unit of F.
    values: [f64; 2],
    step: f64,
    secant: f64,
}

/// What a double computed for F says about the root, all over a part.
pub(super) struct Sight {
    /// One over the middle of the slopes of F.
    inverse: f64,
    /// How far that is from one over any slope, as part of it.
    unevenness: f64,
    /// How far rounding of F may move a root.
    blur: f64,
    /// How wide the enclosure of a root may be.
    tolerance: f64,
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
        } else if self.follow_edge(part) {
            // Nothing is left to do.
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
        let count = self.start(part, model, &mut pixels);
        self.pursue_and_settle(&mut pixels[..count], kernels, &sight);
        self.memory.pixels = pixels;
    }

    /// What values by kernels of this number say over a part. `None` when rounding is not bounded there.
    fn sight(&mut self, part: &Part, kernels: u32) -> Option<Sight> {
        let form = &part.form;
        let tolerance = self.tolerance(part);
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

    /// Puts the rays of a part that are still followed and may have a root there in front of `pixels`, and counts them. Those that
    /// may have one so near to a face of the region that no point inside is known are searched each for its own.
    fn start(&mut self, part: &Part, model: &Model, pixels: &mut Vec<Pixel<Secants>>) -> usize {
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
                pixel.known.values = [f64::NAN; 2];
                count += 1;
            }
        }
        count
    }
}

impl Known for Secants {
    type Sight = Sight;

    /// One step of the interval Newton method, for all slopes of the part at once, where `value` was computed for F at t. All
    /// roots in reach lie in its result, and if that lies in reach itself, there is one. Where it is about, values so far tell.
    #[inline]
    fn look(pixel: &mut Pixel<Self>, value: f64, sight: &Sight) -> Verdict {
        let Sight { inverse, unevenness, blur, tolerance } = *sight;
        let offset = value * inverse;
        let middle = pixel.t - offset;
        let rounding = ROUNDING * (pixel.t + offset.abs());
        let radius = offset.abs() * unevenness + blur + rounding;
        let root = Span { start: middle - radius, end: middle + radius };
        if root.end < pixel.wanted.start || pixel.wanted.end < root.start {
            return Verdict::Free;
        }
        let nearer = pixel.known.interpolate(pixel.t, value, sight).unwrap_or(middle);
        if 2.0 * radius <= tolerance {
            let is_inside = pixel.reach.start <= root.start && root.end <= pixel.reach.end;
            if !is_inside {
                return Verdict::Lost;
            }
            pixel.t = nearer.max(root.start).min(root.end);
            pixel.wanted = root;
            return Verdict::Hit;
        }
        let next = nearer.max(pixel.reach.start).min(pixel.reach.end);
        pixel.known.step = next - pixel.t;
        pixel.t = next;
        if pixel.known.step == 0.0 || !nearer.is_finite() { Verdict::Lost } else { Verdict::Open }
    }
}

impl Secants {
    /// About where the root is by the last values, the newest of which is `value`, taken at t: by inverse linear and quadratic
    /// interpolation (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4). `None` after the first one, and
    /// when they tell of a slope that F does not have.
    #[inline]
    fn interpolate(&mut self, t: f64, value: f64, sight: &Sight) -> Option<f64> {
        let [before, last] = self.values;
        let secant = self.step / (value - last);
        let bend = value * last * (secant - self.secant) / (value - before);
        (self.values, self.secant) = ([last, value], secant);
        let is_slope = (secant - sight.inverse).abs() <= sight.unevenness * sight.inverse.abs();
        is_slope.then(|| {
            let linear = value * secant;
            // A bend is a small correction, and none is known before the third value.
            if 2.0 * bend.abs() < linear.abs() { t - linear + bend } else { t - linear }
        })
    }
}

/// What is in both; it ends before it starts when nothing is.
fn common(a: Span, b: Span) -> Span {
    Span { start: a.start.max(b.start), end: a.end.min(b.end) }
}
