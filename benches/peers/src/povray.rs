//! POV-Ray's `isosurface` as a renderer, when the program is installed.
//!
//! Depth is drawn as a shade that grows into the picture, and read back from a file of 16 bits a channel. The time is the
//! one that POV-Ray states for tracing, without starting and reading the scene.

use std::error::Error;
use std::path::PathBuf;
use std::process::Command;

use glam::DVec3;
use iso_expr::{Engine, Interpreter, Node, NodeId, Operation, Program, Scratch};
use tempfile::TempDir;

use crate::depths::Depths;
use crate::iso::Answer;
use crate::renderer::Renderer;
use crate::view::SquareView;

/// The accuracy asked for, along the ray.
const ACCURACY: f64 = 1e-4;
/// The width of the pictures by which `max_gradient` is found.
const TRIAL_SIZE: u32 = 128;
/// The most such pictures.
const TRIALS: usize = 16;
/// One pixel in so many of the surface may differ from what is expected: silhouettes are drawn differently.
const TOLERATED: u64 = 200;
/// Pictures that would take longer are left out.
const LONGEST_SECONDS: f64 = 120.0;
/// Points along each axis at which the steepness near the surface is looked for.
const SAMPLES: usize = 64;
/// The longest formula that is handed over: POV-Ray's have no names for parts, so what is used twice is written twice.
const LONGEST: usize = 100_000;

/// One surface as a scene of POV-Ray.
pub struct PovRay {
    folder: TempDir,
    view: SquareView,
    threads: usize,
    rendered: bool,
}

impl PovRay {
    /// The program's name in tables.
    pub const NAME: &'static str = "POV-Ray";

    /// Whether `povray` can be run.
    pub fn is_installed() -> bool {
        Command::new("povray").arg("--version").output().is_ok()
    }

    /// Finds the least `max_gradient` that leaves no holes, as users do by trial, and writes the scene.
    ///
    /// Trials begin with the steepness near the surface and double it until a small picture shows all that `expected` has.
    ///
    /// # Errors
    /// When POV-Ray lacks an operation of the formula, the formula is too long, no trial succeeds or would take too
    /// long, or files cannot be written.
    pub fn tuned(
        program: &Program,
        view: SquareView,
        threads: usize,
        expected: impl Fn(SquareView) -> Result<Answer, Box<dyn Error>>,
    ) -> Result<Self, Box<dyn Error>> {
        let formula = expression(program)?;
        let trial_view = SquareView { size: TRIAL_SIZE, ..view };
        let Answer { depths, decided, counts } = expected(trial_view)?;
        let mut max_gradient = steepness(program, &view)?;
        for _ in 0..TRIALS {
            let mut trial = Self::new(&formula, max_gradient, trial_view, threads)?;
            let seconds = trial.render()? * (f64::from(view.size) / f64::from(TRIAL_SIZE)).powi(2);
            if seconds > LONGEST_SECONDS {
                return Err(format!("POV-Ray would take about {seconds:.0} seconds and is left out").into());
            }
            let holes = trial.depths()?.error_against(&depths, &decided).mismatches as u64;
            if holes * TOLERATED <= counts.hit + counts.touch {
                return Self::new(&formula, max_gradient, view, threads);
            }
            max_gradient *= 2.0;
        }
        Err("POV-Ray leaves holes whatever its max_gradient".into())
    }

    fn new(
        formula: &str,
        max_gradient: f64,
        view: SquareView,
        threads: usize,
    ) -> Result<Self, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        std::fs::write(folder.path().join("scene.pov"), scene(formula, max_gradient, &view))?;
        Ok(Self { folder, view, threads, rendered: false })
    }

    fn picture(&self) -> PathBuf {
        self.folder.path().join("picture.png")
    }
}

impl Renderer for PovRay {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn render(&mut self) -> Result<f64, Box<dyn Error>> {
        let size = self.view.size;
        let output = Command::new("povray")
            .current_dir(self.folder.path())
            .args(["+Iscene.pov", "+Opicture.png", "+FN16", "-D", "-A", "File_Gamma=1.0"])
            .args([format!("+W{size}"), format!("+H{size}"), format!("+WT{}", self.threads)])
            .output()?;
        let messages = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            return Err(format!("povray failed:\n{messages}").into());
        }
        self.rendered = true;
        trace_seconds(&messages).ok_or_else(|| format!("povray states no trace time:\n{messages}").into())
    }

    fn depths(&self) -> Result<Depths, Box<dyn Error>> {
        if !self.rendered {
            return Err("nothing was rendered yet".into());
        }
        let picture = image::open(self.picture())?.into_rgb16();
        let depth = |[red, _, blue]: [u16; 3]| match blue {
            0 => f64::NAN,
            _ => self.view.radius * (2.0 * f64::from(red) / f64::from(u16::MAX) - 1.0),
        };
        Ok(Depths(picture.pixels().map(|pixel| depth(pixel.0)).collect()))
    }
}

/// The seconds in a line such as `Trace Time:  0 hours  0 minutes  5 seconds (5.371 seconds)`.
fn trace_seconds(messages: &str) -> Option<f64> {
    let line = messages.lines().find(|line| line.contains("Trace Time:"))?;
    line.rsplit_once('(')?.1.split_whitespace().next()?.parse().ok()
}

