//! One case, traced by every method on every engine.

use std::sync::Arc;

use iso_expr::{Engine, Interpreter};
use iso_grid::{
    Certified, GridSettings, Method, Outcomes, Ray, RootFinding, Surface, Tile, Tracer, Workspace,
};
use iso_render::{Camera, Projection, Size, StatusCounts, View};
use serde::Serialize;

use super::engines::{EngineCheck, check_engines};
use super::suite::{Case, Stated, program};
use super::truth::{Judgement, Truth};
use crate::clock::{milliseconds, timed};
use crate::comparison::{Answers, Verdict, compare};
use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::plan::plan_of_rays;

/// The methods as they are without flags, the certified one first: the others are held against it.
const METHODS: [fn() -> Method; 4] = [
    || Method::CERTIFIED,
    || Method::Grid(GridSettings::default()),
    || Method::Octree(GridSettings::default()),
    || Method::Direct { step: GridSettings::STEP, roots: RootFinding::PAPER },
];

/// What became of a case.
#[derive(Debug, Serialize)]
pub(crate) struct Measured {
    /// Its family.
    pub(crate) family: &'static str,
    /// What the cases of the family have in common.
    pub(crate) about: String,
    /// Its name.
    pub(crate) name: String,
    /// Its formula.
    pub(crate) formula: String,
    /// What makes it hard.
    pub(crate) hard: String,
    /// Why its rays may be left open.
    pub(crate) open: Option<String>,
    /// The engines and the enclosures.
    pub(crate) engines: EngineCheck,
    /// The stated truth and the certified method.
    pub(crate) truth: TruthCounts,
    /// Every engine with every method, the interpreter first.
    pub(crate) runs: Vec<Run>,
    /// The promises of the engines and of the certified method that did not hold, in words.
    pub(crate) broken: Vec<String>,
    /// What the page shows.
    #[serde(skip)]
    pub(crate) view: Seen,
}

/// A picture's rays and what the methods made of them, on one engine.
#[derive(Debug)]
pub(crate) struct Seen {
    pub(crate) camera: Camera,
    pub(crate) size: Size,
    pub(crate) rays: Vec<Ray>,
    /// The methods' names, answers and what they are worth.
    pub(crate) methods: Vec<(&'static str, Answers, Vec<Verdict>)>,
}

/// Certified rays by how they agree with what is stated: of the picture as a tile on each engine, ray by ray, and the
/// stated rays.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct TruthCounts {
    /// They agree.
    pub(crate) right: u64,
    /// They contradict it.
    pub(crate) wrong: u64,
    /// They are left open without a reason.
    pub(crate) left_open: u64,
    /// Nothing is stated of them.
    pub(crate) unknown: u64,
}

/// A method on an engine, held against the certified method on the interpreter.
#[derive(Debug, Serialize)]
pub(crate) struct Run {
    /// The engine's name.
    pub(crate) engine: &'static str,
    /// The method's name.
    pub(crate) method: &'static str,
    /// How the rays ended.
    pub(crate) ends: StatusCounts,
    /// Hits where there is no root.
    pub(crate) wrong: u64,
    /// Roots that were not found.
    pub(crate) missed: u64,
    /// The largest |t − t*|, in units of x, y and z.
    pub(crate) distance: f64,
    /// The largest |t − t*|, in units in the last place of t*.
    pub(crate) distance_ulps: f64,
    /// The largest |F − C| at a point found, in units of its own rounding error; 0 where it has no bound.
    pub(crate) residual: f64,
    /// The largest angle between normals, in radians.
    pub(crate) angle: f64,
    /// Milliseconds of preprocessing and tracing on one thread.
    pub(crate) milliseconds: f64,
}

