//! `iso bench`: the interpreter against native code.

use std::io::{self, Write};
use std::sync::Arc;

use iso_expr::{Engine, Interpreter};
use iso_grid::{Accuracy, Method, Surface};
use iso_render::{Camera, Projection, Size, View};
use serde::Serialize;

use crate::clock::{Deadline, Spread};
use crate::engine::{native_code, threads};
use crate::evaluation::SpreadPoints;
use crate::failure::Failure;
use crate::flags::BenchFlags;
use crate::formula::{minus_level, understand};
use crate::measurement::{Subject, in_turns};
use crate::method::{fitted_unless, method};
use crate::notes::counted;
use crate::output::to_standard_output;

/// Measures both engines.
pub(crate) fn run(flags: BenchFlags) -> Result<(), Failure> {
    let formula = understand(&flags.formula)?;
    let program = minus_level(&formula, flags.level.level)?.simplified();
    let surface = Surface::new(Arc::new(Interpreter), program.clone());
    let region = fitted_unless(flags.method.region.region, &surface)?.region;
    let size = flags.measurement.size;
    let camera = Camera::new(View::DEFAULT, Projection::DEFAULT, &region, size)?;
    let bench = Bench {
        subject: Subject { program, region, projection: Projection::DEFAULT, camera, size },
        method: method(&flags.method, Accuracy::Pixels)?,
        points: SpreadPoints::over(&region),
    };
    let runs = flags.measurement.runs.get() as usize;
    let report = threads(&flags.threads)?.install(|| bench.report(runs))?;
    to_standard_output(|writer| match flags.measurement.json {
        true => {
            serde_json::to_writer_pretty(&mut *writer, &report)?;
            writeln!(writer)
        }
        false => report.write(writer),
    })
}

/// What is measured.
struct Bench {
    subject: Subject,
    method: Method,
    points: SpreadPoints,
}

/// One round of measurements of an engine.
#[derive(Clone, Copy, Debug, Default)]
struct Round {
    point_nanoseconds: f64,
    batch_nanoseconds: f64,
    compile_milliseconds: f64,
    picture_milliseconds: f64,
}

impl Bench {
    fn report(&self, runs: usize) -> Result<Report, Failure> {
        let engines: [Arc<dyn Engine>; 2] = [Arc::new(Interpreter), native_code()?];
        let mut rounds = [Vec::new(), Vec::new()];
        // The first round does not count: it fills caches and wakes the processor.
        in_turns(engines.len(), runs + 1, Deadline::never(), |turn| {
            let measured = self.round(&engines[turn.candidate])?;
            if turn.round > 0 {
                rounds[turn.candidate].push(measured);
            }
            Ok::<(), Failure>(())
        })?;
        let [interpreter, native] = rounds.map(|rounds| Measured::of(&rounds));
        let [width, height] = [self.subject.size.width(), self.subject.size.height()];
        Ok(Report {
            operations: self.subject.program.operations(),
            method: self.method.name(),
            width,
            height,
            runs,
            gain: Gain::of(&interpreter, &native),
            break_even_pixels: break_even(&interpreter, &native, self.subject.size),
            interpreter,
            native,
        })
    }

    fn round(&self, engine: &Arc<dyn Engine>) -> Result<Round, Failure> {
        let program = &self.subject.program;
        let point_nanoseconds = self.points.one_by_one(&*engine.point(program)?);
        let batch_nanoseconds = self.points.together(&*engine.batch(program)?);
        let picture = self.subject.measure(engine, &self.method)?;
        Ok(Round {
            point_nanoseconds,
            batch_nanoseconds,
            compile_milliseconds: picture.phases.compile.wall,
            picture_milliseconds: picture.total.wall - picture.phases.compile.wall,
        })
    }
}

/// What was measured of an engine.
#[derive(Debug, Serialize)]
struct Measured {
    /// One evaluation, each point asked for by itself.
    point_nanoseconds: Spread,
    /// One evaluation, all points asked for together.
    batch_nanoseconds: Spread,
    /// Compiling the kernels of a picture.
    compile_milliseconds: Spread,
    /// A picture from preprocessing to colours, without compiling.
    picture_milliseconds: Spread,
    /// The same with compiling.
    picture_and_compile_milliseconds: Spread,
}

