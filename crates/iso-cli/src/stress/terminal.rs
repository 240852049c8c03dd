//! The table that a person reads.

use std::io::{self, Write};

use super::measure::Measured;
use crate::notes::counted;

/// Writes a row for each case, grouped by family, the worst first: broken promises, then rays left open, then errors of
/// the methods that sample. On the left the certified method on native code; on the right the methods that sample, `grid`,
/// `octree` and `direct`: the worst errors of all three, and the wrong and missed hits of each.
pub(crate) fn write_table(writer: &mut dyn Write, measured: &[Measured]) -> io::Result<()> {
    writeln!(
        writer,
        "{:<24} {:>6} {:>6} {:>6} {:>6} {:>8} | {:>9} {:>9} {:>9} {:>22}",
        "certified", "hit", "touch", "miss", "open", "ms", "|t - t*|", "residual", "normal", "wrong/missed"
    )?;
    for family in measured.chunk_by(|a, b| a.family == b.family) {
        writeln!(writer, "\n{}: {}", family[0].family, family[0].about)?;
        let mut family: Vec<&Measured> = family.iter().collect();
        family.sort_by_key(|case| std::cmp::Reverse(badness(case)));
        for case in family {
            write_case(writer, case)?;
        }
    }
    let broken = measured.iter().filter(|case| !case.broken.is_empty()).count();
    let sum = |count: fn(&Measured) -> u64| measured.iter().map(count).sum::<u64>();
    writeln!(
        writer,
        "\nLeft of the bar, the certified method. Right of it the worst of grid, octree and direct where they found the proven \
         root: |t - t*|, |F - C| in units of its own rounding error, the angle between normals in radians; then the wrong \
         and missed hits of each.\n\n{}, {broken} with a broken promise; {} certified rays agree with the stated truth, {} contradict it; {} doubles and \
         decorations compared between the engines, {} differ; {} values looked for in enclosures, {} outside; {} slopes, \
         {} unexplained",
        counted(measured.len(), "case"),
        sum(|case| case.truth.right),
        sum(|case| case.truth.wrong),
        sum(|case| case.engines.compared),
        sum(|case| case.engines.differing),
        sum(|case| case.engines.sampled),
        sum(|case| case.engines.outside),
        sum(|case| case.engines.slopes),
        sum(|case| case.engines.unexplained),
    )
}

fn badness(case: &Measured) -> (usize, u64, u64) {
    (case.broken.len(), case.certified().open(), case.native().iter().map(|run| run.wrong + run.missed).sum())
}

fn write_case(writer: &mut dyn Write, case: &Measured) -> io::Result<()> {
    let certified = case.certified();
    let faults: Vec<String> =
        case.sampled().iter().map(|run| format!("{}/{}", run.wrong, run.missed)).collect();
    writeln!(
        writer,
        "  {:<22} {:>6} {:>6} {:>6} {:>6} {:>8.1} | {:>9.1e} {:>9.1e} {:>9.1e} {:>22}",
        case.name,
        certified.ends.hit,
        certified.ends.touch,
        certified.ends.miss,
        certified.ends.undecided,
        certified.milliseconds,
        case.worst_sampled(|run| run.distance),
        case.worst_sampled(|run| run.residual),
        case.worst_sampled(|run| run.angle),
        faults.join(" "),
    )?;
    case.broken.iter().try_for_each(|problem| writeln!(writer, "    broken: {problem}"))
}