/// Traces a case at `size`.
pub(crate) fn measure(case: &Case, size: Size) -> Result<Measured, Failure> {
    let value = program(&case.formula).expect("the formulas of the suite are in the language").simplified();
    let engines: [Arc<dyn Engine>; 2] = [Arc::new(Interpreter), engine(EngineName::Jit)?];
    let camera = Camera::new(View::DEFAULT, Projection::DEFAULT, &case.region, size)?;
    let pixels = (0..size.height()).flat_map(|row| (0..size.width()).map(move |column| (column, row)));
    let rays: Vec<Ray> = pixels.map(|(column, row)| camera.ray(column, row)).collect();
    let mut measured = Measured {
        family: case.family,
        about: case.about.clone(),
        name: case.name.clone(),
        formula: case.formula.clone(),
        hard: case.hard.clone(),
        open: case.open.clone(),
        engines: check_engines(&engines, &value.with_gradient().simplified(), &case.region)?,
        truth: TruthCounts::default(),
        runs: Vec::new(),
        broken: Vec::new(),
        view: Seen { camera, size, rays, methods: Vec::new() },
    };
    let truths = truths(case, &measured.view.rays, size)?;
    for engine in engines {
        measured.trace(case, &Surface::new(engine.clone(), value.clone()), engine.name(), &truths)?;
    }
    measured.engines_are_right();
    Ok(measured)
}

/// What is true of the rays of the picture.
fn truths(case: &Case, rays: &[Ray], size: Size) -> Result<Vec<Truth>, Failure> {
    let region = &case.region;
    Ok(match &case.surface {
        Stated::Shapes(shapes, within) => {
            rays.iter().map(|ray| Truth::of_shapes(region, shapes, within, ray)).collect()
        }
        Stated::SameAs(formula) => {
            let value = program(formula).expect("the formulas of the suite are in the language");
            let surface = Surface::new(Arc::new(Interpreter), value.simplified());
            let tracer = Certified::new(&surface, *region)?;
            trace(&tracer, rays, size).iter().map(|outcome| Truth::of_proven(&outcome)).collect()
        }
        Stated::Filled => rays.iter().map(|ray| Truth::of_filled(region, ray)).collect(),
        Stated::AlongRays => vec![Truth::Unknown; rays.len()],
    })
}

/// Traces a picture as one tile.
fn trace(tracer: &dyn Tracer, rays: &[Ray], size: Size) -> Outcomes {
    let mut outcomes = Outcomes::default();
    tracer.trace_tile(
        &mut Workspace::default(),
        Tile::listed(rays, size.width() as usize),
        &mut outcomes,
        None,
    );
    outcomes
}

impl Measured {
    /// The runs on native code, the certified method first.
    pub(crate) fn native(&self) -> &[Run] {
        &self.runs[self.runs.len() / 2..]
    }

    /// The certified method on native code.
    pub(crate) fn certified(&self) -> &Run {
        &self.native()[0]
    }

    /// The methods that sample, on native code: `grid`, `octree`, `direct`.
    pub(crate) fn sampled(&self) -> &[Run] {
        &self.native()[1..]
    }

    /// The largest of an error of the methods that sample.
    pub(crate) fn worst_sampled(&self, error: fn(&Run) -> f64) -> f64 {
        self.sampled().iter().map(error).fold(0.0, f64::max)
    }

