//! F along one ray: a function of t, enclosed over stretches of the ray.

use std::sync::Arc;

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::interval::{round_down, round_up};
use iso_expr::{BoxKernel, Decorated, Decoration, Interval, Scratch};

use crate::{Ray, Span};

/// How many stretches are enclosed by one call at most.
pub(super) const BATCH: usize = 8;

/// The kernels of the surface that proofs are made of.
pub(super) struct Kernels {
    pub(super) values: Arc<dyn BoxKernel>,
    pub(super) gradients: Arc<dyn BoxKernel>,
}

/// F along a ray. All enclosures hold for every real t of a stretch and every point o + t·d exactly.
pub(super) struct Line<'a> {
    pub(super) kernels: &'a Kernels,
    pub(super) scratch: &'a mut Scratch,
    pub(super) ray: Ray,
    /// How many boxes were enclosed along this ray.
    pub(super) evaluations: u64,
}

/// F over a stretch of the ray, and its derivative by t.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) value: Decorated,
    /// An empty slope is that of a function with no derivative anywhere here; its decoration says so.
    pub(super) slope: Decorated,
}

const NOTHING_KNOWN: Decorated = Decorated { interval: Interval::ENTIRE, decoration: Decoration::Trivial };

impl Line<'_> {
    /// Encloses F over each of the stretches; what stands behind their number means nothing.
    pub(super) fn values(&mut self, stretches: &[Span]) -> [Decorated; BATCH] {
        let outputs = self.enclose::<{ BATCH }>(&*self.kernels.values, stretches);
        std::array::from_fn(|place| outputs.at(place))
    }

    /// Encloses F at `t`.
    pub(super) fn value_at(&mut self, t: f64) -> Interval {
        self.values(&[Span { start: t, end: t }])[0].interval
    }

    /// Encloses F and its slope over each of the stretches; what stands behind their number means nothing.
    pub(super) fn courses(&mut self, stretches: &[Span]) -> [Course; BATCH] {
        let outputs = self.enclose::<{ 4 * BATCH }>(&*self.kernels.gradients, stretches);
        let count = stretches.len();
        let mut courses = [Course { value: NOTHING_KNOWN, slope: NOTHING_KNOWN }; BATCH];
        for (place, course) in courses.iter_mut().enumerate().take(count) {
            let partials = [1, 2, 3].map(|output| outputs.at(output * count + place));
            *course = Course { value: outputs.at(place), slope: self.slope(partials) };
        }
        courses
    }

    /// Encloses F and its slope over a stretch.
    pub(super) fn course(&mut self, stretch: Span) -> Course {
        self.courses(&[stretch])[0]
    }

    /// The box around a stretch of the ray.
    pub(super) fn bounds(&self, stretch: Span) -> [Interval; 3] {
        [0, 1, 2].map(|axis| {
            let (origin, direction) = (self.ray.origin[axis], self.ray.direction[axis]);
            if direction == 0.0 {
                return Interval::point(origin);
            }
            let (near, far) =
                if direction > 0.0 { (stretch.start, stretch.end) } else { (stretch.end, stretch.start) };
            Interval {
                lo: round_down(origin + round_down(near * direction)),
                hi: round_up(origin + round_up(far * direction)),
            }
        })
    }

    /// ∇F·d. Derivatives across the ray do not matter, not even whether they exist.
    fn slope(&self, gradient: [Decorated; 3]) -> Decorated {
        let mut slope = Decorated { interval: Interval::point(0.0), decoration: Decoration::Common };
        for (axis, partial) in gradient.into_iter().enumerate() {
            let direction = self.ray.direction[axis];
            if direction != 0.0 {
                slope.interval = slope.interval.plus(scaled(partial.interval, direction));
                slope.decoration = slope.decoration.min(partial.decoration);
            }
        }
        slope
    }

    fn enclose<const N: usize>(&mut self, kernel: &dyn BoxKernel, stretches: &[Span]) -> Outputs<N> {
        let count = stretches.len();
        let (mut lo, mut hi) = ([[0.0; BATCH]; 3], [[0.0; BATCH]; 3]);
        for (place, stretch) in stretches.iter().enumerate() {
            for (axis, bounds) in self.bounds(*stretch).into_iter().enumerate() {
                (lo[axis][place], hi[axis][place]) = (bounds.lo, bounds.hi);
            }
        }
        let mut outputs = Outputs { lo: [0.0; N], hi: [0.0; N], decoration: [Decoration::Trivial; N] };
        let used = count * (N / BATCH);
        kernel.evaluate(
            self.scratch,
            Boxes {
                lo: lo.each_ref().map(|ends| &ends[..count]),
                hi: hi.each_ref().map(|ends| &ends[..count]),
            },
            Enclosures {
                lo: &mut outputs.lo[..used],
                hi: &mut outputs.hi[..used],
                decoration: &mut outputs.decoration[..used],
            },
        );
        self.evaluations += count as u64;
        outputs
    }
}

/// What a kernel wrote for a batch.
struct Outputs<const N: usize> {
    lo: [f64; N],
    hi: [f64; N],
    decoration: [Decoration; N],
}

impl<const N: usize> Outputs<N> {
    fn at(&self, place: usize) -> Decorated {
        let interval = Interval { lo: self.lo[place], hi: self.hi[place] };
        Decorated { interval, decoration: self.decoration[place] }
    }
}

/// Encloses the products of the finite `factor`, which is not zero, and the numbers of `interval`.
fn scaled(interval: Interval, factor: f64) -> Interval {
    let (a, b) = (interval.lo * factor, interval.hi * factor);
    if factor > 0.0 {
        Interval { lo: round_down(a), hi: round_up(b) }
    } else {
        Interval { lo: round_down(b), hi: round_up(a) }
    }
}
