//! The search for the first change of sign along one ray.

use crate::batch::PointBatch;
use crate::paper::stretch::{Stretch, Stretches};
use crate::roots::{Bracket, Narrowing, RootFinding, Sample};
use crate::sign::Signs;
use crate::{Hit, Outcome, Ray, Span};

/// Samples asked for at once. Those behind the first change of sign are wasted, so there are few.
const BLOCK: usize = 8;

/// How far behind a zero its next sign is looked for first, as a part of the distance between samples: further than
/// rounding errors reach where F − C crosses zero, nearer than the next root should be.
const FIRST_LOOK: f64 = 1.0 / 1_048_576.0;
/// How many times further each look goes where there is no sign.
const FURTHER: f64 = 16.0;

/// Samples the stretches of a ray in order and narrows the first interval whose ends have unlike signs.
///
/// The search owns no kernel: it asks for points and is answered with the values there, so that many searches share one
/// call of a kernel. What it asks for depends on its own answers alone.
///
/// It knows nothing but signs, as the paper's method does. A pole that changes sign looks like a root, and is reported
/// as one. Two roots between neighbouring samples look like none.
pub(crate) struct Search<S> {
    ray: Ray,
    roots: RootFinding,
    stretches: S,
    sampled: Option<Sampled>,
    block: Block,
    previous: Option<Sample>,
    stage: Stage,
}

/// The stretch being sampled.
#[derive(Clone, Copy)]
struct Sampled {
    stretch: Stretch,
    /// How many steps from its start the next sample is.
    next: u32,
    /// Whether nothing was left out between the next sample and the last one.
    joined: bool,
}

/// Samples asked for together.
#[derive(Clone, Copy, Default)]
struct Block {
    places: [f64; BLOCK],
    values: [f64; BLOCK],
    /// Whether nothing was left out between a sample and the one before it.
    joined: [bool; BLOCK],
    /// How many were asked for.
    asked: usize,
    /// How many were looked at.
    read: usize,
}

/// What the search is doing.
#[derive(Clone, Copy)]
enum Stage {
    /// Looking for samples of unlike sign.
    Sampling,
    /// Narrowing the interval between two samples of unlike sign.
    Narrowing(Narrowing),
    /// Looking what sign there is behind the zero at the interval's end, at this distance.
    Passing(Narrowing, f64),
}

impl<S: Stretches> Search<S> {
    pub(crate) fn new(ray: Ray, roots: RootFinding, stretches: S) -> Self {
        Self {
            ray,
            roots,
            stretches,
            sampled: None,
            block: Block::default(),
            previous: None,
            stage: Stage::Sampling,
        }
    }

    /// How many cells were walked through so far.
    pub(crate) fn steps(&self) -> u64 {
        self.stretches.steps()
    }

    /// The ray that is searched.
    pub(crate) fn ray(&self) -> &Ray {
        &self.ray
    }

    /// Whether the slope along the ray is to be known beside the value at the next point, which is then one at most.
    pub(crate) fn wants_slope(&self) -> bool {
        matches!(&self.stage, Stage::Narrowing(narrowing) if narrowing.wants_slope())
    }

    /// Adds the points where F − C is to be known next, and says how many.
    pub(crate) fn ask(&mut self, points: &mut PointBatch) -> usize {
        match &self.stage {
            Stage::Sampling => self.ask_for_block(points),
            Stage::Narrowing(narrowing) => narrowing.next().map_or(0, |next| self.ask_for(points, next)),
            Stage::Passing(narrowing, distance) => {
                self.ask_for(points, narrowing.bracket().after.t + distance)
            }
        }
    }

    /// Takes the values at the points last asked for, and the slope if it was wanted, and says how the search ended if it did.
    pub(crate) fn answer(&mut self, values: &[f64], slope: f64) -> Option<Outcome> {
        match (self.stage, values) {
            (Stage::Sampling, []) => return Some(Outcome::Miss),
            (Stage::Sampling, _) => {
                self.block.values[..values.len()].copy_from_slice(values);
                self.block.read = 0;
            }
            (Stage::Narrowing(narrowing), &[value]) => return self.narrow(narrowing, value, slope),
            (Stage::Narrowing(narrowing), _) if narrowing.bracket().after.value == 0.0 => {
                self.stage = Stage::Passing(narrowing, narrowing.step() * FIRST_LOOK);
                return None;
            }
            (Stage::Narrowing(narrowing), _) => return Some(Outcome::Hit(narrowing.bracket().hit())),
            (Stage::Passing(narrowing, distance), _) => return self.pass(narrowing, distance, values),
        }
        self.read_block()
    }

