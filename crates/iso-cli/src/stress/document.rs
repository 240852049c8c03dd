//! The document about the suite, `docs/stability.md`.

use std::io::{self, Write};

use iso_render::Size;

use super::measure::Measured;
use crate::machine::Machine;

/// Writes what was promised and found, what the certified method leaves open and why, and a table of all cases.
pub(crate) fn write_document(writer: &mut dyn Write, measured: &[Measured], size: Size) -> io::Result<()> {
    let Machine { date, .. } = Machine::here();
    writeln!(
        writer,
        "# Hard cases\n\n\
         Written by `iso stress --markdown` on {date}, from pictures of {}x{} pixels. The suite stands in `testdata/stability`, with the \
         formula of each case,\nwhat makes it hard and what is true of it; `iso stress --html stress.html` shows the pictures.\n",
        size.width(),
        size.height(),
    )?;
    write_promises(writer, measured)?;
    write_open(writer, measured)?;
    write_cases(writer, measured)
}

fn write_promises(writer: &mut dyn Write, measured: &[Measured]) -> io::Result<()> {
    let sum = |count: fn(&Measured) -> u64| measured.iter().map(count).sum::<u64>();
    writeln!(
        writer,
        "| promise | looked at | broken |\n\
         |---|---:|---:|\n\
         | interpreter and native code agree on every bit | {} doubles and decorations | {} |\n\
         | values lie in their enclosures | {} values | {} |\n\
         | differences of F are explained by the enclosure of its derivative | {} differences | {} |\n\
         | certified rays agree with what is true of them | {} rays, as tiles and alone, on both engines | {} |\n\
         | certified rays are decided, but in the cases below | the same rays | {} |\n\n\
         Of {} more rays nothing is stated: the truth is known along some rays only, or the ray grazes a shape or the edge of the box.\n",
        sum(|case| case.engines.compared),
        sum(|case| case.engines.differing),
        sum(|case| case.engines.sampled),
        sum(|case| case.engines.outside),
        sum(|case| case.engines.slopes),
        sum(|case| case.engines.unexplained),
        sum(|case| case.truth.right),
        sum(|case| case.truth.wrong),
        sum(|case| case.truth.left_open),
        sum(|case| case.truth.unknown),
    )
}

fn write_open(writer: &mut dyn Write, measured: &[Measured]) -> io::Result<()> {
    writeln!(
        writer,
        "## What cannot be decided\n\n\
         A touch is a place where F comes within rounding of zero without a proven crossing; an undecided ray is one whose proof stopped. \
         Both say that no\nroot lies before.\n\n\
         | case | touches | undecided | why |\n|---|---:|---:|---|"
    )?;
    let reasons = measured.iter().filter_map(|case| Some((case, case.open.as_deref()?)));
    let (open, seldom): (Vec<_>, Vec<_>) = reasons.partition(|(case, _)| case.certified().open() > 0);
    for (case, reason) in open {
        let ends = case.certified().ends;
        writeln!(writer, "| `{}` | {} | {} | {reason} |", case.name, ends.touch, ends.undecided)?;
    }
    writeln!(
        writer,
        "\nIn the other cases every ray is proven to hit or to miss. In other pictures single rays may be left open in"
    )?;
    for (place, (case, reason)) in seldom.iter().enumerate() {
        let end = if place + 1 < seldom.len() { ";" } else { "." };
        writeln!(writer, "- `{}`: {reason}{end}", case.name)?;
    }
    writeln!(writer)
}

fn write_cases(writer: &mut dyn Write, measured: &[Measured]) -> io::Result<()> {
    writeln!(
        writer,
        "## All cases\n\n\
         Hits, touches, misses and undecided rays are those of the certified method on native code. Errors and faults are those of the \
         methods that\nsample, with their default settings: the worst of `grid`, `octree` and `direct` where they found the proven root, \
         then the wrong and missed hits of\neach. The residual |F - C| is in units of its own rounding error; normals are in radians.\n\n\
         | case | hit | touch | miss | undecided | \\|t - t*\\| | residual | normal | wrong/missed: grid | octree | direct |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    )?;
    for family in measured.chunk_by(|a, b| a.family == b.family) {
        writeln!(writer, "| **{}** |||||||||||", family[0].family)?;
        family.iter().try_for_each(|case| write_case(writer, case))?;
    }
    Ok(())
}

fn write_case(writer: &mut dyn Write, case: &Measured) -> io::Result<()> {
    let ends = case.certified().ends;
    let errors = [
        case.worst_sampled(|run| run.distance),
        case.worst_sampled(|run| run.residual),
        case.worst_sampled(|run| run.angle),
    ];
    let errors = errors.map(|error| if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") });
    let faults: Vec<String> =
        case.sampled().iter().map(|run| format!("{}/{}", run.wrong, run.missed)).collect();
    writeln!(
        writer,
        "| `{}` | {} | {} | {} | {} | {} | {} |",
        case.name,
        ends.hit,
        ends.touch,
        ends.miss,
        ends.undecided,
        errors.join(" | "),
        faults.join(" | "),
    )
}
