//! Holds the methods of intersection against rays that an independent program decided, and prints `docs/methods.md`:
//!
//! ```text
//! cargo run --release --example methods > docs/methods.md
//! ```

#[path = "../tests/scenes/mod.rs"]
#[allow(dead_code, reason = "tests use other parts of it")]
mod scenes;

use std::sync::Arc;
use std::time::Duration;

use iso_expr::Engine;
use iso_grid::{
    Certified, Direct, Grid, GridSettings, Hit, Kernel, Octree, Outcome, Outcomes, Ray, RootFinding, Surface,
    Tracer, Workspace,
};
use iso_jit::Jit;
use iso_render::Stopwatch;
use scenes::{Scene, Status, Verdict};

/// Cells along each axis: the finest of the paper's grids.
const CELLS: u32 = 60;

/// A method of intersection.
struct Method {
    name: &'static str,
    prepare: fn(&Scene, &Surface) -> Box<dyn Tracer>,
}

/// The methods, in the order of the columns.
const METHODS: [Method; 4] = [
    Method {
        name: "direct",
        prepare: |scene, surface| {
            let step = GridSettings::STEP * f64::from(Direct::CELLS) / f64::from(CELLS);
            Box::new(
                Direct::new(surface, scene.region(), step, RootFinding::PAPER)
                    .expect("the settings are in range"),
            )
        },
    },
    Method {
        name: "grid",
        prepare: |scene, surface| {
            let settings = GridSettings::new([CELLS; 3]);
            Box::new(Grid::new(surface, scene.region(), &settings).expect("the settings are in range"))
        },
    },
    Method {
        name: "octree",
        prepare: |scene, surface| {
            let settings = GridSettings::new([CELLS; 3]);
            Box::new(Octree::new(surface, scene.region(), &settings).expect("the settings are in range"))
        },
    },
    Method {
        name: "certified",
        prepare: |scene, surface| {
            Box::new(Certified::new(surface, scene.region()).expect("the scenes compile"))
        },
    },
];

/// A root further from the oracle's than this, relative to max(1, |t|), is another root, unless its bracket holds both.
const SAME_ROOT: f64 = 1e-6;

fn main() {
    let engine: Arc<dyn Engine> = Arc::new(Jit::new().expect("this machine is one that code is made for"));
    let mut totals = [Tally::default(); METHODS.len()];
    let mut rows = Vec::new();
    for scene in scenes::all() {
        let surface = scene.surface(Arc::clone(&engine));
        let verdicts = scene.verdicts();
        let tallies = METHODS.map(|method| Tally::of(&scene, &surface, &verdicts, &method));
        for (total, tally) in totals.iter_mut().zip(&tallies) {
            total.add(tally);
        }
        rows.push((scene.name, tallies));
    }
    print!("{INTRODUCTION}");
    println!("\n## All scenes together, {} engine\n", engine.name());
    let [Tally { rays, decided, rooted, .. }, ..] = totals;
    println!("The oracle decides {decided} of {rays} rays, and finds a root on {rooted} of them.\n");
    print_summary(&totals);
    print_table(&rows, "Wrong hits, missed hits, touches and undecided rays", |tally| {
        let Tally { wrong, missed, touches, undecided, .. } = tally;
        format!("{wrong} · {missed} · {touches} · {undecided}")
    });
    print_table(&rows, "Worst error in t", |tally| format!("{:.1e}", tally.error));
    print_table(&rows, "Evaluations a ray, of points or boxes", |tally| {
        format!("{:.0}", tally.evaluations as f64 / tally.rays as f64)
    });
    print_table(&rows, "Time in milliseconds", |tally| format!("{:.1}", 1e3 * tally.time.as_secs_f64()));
}

const INTRODUCTION: &str = "\
# The methods of intersection, side by side

Printed by `cargo run --release --example methods`. The rays are those of `testdata/oracle`, decided by an independent
program in ball arithmetic (`tools/oracle`); rays that it leaves undecided are left out. `direct` samples as closely as
`grid` does; `grid` and `octree` have 60 cells along each axis, the finest of the paper's grids. One thread traces; `grid`
and `octree` prepare their cells on all.

- A *right* hit is the root that the oracle found: within 10⁻⁶ of it, relative to t, or in a bracket that holds both.
- A *wrong* hit is one where there is no root.
- A hit is *missed* when the method says that there is none, or finds a later one.
- *Touches* are roots found but not proven simple, whether the oracle calls them hits or touches. They are right, wrong or missed like hits.
- *Undecided* rays are those that the method leaves open.
- The *error* is the largest |t − t*| / max(1, |t*|) over the hits and touches found, t* being the oracle's hit. `certified` encloses roots to 10⁻¹² where
  rounding lets it: not where an exponential overflows in front of the root (`overflow_diff`), nor far from the origin (`far_sphere_expanded`).
