//! The paper's methods on the classic scenes of `testdata/oracle`.
//!
//! They promise less than a proof: a piece of the surface that no grid point and no sample tells of is missed. What they
//! do report must be a root, and what they miss is recorded here, ray by ray counted.

#[allow(dead_code, reason = "other tests use the rest of it")]
mod scenes;

use std::fmt;
use std::sync::Arc;

use iso_expr::{Engine, Interpreter};
use iso_grid::{
    Counters, Direct, Grid, GridSettings, Octree, Outcome, Outcomes, Ray, Region, RootFinding, Surface,
    Tracer, Workspace,
};
use iso_jit::Jit;
use iso_render::Stopwatch;
use scenes::rounding::Rounding;
use scenes::{Scene, Status, Verdict};

/// The cells along each axis of the grids that are compared.
const SIZES: [u32; 4] = [8, 15, 30, 60];

/// How many rays miss the oracle's root, ending behind it or nowhere, for each size of the grid.
struct Recorded {
    scene: &'static str,
    missed: [usize; 4],
    reason: &'static str,
}

const RECORDED: &[Recorded] = &[
    Recorded {
        scene: "barth_sextic",
        missed: [0, 1, 0, 0],
        reason: "the body tapers towards a node, thinner than a cell and without a grid point in it",
    },
    Recorded {
        scene: "barth_decic",
        missed: [2, 0, 2, 0],
        reason: "the body tapers towards nodes, thinner than a cell and without a grid point in it",
    },
    Recorded {
        scene: "chmutov14",
        missed: [1, 1, 0, 0],
        reason: "two roots 0.002 apart, nearer to each other than samples are",
    },
    Recorded { scene: "decocube", missed: [129, 0, 0, 0], reason: "no grid point lies in any ring" },
];

