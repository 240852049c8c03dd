//! Rays of a part along which F may bend, followed by values of F. Where F is monotone, they are followed by its [slopes](super::bundle).

use iso_expr::{BatchKernel, Scratch};
use pulp::{Simd, WithSimd};

use super::bows::Bow;
use super::course::{Course, ways};
use super::form::ROUNDING;
use super::packet::Packet;
use super::pursuit::AT_ONCE;
use super::subdivision::Subdivision;
use crate::lanes::{Lanes, Mask, Row, parts};
use crate::point_rows::{PointRows, row_of};
use crate::raster::RayRow;
use crate::{Hit, Kernel, Span, Workspace};

/// How many values of F a ray is given at most before it is searched for its own.
pub(super) const STEPS: usize = 10;

/// How far a ray has come: numbers, as whatever else is known of it.
pub(super) mod state {
    /// There is no root where one is looked for, or no ray.
    pub(in super::super) const FREE: f64 = 0.0;
    /// Another place is nearer to the root.
    pub(in super::super) const OPEN: f64 = 1.0;
    /// There is one.
    pub(in super::super) const HIT: f64 = 2.0;
    /// Single values do not tell.
    pub(in super::super) const LOST: f64 = 3.0;
}

/// Rays that may each have a root in a part, and what is known of F along them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pixels {
    packet: Packet,
    rays: RayRow,
    /// Where a root is looked for: everything before it is free of roots. In the end, what encloses it.
    wanted: [Row; 2],
    /// Where F is to be taken next. In the end, about where the root is.
    t: Row,
    state: Row,
    /// The sign of F where there is no root, or before it.
    sign: Row,
    pub(super) known: Bowed,
}

/// What is known of F along rays that bend.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bowed {
    /// The slope where the part's expansion is centred.
    slope: Row,
    /// Where F was taken last, and its value there; NaN before the first.
    last_t: Row,
    last: Row,
    /// 1 where F is negative where a root is wanted first, or else 0.
    pub(super) starts_below: Row,
}

/// What values tell of pixels.
pub(super) struct Verdict<S: Simd> {
    pub(super) state: Lanes<S>,
    pub(super) sign: Lanes<S>,
    pub(super) t: Lanes<S>,
    pub(super) wanted: [Lanes<S>; 2],
    pub(super) starts_below: Lanes<S>,
}

/// How the pursuit of a ray ended.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// There is no root, and F has this sign.
    Free(f64),
    /// There is one, and F has this sign before it.
    Hit(Hit, f64),
    /// The stretch is to be searched otherwise.
    Lost(Span),
}

impl Pixels {
    /// Rays that look for a root where one is wanted, and begin where a part's expansion is centred.
    #[inline(always)]
    pub(super) fn new(packet: Packet, rays: RayRow, wanted: [Row; 2], bow: &Bow) -> Self {
        let (nothing, no) = ([f64::NAN; _], [0.0; _]);
        let known = Bowed { slope: no, last_t: nothing, last: nothing, starts_below: no };
        let state = packet.each(state::OPEN, state::FREE);
        Self { packet, rays, wanted, t: [bow.t; _], state, sign: no, known }
    }

    /// F is `course` where the part's expansion is centred. Where it has no sign yet, the root is about so far away.
    #[inline(always)]
    pub(super) fn begin<S: Simd>(
        &mut self,
        (simd, part): (S, usize),
        course: &Course<S>,
        (sign, way): (Lanes<S>, Lanes<S>),
        bow: &Bow,
    ) {
        let all = |number| Lanes::all(simd, number);
        let is_open = sign.is_same(all(0.0)) & self.are_open(simd, part);
        let t = self.t(simd, part);
        let is_known = way.abs().is_less(all(f64::INFINITY));
        is_known.put(bow.in_reach(t + way), &mut self.t, part);
        is_open.select(all(state::OPEN), all(state::FREE)).put(&mut self.state, part);
        (sign * all(bow.sign)).put(&mut self.sign, part);
        course.slope.put(&mut self.known.slope, part);
    }

    /// F is `course` where the part's expansion is centred: looks for the root from there. Counts the rays that may be followed in vain.
    #[inline(always)]
    pub(super) fn start<S: Simd>(&mut self, (simd, part): (S, usize), course: &Course<S>, bow: &Bow) -> f64 {
        let all = |number| Lanes::all(simd, number);
        let (was_open, t) = (self.are_open(simd, part), self.t(simd, part));
        let wanted = self.wanted(simd, part);
        let mut verdict = self.judge((simd, part), *course, bow);
        let (free, open) = (all(state::FREE), all(state::OPEN));
        let (is_free, is_open) = (verdict.state.is_same(free), verdict.state.is_same(open));
        let is_doubtful = was_open & is_open & course.is_doubtful(verdict.t - t, ways(wanted, t), bow);
        // What is told of roots so early is told again by the first value.
        verdict.t = is_open.select(verdict.t, t);
        verdict.wanted = wanted;
        verdict.state = is_free.select(free, open);
        self.follow((simd, part), &verdict);
        course.slope.put(&mut self.known.slope, part);
        is_doubtful.select(all(1.0), all(0.0)).sum()
    }

    /// The root is wanted at which functions that bend rise again.
    pub(super) fn rise(&mut self) {
        self.known.starts_below = [1.0; _];
    }

    fn is_any_open(&self) -> bool {
        self.state.contains(&state::OPEN)
    }

    /// Those that are followed.
    #[inline(always)]
    pub(super) fn are_open<S: Simd>(&self, simd: S, part: usize) -> Mask<S> {
        Lanes::of(simd, &self.state, part).is_same(Lanes::all(simd, state::OPEN))
    }