- *Evaluations* are of F at points, and for `certified` of F or of F and its gradient over boxes as well,
  preprocessing included. Time includes it too, but not the compilation of kernels.
";

/// What became of the rays.
#[derive(Clone, Copy, Default)]
struct Tally {
    rays: usize,
    /// Those that the oracle decides.
    decided: usize,
    /// Those on which it finds a root.
    rooted: usize,
    right: usize,
    wrong: usize,
    missed: usize,
    touches: usize,
    undecided: usize,
    error: f64,
    evaluations: u64,
    time: Duration,
}

impl Tally {
    fn of(scene: &Scene, surface: &Surface, verdicts: &[Verdict], method: &Method) -> Self {
        let rays: Vec<Ray> = verdicts.iter().map(|verdict| verdict.ray).collect();
        let mut outcomes = Outcomes::default();
        let mut workspace = Workspace::default();
        compile(surface);
        let watch = Stopwatch::start();
        let tracer = (method.prepare)(scene, surface);
        tracer.trace(&mut workspace, &rays, &mut outcomes);
        let time = watch.elapsed();
        let mut counters = workspace.counters;
        counters += tracer.preprocessing();
        let evaluations =
            counters.preprocess_evaluations + counters.trace_evaluations + counters.box_evaluations;
        let mut tally = Self { rays: rays.len(), evaluations, time, ..Self::default() };
        for (verdict, outcome) in verdicts.iter().zip(outcomes.iter()) {
            tally.count(verdict, outcome);
        }
        tally
    }

    fn count(&mut self, verdict: &Verdict, outcome: Outcome) {
        if verdict.status == Status::Undecided {
            return;
        }
        let exists = verdict.status != Status::Miss;
        self.decided += 1;
        self.rooted += usize::from(exists);
        let found = match outcome {
            Outcome::Undecided(_) => {
                self.undecided += 1;
                return;
            }
            Outcome::Miss => None,
            Outcome::Hit(hit) => Some(hit),
            Outcome::Touch(hit) => {
                self.touches += 1;
                Some(hit)
            }
        };
        let Some(Hit { t, bracket }) = found else {
            self.missed += usize::from(exists);
            return;
        };
        let error = (t - verdict.t).abs() / verdict.t.abs().max(1.0);
        if exists && (error <= SAME_ROOT || verdict.overlaps(bracket)) {
            self.right += 1;
            self.error = self.error.max(error);
        } else if exists && t > verdict.t {
            self.missed += 1;
        } else {
            self.wrong += 1;
        }
    }

    fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.decided += other.decided;
        self.rooted += other.rooted;
        self.right += other.right;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.touches += other.touches;
        self.undecided += other.undecided;
        self.error = self.error.max(other.error);
        self.evaluations += other.evaluations;
        self.time += other.time;
    }
}

/// Compiles the kernels that methods ask for, so that no method is charged for it.
fn compile(surface: &Surface) {
    surface.over_points(Kernel::Values).expect("the scenes compile");
    surface.over_boxes(Kernel::ValueEnclosures).expect("the scenes compile");
    surface.over_boxes(Kernel::GradientEnclosures).expect("the scenes compile");
}

fn print_summary(totals: &[Tally; METHODS.len()]) {
    println!(
        "| method | right | wrong | missed | touches | undecided | worst error | evaluations a ray | seconds |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (Method { name, .. }, total) in METHODS.iter().zip(totals) {
        let Tally { right, wrong, missed, touches, undecided, error, .. } = total;
        let evaluations = total.evaluations as f64 / total.rays as f64;
        let seconds = total.time.as_secs_f64();
        println!(
            "| `{name}` | {right} | {wrong} | {missed} | {touches} | {undecided} | {error:.1e} | {evaluations:.0} | {seconds:.2} |"
        );
    }
}

fn print_table(rows: &[(String, [Tally; METHODS.len()])], title: &str, cell: fn(&Tally) -> String) {
    println!("\n## {title}\n");
    println!("| scene |{}", METHODS.map(|Method { name, .. }| format!(" `{name}` |")).concat());
    println!("|---|{}", "---:|".repeat(METHODS.len()));
    for (scene, tallies) in rows {
        println!("| {scene} |{}", tallies.each_ref().map(|tally| format!(" {} |", cell(tally))).concat());
    }
}
