//! The page of a report: one file that needs nothing else, for screens and paper.

use std::io::{self, Write};

use super::images::LEGEND;
use super::{Report, Run, Section, plots};
use crate::html::escaped;
use crate::scaling::{Family, evaluation_plot};

const STYLE: &str = "\
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 76rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.5rem; margin-bottom: 0.2rem } h2 { font-size: 1.25rem; margin-top: 2.5rem } h3 { font-size: 1.05rem }
.advice { font-size: 1.1rem; border-left: 4px solid #0072b2; padding-left: 0.8rem }
.about, .note, figcaption { color: #555; font-size: 0.9rem } code { overflow-wrap: anywhere }
figure { margin: 1rem 0; max-width: 60rem } svg { width: 100%; height: auto } .mark:hover circle { stroke: #000; stroke-width: 3 }
.side-by-side { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 22rem), 1fr)); gap: 1rem }
.images { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 15rem), 1fr)); gap: 1rem }
.side-by-side figure, .images figure { margin: 0 } img { width: 100%; image-rendering: pixelated; border: 1px solid #ccc }
table { border-collapse: collapse; font-size: 0.8rem; width: 100% }
th, td { padding: 0.15rem 0.4rem; text-align: right; border-bottom: 1px solid #e4e4e4; vertical-align: top; white-space: nowrap }
th { font-weight: 600; vertical-align: bottom; white-space: normal } td:first-child, td.text { white-space: normal }
td:first-child, th:first-child, .text { text-align: left }
@media screen and (max-width: 60rem) { .detail { display: none } body { margin: 1rem auto; font-size: 15px } }
@media screen and (max-width: 40rem) { .large { overflow-x: auto } .large svg { min-width: 34rem } }
@page { margin: 14mm }
@media print {
  body { margin: 0; padding: 0; max-width: none; font-size: 10pt } .about, .note, figcaption { font-size: 8pt } table { font-size: 6.5pt } th, td { padding: 0.1rem 0.2rem }
  figure, tr { break-inside: avoid } h2, h3 { break-after: avoid } thead { display: table-header-group }
  .side-by-side { grid-template-columns: 1fr 1fr } .images { display: block } .images figure { display: inline-block; width: 23%; margin-right: 1%; vertical-align: top }
}";

/// Writes report.html. Its tags are closed and its text escaped as XML asks for.
pub(crate) fn write_page(report: &Report, writer: &mut dyn Write) -> io::Result<()> {
    let Report { machine, width, height, threads, version, formulas, notes, .. } = report;
    let title = match &formulas[..] {
        [section] => format!("Error against time: {}", section.formula),
        sections => format!("Error against time: {} formulas", sections.len()),
    };
    writeln!(
        writer,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width\"/>\n\
         <title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>Error against time</h1>",
        escaped(&title)
    )?;
    write_notes(notes, writer)?;
    if let [section] = &formulas[..] {
        write_advice(section, writer)?;
    }
    writeln!(
        writer,
        "<p class=\"about\">Pictures of {width}×{height} pixels on {threads} threads; iso {version} on {}, {} cores, {}, {}. Each \
         pixel is held against what the certified method proves of its ray alone.</p>",
        escaped(&machine.processor),
        machine.cores,
        machine.system,
        machine.date
    )?;
    match &formulas[..] {
        [section] => write_figures(section, writer)?,
        sections => {
            write_overview(sections, writer)?;
            for section in sections {
                writeln!(writer, "<h2 id=\"{0}\">{0}</h2>", escaped(&section.name))?;
                write_advice(section, writer)?;
                write_figures(section, writer)?;
            }
        }
    }
    if !report.engines.is_empty() {
        let plot = evaluation_plot(&report.engines, Family::Blobs);
        writeln!(
            writer,
            "<h2>The interpreter and native code</h2>\n<figure>\n<div class=\"large\">{plot}</div><figcaption>What one evaluation of \
             F takes, and what compiling it takes once, as formulas grow: sums of more and more metaballs.</figcaption>\n</figure>"
        )?;
    }
    writeln!(writer, "</body>\n</html>")
}

fn write_notes(notes: &[String], writer: &mut dyn Write) -> io::Result<()> {
    notes.iter().try_for_each(|note| writeln!(writer, "<p class=\"note\">{}</p>", escaped(note)))
}

/// The formula and what to use for it.
fn write_advice(section: &Section, writer: &mut dyn Write) -> io::Result<()> {
    writeln!(
        writer,
        "<p><code>{}</code><br/><span class=\"about\">{} operations. {}</span></p>\n<p class=\"advice\">{}</p>",
        escaped(&section.formula),
        section.operations,
        escaped(&section.note),
        escaped(&section.advice)
    )?;
    write_notes(&section.notes, writer)
}

/// One line for each formula.
fn write_overview(sections: &[Section], writer: &mut dyn Write) -> io::Result<()> {
    writeln!(
        writer,
        "<h2>Overview</h2>\n<table>\n<thead><tr><th>formula</th><th class=\"detail\">operations</th>\
         <th class=\"text\">what to use, and what it costs</th></tr></thead>\n<tbody>"
    )?;
    for Section { name, operations, advice, .. } in sections {
        writeln!(
            writer,
            "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"detail\">{operations}</td><td class=\"text\">{1}</td></tr>",
            escaped(name),
            escaped(advice)
        )?;
    }
    writeln!(writer, "</tbody>\n</table>")
}

/// Plots, images and the table of runs.
fn write_figures(section: &Section, writer: &mut dyn Write) -> io::Result<()> {
    let (small, large): (Vec<_>, Vec<_>) = plots(section).into_iter().partition(|plot| plot.is_small);
    let figure = |content: &str, caption: &str| {
        format!("<figure>\n{content}<figcaption>{}</figcaption>\n</figure>\n", escaped(caption))
    };
    for plot in large {
        let content = format!("<div class=\"large\">{}</div>", plot.svg);
        writer.write_all(figure(&content, plot.caption).as_bytes())?;
    }
    if !small.is_empty() {
        writeln!(writer, "<h3>More and more cells</h3>\n<div class=\"side-by-side\">")?;
        for plot in small {
            writer.write_all(figure(&plot.svg, plot.caption).as_bytes())?;
        }
        writeln!(writer, "</div>")?;
    }
    if !section.images.is_empty() {
        writeln!(
            writer,
            "<h3>Where errors sit</h3>\n<p class=\"about\">The worst setting of each method that samples. {LEGEND}</p>\n\
             <div class=\"images\">"
        )?;
        for image in &section.images {
            let content = format!("<img alt=\"\" src=\"{}\"/>\n", image.address);
            writer.write_all(figure(&content, &image.caption).as_bytes())?;
        }
        writeln!(writer, "</div>")?;
    }
    write_runs(&section.runs, writer)
}

/// The columns; those that narrow screens leave out are marked.
const HEADS: [(&str, bool); 14] = [
    ("setting", false),
    ("median", false),
    ("least to greatest", true),
    ("compile", true),
    ("prepare", true),
    ("trace", true),
    ("shade", true),
    ("other", true),
    ("processors", true),
    ("missed", false),
    ("false", false),
    ("undecided", true),
    ("ulps", false),
    ("peak MiB", true),
];

fn write_runs(runs: &[Run], writer: &mut dyn Write) -> io::Result<()> {
    writeln!(
        writer,
        "<h3>All runs</h3>\n<p class=\"about\">Times are in milliseconds. Those of phases and on processors are of the middle \
         repetition, and the phases’ sum is its time. 99.9 % of the roots found are no further from the proven ones than so many \
         ulps, units in the last place of t. Narrow screens show less; report.csv has all.</p>\n<table>\n<thead><tr>{}</tr></thead>\n<tbody>",
        HEADS.map(|(head, is_detail)| cell("th", head, is_detail)).concat()
    )?;
    for run in runs {
        let cells = cells(run).into_iter().zip(HEADS);
        let cells: String = cells.map(|(text, (_, is_detail))| cell("td", &text, is_detail)).collect();
        writeln!(writer, "<tr>{cells}</tr>")?;
    }
    writeln!(writer, "</tbody>\n</table>")
}

fn cell(tag: &str, text: &str, is_detail: bool) -> String {
    let class = if is_detail { " class=\"detail\"" } else { "" };
    format!("<{tag}{class}>{text}</{tag}>")
}

fn cells(run: &Run) -> [String; HEADS.len()] {
    let Run { setting, milliseconds, quality, .. } = run;
    let (time, middle) = (run.time(), &milliseconds.middle);
    let known = |number: Option<f64>, decimals: usize| {
        number.map_or_else(|| "–".to_owned(), |number| format!("{number:.decimals$}"))
    };
    [
        escaped(setting.flags.trim_start_matches("--method ")),
        format!("{:.2}", time.median),
        format!("{:.2} to {:.2}", time.least, time.greatest),
        format!("{:.2}", middle.compile),
        format!("{:.2}", middle.preprocess),
        format!("{:.2}", middle.trace),
        format!("{:.2}", middle.shade),
        format!("{:.2}", middle.other),
        known(milliseconds.middle_processor.total, 2),
        quality.missed.to_string(),
        quality.made_up.to_string(),
        quality.undecided.to_string(),
        match quality.ulps.p999 {
            ulps if ulps.is_nan() => "–".to_owned(),
            ulps if ulps < 1e5 => format!("{ulps:.0}"),
            ulps => format!("{ulps:.1e}"),
        },
        known(run.peak_memory, 0),
    ]
}
