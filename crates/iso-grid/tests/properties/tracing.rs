//! What holds of any formula, met by any rays: every method ends soon, and the certified one contradicts neither itself nor
//! a change of sign that intervals prove.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{Decorated, Decoration, Engine, Interpreter, Interval, Program, Scratch};
use iso_grid::{
    Certified, Direct, Grid, GridError, GridSettings, Octree, Outcome, Outcomes, Ray, Region, RootFinder,
    RootFinding, Span, Stop, Surface, Tile, Tracer, Workspace,
};

/// How many columns and rows the tile that is traced may have.
const SIDES: [usize; 3] = [2, 3, 6];
/// Points of a ray between which signs are compared.
const SAMPLES: usize = 48;
const HALF_SIDE: f64 = 2.0;

/// Traces a tile of random rays by a method that samples and by the certified one, and says whether that took less than `limit`.
///
/// # Panics
/// When what the certified method says is impossible.
pub(crate) fn ends_in_time(random: &mut Random, program: &Program, limit: Duration) -> bool {
    let stop = Stop::default();
    let (done, wait) = channel::<()>();
    let watch = {
        let stop = stop.clone();
        thread::spawn(move || {
            if wait.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                stop.request();
            }
        })
    };
    let traced = trace_by_two(random, program, &stop);
    drop(done);
    watch.join().expect("waiting does not panic");
    match traced {
        Ok(()) => !stop.is_requested(),
        Err(GridError::Stopped) => false,
        Err(error) => panic!("{error}"),
    }
}

fn trace_by_two(random: &mut Random, program: &Program, stop: &Stop) -> Result<(), GridError> {
    let value = program.simplified();
    let surface = Surface::new(Arc::new(Interpreter), value).stopped_by(stop.clone());
    let region = Region::new(DVec3::splat(-HALF_SIDE), DVec3::splat(HALF_SIDE)).expect("the region has room");
    let side = random.choose(&SIDES);
    let rays = tile(random, side);
    let finder = random.choose(&RootFinder::ALL);
    let roots = RootFinding { finder, tolerance: 0.0 };
    let settings = GridSettings { roots, ..GridSettings::new([8; 3]) };
    let sampling: Box<dyn Tracer> = match random.below(3) {
        0 => Box::new(Grid::new(&surface, region, &settings)?),
        1 => Box::new(Octree::new(&surface, region, &settings)?),
        _ => Box::new(Direct::new(&surface, region, 1.0, roots)?),
    };
    outcomes(sampling.as_ref(), &rays).iter().for_each(check_places);
    let certified = Certified::new(&surface, region)?;
    let alone = outcomes(&certified, &rays);
    let mut together = Outcomes::default();
    certified.trace_tile(&mut Workspace::default(), Tile::listed(&rays, side), &mut together, None);
    if stop.is_requested() {
        return Err(GridError::Stopped);
    }
    for ((ray, alone), together) in rays.iter().zip(&alone).zip(together.iter()) {
        let context = || format!("{alone:?} alone, {together:?} in a tile, along {ray:?} of\n{program}");
        check_places(alone);
        check_places(&together);
        assert!(agree(alone, &together), "{}", context());
        if let Some(before) = first_crossing(program, ray) {
            for outcome in [alone, &together] {
                let start = earliest(outcome);
                assert!(
                    start.is_some_and(|start| start <= before),
                    "a root lies before {before}: {}",
                    context()
                );
            }
        }
    }
    Ok(())
}

/// Neighbouring rays towards the region, from an eye, in parallel, or from inside, in all of which ways axes matter.
fn tile(random: &mut Random, side: usize) -> Vec<Ray> {
    let from = DVec3::from_array([(); 3].map(|()| random.coordinate() * random.choose(&[1.0, 3.0])));
    let towards = DVec3::from_array([(); 3].map(|()| random.coordinate()));
    let direction = match random.below(4) {
        0 => random.choose(&DVec3::AXES),
        _ if towards == from => DVec3::X,
        _ => towards - from,
    };
    let (right, up) = direction.normalize().any_orthonormal_pair();
    let spread = random.choose(&[1e-6, 0.01, 0.3]);
    let is_parallel = random.below(2) == 0;
    let places = (0..side).flat_map(|row| (0..side).map(move |column| (column as f64, row as f64)));
    let ray = |(column, row): (f64, f64)| {
        let aside = spread * (column * right - row * up);
        let (origin, direction) =
            if is_parallel { (from + aside, direction) } else { (from, direction + aside) };
        Ray { origin, direction }
    };
    places.map(ray).collect()
}

fn outcomes(method: &dyn Tracer, rays: &[Ray]) -> Vec<Outcome> {
    let mut outcomes = Outcomes::default();
    method.trace(&mut Workspace::default(), rays, &mut outcomes);
    outcomes.iter().collect()
}

