//! The roots of single rays of a beam along which F is monotone.

use glam::DVec3;
use iso_expr::Interval;
use iso_expr::interval::{round_down, round_up};

use super::form::Form;
use super::subdivision::{Part, Subdivision};
use crate::certified::clip::Clip;
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
    /// Where F is known to be monotone inside the region.
    reach: Span,
    /// Where a root is looked for: everything before it is free of roots.
    wanted: Span,
    /// Near the root, inside `reach`.
    t: f64,
    /// F at the last place, and how far that is from `t`.
    value: f64,
    step: f64,
    /// The part that the last step was of the one before.
    rate: f64,
    slope: f64,
    /// Holds the root, if there is one in `reach`.
    root: Interval,
}

impl Subdivision<'_> {
    /// Ends or goes on with each ray of a part by its root there.
    pub(super) fn follow_each(&mut self, part: &Part, form: &Form) {
        let mut pixels = self.pixels(part, form);
        self.approach(&mut pixels, form);
        self.prove(pixels, form);
    }

    /// The rays of a part that are still followed. Those that may have a root so near to a face of the region that no
    /// point inside is known are searched each for its own.
    fn pixels(&mut self, part: &Part, form: &Form) -> Vec<Pixel> {
        let Part { beam, stretch, is_inside, .. } = part;
        let mut pixels = Vec::with_capacity(beam.area.width * beam.area.height);
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
                    self.search_one(place, wanted);
                    continue;
                }
                let (across, along) = beam.area.offset(column, row);
                pixels.push(Pixel {
                    place,
                    reach,
                    wanted,
                    t: form.estimate(across, along).max(reach.start).min(reach.end),
                    value: f64::NAN,
                    step: f64::NAN,
                    rate: 1.0,
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
                points.push(self.bundle.rays[pixel.place].at(pixel.t));
            }
            counters.trace_evaluations += moving.len() as u64;
            let values = points.evaluate(&*self.certified.value_batch, scratch, 1);
            let mut values = values.iter();
            moving.retain(|number| {
                let pixel = &mut pixels[*number];
                let error = pixel.step(*values.next().expect("a value for each point"), slopes, unevenness);
                // The proof multiplies the error by the unevenness.
                error * unevenness > 0.25 * self.certified.accuracy * pixel.t.max(1.0)
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
                let (lo, hi) = around(&self.bundle.rays[pixel.place], pixel.t);
                boxes.push(lo, hi);
            }
            counters.box_evaluations += pixels.len() as u64;
            boxes.evaluate(&*self.certified.kernels.values, scratch, 1);
            let mut number = 0;
            pixels.retain_mut(|pixel| {
                let value = boxes.interval(0, number);
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
    /// One step of the secant method, where `value` is F at `t`. Returns about how far the root may still be; NaN where F is
    /// not finite, which no step helps.
    fn step(&mut self, value: f64, slopes: Interval, unevenness: f64) -> f64 {
        let secant = (value - self.value) / self.step;
        if secant.is_finite() {
            self.slope = secant.max(slopes.lo).min(slopes.hi);
        }
        let next = self.t - value / self.slope;
        if !next.is_finite() {
            return f64::NAN;
        }
        let next = next.max(self.reach.start).min(self.reach.end);
        let step = next - self.t;
        let rate = if self.step.is_nan() { unevenness } else { (step / self.step).abs() };
        // Each error is a constant times the two before it, and each step about as long as the error before it.
        let error = step.abs() * rate * self.rate;
        (self.t, self.value, self.step, self.rate) = (next, value, step, rate);
        error
    }

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

/// What is in both; it ends before it starts when nothing is.
fn common(a: Span, b: Span) -> Span {
    Span { start: a.start.max(b.start), end: a.end.min(b.end) }
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
