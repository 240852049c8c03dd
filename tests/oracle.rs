//! The certified method against rays that an independent program decided with ball arithmetic.

mod scenes;

use std::fmt;
use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Engine, Interpreter};
use iso_grid::{Certified, Hit, Outcome, Outcomes, Ray, Tile, Tracer, Workspace, normals};
use iso_jit::Jit;
use scenes::rounding::Rounding;
use scenes::{Scene, Status, Verdict};

/// How many rays may end as `touch` or `undecided` though the independent program, with its 256 bits, says more.
struct Exception {
    scene: &'static str,
    touches: usize,
    undecided: usize,
    reason: &'static str,
}

const EXCEPTIONS: &[Exception] = &[
    Exception {
        scene: "sphere_pow5",
        touches: 132,
        undecided: 0,
        reason: "the root is of order five: its sign changes, but its slope does not exclude zero",
    },
    Exception {
        scene: "overflow_diff",
        touches: 0,
        undecided: 139,
        reason: "both exponentials overflow in front of the surface, where their difference may be any double",
    },
];

#[test]
fn interpreter_proves_what_the_oracle_says() {
    compare(Arc::new(Interpreter), trace_each);
    compare(Arc::new(Interpreter), trace_pictures);
}

#[test]
fn native_code_proves_what_the_oracle_says() {
    let engine = Arc::new(Jit::new().expect("this machine is one that code is made for"));
    compare(Arc::clone(&engine) as Arc<dyn Engine>, trace_each);
    compare(engine, trace_pictures);
}

#[test]
fn both_engines_say_the_same_of_tiles() {
    let jit: Arc<dyn Engine> = Arc::new(Jit::new().expect("this machine is one that code is made for"));
    for scene in scenes::all() {
        let rays: Vec<Ray> = scene.verdicts().iter().map(|verdict| verdict.ray).collect();
        let outcomes = [Arc::new(Interpreter) as Arc<dyn Engine>, Arc::clone(&jit)].map(|engine| {
            let surface = scene.surface(engine);
            let tracer = Certified::new(&surface, scene.region()).expect("the scenes compile");
            trace_pictures(&tracer, &mut Workspace::default(), &rays)
        });
        assert_eq!(outcomes[0], outcomes[1], "{}", scene.name);
    }
}

/// A way to trace all rays of a scene.
type Trace = fn(&Certified, &mut Workspace, &[Ray]) -> Outcomes;

/// Traces each ray alone.
fn trace_each(tracer: &Certified, workspace: &mut Workspace, rays: &[Ray]) -> Outcomes {
    let mut outcomes = Outcomes::default();
    tracer.trace(workspace, rays, &mut outcomes);
    outcomes
}

/// The sides of the square pictures whose rays make up a scene, one after the other; not all scenes have the last one.
const SIDES: [usize; 3] = [24, 16, 12];

/// Traces each of the pictures that make up a scene as one tile.
fn trace_pictures(tracer: &Certified, workspace: &mut Workspace, mut rays: &[Ray]) -> Outcomes {
    let (mut all, mut outcomes) = (Vec::new(), Outcomes::default());
    for side in SIDES {
        let (tile, others) = rays.split_at(rays.len().min(side * side));
        tracer.trace_tile(workspace, Tile::listed(tile, side), &mut outcomes, None);
        all.extend(outcomes.iter());
        rays = others;
    }
    assert!(rays.is_empty(), "a scene has three pictures");
    all.into_iter().collect()
}

/// Traces every ray of every scene. All that is wrong is told at once.
fn compare(engine: Arc<dyn Engine>, trace: Trace) {
    let mut wrong = Vec::new();
    for scene in scenes::all() {
        let comparison = Comparison::of(&scene, Arc::clone(&engine), trace);
        println!("{comparison}");
        let exception = EXCEPTIONS.iter().find(|exception| exception.scene == scene.name);
        let is_classic = scene.tags.iter().any(|tag| tag == "classic");
        assert!(
            !(is_classic && exception.is_some()),
            "{}: all of a classic scene can be decided",
            scene.name
        );
        let (touches, undecided, reason) = exception
            .map_or((0, 0, "all can be decided"), |Exception { touches, undecided, reason, .. }| {
                (*touches, *undecided, *reason)
            });
        if comparison.touches > touches || comparison.undecided > undecided {
            wrong.push(format!(
                "{}: {} touches and {} undecided, allowed {touches} and {undecided} ({reason})",
                scene.name, comparison.touches, comparison.undecided
            ));
        }
        wrong.extend(comparison.contradictions.into_iter().map(|text| format!("{}: {text}", scene.name)));
    }
    assert!(wrong.is_empty(), "{} engine:\n{}", engine.name(), wrong.join("\n"));
}

/// One scene's rays, compared.
struct Comparison {
    name: String,
    rays: usize,
    /// Rays said to touch that the oracle says hit or miss.
    touches: usize,
    /// Undecided rays that the oracle decided.
    undecided: usize,
    /// The largest |t − t*| / max(1, |t*|).
    error: f64,
    /// The widest bracket of a hit relative to max(1, |t|).
    width: f64,
    /// Boxes enclosed.
    boxes: u64,
    contradictions: Vec<String>,
}