/// The scene file. The background has no blue, the surface has all of it; its red grows with the depth.
fn scene(formula: &str, max_gradient: f64, view: &SquareView) -> String {
    let SquareView { radius, .. } = *view;
    let width = 2.0 * radius;
    let [eye, forward, right, up] =
        [view.eye(), SquareView::forward(), width * SquareView::right(), width * SquareView::up()]
            .map(vector);
    // The pattern repeats with period 1 along the line of sight, and is 0 in the plane that touches the ball in front.
    let start = vector(-radius * SquareView::forward());
    format!(
        "#version 3.7;\n\
         global_settings {{ assumed_gamma 1.0 }}\n\
         camera {{ orthographic location {eye} direction {forward} right {right} up {up} }}\n\
         isosurface {{\n  \
           function {{ {formula} }}\n  \
           contained_by {{ sphere {{ 0, {radius} }} }}\n  \
           accuracy {ACCURACY} max_gradient {max_gradient}\n  \
           pigment {{ gradient {forward} color_map {{ [0 rgb <0, 0, 1>] [1 rgb <1, 0, 1>] }} scale {width} translate {start} }}\n  \
           finish {{ ambient 0 diffuse 0 emission 1 }}\n\
         }}\n"
    )
}

fn vector(vector: DVec3) -> String {
    format!("<{}, {}, {}>", vector.x, vector.y, vector.z)
}

/// The largest gradient near the surface: over points of a lattice next to which the surface may pass.
fn steepness(program: &Program, view: &SquareView) -> Result<f64, Box<dyn Error>> {
    let kernel = Interpreter.batch(&program.with_gradient().simplified())?;
    let spacing = 2.0 * view.radius / SAMPLES as f64;
    let coordinate = |place: usize| (place as f64 + 0.5) * spacing - view.radius;
    let line: Vec<f64> = (0..SAMPLES).map(coordinate).collect();
    let (mut values, mut scratch) = (vec![0.0; 4 * SAMPLES], Scratch::default());
    let mut steepest = 0.0_f64;
    for column in 0..SAMPLES * SAMPLES {
        let (x, y) = (coordinate(column % SAMPLES), coordinate(column / SAMPLES));
        kernel.evaluate(&mut scratch, &[&[x; SAMPLES], &[y; SAMPLES], &line], &mut values);
        for place in 0..SAMPLES {
            let [value, dx, dy, dz] = [0, 1, 2, 3].map(|output| values[output * SAMPLES + place]);
            let slope = DVec3::new(dx, dy, dz).length();
            if value.abs() <= slope * spacing {
                steepest = steepest.max(slope);
            }
        }
    }
    Ok(steepest)
}

/// The formula as POV-Ray's functions are written, all parts written out where they are used.
fn expression(program: &Program) -> Result<String, Box<dyn Error>> {
    let mut texts: Vec<String> = Vec::with_capacity(program.nodes().len());
    for node in program.nodes() {
        let text = match node {
            Node::Variable(argument) => argument.to_string(),
            Node::Constant(constant) => format!("({})", constant.value()),
            Node::Apply(operation, _) => {
                let operands: Vec<&str> = operands(&texts, node.operands());
                application(*operation, &operands)?
            }
        };
        if text.len() > LONGEST {
            return Err("the formula is too long for POV-Ray once its parts are written out".into());
        }
        texts.push(text);
    }
    Ok(texts.swap_remove(program.outputs()[0].index()))
}

fn operands<'a>(texts: &'a [String], operands: &[NodeId]) -> Vec<&'a str> {
    operands.iter().map(|operand| texts[operand.index()].as_str()).collect()
}

fn application(operation: Operation, operands: &[&str]) -> Result<String, Box<dyn Error>> {
    let function = match (operation, operands) {
        (Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Divide, [a, b]) => {
            return Ok(format!("({a}{}{b})", operation.name()));
        }
        (Operation::IntegerPower, [a, "(2)"]) => return Ok(format!("({a}*{a})")),
        (Operation::Negate, [a]) => return Ok(format!("(-{a})")),
        (Operation::IntegerPower, _) => "pow",
        (Operation::Minimum, _) => "min",
        (Operation::Maximum, _) => "max",
        (Operation::Atan2, _) => "atan2",
        (Operation::Absolute, _) => "abs",
        (Operation::SquareRoot, _) => "sqrt",
        (Operation::Exp, _) => "exp",
        (Operation::Ln, _) => "ln",
        (Operation::Sin, _) => "sin",
        (Operation::Cos, _) => "cos",
        (Operation::Tan, _) => "tan",
        (Operation::Asin, _) => "asin",
        (Operation::Acos, _) => "acos",
        (Operation::Atan, _) => "atan",
        (Operation::Floor, _) => "floor",
        (Operation::Ceil, _) => "ceil",
        _ => return Err(format!("POV-Ray has no operation like {}", operation.name()).into()),
    };
    Ok(format!("{function}({})", operands.join(",")))
}
