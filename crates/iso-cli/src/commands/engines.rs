//! `iso engines`: the interpreter against native code, as formulas and pictures grow.

use std::io::Write;

use crate::clock::{Deadline, milliseconds};
use crate::engine::threads;
use crate::failure::Failure;
use crate::flags::{EnginesFlags, name_of};
use crate::output::{OutputFile, make_folder, to_standard_output};
use crate::progress::Progress;
use crate::scaling::{
    Evaluation, Formula, PictureTimes, evaluation_plot, gain_plot, measure_evaluations, measure_pictures,
    write_evaluations, write_pictures,
};

/// Measures and writes the folder.
pub(crate) fn run(flags: EnginesFlags) -> Result<(), Failure> {
    let deadline = Deadline::after(flags.budget);
    make_folder(&flags.output)?;
    let file = |name: &str| OutputFile::new(flags.output.join(name));
    let (evaluation_file, picture_file) = (file("evaluations.csv")?, file("pictures.csv")?);
    let formulas: Vec<Formula> = flags
        .families
        .iter()
        .flat_map(|family| flags.sizes.iter().map(|&size| family.formula(size as usize)))
        .collect();
    let rounds = flags.runs.get() as usize;
    let progress = Progress::new(true);
    let report = |done: usize, all: usize| progress.report(done as u64, all as u64);
    let (evaluations, pictures) = threads(&flags.threads)?.install(|| {
        let evaluations = measure_evaluations(&formulas, rounds, deadline, report)?;
        let patience = milliseconds(flags.patience);
        let pictures = measure_pictures(&formulas, &flags.sides, rounds, patience, deadline, report)?;
        Ok::<(Vec<Evaluation>, Vec<PictureTimes>), Failure>((evaluations, pictures))
    })?;
    progress.finish();
    evaluation_file.write(|writer| write_evaluations(&evaluations, writer))?;
    picture_file.write(|writer| write_pictures(&pictures, writer))?;
    for &family in &flags.families {
        for (name, svg) in [
            ("evaluations", evaluation_plot(&evaluations, family)),
            ("pictures", gain_plot(&pictures, family)),
        ] {
            file(&format!("{name}-{}.svg", name_of(family)))?
                .write(|writer| writer.write_all(svg.as_bytes()))?;
        }
    }
    to_standard_output(|writer| {
        writeln!(writer, "{}", evaluation_file.path().display())?;
        writeln!(writer, "{}", picture_file.path().display())
    })
}