impl Comparison {
    fn of(scene: &Scene, engine: Arc<dyn Engine>, trace: Trace) -> Self {
        let surface = scene.surface(engine);
        let tracer = Certified::new(&surface, scene.region()).expect("the scenes compile");
        let verdicts = scene.verdicts();
        let rays: Vec<Ray> = verdicts.iter().map(|verdict| verdict.ray).collect();
        let mut workspace = Workspace::default();
        let outcomes = trace(&tracer, &mut workspace, &rays);
        let mut found = vec![DVec3::NAN; rays.len()];
        normals(&surface, None, &mut workspace, rays.as_slice().into(), &outcomes, &mut found)
            .expect("the scenes compile");

        let mut comparison = Self {
            name: scene.name.clone(),
            rays: rays.len(),
            touches: 0,
            undecided: 0,
            error: 0.0,
            width: 0.0,
            boxes: workspace.counters.box_evaluations,
            contradictions: Vec::new(),
        };
        for (row, verdict) in verdicts.iter().enumerate() {
            let rounding = || Rounding::at(&surface, verdict);
            if let Err(contradiction) = comparison.check(verdict, outcomes.get(row), found[row], rounding) {
                comparison.contradictions.push(format!("row {row}: {contradiction}"));
            }
        }
        comparison
    }

    fn check(
        &mut self,
        verdict: &Verdict,
        outcome: Outcome,
        normal: DVec3,
        rounding: impl Fn() -> Rounding,
    ) -> Result<(), String> {
        let said =
            format!("the oracle says {:?} at {}, but the ray ends as {outcome:?}", verdict.status, verdict.t);
        let unless = |holds: bool| if holds { Ok(()) } else { Err(said.clone()) };
        match (verdict.status, outcome) {
            (Status::Hit, Outcome::Hit(hit)) => self.check_hit(verdict, hit, normal, &rounding()),
            (Status::Hit, Outcome::Touch(Hit { bracket, .. })) => {
                self.touches += 1;
                unless(verdict.overlaps(bracket))
            }
            (Status::Hit, Outcome::Undecided(stretch)) => {
                self.undecided += 1;
                unless(stretch.start <= verdict.place.end)
            }
            (Status::Touch, Outcome::Touch(Hit { bracket, .. })) => unless(verdict.overlaps(bracket)),
            (Status::Miss, Outcome::Miss) | (Status::Undecided, Outcome::Undecided(_)) => Ok(()),
            (Status::Miss, Outcome::Touch(_)) => {
                self.touches += 1;
                Ok(())
            }
            (Status::Miss, Outcome::Undecided(_)) => {
                self.undecided += 1;
                Ok(())
            }
            // Where the oracle stopped, nothing before is a root.
            (Status::Undecided, Outcome::Hit(Hit { bracket, .. }) | Outcome::Touch(Hit { bracket, .. })) => {
                unless(bracket.end >= verdict.place.start)
            }
            (Status::Undecided, Outcome::Miss) => Ok(()),
            (Status::Hit | Status::Touch, _) | (Status::Miss, Outcome::Hit(_)) => Err(said),
        }
    }

    fn check_hit(
        &mut self,
        verdict: &Verdict,
        hit: Hit,
        normal: DVec3,
        rounding: &Rounding,
    ) -> Result<(), String> {
        let unit = verdict.t.abs().max(1.0);
        let (error, width) = ((hit.t - verdict.t).abs(), hit.bracket.end - hit.bracket.start);
        (self.error, self.width) = (self.error.max(error / unit), self.width.max(width / unit));
        if !(hit.bracket.start <= verdict.t && verdict.t <= hit.bracket.end) {
            return Err(format!("the enclosure {:?} does not hold t = {}", hit.bracket, verdict.t));
        }
        if error > (1e-11 * unit).max(rounding.of_t) {
            return Err(format!("t = {} is {error:e} off, rounding explains {:e}", hit.t, rounding.of_t));
        }
        if width > (1e-12 * unit).max(2.0 * rounding.of_t) {
            return Err(format!(
                "{:?} is {width:e} wide, rounding explains {:e}",
                hit.bracket, rounding.of_t
            ));
        }
        if !verdict.normal.is_nan() {
            let angle = normal.cross(verdict.normal).length().atan2(normal.dot(verdict.normal));
            let angle = if angle.is_nan() { f64::INFINITY } else { angle };
            if angle > f64::max(1e-6, rounding.of_normal) {
                return Err(format!(
                    "the normal {normal} is {angle:e} off, rounding explains {:e}",
                    rounding.of_normal
                ));
            }
        }
        Ok(())
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, rays, touches, undecided, error, width, boxes, contradictions } = self;
        write!(
            f,
            "{name:20} {rays} rays, {touches} touches, {undecided} undecided, {} contradictions, ",
            contradictions.len()
        )?;
        write!(f, "error {error:.1e}, width {width:.1e}, {:.0} boxes a ray", *boxes as f64 / *rays as f64)
    }
}
