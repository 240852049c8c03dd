//! A report as a table.

use std::io::{self, Write};

use super::quality::Deviation;
use super::{Report, Run};
use crate::table::{digits, write_row};

/// Writes report.csv: a row for each run.
pub(crate) fn write_table(report: &Report, writer: &mut dyn Write) -> io::Result<()> {
    write_row(writer, columns())?;
    report
        .formulas
        .iter()
        .flat_map(|section| section.runs.iter().map(move |run| row(&section.name, run)))
        .try_for_each(|row| write_row(writer, row))
}

const SETTING: [&str; 10] = [
    "formula",
    "method",
    "engine",
    "grid",
    "refine",
    "step",
    "root_finder",
    "tolerance",
    "repetitions",
    "peak_memory_mib",
];
const PHASES: [&str; 6] = ["total", "compile", "preprocess", "trace", "shade", "other"];
const OF_A_PHASE: [&str; 5] = ["ms", "processor_ms", "median_ms", "least_ms", "greatest_ms"];
const PIXELS: [&str; 5] = ["right", "missed", "false", "undecided", "open"];
const DEVIATIONS: [&str; 4] = ["distance", "ulps", "residual", "angle"];
const OF_A_DEVIATION: [&str; 3] = ["max", "mean", "p999"];
const WORK: [&str; 13] = [
    "psnr_db",
    "worst_channel",
    "rays",
    "rays_in_region",
    "preprocess_evaluations",
    "trace_evaluations",
    "gradient_evaluations",
    "box_evaluations",
    "steps",
    "cells",
    "existence_cells",
    "examined_cells",
    "rescued_cells",
];

fn columns() -> Vec<String> {
    let pairs = |whats: &[&str], figures: &[&str]| -> Vec<String> {
        whats.iter().flat_map(|what| figures.iter().map(move |figure| format!("{what}_{figure}"))).collect()
    };
    [
        SETTING.map(str::to_owned).to_vec(),
        pairs(&PHASES, &OF_A_PHASE),
        PIXELS.map(str::to_owned).to_vec(),
        pairs(&DEVIATIONS, &OF_A_DEVIATION),
        WORK.map(str::to_owned).to_vec(),
    ]
    .concat()
}

fn row(formula: &str, run: &Run) -> Vec<String> {
    let Run { setting, repetitions, milliseconds, peak_memory, quality, counters } = run;
    let count = |count: Option<u32>| count.map_or_else(String::new, |count| count.to_string());
    let number = |number: Option<f64>| number.map_or_else(String::new, digits);
    let mut row = vec![
        formula.to_owned(),
        setting.name.to_owned(),
        setting.engine_name.clone(),
        count(setting.grid),
        count(setting.refine),
        number(setting.step),
        setting.root_finder.unwrap_or_default().to_owned(),
        digits(setting.tolerance),
        repetitions.to_string(),
        number(*peak_memory),
    ];
    let phases = milliseconds.middle.each().into_iter().zip(milliseconds.middle_processor.each());
    for ((wall, processor), spread) in phases.zip(milliseconds.spread.each()) {
        row.extend([digits(*wall), number(*processor)]);
        row.extend([spread.median, spread.least, spread.greatest].map(digits));
    }
    let pixels = [quality.right, quality.missed, quality.made_up, quality.undecided, quality.open];
    row.extend(pixels.map(|pixels| pixels.to_string()));
    for Deviation { max, mean, p999 } in [quality.distance, quality.ulps, quality.residual, quality.angle] {
        row.extend([max, mean, p999].map(digits));
    }
    row.extend([number(quality.psnr), quality.worst_channel.to_string()]);
    let work = [
        counters.rays,
        counters.rays_in_region,
        counters.preprocess_evaluations,
        counters.trace_evaluations,
        counters.gradient_evaluations,
        counters.box_evaluations,
        counters.steps,
        counters.cells,
        counters.existence_cells,
        counters.examined_cells,
        counters.rescued_cells,
    ];
    row.extend(work.map(|count| count.to_string()));
    row
}
