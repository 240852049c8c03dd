//! The search for the first root along a ray, front to back.

use iso_expr::interval::{round_down, round_up};
use iso_expr::{Decoration, Interval};

use super::classify::{Finding, classify, free_of_zero};
use super::clip::Clip;
use super::isolate::Isolation;
use super::line::Line;
use super::side::side;
use super::walk::Walk;
use crate::{Counters, Hit, Outcome, Span, Stop};

/// Into how many parts an open stretch is cut.
const PARTS: usize = 4;

/// Where a stretch is cut, as fractions of its length: off the symmetric places where roots are fond of lying, for a root
/// at a cut leaves both neighbours open.
const CUTS: [f64; PARTS - 1] = [0.2402, 0.4883, 0.7539];

/// How many boxes may be enclosed along one ray before the search gives up.
pub(super) const WORK_LIMIT: u64 = 1 << 12;

/// How many pieces of F around its poles and jumps are looked at before the search goes on without them.
const PIECES: usize = 32;

/// How often a stretch that cannot be split is widened, each time by four times as much, to see whether a simple root
/// hides in the rounding.
const WIDENINGS: u32 = 12;

/// The search along one ray.
pub(super) struct Search<'a> {
    pub(super) line: Line<'a>,
    pub(super) accuracy: f64,
    pub(super) stop: &'a Stop,
    pub(super) clip: Clip,
    pub(super) way: Way<'a>,
    /// How many boxes may be enclosed.
    pub(super) budget: u64,
    /// What lies ahead in the stretch of the way that is looked at, the nearest on top. Everything before it is free of
    /// roots, and so is all between.
    pub(super) ahead: &'a mut Vec<Ahead>,
}

/// Where stretches to look at come from, front to back. All between them is free of roots.
pub(super) enum Way<'a> {
    /// The cells that are not empty.
    Cells(Walk<'a>),
    /// The pieces in which a polynomial may change sign.
    Pieces(Isolation<'a>),
}

impl Way<'_> {
    /// Counts the work that finding the stretches took.
    pub(super) fn tally(&self, counters: &mut Counters) {
        match self {
            Self::Cells(walk) => {
                counters.box_evaluations += walk.evaluations;
                counters.steps += walk.steps;
            }
            Self::Pieces(isolation) => {
                counters.box_evaluations += 1;
                counters.steps += isolation.judged;
            }
        }
    }
}

/// A stretch that may hold roots.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead {
    stretch: Span,
    finding: Finding,
}

/// How many times farther from zero than by its slopes F may be where it reaches zero nearby: roots such as ∜x fall so fast at last. Beside 0/0
/// slopes vanish but for roundings.
const BENDING: f64 = 16.0;

/// Whether F, in `value` at a point, may be zero there or nearby, as its slopes tell, by which it changes by `change`, or is much nearer to zero
/// than at one of two points around it. Where it is not, as beside 0/0, it is only that its enclosures are wide.
fn is_lower(value: Interval, change: f64, around: [Interval; 2]) -> bool {
    let distance = value.lo.max(-value.hi);
    distance <= 0.0
        || distance <= BENDING * change
        || around.into_iter().any(|other| 2.0 * distance < other.magnitude())
}