#[test]
fn the_grid_finds_what_it_should_and_nothing_else() {
    let mut wrong = Vec::new();
    for scene in classic_scenes() {
        let comparisons = SIZES.map(|cells| {
            let comparison = Comparison::of(&scene, Arc::new(Interpreter), &grid(cells));
            println!("grid of {cells:2}: {comparison}");
            comparison
        });
        let (expected, reason) = RECORDED
            .iter()
            .find(|recorded| recorded.scene == scene.name)
            .map_or(([0; 4], "all can be found"), |recorded| (recorded.missed, recorded.reason));
        let missed = comparisons.each_ref().map(Comparison::missed);
        if missed != expected {
            wrong.push(format!(
                "{}: {missed:?} rays miss the root, expected {expected:?} ({reason})",
                scene.name
            ));
        }
        wrong.extend(comparisons.into_iter().flat_map(|comparison| comparison.contradictions));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_grid_is_the_same_on_both_engines() {
    for scene in classic_scenes() {
        let interpreted = Comparison::of(&scene, Arc::new(Interpreter), &grid(60));
        let jit = Jit::new().expect("this machine has native code");
        let compiled = Comparison::of(&scene, Arc::new(jit), &grid(60));
        println!("{:15} {compiled}", "compiled");
        assert_eq!(interpreted.outcomes, compiled.outcomes, "{}", scene.name);
        assert_eq!(interpreted.counters, compiled.counters, "{}", scene.name);
    }
}

#[test]
fn the_other_methods_find_no_more_than_there_is() {
    let mut wrong = Vec::new();
    for scene in classic_scenes() {
        for (name, method) in
            [("direct", direct as fn(&Surface, Region) -> Box<dyn Tracer>), ("octree", octree)]
        {
            let comparison = Comparison::of(&scene, Arc::new(Interpreter), &method);
            println!("{name:10}: {comparison}");
            if comparison.missed() > 1 {
                wrong.push(format!("{name} misses {} roots of {}", comparison.missed(), scene.name));
            }
            wrong.extend(comparison.contradictions);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn classic_scenes() -> impl Iterator<Item = Scene> {
    scenes::all().into_iter().filter(|scene| scene.tags.iter().any(|tag| tag == "classic"))
}

fn grid(cells: u32) -> impl Fn(&Surface, Region) -> Box<dyn Tracer> {
    move |surface, region| {
        Box::new(Grid::new(surface, region, &GridSettings::new([cells; 3])).expect("the grid is small"))
    }
}

fn octree(surface: &Surface, region: Region) -> Box<dyn Tracer> {
    Box::new(Octree::new(surface, region, &GridSettings::new([60; 3])).expect("the octree is small"))
}

fn direct(surface: &Surface, region: Region) -> Box<dyn Tracer> {
    Box::new(
        Direct::new(surface, region, GridSettings::STEP, RootFinding::PAPER)
            .expect("the step is the paper's"),
    )
}

/// One scene's rays, compared.
struct Comparison {
    name: String,
    outcomes: Outcomes,
    /// Hits that are the oracle's.
    met: usize,
    /// Rays that end at a root behind the oracle's.
    passed: usize,
    /// Rays that end nowhere though the oracle has a root.
    lost: usize,
    /// The largest |t − t*| / max(1, |t*|) of hits that are the oracle's.
    error: f64,
    /// The time of preprocessing, then of tracing.
    milliseconds: [f64; 2],
    /// What preprocessing took, then what tracing took.
    counters: [Counters; 2],
    contradictions: Vec<String>,
}

/// Prepares a method for a surface and a region.
type Method<'a> = dyn Fn(&Surface, Region) -> Box<dyn Tracer> + 'a;

impl Comparison {
    fn of(scene: &Scene, engine: Arc<dyn Engine>, method: &Method<'_>) -> Self {
        let surface = scene.surface(engine);
        let verdicts = scene.verdicts();
        let rays: Vec<Ray> = verdicts.iter().map(|verdict| verdict.ray).collect();
        let mut workspace = Workspace::default();
        let mut outcomes = Outcomes::default();
        let mut watch = Stopwatch::start();
        let tracer = method(&surface, scene.region());
        let prepared = watch.lap();
        tracer.trace(&mut workspace, &rays, &mut outcomes);
        let milliseconds = [prepared, watch.lap()].map(|time| time.as_secs_f64() * 1e3);

        let mut comparison = Self {
            name: scene.name.clone(),
            outcomes: outcomes.clone(),
            met: 0,
            passed: 0,
            lost: 0,
            error: 0.0,
            milliseconds,
            counters: [tracer.preprocessing(), workspace.counters],
            contradictions: Vec::new(),
        };
        let interpreted = scene.surface(Arc::new(Interpreter));
        for (row, (verdict, outcome)) in verdicts.iter().zip(outcomes.iter()).enumerate() {
            if let Err(contradiction) = comparison.check(&interpreted, verdict, outcome) {
                comparison.contradictions.push(format!("{}, row {row}: {contradiction}", scene.name));
            }
        }
        comparison
    }

    fn missed(&self) -> usize {
        self.passed + self.lost
    }

    /// A hit must be the oracle's or lie behind it. Bisection ends between neighbouring doubles, so that all that moves a
    /// hit is the rounding of F.
    fn check(&mut self, surface: &Surface, verdict: &Verdict, outcome: Outcome) -> Result<(), String> {
        match (verdict.status, outcome) {
            (Status::Hit, Outcome::Hit(hit)) => {
                let error = hit.t - verdict.t;
                let unit = verdict.t.abs().max(1.0);
                let allowed = 4.0 * f64::EPSILON * unit + Rounding::at(surface, verdict).of_t;
                if error.abs() <= allowed {
                    self.met += 1;
                    self.error = self.error.max(error.abs() / unit);
                } else if error > 0.0 {
                    self.passed += 1;
                } else {
                    return Err(format!(
                        "t = {}, {error:e} before the root, rounding explains {allowed:e}",
                        hit.t
                    ));
                }
            }
            (Status::Hit | Status::Touch, Outcome::Miss) => self.lost += 1,
            (Status::Miss, Outcome::Miss) | (Status::Undecided, _) => {}
            (Status::Touch, Outcome::Hit(hit) | Outcome::Touch(hit)) if hit.t >= verdict.place.start => {}
            (status, outcome) => {
                return Err(format!("the oracle says {status:?} at {}, but {outcome:?}", verdict.t));
            }
        }
        Ok(())
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, met, passed, lost, error, milliseconds: [preparing, tracing], .. } = self;
        let [Counters { preprocess_evaluations, existence_cells, rescued_cells, .. }, traced] = self.counters;
        let evaluations = traced.trace_evaluations as f64 / traced.rays_in_region as f64;
        write!(f, "{name:15} {met} met, {passed} passed, {lost} lost, error {error:.1e}, ")?;
        write!(
            f,
            "{preprocess_evaluations} evaluations and {preparing:.0} ms to find {existence_cells} cells "
        )?;
        write!(f, "({rescued_cells} rescued), {evaluations:.0} a ray and {tracing:.0} ms to trace")
    }
}
