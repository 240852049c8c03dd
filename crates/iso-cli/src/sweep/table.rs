//! A report as a table.

use std::io::{self, Write};

use super::quality::Deviation;
use super::{Report, Run};
use crate::table::{digits, write_row};

/// Writes report.csv: a row for each run.
pub(crate) fn write_table(report: &Report, writer: &mut dyn Write) -> io::Result<()> {
    write_row(writer, COLUMNS)?;
    report.runs.iter().try_for_each(|run| write_row(writer, row(run)))
}

const COLUMNS: [&str; 43] = [
    "method",
    "engine",
    "grid",
    "refine",
    "step",
    "repetitions",
    "median_ms",
    "least_ms",
    "greatest_ms",
    "total_ms",
    "compile_ms",
    "preprocess_ms",
    "trace_ms",
    "shade_ms",
    "other_ms",
    "processor_ms",
    "peak_memory_mib",
    "right",
    "missed",
    "false",
    "undecided",
    "open",
    "distance_max",
    "distance_mean",
    "distance_p999",
    "ulps_max",
    "ulps_mean",
    "ulps_p999",
    "residual_max",
    "residual_mean",
    "residual_p999",
    "angle_max",
    "angle_mean",
    "angle_p999",
    "psnr_db",
    "worst_channel",
    "preprocess_evaluations",
    "trace_evaluations",
    "gradient_evaluations",
    "box_evaluations",
    "steps",
    "cells",
    "existence_cells",
];

fn row(run: &Run) -> Vec<String> {
    let Run { setting, repetitions, milliseconds, phases, quality, counters } = run;
    let count = |count: Option<u32>| count.map_or_else(String::new, |count| count.to_string());
    let number = |number: Option<f64>| number.map_or_else(String::new, digits);
    let mut row = vec![
        setting.name.to_owned(),
        setting.engine_name.to_owned(),
        count(setting.grid),
        count(setting.refine),
        number(setting.step),
        repetitions.to_string(),
    ];
    let times = [
        milliseconds.median,
        milliseconds.least,
        milliseconds.greatest,
        phases.total,
        phases.compile,
        phases.preprocess,
        phases.trace,
        phases.shade,
        phases.other,
    ];
    row.extend(times.map(digits));
    row.extend([phases.processor, phases.peak_memory].map(number));
    let pixels = [quality.right, quality.missed, quality.made_up, quality.undecided, quality.open];
    row.extend(pixels.map(|pixels| pixels.to_string()));
    for Deviation { max, mean, p999 } in [quality.distance, quality.ulps, quality.residual, quality.angle] {
        row.extend([max, mean, p999].map(digits));
    }
    row.extend([number(quality.psnr), quality.worst_channel.to_string()]);
    let work = [
        counters.preprocess_evaluations,
        counters.trace_evaluations,
        counters.gradient_evaluations,
        counters.box_evaluations,
        counters.steps,
        counters.cells,
        counters.existence_cells,
    ];
    row.extend(work.map(|count| count.to_string()));
    row
}