    /// Where a root is looked for.
    #[inline(always)]
    pub(super) fn wanted<S: Simd>(&self, simd: S, part: usize) -> [Lanes<S>; 2] {
        Lanes::of_both(simd, &self.wanted, part)
    }

    /// Where F is to be taken next.
    #[inline(always)]
    pub(super) fn t<S: Simd>(&self, simd: S, part: usize) -> Lanes<S> {
        Lanes::of(simd, &self.t, part)
    }

    /// Takes over what was told of those that are open.
    #[inline(always)]
    pub(super) fn follow<S: Simd>(&mut self, (simd, part): (S, usize), verdict: &Verdict<S>) {
        let was_open = self.are_open(simd, part);
        let put = |to: &mut Row, from: Lanes<S>| {
            was_open.put(from, to, part);
        };
        put(&mut self.t, verdict.t);
        put(&mut self.wanted[0], verdict.wanted[0]);
        put(&mut self.wanted[1], verdict.wanted[1]);
        put(&mut self.sign, verdict.sign);
        put(&mut self.known.starts_below, verdict.starts_below);
        put(&mut self.state, verdict.state);
    }

    /// Learns from the values that were computed for F at t; says whether any ray is still open.
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S, values: &Row, bow: &Bow) -> bool {
        let all = |number| Lanes::all(simd, number);
        let mut is_any_open = false;
        for part in 0..parts::<S>() {
            let at = |row: &Row| Lanes::of(simd, row, part);
            let (t, value) = (at(&self.t), all(bow.sign) * at(values));
            let is_known = value.abs().is_less(all(f64::INFINITY));
            let away = t - all(bow.t);
            let (slope, bending) = (at(&self.known.slope), away * all(bow.middle));
            let rounding = all(ROUNDING) * (slope.abs() + bending.abs());
            let error_there = all(bow.slope_error) + away.abs() * all(bow.spread) + rounding;
            let slope_there = slope + bending;
            // The slope at t is the one from the last place to here, and half the way more of bending.
            let step = t - at(&self.known.last_t);
            let (slope, bending) = ((value - at(&self.known.last)) / step, all(0.5) * step * all(bow.middle));
            let error = all(0.5) * step.abs() * all(bow.spread)
                + all(2.0 * bow.error) / step.abs()
                + all(ROUNDING) * (slope.abs() + bending.abs());
            let is_nearer = error.is_less(error_there);
            let course = Course {
                value,
                value_error: all(bow.error),
                slope: is_nearer.select(slope + bending, slope_there),
                slope_error: is_nearer.select(error, error_there),
            };
            t.put(&mut self.known.last_t, part);
            value.put(&mut self.known.last, part);
            let mut verdict = self.judge((simd, part), course, bow);
            verdict.state = is_known.select(verdict.state, all(state::LOST));
            self.follow((simd, part), &verdict);
            is_any_open |= self.are_open(simd, part).is_any();
        }
        is_any_open
    }

    /// How each ray ended, by its place.
    pub(super) fn ends(&self) -> impl Iterator<Item = (usize, End)> {
        self.packet.places().enumerate().map(|(lane, place)| {
            let wanted = Span { start: self.wanted[0][lane], end: self.wanted[1][lane] };
            let end = match self.state[lane] {
                state::FREE => End::Free(self.sign[lane]),
                state::HIT => End::Hit(Hit { t: self.t[lane], bracket: wanted }, self.sign[lane]),
                _ => End::Lost(wanted),
            };
            (place, end)
        })
    }
}

/// The pursuit of rays, no more than [`AT_ONCE`] times as many as stand side by side.
struct Approach<'a> {
    pixels: &'a mut [Pixels],
    bow: &'a Bow,
    kernel: &'a dyn BatchKernel,
    points: &'a mut PointRows,
    scratch: &'a mut Scratch,
}

impl WithSimd for Approach<'_> {
    /// How many values were taken.
    type Output = usize;

    /// Goes on with each ray to its root.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { pixels, bow, kernel, points, scratch } = self;
        let (mut open, mut count, mut taken) = ([0; AT_ONCE], 0, 0);
        let mut coordinates = points.replace(pixels.len());
        for (number, pixels) in pixels.iter().enumerate() {
            if pixels.is_any_open() {
                pixels.rays.at(simd, &pixels.t, row_of(&mut coordinates, count));
                open[count] = number;
                count += 1;
            }
        }
        points.truncate(count);
        for _ in 0..STEPS {
            if count == 0 {
                break;
            }
            let (values, mut coordinates) = points.evaluate(kernel, scratch, 1);
            taken += values.as_flattened().len();
            let mut kept = 0;
            for (place, values) in values.iter().enumerate() {
                let number = open[place];
                let pixels = &mut pixels[number];
                if pixels.look(simd, values, bow) {
                    pixels.rays.at(simd, &pixels.t, row_of(&mut coordinates, kept));
                    open[kept] = number;
                    kept += 1;
                }
            }
            count = kept;
            points.truncate(count);
        }
        taken
    }
}

impl Subdivision<'_> {
    /// Goes on with each ray to its root in a part of these kernels. Those that are still open in the end are lost.
    pub(super) fn pursue(&mut self, pixels: &mut [Pixels], kernels: u32, bow: &Bow) {
        let Workspace { arch, point_rows, scratch, counters, .. } = &mut *self.workspace;
        if !pixels.iter().any(Pixels::is_any_open) {
            return;
        }
        let of_part = &self.kernels[kernels as usize];
        let kernel = of_part.over_points(Kernel::Values);
        for pixels in pixels.chunks_mut(AT_ONCE) {
            let taken = arch.dispatch(Approach { pixels, bow, kernel, points: point_rows, scratch });
            counters.trace_evaluations += taken as u64;
            counters.operations += of_part.charge(Kernel::Values, taken);
        }
    }
}
