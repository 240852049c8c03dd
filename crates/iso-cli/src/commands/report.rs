//! `iso report`: what error each method and setting buys for what time.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use iso_expr::Interpreter;
use iso_grid::Surface;

use crate::camera::{camera, projection};
use crate::clock::Deadline;
use crate::engine::threads;
use crate::failure::Failure;
use crate::flags::ReportFlags;
use crate::formula::{Source, minus_level};
use crate::measurement::Subject;
use crate::method::region;
use crate::output::{OutputFile, to_standard_output};
use crate::progress::Progress;
use crate::sweep::{Report, Sweep, cells_plot, error_plot, settings, write_page, write_table};

/// Measures all settings and writes the report.
pub(crate) fn run(flags: ReportFlags) -> Result<(), Failure> {
    let deadline = Deadline::after(flags.sweep.budget);
    let source = Source::read(&flags.formula.formula)?;
    let formula = source.lower(&source.parse()?, &flags.formula.settings)?;
    let program = minus_level(&formula, flags.level.level)?.simplified();
    let surface = Surface::new(Arc::new(Interpreter), program.clone());
    let region = region(flags.region.region, &surface)?;
    let sweep = Sweep {
        subject: Subject {
            camera: camera(&flags.camera, &region, flags.sweep.size)?,
            size: flags.sweep.size,
            projection: projection(&flags.camera),
            program,
            region,
        },
        formula: source.text().trim().to_owned(),
        settings: settings(&flags.sweep.grids, &flags.sweep.steps),
        rounds: flags.sweep.runs.get() as usize,
        deadline,
    };
    let files = ReportFiles::new(&flags.sweep.output)?;
    let progress = Progress::new(true);
    let report = threads(&flags.threads)?.install(|| {
        sweep.run(|report, done, all| {
            progress.report(done as u64, all as u64);
            files.write(report)
        })
    });
    progress.finish();
    let report = report?;
    if flags.sweep.json {
        return to_standard_output(|writer| {
            serde_json::to_writer_pretty(&mut *writer, &report)?;
            writeln!(writer)
        });
    }
    to_standard_output(|writer| {
        writeln!(writer, "{}", report.advice)?;
        report.notes.iter().try_for_each(|note| writeln!(writer, "{note}"))?;
        writeln!(writer, "{}", files.page.path().display())
    })
}

/// The files of a report.
struct ReportFiles {
    table: OutputFile,
    object: OutputFile,
    page: OutputFile,
    error: OutputFile,
    cells: OutputFile,
}

impl ReportFiles {
    /// Makes the folder, and sure that its files can be written.
    fn new(folder: &Path) -> Result<Self, Failure> {
        fs::create_dir_all(folder).map_err(|error| Failure::write(folder, error))?;
        let file = |name: &str| OutputFile::new(folder.join(name));
        Ok(Self {
            table: file("report.csv")?,
            object: file("report.json")?,
            page: file("report.html")?,
            error: file("error.svg")?,
            cells: file("cells.svg")?,
        })
    }

    fn write(&self, report: &Report) -> Result<(), Failure> {
        self.table.write(|writer| write_table(report, writer))?;
        self.object.write(|writer| serde_json::to_writer_pretty(writer, report))?;
        self.page.write(|writer| write_page(report, writer))?;
        self.error.write(|writer| writer.write_all(error_plot(report).as_bytes()))?;
        self.cells.write(|writer| writer.write_all(cells_plot(report).as_bytes()))
    }
}