impl Search<'_> {
    /// How the search ends, or what is left of the ray when the budget is spent or work is to end. Everything before the end is proven.
    pub(super) fn run(&mut self) -> Result<Outcome, Span> {
        self.ahead.clear();
        while let Some(Ahead { stretch, finding }) = self.next() {
            if self.line.evaluations >= self.budget || self.stop.is_requested() {
                return Err(Span { start: stretch.start, end: self.clip.outer.end });
            }
            let end = match finding {
                Finding::Open if stretch.end - stretch.start > self.resolution(stretch) => {
                    self.divide(stretch);
                    None
                }
                Finding::Open | Finding::Flat => self.settle(stretch),
                Finding::Crossing => self.place(stretch),
                Finding::Plateau => Some(Outcome::Touch(Hit { t: stretch.start, bracket: stretch })),
            };
            if let Some(outcome) = end {
                return Ok(outcome);
            }
        }
        Ok(Outcome::Miss)
    }

    /// The nearest stretch that may hold roots.
    fn next(&mut self) -> Option<Ahead> {
        while self.ahead.is_empty() {
            let Span { start, end } = match &mut self.way {
                Way::Cells(walk) => walk.next(self.line.kernels, self.line.scratch)?,
                Way::Pieces(isolation) => isolation.next()?,
            };
            // In about halves, for two boxes take no longer than one.
            self.examine(&[start, start + CUTS[1] * (end - start), end]);
        }
        self.ahead.pop()
    }

    /// How wide the enclosure of a root in `stretch` may be: never wider than the ray's scale allows.
    fn tolerance(&self, stretch: Span) -> f64 {
        let scale = self.clip.outer.end;
        self.accuracy * stretch.start.max(1.0).min(scale)
    }

    /// How wide a stretch must be to be worth splitting: a few neighbouring doubles, or well below the tolerance.
    fn resolution(&self, stretch: Span) -> f64 {
        let neighbours = 4.0 * f64::EPSILON * self.clip.outer.end;
        neighbours.max(self.tolerance(stretch) / 1024.0)
    }

    /// Cuts a stretch, and puts the parts that may hold roots in its place.
    fn divide(&mut self, stretch: Span) {
        let length = stretch.end - stretch.start;
        let mut ends = [stretch.start; PARTS + 1];
        for (end, fraction) in ends[1..].iter_mut().zip(CUTS) {
            *end = stretch.start + fraction * length;
        }
        ends[PARTS] = stretch.end;
        self.examine(&ends);
    }

    /// Looks at the stretches between neighbouring `ends`, no more than [`PARTS`], and puts what of them may hold roots
    /// ahead.
    fn examine(&mut self, ends: &[f64]) {
        let count = ends.len() - 1;
        self.line.enter(Span { start: ends[0], end: ends[count] });
        let parts: [Span; PARTS] = std::array::from_fn(|part| {
            let part = part.min(count - 1);
            Span { start: ends[part], end: ends[part + 1] }
        });
        let values = self.line.values(&parts[..count]);
        let open = |part: &usize| !free_of_zero(values[*part].interval);
        let (Some(first), Some(last)) = ((0..count).find(open), (0..count).rev().find(open)) else { return };
        let courses = self.line.courses(&parts[first..=last]);
        let points: [Span; PARTS + 1] = std::array::from_fn(|end| {
            let t = ends[end.min(count)];
            Span { start: t, end: t }
        });
        let at_ends = self.line.values(&points[first..=last + 1]);

        for part in (first..=last).rev().filter(open) {
            let place = part - first;
            let (start, end) = (at_ends[place].interval, at_ends[place + 1].interval);
            let Some((stretch, finding)) = classify(parts[part], courses[place], start, end) else {
                continue;
            };
            let continuous = courses[place].value.decoration >= Decoration::Continuous;
            if continuous || !self.pieces_are_free(stretch) {
                self.ahead.push(Ahead { stretch, finding });
            }
        }
    }

    /// Ends the search at a stretch that cannot be split further, or finds that it holds no root after all.
    fn settle(&mut self, stretch: Span) -> Option<Outcome> {
        self.line.enter(stretch);
        let value = self.line.course(stretch).value;
        if value.decoration < Decoration::Continuous {
            return (!self.pieces_are_free(stretch)).then_some(Outcome::Undecided(stretch));
        }
        let (mut around, mut valley) = (stretch, None);
        let mut margin = (stretch.end - stretch.start).max(self.resolution(stretch));
        for _ in 0..WIDENINGS {
            let wide =
                Span { start: round_down(stretch.start - margin), end: round_up(stretch.end + margin) };
            self.line.enter(wide);
            let course = self.line.course(wide);
            let [before, after, ..] =
                self.line.courses(&[wide.start, wide.end].map(|t| Span { start: t, end: t }));
            match classify(wide, course, before.value.interval, after.value.interval) {
                None => return None,
                Some((narrowed, Finding::Crossing)) => return self.place(narrowed),
                Some(_) => margin *= 4.0,
            }
            if course.value.decoration >= Decoration::Continuous {
                around = wide;
            }
            let (falls, rises) = (side(before.slope.interval), side(after.slope.interval));
            if falls.is_some() && rises.is_some() && falls != rises {
                valley = Some(wide);
                break;
            }
        }
        if !value.interval.is_bounded() {
            return Some(Outcome::Undecided(stretch));
        }
        // A valley that was widened may have its bottom before the ray begins, or far from zero.
        let outer = self.clip.outer;
        let bottom = valley.map(|valley| self.line.extremum(valley).clamp(outer.start, outer.end));
        Some(self.touch(stretch, bottom, around))
    }

    /// Ends the search at a stretch that may hold a contact, which is at the bottom of a valley if that may reach zero, or else as near the start of
    /// the stretch as can be told. F is continuous `around` it.
    fn touch(&mut self, stretch: Span, bottom: Option<f64>, around: Span) -> Outcome {
        let middle = stretch.start + 0.5 * (stretch.end - stretch.start);
        let bottom = self.line.first_contact(bottom.as_slice());
        let contact = bottom.or_else(|| self.line.first_contact(&[stretch.start, middle, stretch.end]));
        let t = contact.unwrap_or(middle);
        let [here, before, after, ..] = self.line.jets_beside(&[t, around.start, around.end]);
        let sides = self.line.bounds(stretch).map(Interval::width);
        let changes = here.gradient.into_iter().zip(sides).filter(|(_, side)| *side > 0.0);
        let change = changes.map(|(partial, side)| partial.interval.magnitude() * side).sum();
        if !is_lower(here.value.interval, change, [before, after].map(|jet| jet.value.interval)) {
            return Outcome::Undecided(stretch);
        }
        let bracket = Span { start: stretch.start.min(t), end: stretch.end.max(t) };
        Outcome::Touch(Hit { t, bracket })
    }

    /// Ends the search at the one simple root of a stretch, unless it lies outside the region.
    fn place(&mut self, stretch: Span) -> Option<Outcome> {
        self.line.enter(stretch);
        let bracket = self.line.enclose_root(stretch, self.tolerance(stretch));
        let Clip { outer, inner } = self.clip;
        if bracket.end < outer.start || bracket.start > outer.end {
            return None;
        }
        if bracket.start < inner.start || bracket.end > inner.end {
            let inside = Span { start: bracket.start.max(outer.start), end: bracket.end.min(outer.end) };
            return Some(Outcome::Undecided(inside));
        }
        let t = bracket.start + 0.5 * (bracket.end - bracket.start);
        Some(Outcome::Hit(Hit { t, bracket }))
    }

    /// Whether F is never zero on a stretch, seen piece by piece.
    fn pieces_are_free(&mut self, stretch: Span) -> bool {
        let bounds = self.line.bounds(stretch);
        for (place, piece) in self.line.asked.program().pieces(bounds).enumerate() {
            self.line.evaluations += 1;
            if place == PIECES || !free_of_zero(piece) {
                return false;
            }
        }
        true
    }
}
