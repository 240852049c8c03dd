//! The interpreter against native code, as formulas and pictures grow.

mod evaluations;
mod family;
mod pictures;
mod plots;

pub(crate) use evaluations::{Evaluation, measure_evaluations};
pub(crate) use family::{Family, Formula};
pub(crate) use pictures::{PictureTimes, measure_pictures};
pub(crate) use plots::{evaluation_plot, gain_plot};

use std::io::{self, Write};

use crate::flags::{EngineName, name_of};
use crate::table::{digits, write_row};

/// The names of the engines, in the order of all figures.
fn engines() -> impl Iterator<Item = String> {
    [EngineName::Interp, EngineName::Jit].into_iter().map(name_of)
}

/// Writes a row for each formula: what one evaluation takes.
pub(crate) fn write_evaluations(evaluations: &[Evaluation], writer: &mut dyn Write) -> io::Result<()> {
    let kinds = ["point_ns", "batch_ns", "compile_ms"];
    let columns = kinds.iter().flat_map(|kind| {
        engines().flat_map(move |engine| {
            ["", "_least", "_greatest"].map(|figure| format!("{engine}_{kind}{figure}"))
        })
    });
    let head = ["family", "operations", "jit_is_interpreted"].map(str::to_owned);
    write_row(writer, head.into_iter().chain(columns))?;
    evaluations.iter().try_for_each(|evaluation| {
        let Evaluation { family, operations, point, batch, compile, interpreted } = evaluation;
        let spreads = [point, batch, compile].into_iter().flatten();
        let figures = spreads.flat_map(|spread| [spread.median, spread.least, spread.greatest].map(digits));
        let head = [name_of(*family), operations.to_string(), interpreted.join(" ")];
        write_row(writer, head.into_iter().chain(figures))
    })
}

/// Writes a row for each formula and size of picture.
pub(crate) fn write_pictures(pictures: &[PictureTimes], writer: &mut dyn Write) -> io::Result<()> {
    let columns = engines().flat_map(|engine| {
        ["", "_least", "_greatest", "_compile"].map(|figure| format!("{engine}_ms{figure}"))
    });
    let head = ["family", "operations", "side", "jit_is_interpreted"].map(str::to_owned);
    write_row(writer, head.into_iter().chain(columns))?;
    pictures.iter().try_for_each(|picture| {
        let PictureTimes { family, operations, side, total, compile, interpreted } = picture;
        let figures = total.iter().zip(compile).flat_map(|(total, compile)| {
            [total.median, total.least, total.greatest, compile.median].map(digits)
        });
        let head = [name_of(*family), operations.to_string(), side.to_string(), interpreted.join(" ")];
        write_row(writer, head.into_iter().chain(figures))
    })
}