    /// Traces the case with every method on one engine.
    fn trace(
        &mut self,
        case: &Case,
        surface: &Surface,
        engine: &'static str,
        truths: &[Truth],
    ) -> Result<(), Failure> {
        let may_be_open = case.open.is_some();
        for (number, method) in METHODS.iter().map(|method| method()).enumerate() {
            let plan = plan_of_rays(method, surface.program(), true);
            plan.compile(surface)?;
            let (traced, time) = timed(|| {
                let tracer = plan.tracer(surface, case.region)?;
                let outcomes = trace(tracer.as_ref(), &self.view.rays, self.view.size);
                Ok::<_, Failure>((tracer, outcomes))
            });
            let (tracer, outcomes) = traced?;
            if number == 0 {
                self.judge(truths, &outcomes, may_be_open, engine);
                self.judge_alone(case, tracer.as_ref(), truths);
            }
            let rays = &self.view.rays;
            let answers = Answers::new(surface, &mut Workspace::default(), rays, outcomes)?;
            let proven = self.view.methods.first().map_or(&answers, |(_, proven, _)| proven);
            let verdicts = compare(surface, rays, proven, &answers)?;
            self.runs.push(Run::of(engine, method.name(), &answers, &verdicts, milliseconds(time)));
            match self.view.methods.get(number) {
                None => self.view.methods.push((method.name(), answers, verdicts)),
                Some((name, interpreted, _)) if interpreted.outcomes != answers.outcomes => {
                    self.broken.push(format!("the engines give different answers with the method {name}"));
                }
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// Holds the picture's certified outcomes against the truth.
    fn judge(&mut self, truths: &[Truth], outcomes: &Outcomes, may_be_open: bool, way: &str) {
        for (pixel, (truth, outcome)) in truths.iter().zip(outcomes.iter()).enumerate() {
            let judgement = truth.judge(&outcome, may_be_open);
            self.count(judgement, || format!("{way}, pixel {pixel}: {truth:?} ends as {outcome:?}"));
        }
    }

    /// The same for each ray by itself, and for the stated ones.
    fn judge_alone(&mut self, case: &Case, tracer: &dyn Tracer, truths: &[Truth]) {
        let may_be_open = case.open.is_some();
        let mut outcomes = Outcomes::default();
        tracer.trace(&mut Workspace::default(), &self.view.rays, &mut outcomes);
        self.judge(truths, &outcomes, may_be_open, "each ray alone");
        for stated in &case.rays {
            tracer.trace(&mut Workspace::default(), &[stated.ray()], &mut outcomes);
            let outcome = outcomes.get(0);
            let judgement = Truth::of_stated(stated).judge(&outcome, may_be_open);
            self.count(judgement, || format!("{stated:?} ends as {outcome:?}"));
        }
    }

    fn count(&mut self, judgement: Judgement, story: impl Fn() -> String) {
        /// More than these would say the same again.
        const TOLD: u64 = 3;
        let (count, word) = match judgement {
            Judgement::Right => return self.truth.right += 1,
            Judgement::Unknown => return self.truth.unknown += 1,
            Judgement::Wrong => (&mut self.truth.wrong, "contradicts the stated truth"),
            Judgement::LeftOpen => (&mut self.truth.left_open, "is left open"),
        };
        *count += 1;
        if *count <= TOLD {
            self.broken.push(format!("{word}: {}", story()));
        }
    }

    /// Notes what the check of the engines found.
    fn engines_are_right(&mut self) {
        let EngineCheck { differing, outside, unexplained, .. } = self.engines;
        let problems = [
            (differing, "doubles or decorations differ between the engines"),
            (outside, "values lie outside their enclosures"),
            (unexplained, "differences of F are not explained by the enclosure of its derivative"),
        ];
        let found = problems.into_iter().filter(|(count, _)| *count > 0);
        self.broken.extend(found.map(|(count, problem)| format!("{count} {problem}")));
    }
}

impl Run {
    /// Rays that end without a proof of a crossing or of none.
    pub(crate) fn open(&self) -> u64 {
        self.ends.touch + self.ends.undecided
    }

    fn of(
        engine: &'static str,
        method: &'static str,
        answers: &Answers,
        verdicts: &[Verdict],
        milliseconds: f64,
    ) -> Self {
        let ends = StatusCounts::of(answers.outcomes.kinds());
        let mut run = Self {
            engine,
            method,
            ends,
            wrong: 0,
            missed: 0,
            distance: 0.0,
            distance_ulps: 0.0,
            residual: 0.0,
            angle: 0.0,
            milliseconds,
        };
        verdicts.iter().for_each(|verdict| run.count(verdict));
        run
    }

    fn count(&mut self, verdict: &Verdict) {
        match verdict {
            Verdict::Found(distance) => {
                self.distance = self.distance.max(distance.length);
                self.distance_ulps = self.distance_ulps.max(distance.ulps);
                self.residual = self.residual.max(distance.residual_in_roundings());
                self.angle = self.angle.max(distance.angle);
            }
            Verdict::Missed => self.missed += 1,
            Verdict::False => self.wrong += 1,
            Verdict::Empty | Verdict::Undecided | Verdict::Open => {}
        }
    }
}