/// Roots lie in their brackets, and brackets on their rays.
fn check_places(outcome: &Outcome) {
    let bracket = match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => {
            assert!(hit.bracket.start <= hit.t && hit.t <= hit.bracket.end, "{outcome:?}");
            hit.bracket
        }
        Outcome::Undecided(span) => *span,
        Outcome::Miss => return,
    };
    assert!(0.0 <= bracket.start && bracket.start <= bracket.end && bracket.end.is_finite(), "{outcome:?}");
}

/// Whether two proofs about a ray can both be true.
fn agree(one: &Outcome, other: &Outcome) -> bool {
    match (one, other) {
        (Outcome::Hit(one), Outcome::Hit(other)) => {
            let Span { start, end } = one.bracket;
            start <= other.bracket.end && other.bracket.start <= end
        }
        (Outcome::Hit(_), Outcome::Miss) | (Outcome::Miss, Outcome::Hit(_)) => false,
        _ => true,
    }
}

/// Where the first root may lie at the earliest; `None` where there is none.
fn earliest(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => Some(hit.bracket.start),
        Outcome::Undecided(span) => Some(span.start),
        Outcome::Miss => None,
    }
}

/// A place on the ray before which a root lies, proven by unlike signs at two points of the region between which the
/// formula is continuous; `None` where no such points were found.
fn first_crossing(program: &Program, ray: &Ray) -> Option<f64> {
    let end = (ray.origin.length() + 2.0 * HALF_SIDE) / ray.direction.length();
    let places: Vec<f64> = (0..=SAMPLES).map(|sample| end * sample as f64 / SAMPLES as f64).collect();
    let points: Vec<[Interval; 3]> = places.iter().map(|&t| around(ray, t)).collect();
    let stretches: Vec<[Interval; 3]> = points.windows(2).map(|ends| hull(&ends[0], &ends[1])).collect();
    let (values, courses) = (enclose(program, &points), enclose(program, &stretches));
    (0..SAMPLES).find_map(|sample| {
        let is_inside = stretches[sample].iter().all(|side| -HALF_SIDE <= side.lo && side.hi <= HALF_SIDE);
        let is_continuous = courses[sample].decoration >= Decoration::Continuous;
        let signs = [sample, sample + 1].map(|sample| sign(values[sample].interval));
        let is_crossed = signs == [Some(true), Some(false)] || signs == [Some(false), Some(true)];
        (is_inside && is_continuous && is_crossed).then_some(places[sample + 1])
    })
}

/// A box around the ray's point at `t`: two roundings away from the computed one at most.
fn around(ray: &Ray, t: f64) -> [Interval; 3] {
    std::array::from_fn(|axis| {
        let (origin, step) = (ray.origin[axis], t * ray.direction[axis]);
        let slack = 2.0 * f64::EPSILON * (origin.abs() + step.abs()) + f64::MIN_POSITIVE;
        Interval { lo: origin + step - slack, hi: origin + step + slack }
    })
}

fn hull(one: &[Interval; 3], other: &[Interval; 3]) -> [Interval; 3] {
    std::array::from_fn(|axis| Interval {
        lo: one[axis].lo.min(other[axis].lo),
        hi: one[axis].hi.max(other[axis].hi),
    })
}

/// Whether an interval is above zero or below; `None` where it is neither.
fn sign(interval: Interval) -> Option<bool> {
    if interval.lo > 0.0 {
        Some(true)
    } else if interval.hi < 0.0 {
        Some(false)
    } else {
        None
    }
}

fn enclose(program: &Program, boxes: &[[Interval; 3]]) -> Vec<Decorated> {
    let ends = |end: fn(&Interval) -> f64| {
        [0, 1, 2].map(|axis| boxes.iter().map(|sides| end(&sides[axis])).collect::<Vec<_>>())
    };
    let (lo, hi) = (ends(|side| side.lo), ends(|side| side.hi));
    let count = boxes.len();
    let (mut low, mut high) = (vec![0.0; count], vec![0.0; count]);
    let mut decoration = vec![Decoration::Trivial; count];
    Interpreter.boxes(program).expect("the interpreter takes all programs").evaluate(
        &mut Scratch::default(),
        Boxes { lo: lo.each_ref().map(Vec::as_slice), hi: hi.each_ref().map(Vec::as_slice) },
        Enclosures { lo: &mut low, hi: &mut high, decoration: &mut decoration },
    );
    let ends = low.into_iter().zip(high);
    ends.zip(decoration)
        .map(|((lo, hi), decoration)| Decorated { interval: Interval { lo, hi }, decoration })
        .collect()
}
