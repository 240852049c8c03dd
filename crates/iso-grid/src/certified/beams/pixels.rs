//! The roots of single rays of a beam along which F is monotone.

use glam::DVec3;
use iso_expr::Interval;
use iso_expr::interval::{round_down, round_up};

use super::bundle::Beam;
use super::form::Form;
use super::subdivision::Subdivision;
use crate::{Hit, Outcome, Ray, Span, Workspace};

/// How many steps towards a root are taken at most, and then how many proofs are tried.
const STEPS: usize = 8;
const PROOFS: usize = 4;

/// An enclosure of a root no wider than this many times what rounding of F alone makes it is as narrow as it gets.
const ROUNDINGS: f64 = 2.0;

/// A ray that may have a root.
#[derive(Clone, Copy, Debug)]
struct Pixel {
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
    slope: f64,
    /// Holds the root, if there is one in `reach`.
    root: Interval,
}

impl Subdivision<'_> {
    /// Ends or goes on with each ray of a beam by its root in `stretch`.
    pub(super) fn follow_each(&mut self, beam: &Beam, stretch: Span, form: &Form) {
        let mut pixels = self.pixels(beam, stretch, form);
        self.approach(&mut pixels, form);
        self.prove(pixels, form);
    }

    fn pixels(&mut self, beam: &Beam, stretch: Span, form: &Form) -> Vec<Pixel> {
        let mut pixels = Vec::with_capacity(beam.area.width * beam.area.height);
        for row in beam.area.rows() {
            for column in beam.area.columns() {
                let place = row * self.bundle.area.width + column;
                let Some(clip) = self.clips[place] else { continue };
                if !self.open[place] {
                    continue;
                }
                let (outer, inner) = (clip.outer, clip.inner);
                let wanted = Span { start: stretch.start.max(outer.start), end: stretch.end.min(outer.end) };
                let reach =
                    Span { start: form.reach.start.max(inner.start), end: form.reach.end.min(inner.end) };
                if wanted.start > wanted.end {
                    continue;
                }
                let (across, along) = beam.area.offset(column, row);
                let t = form.estimate(across, along).max(reach.start).min(reach.end);
                if reach.start > reach.end {
                    self.search_one(place, stretch);
                    continue;
                }
                pixels.push(Pixel {
                    place,
                    ray: self.bundle.rays[place],
                    reach,
                    wanted,
                    t,
                    value: f64::NAN,
                    step: f64::NAN,
                    slope: form.slope.middle,
                    root: Interval::ENTIRE,
                });
            }
        }
        pixels
    }

    /// Brings each pixel's t near to its root, by the secant method from the slope of the beam.
    fn approach(&mut self, pixels: &mut [Pixel], form: &Form) {
        let Workspace { points, scratch, counters, .. } = &mut *self.workspace;
        let slopes = form.slope.interval();
        let unevenness = form.unevenness();
        let mut moving: Vec<usize> = (0..pixels.len()).collect();
        for _ in 0..STEPS {
            if moving.is_empty() {
                break;
            }
            points.clear();
            for number in &moving {
                let pixel = &pixels[*number];
                points.push(pixel.ray.at(pixel.t));
            }
            counters.trace_evaluations += moving.len() as u64;
            let values = points.evaluate(&*self.certified.value_batch, scratch, 1);
            let accuracy = 0.25 * self.certified.accuracy;
            let mut place = 0;
            moving.retain(|number| {
                let pixel = &mut pixels[*number];
                let value = values[place];
                place += 1;
                let secant = (value - pixel.value) / pixel.step;
                if secant.is_finite() {
                    pixel.slope = secant.max(slopes.lo).min(slopes.hi);
                }
                let next = (pixel.t - value / pixel.slope).max(pixel.reach.start).min(pixel.reach.end);
                let step = next - pixel.t;
                let rate = if pixel.step.is_nan() { unevenness } else { (step / pixel.step).abs() };
                if !next.is_finite() {
                    return false;
                }
                (pixel.t, pixel.value, pixel.step) = (next, value, step);
                step.abs() * rate * unevenness > accuracy * next.max(1.0)
            });
        }
    }

    /// Encloses each pixel's root, or finds that it has none.
    fn prove(&mut self, mut pixels: Vec<Pixel>, form: &Form) {
        let slopes = form.slope.interval();
        for _ in 0..PROOFS {
            if pixels.is_empty() {
                return;
            }
            let Workspace { boxes, scratch, counters, .. } = &mut *self.workspace;
            boxes.clear();
            for pixel in &pixels {
                let (lo, hi) = around(&pixel.ray, pixel.t);
                boxes.push(lo, hi);
            }
            counters.box_evaluations += pixels.len() as u64;
            let values = boxes.evaluate(&*self.certified.kernels.values, scratch, 1);
            let mut number = 0;
            pixels.retain_mut(|pixel| {
                let value = values.interval(0, number);
                number += 1;
                match pixel.narrow(value, slopes, self.certified.accuracy) {
                    Verdict::Free => false,
                    Verdict::Hit(hit) => {
                        self.outcomes[pixel.place] = Outcome::Hit(hit);
                        self.open[pixel.place] = false;
                        false
                    }
                    Verdict::Open => true,
                }
            });
        }
        for Pixel { place, wanted, root, .. } in pixels {
            let stretch = Span { start: wanted.start.max(root.lo), end: wanted.end.min(root.hi) };
            self.search_one(place, stretch);
        }
    }
}

/// What is known of a pixel's root.
enum Verdict {
    /// There is none.
    Free,
    /// There is one, narrowly enclosed.
    Hit(Hit),
    Open,
}

impl Pixel {
    /// One step of the interval Newton method, where `value` encloses F at `t` and `slopes` its derivative in reach: all
    /// roots in reach lie in the result, and if that lies in reach itself, there is one.
    fn narrow(&mut self, value: Interval, slopes: Interval, accuracy: f64) -> Verdict {
        let root = Interval::point(self.t).minus(value.over(slopes)).intersection(self.root);
        let wanted = Interval { lo: self.wanted.start, hi: self.wanted.end };
        if root.intersection(wanted).is_empty() {
            return Verdict::Free;
        }
        let is_inside = self.reach.start <= root.lo && root.hi <= self.reach.end;
        let tolerance = accuracy * root.lo.max(1.0).min(self.wanted.end);
        let rounding = ROUNDINGS * value.width() / slopes.magnitude();
        if is_inside && root.width() <= tolerance.max(rounding) {
            let bracket = Span { start: root.lo, end: root.hi };
            return Verdict::Hit(Hit { t: root.midpoint(), bracket });
        }
        self.root = root;
        self.t = root.midpoint().max(self.reach.start).min(self.reach.end);
        Verdict::Open
    }
}

/// A box around the point of a ray at `t`.
fn around(ray: &Ray, t: f64) -> (DVec3, DVec3) {
    let end = |round: fn(f64) -> f64| {
        DVec3::from_array([0, 1, 2].map(|axis| {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            if direction == 0.0 { origin } else { round(origin + round(t * direction)) }
        }))
    };
    (end(round_down), end(round_up))
}
