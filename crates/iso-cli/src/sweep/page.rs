//! The page of a report: one file that needs nothing else, for screens and paper.

use std::io::{self, Write};

use super::{Report, Run, cells_plot, error_plot};
use crate::html::escaped;

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 76rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.5rem; margin-bottom: 0.2rem } h2 { font-size: 1.15rem; margin-top: 2rem }
.advice { font-size: 1.1rem; border-left: 4px solid #0072b2; padding-left: 0.8rem }
.about, .note, figcaption { color: #555; font-size: 0.9rem } code { overflow-wrap: anywhere }
figure { margin: 1rem 0; max-width: 60rem } svg { width: 100%; height: auto } .mark:hover circle { stroke: #000 }
.wide { overflow-x: auto } table { border-collapse: collapse; font-size: 0.8rem; width: 100% }
th, td { padding: 0.15rem 0.4rem; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap }
th { font-weight: 600; white-space: normal; vertical-align: bottom } th:first-child, td:first-child { text-align: left }
@media print { body { margin: 0; max-width: none; font-size: 10pt } table { font-size: 6.5pt } figure, tr { break-inside: avoid } }";

/// Writes report.html. Its tags are closed and its text escaped as XML asks for.
pub(crate) fn write_page(report: &Report, writer: &mut dyn Write) -> io::Result<()> {
    let Report { machine, width, height, threads, operations, version, .. } = report;
    let formula = escaped(&report.formula);
    writeln!(
        writer,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width\"/>\n\
         <title>Error against time: {formula}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <h1>Error against time</h1>\n<p><code>{formula}</code></p>\n<p class=\"advice\">{}</p>",
        escaped(&report.advice)
    )?;
    for note in &report.notes {
        writeln!(writer, "<p class=\"note\">{}</p>", escaped(note))?;
    }
    writeln!(
        writer,
        "<p class=\"about\">{width}×{height} pixels, {threads} threads, {operations} operations; iso {version} on {}, \
         {} cores, {}, {}. Each pixel is held against what the certified method proves of its ray alone.</p>",
        escaped(&machine.processor),
        machine.cores,
        machine.system,
        machine.date
    )?;
    let figures = [
        (
            error_plot(report),
            "Wrong pixels, which are missed, false or undecided, against time. Bars reach from the least to the \
             greatest time; no setting beats those on the dashed line. Point at a mark to see its setting.",
        ),
        (
            cells_plot(report),
            "Time of a picture against cells along every axis, at the largest step; dashed lines are the interpreter's.",
        ),
    ];
    for (figure, caption) in figures {
        writeln!(writer, "<figure>\n{figure}<figcaption>{caption}</figcaption>\n</figure>")?;
    }
    writeln!(
        writer,
        "<h2>All runs</h2>\n<p class=\"about\">Times are in milliseconds. Those of phases are of the middle repetition, and \
         their sum is its time.</p>\n<div class=\"wide\"><table>\n<thead><tr>{}</tr></thead>\n<tbody>",
        HEADS.map(|head| format!("<th>{head}</th>")).concat()
    )?;
    report.runs.iter().try_for_each(|run| write_run(run, writer))?;
    writeln!(writer, "</tbody>\n</table></div>\n</body>\n</html>")
}

const HEADS: [&str; 13] = [
    "setting",
    "median",
    "least to greatest",
    "compile",
    "prepare",
    "trace",
    "shade",
    "other",
    "missed",
    "false",
    "undecided",
    "99.9 % of |t − t*| below, ulps",
    "peak MiB",
];

fn write_run(run: &Run, writer: &mut dyn Write) -> io::Result<()> {
    let Run { setting, milliseconds, phases, quality, .. } = run;
    let cells = [
        escaped(setting.flags.trim_start_matches("--method ")),
        format!("{:.2}", milliseconds.median),
        format!("{:.2} to {:.2}", milliseconds.least, milliseconds.greatest),
        format!("{:.2}", phases.compile),
        format!("{:.2}", phases.preprocess),
        format!("{:.2}", phases.trace),
        format!("{:.2}", phases.shade),
        format!("{:.2}", phases.other),
        quality.missed.to_string(),
        quality.made_up.to_string(),
        quality.undecided.to_string(),
        if quality.ulps.p999.is_nan() { "–".to_owned() } else { format!("{:.0}", quality.ulps.p999) },
        phases.peak_memory.map_or_else(|| "–".to_owned(), |memory| format!("{memory:.0}")),
    ];
    writeln!(writer, "<tr>{}</tr>", cells.map(|cell| format!("<td>{cell}</td>")).concat())
}