    fn ask_for(&self, points: &mut PointBatch, t: f64) -> usize {
        points.push_along(&self.ray, &[t]);
        1
    }

    fn ask_for_block(&mut self, points: &mut PointBatch) -> usize {
        self.block.asked = 0;
        while self.block.asked < BLOCK && self.stand_before_sample() {
            let Some(Sampled { stretch, next, joined }) = &mut self.sampled else { break };
            let count = (BLOCK - self.block.asked).min((stretch.steps + 1 - *next) as usize);
            let run = self.block.asked..self.block.asked + count;
            for (place, step) in self.block.places[run.clone()].iter_mut().zip(*next..) {
                *place = stretch.sample(step);
            }
            self.block.joined[run.clone()].fill(true);
            self.block.joined[run.start] = *joined;
            (*next, *joined) = (*next + count as u32, true);
            self.block.asked = run.end;
        }
        points.push_along(&self.ray, &self.block.places[..self.block.asked]);
        self.block.asked
    }

    /// Goes on to the next stretch where the last one ended. Where it begins at the other's end, its first sample is the
    /// other's last one. Says whether there is a sample left.
    fn stand_before_sample(&mut self) -> bool {
        let last = self.sampled;
        if last.is_some_and(|last| last.next <= last.stretch.steps) {
            return true;
        }
        let Some(stretch) = self.stretches.next() else { return false };
        let joined = last.is_some_and(|last| last.stretch.span.end == stretch.span.start);
        self.sampled = Some(Sampled { stretch, next: u32::from(joined), joined });
        true
    }

    /// Goes on through the block's samples to the next change of sign.
    fn read_block(&mut self) -> Option<Outcome> {
        let Block { places, values, joined, asked, read } = self.block;
        let signs: Signs = values[read..asked].iter().map(|&value| Signs::of(value)).collect();
        let known = self.previous.map_or(Signs::NONE, |previous| previous.signs());
        if !(known | signs).differ() && read < asked {
            self.previous = Some(Sample { t: places[asked - 1], value: values[asked - 1] });
            return None;
        }
        for number in read..asked {
            self.block.read = number + 1;
            let sample = Sample { t: places[number], value: values[number] };
            let before = self.previous.replace(sample).filter(|_| joined[number]);
            let known = before.map_or(Signs::NONE, |before| before.signs());
            match before {
                Some(before) if known != Signs::NONE && (known | sample.signs()).differ() => {
                    let bracket = Bracket { before, after: sample };
                    self.stage = Stage::Narrowing(Narrowing::new(self.roots, bracket));
                    return None;
                }
                _ if sample.signs().differ() => return Some(touch(sample.t)),
                _ => {}
            }
        }
        None
    }

    /// Keeps the part of an interval whose ends have unlike signs. Where F − C is undefined at the point that was asked for,
    /// the interval is given up and the search goes on behind it.
    fn narrow(&mut self, mut narrowing: Narrowing, value: f64, slope: f64) -> Option<Outcome> {
        let has_sign = narrowing.take(Sample { t: narrowing.next()?, value }, slope);
        if has_sign {
            self.stage = Stage::Narrowing(narrowing);
            return None;
        }
        self.stage = Stage::Sampling;
        let after = narrowing.bracket().after;
        if after.value == 0.0 { Some(touch(after.t)) } else { self.read_block() }
    }

    /// Tells a zero that is crossed from one that is only touched, by the first sign behind it.
    fn pass(&mut self, narrowing: Narrowing, distance: f64, values: &[f64]) -> Option<Outcome> {
        let behind: Signs = values.iter().map(|&value| Signs::of(value)).collect();
        let bracket = narrowing.bracket();
        if behind == Signs::NEGATIVE || behind == Signs::POSITIVE {
            let crossed = behind != bracket.before.signs();
            return Some(if crossed { Outcome::Hit(bracket.hit()) } else { Outcome::Touch(bracket.hit()) });
        }
        if distance >= narrowing.step() {
            return Some(Outcome::Touch(bracket.hit()));
        }
        self.stage = Stage::Passing(narrowing, (FURTHER * distance).min(narrowing.step()));
        None
    }
}

/// A zero without a neighbour to compare its sign with.
fn touch(t: f64) -> Outcome {
    Outcome::Touch(Hit { t, bracket: Span { start: t, end: t } })
}