impl Measured {
    fn of(rounds: &[Round]) -> Self {
        let spread = |number: fn(&Round) -> f64| Spread::of(&rounds.iter().map(number).collect::<Vec<_>>());
        Self {
            point_nanoseconds: spread(|round| round.point_nanoseconds),
            batch_nanoseconds: spread(|round| round.batch_nanoseconds),
            compile_milliseconds: spread(|round| round.compile_milliseconds),
            picture_milliseconds: spread(|round| round.picture_milliseconds),
            picture_and_compile_milliseconds: spread(|round| {
                round.picture_milliseconds + round.compile_milliseconds
            }),
        }
    }
}

/// How many times faster native code is, by medians.
#[derive(Debug, Serialize)]
struct Gain {
    point: f64,
    batch: f64,
    picture: f64,
    picture_and_compile: f64,
}

impl Gain {
    fn of(interpreter: &Measured, native: &Measured) -> Self {
        let gain = |spread: fn(&Measured) -> &Spread| spread(interpreter).median / spread(native).median;
        Self {
            point: gain(|measured| &measured.point_nanoseconds),
            batch: gain(|measured| &measured.batch_nanoseconds),
            picture: gain(|measured| &measured.picture_milliseconds),
            picture_and_compile: gain(|measured| &measured.picture_and_compile_milliseconds),
        }
    }
}

/// The pixels from which on native code, compiled first, is done before the interpreter; `None` when it never is.
///
/// Pictures are taken to cost in proportion to their pixels.
fn break_even(interpreter: &Measured, native: &Measured, size: Size) -> Option<f64> {
    let saved = interpreter.picture_milliseconds.median - native.picture_milliseconds.median;
    let spent = native.compile_milliseconds.median - interpreter.compile_milliseconds.median;
    (saved > 0.0).then(|| (spent.max(0.0) / saved * size.pixels() as f64).ceil())
}

/// All measurements. Its fields are the keys of `iso bench --json`.
#[derive(Debug, Serialize)]
struct Report {
    operations: usize,
    method: &'static str,
    width: u32,
    height: u32,
    runs: usize,
    #[serde(rename = "interp")]
    interpreter: Measured,
    #[serde(rename = "jit")]
    native: Measured,
    gain: Gain,
    break_even_pixels: Option<f64>,
}

impl Report {
    fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        let Self { interpreter, native, gain, .. } = self;
        writeln!(
            writer,
            "{}; method {}, {}x{} pixels; medians of {} (least to greatest)\n",
            counted(self.operations, "operation"),
            self.method,
            self.width,
            self.height,
            counted(self.runs, "run")
        )?;
        writeln!(writer, "{:<26} {:>28} {:>28} {:>8}", "", "interpreter", "native code", "gain")?;
        let mut line = |name: &str, spread: fn(&Measured) -> &Spread, gain: Option<f64>| {
            let gain = gain.map_or_else(String::new, |gain| format!("{gain:.2}x"));
            let [left, right] = [interpreter, native].map(|measured| shown(spread(measured)));
            writeln!(writer, "{name:<26} {left:>28} {right:>28} {gain:>8}")
        };
        line("a point alone, ns", |measured| &measured.point_nanoseconds, Some(gain.point))?;
        line("a point in a batch, ns", |measured| &measured.batch_nanoseconds, Some(gain.batch))?;
        line("compiling, ms", |measured| &measured.compile_milliseconds, None)?;
        line("picture, ms", |measured| &measured.picture_milliseconds, Some(gain.picture))?;
        line(
            "picture and compiling, ms",
            |measured| &measured.picture_and_compile_milliseconds,
            Some(gain.picture_and_compile),
        )?;
        match self.break_even_pixels {
            Some(pixels) => {
                let side = pixels.sqrt().ceil();
                writeln!(writer, "\nnative code is done first from {pixels} pixels on, about {side}x{side}")
            }
            None => writeln!(writer, "\nnative code is never done first"),
        }
    }
}

fn shown(spread: &Spread) -> String {
    format!("{:.3} ({:.3} to {:.3})", spread.median, spread.least, spread.greatest)
}
