//! Engines held against each other, and enclosures against values: nothing here asks a method of intersection.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{CompileError, Decoration, Engine, Interval, Program, Scratch};
use iso_grid::Region;
use serde::Serialize;

/// Boxes over which F and its gradient are enclosed, from the whole region down to points.
const BOXES: usize = 240;
/// Points in each of them.
const POINTS: usize = 4;
/// The halvings from the whole region to the smallest box that is no point.
const HALVINGS: usize = 30;
/// F and its three derivatives.
const OUTPUTS: usize = 4;

/// What was compared, and what should not be.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct EngineCheck {
    /// Doubles and decorations that both engines computed.
    pub(crate) compared: u64,
    /// Of them, those whose bits differ.
    pub(crate) differing: u64,
    /// Values that were looked for in enclosures.
    pub(crate) sampled: u64,
    /// Of them, those that lie outside.
    pub(crate) outside: u64,
    /// Differences of F between two points that were held against the enclosure of its derivative.
    pub(crate) slopes: u64,
    /// Of them, those that no derivative in the enclosure explains (mean value theorem).
    pub(crate) unexplained: u64,
}

/// Compares the engines on a program of F and its gradient.
pub(crate) fn check_engines(
    engines: &[Arc<dyn Engine>; 2],
    program: &Program,
    region: &Region,
) -> Result<EngineCheck, CompileError> {
    let places = Places::spread(region);
    let [interpreted, native] = [0, 1].map(|engine| Answers::of(&*engines[engine], program, &places));
    let (interpreted, native) = (interpreted?, native?);
    let mut check = EngineCheck::default();
    check.compare(&interpreted, &native);
    check.contain(&interpreted);
    check.explain(&interpreted, &places);
    Ok(check)
}

/// Boxes of all sizes, and points in each.
struct Places {
    /// The lower and the upper ends of the boxes, axis by axis.
    ends: [[Vec<f64>; 3]; 2],
    /// The points of each box, one after the other.
    points: [Vec<f64>; 3],
}

impl Places {
    /// The same in every run.
    fn spread(region: &Region) -> Self {
        let mut random = Random::new(1);
        let mut places = Self { ends: Default::default(), points: Default::default() };
        for number in 0..BOXES {
            let size = match number % (HALVINGS + 1) {
                HALVINGS => DVec3::ZERO,
                halvings => region.extent() * 0.5_f64.powi(halvings as i32),
            };
            let unit = DVec3::from_array([0; 3].map(|_| random.between(0.0, 1.0)));
            let lo = (region.min() + (region.extent() - size) * unit).max(region.min());
            places.push(&mut random, lo, (lo + size).min(region.max()));
        }
        places
    }

    fn push(&mut self, random: &mut Random, lo: DVec3, hi: DVec3) {
        for axis in 0..3 {
            self.ends[0][axis].push(lo[axis]);
            self.ends[1][axis].push(hi[axis]);
            for point in 0..POINTS {
                // The first two differ along one axis alone, so that the difference of F between them is a slope.
                let value = match (point, axis) {
                    (1, 1..) => *self.points[axis].last().expect("another point stands before"),
                    _ => random.between(lo[axis], hi[axis]).clamp(lo[axis], hi[axis]),
                };
                self.points[axis].push(value);
            }
        }
    }
}

/// What an engine says at the points and over the boxes.
struct Answers {
    values: Vec<f64>,
    over_boxes: Enclosed,
    at_points: Enclosed,
}

/// Enclosures, end by end.
struct Enclosed {
    lo: Vec<f64>,
    hi: Vec<f64>,
    decoration: Vec<Decoration>,
}

impl Enclosed {
    fn interval(&self, place: usize) -> Interval {
        Interval { lo: self.lo[place], hi: self.hi[place] }
    }
}

impl Answers {
    fn of(engine: &dyn Engine, program: &Program, places: &Places) -> Result<Self, CompileError> {
        let mut scratch = Scratch::default();
        let [x, y, z] = places.points.each_ref().map(|column| &column[..]);
        let mut values = vec![0.0; OUTPUTS * x.len()];
        engine.batch(program)?.evaluate(&mut scratch, &[x, y, z], &mut values);
        let kernel = engine.boxes(program)?;
        let mut enclose = |lo: [&[f64]; 3], hi: [&[f64]; 3]| {
            let count = OUTPUTS * lo[0].len();
            let (mut found, trivial) = ([vec![0.0; count], vec![0.0; count]], Decoration::Trivial);
            let mut decoration = vec![trivial; count];
            let [low, high] = &mut found;
            let room = Enclosures { lo: low, hi: high, decoration: &mut decoration };
            kernel.evaluate(&mut scratch, Boxes { lo, hi }, room);
            let [lo, hi] = found;
            Enclosed { lo, hi, decoration }
        };
        let [lo, hi] = places.ends.each_ref().map(|ends| ends.each_ref().map(|column| &column[..]));
        Ok(Self { values, over_boxes: enclose(lo, hi), at_points: enclose([x, y, z], [x, y, z]) })
    }
}

impl EngineCheck {
    /// Counts the doubles and decorations that differ, any two NaN being equal.
    fn compare(&mut self, left: &Answers, right: &Answers) {
        let mut doubles = |left: &[f64], right: &[f64]| {
            let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
            self.compared += left.len() as u64;
            self.differing += left.iter().zip(right).filter(|&pair| !same(pair)).count() as u64;
        };
        doubles(&left.values, &right.values);
        for (left, right) in [(&left.over_boxes, &right.over_boxes), (&left.at_points, &right.at_points)] {
            doubles(&left.lo, &right.lo);
            doubles(&left.hi, &right.hi);
        }
        for (left, right) in [(&left.over_boxes, &right.over_boxes), (&left.at_points, &right.at_points)] {
            let pairs = left.decoration.iter().zip(&right.decoration);
            self.compared += left.decoration.len() as u64;
            self.differing += pairs.filter(|(left, right)| left != right).count() as u64;
        }
    }

    /// Counts the values outside their enclosures. A double may exist where the formula is undefined, as e^(−1/0) does:
    /// there the enclosure of the point is empty, and nothing is counted.
    fn contain(&mut self, answers: &Answers) {
        for (place, &value) in answers.values.iter().enumerate() {
            let (output, point) = (place / (BOXES * POINTS), place % (BOXES * POINTS));
            let at_point = answers.at_points.interval(place);
            if !value.is_finite() || at_point.is_empty() {
                continue;
            }
            let over_box = answers.over_boxes.interval(output * BOXES + point / POINTS);
            self.sampled += 2;
            self.outside += u64::from(!at_point.contains(value)) + u64::from(!over_box.contains(value));
        }
    }

    /// Counts the differences of F along x that its derivative over the box cannot explain.
    fn explain(&mut self, answers: &Answers, places: &Places) {
        let x = &places.points[0];
        for (number, points) in x.chunks(POINTS).enumerate() {
            let derivative = BOXES + number;
            let is_smooth = answers.over_boxes.decoration[number] >= Decoration::Continuous
                && answers.over_boxes.decoration[derivative] >= Decoration::Continuous;
            if !is_smooth || points[0] == points[1] {
                continue;
            }
            let [from, to] = [0, 1].map(|point| answers.at_points.interval(number * POINTS + point));
            let way = Interval::point(points[1]).minus(Interval::point(points[0]));
            let explained = answers.over_boxes.interval(derivative).times(way);
            self.slopes += 1;
            self.unexplained += u64::from(to.minus(from).intersection(explained).is_empty());
        }
    }
}
