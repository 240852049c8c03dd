//! `iso report`: what error each method and setting buys for what time.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use iso_expr::{Interpreter, Program};
use iso_grid::{Fitted, RootFinder, Surface};
use iso_render::Stopwatch;

use crate::camera::{camera, projection};
use crate::clock::Deadline;
use crate::engine::threads;
use crate::failure::Failure;
use crate::flags::{AxesFlags, EngineName, ReportFlags, SuiteName};
use crate::formula::{Source, file_of, minus_level};
use crate::measurement::Subject;
use crate::method::fitted_unless;
use crate::output::{OutputFile, make_folder, to_standard_output};
use crate::progress::Progress;
use crate::report::{Axes, Case, Report, Sweep, plots, scenes, write_page, write_table};
use crate::scaling::{Family, Formula};

/// Measures all settings and writes the report.
pub(crate) fn run(flags: ReportFlags) -> Result<(), Failure> {
    let sweep = Sweep {
        deadline: Deadline::after(flags.sweep.budget),
        cases: cases(&flags)?,
        settings: axes(&flags.axes).settings(),
        growing: growing(&flags.axes),
        rounds: flags.sweep.runs.get() as usize,
    };
    let source = flags.subject.formula.as_deref().and_then(file_of);
    let mut files = ReportFiles::new(&flags.sweep.output, source)?;
    let progress = Progress::new(true);
    let report = threads(&flags.threads)?.install(|| {
        sweep.run(|done, all, report| {
            progress.report(done as u64, all as u64);
            if files.are_due() { files.write(&report()) } else { Ok(()) }
        })
    });
    progress.finish();
    let report = report?;
    files.write(&report)?;
    if flags.sweep.json {
        return to_standard_output(|writer| {
            serde_json::to_writer_pretty(&mut *writer, &report)?;
            writeln!(writer)
        });
    }
    to_standard_output(|writer| {
        for section in &report.formulas {
            if report.formulas.len() > 1 {
                write!(writer, "{}: ", section.name)?;
            }
            writeln!(writer, "{}", section.advice)?;
            section.notes.iter().try_for_each(|note| writeln!(writer, "{note}"))?;
        }
        report.notes.iter().try_for_each(|note| writeln!(writer, "{note}"))?;
        writeln!(writer, "{}", files.page.path().display())
    })
}

/// The surfaces that are asked for: one formula, or those of a suite.
fn cases(flags: &ReportFlags) -> Result<Vec<Case>, Failure> {
    let case = |name, formula, note, program, fitted| {
        Ok(Case { name, formula, note, subject: subject(flags, program, fitted)? })
    };
    let suite = |suite: SuiteName| -> Result<Vec<Case>, Failure> {
        let scenes = scenes(suite).into_iter();
        scenes
            .map(|scene| case(scene.name, scene.formula, scene.note, scene.program, scene.region.into()))
            .collect()
    };
    match (&flags.subject.formula, flags.subject.suite) {
        (Some(formula), _) => {
            let source = Source::read(formula)?;
            let formula = source.lower(&source.parse()?, &flags.subject.settings)?;
            let program = minus_level(&formula, flags.level.level)?.simplified();
            let surface = Surface::new(Arc::new(Interpreter), program.clone());
            let fitted = fitted_unless(flags.region.region, &surface)?;
            let text = source.text().trim().to_owned();
            Ok(vec![case("formula".to_owned(), text, String::new(), program, fitted)?])
        }
        (None, Some(name)) => suite(name),
        (None, None) => {
            Err(Failure::usage("neither a formula nor a suite is given", "give a formula, or --suite"))
        }
    }
}

fn subject(flags: &ReportFlags, program: Program, fitted: Fitted) -> Result<Subject, Failure> {
    Ok(Subject {
        camera: camera(&flags.camera, &fitted, flags.sweep.size)?,
        size: flags.sweep.size,
        projection: projection(&flags.camera),
        program,
        region: fitted.region,
    })
}

/// The formulas on which the engines are compared, if both are.
fn growing(flags: &AxesFlags) -> Vec<Formula> {
    let has_both = [EngineName::Jit, EngineName::Interp].iter().all(|name| flags.engines.contains(name));
    let sizes = flags.sizes.iter().filter(|_| has_both);
    sizes.map(|&size| Family::Blobs.formula(size as usize)).collect()
}

fn axes(flags: &AxesFlags) -> Axes {
    Axes {
        methods: flags.methods.clone(),
        engines: flags.engines.clone(),
        grids: flags.grids.clone(),
        refinements: flags.refines.clone(),
        steps: flags.steps.clone(),
        root_finders: flags.root_finders.iter().map(|&name| RootFinder::from(name)).collect(),
        tolerances: flags.tolerances.clone(),
        is_crossed: flags.cross,
    }
}

/// The files of a report.
struct ReportFiles {
    table: OutputFile,
    object: OutputFile,
    page: OutputFile,
    plots: PathBuf,
    /// The file from which the formula is read.
    source: Option<PathBuf>,
    /// Plots by their names, once there are any.
    plot_files: BTreeMap<String, OutputFile>,
    /// Since the last time they were written.
    watch: Stopwatch,
    /// How long they stay as they are, at least.
    rest: Duration,
}

/// How long files stay as they are at least, and how many times longer than writing them took: measuring comes first.
const REST: (Duration, u32) = (Duration::from_secs(1), 20);

impl ReportFiles {
    /// Makes the folder, and sure that its files can be written.
    fn new(folder: &Path, source: Option<PathBuf>) -> Result<Self, Failure> {
        let plots = folder.join("plots");
        make_folder(&plots)?;
        let file = |name: &str| sparing(source.as_deref(), folder.join(name));
        Ok(Self {
            table: file("report.csv")?,
            object: file("report.json")?,
            page: file("report.html")?,
            plots,
            source,
            plot_files: BTreeMap::new(),
            watch: Stopwatch::start(),
            rest: Duration::ZERO,
        })
    }

    /// Whether it is time to write them again.
    fn are_due(&self) -> bool {
        self.watch.elapsed() >= self.rest
    }

    fn write(&mut self, report: &Report) -> Result<(), Failure> {
        let watch = Stopwatch::start();
        self.table.write(|writer| write_table(report, writer))?;
        self.object.write(|writer| serde_json::to_writer_pretty(writer, report))?;
        self.page.write(|writer| write_page(report, writer))?;
        for section in &report.formulas {
            for plot in plots(section) {
                let name = match report.formulas.len() {
                    1 => format!("{}.svg", plot.name),
                    _ => format!("{}-{}.svg", section.name, plot.name),
                };
                self.plot_file(name)?.write(|writer| writer.write_all(plot.svg.as_bytes()))?;
            }
        }
        self.rest = REST.0.max(REST.1 * watch.elapsed());
        self.watch = Stopwatch::start();
        Ok(())
    }

    fn plot_file(&mut self, name: String) -> Result<OutputFile, Failure> {
        if let Some(file) = self.plot_files.get(&name) {
            return Ok(file.clone());
        }
        let file = sparing(self.source.as_deref(), self.plots.join(&name))?;
        self.plot_files.insert(name, file.clone());
        Ok(file)
    }
}

/// A file that does not take the place of the one from which the formula is read.
fn sparing(source: Option<&Path>, path: PathBuf) -> Result<OutputFile, Failure> {
    let file = OutputFile::new(path)?;
    source.map_or(Ok(()), |source| file.spares(source))?;
    Ok(file)
}
