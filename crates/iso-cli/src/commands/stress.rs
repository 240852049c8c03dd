//! `iso stress`: the suite of hard cases.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::engine::threads;
use crate::failure::Failure;
use crate::flags::StressFlags;
use crate::output::{OutputFile, to_standard_output};
use crate::progress::Progress;
use crate::stress::{Case, Measured, cases, measure, write_document, write_page, write_table};

/// Runs the suite, or one case of it.
pub(crate) fn run(flags: StressFlags) -> Result<(), Failure> {
    let to_file = |path: &Path| OutputFile::new(path.to_owned());
    let html = flags.html.as_deref().map(to_file).transpose()?;
    let markdown = flags.markdown.as_deref().map(to_file).transpose()?;
    if let (Some(html), Some(markdown)) = (&html, &markdown)
        && html.is_replaced_by(markdown)
    {
        return Err(Failure::usage("--html and --markdown go to one file", "give them different names"));
    }
    let cases = chosen(flags.case.as_deref())?;
    let (progress, done) = (Progress::new(true), AtomicU64::new(0));
    let measured: Result<Vec<Measured>, Failure> = threads(&flags.threads)?.install(|| {
        cases
            .par_iter()
            .map(|case| {
                let measured = measure(case, flags.size);
                progress.report(done.fetch_add(1, Ordering::Relaxed) + 1, cases.len() as u64);
                measured
            })
            .collect()
    });
    progress.finish();
    let measured = measured?;
    if let Some(file) = html {
        file.write(|mut writer| write_page(&mut writer, &measured))?;
    }
    if let Some(file) = markdown {
        file.write(|mut writer| write_document(&mut writer, &measured, flags.size))?;
    }
    to_standard_output(|writer| match flags.json {
        true => {
            serde_json::to_writer_pretty(&mut *writer, &measured)?;
            writeln!(writer)
        }
        false => write_table(writer, &measured),
    })?;
    match measured.iter().map(|case| case.broken.len()).sum() {
        0 => Ok(()),
        broken => Err(Failure::Broken { promises: broken }),
    }
}

fn chosen(name: Option<&str>) -> Result<Vec<Case>, Failure> {
    let mut cases = cases();
    let Some(name) = name else { return Ok(cases) };
    cases.retain(|case| case.name == name);
    match cases.is_empty() {
        false => Ok(cases),
        true => Err(Failure::usage(
            format!("no case of the suite is called {name}"),
            "`iso stress` without --case lists them all",
        )),
    }
}
