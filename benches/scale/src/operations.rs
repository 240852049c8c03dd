//! Milliseconds against the number of operations of a formula.

use std::error::Error;

use iso_benches::machine::Machine;
use iso_benches::results::Results;
use iso_benches::samples::{Samples, rounded};
use iso_expr::{Ast, FormulaError, Program};
use plotters::chart::SeriesLabelPosition;

use crate::picture::{Subject, threads};
use crate::plot::{Curve, plot};

/// Balls of a formula.
const BALLS: [usize; 6] = [2, 6, 20, 60, 200, 600];
/// The picture's width.
const SIDE: u32 = 128;
const TURNS: usize = 3;
/// Balls lie in a cube with sides of twice this length.
const RADIUS: f64 = 2.0;

/// What becomes of the balls.
#[derive(Clone, Copy)]
enum Kind {
    /// A field that falls off with the distance from each, so that all of them count everywhere.
    Blended,
    /// The union, of which a few count anywhere.
    Union,
}

/// Measures, prints a table, and draws a plot.
///
/// # Errors
/// When a picture cannot be drawn or a file cannot be written.
pub fn measure(machine: &Machine) -> Result<(), Box<dyn Error>> {
    let columns = ["formula", "balls", "operations", "turn", "preparation, seconds", "drawing, seconds"];
    let mut results = Results::create("scale-operations", machine, &columns)?;
    let pool = threads(2)?;
    println!("\nMilliseconds for {SIDE}x{SIDE} pixels by the number of operations: medians of {TURNS}.\n");
    println!("{:<10}{:>8}{:>12}{:>14}{:>12}", "formula", "balls", "operations", "preparation", "drawing");
    let mut curves = Vec::new();
    for (name, kind) in [("blended", Kind::Blended), ("union", Kind::Union)] {
        let mut preparing = Curve { name: format!("{name}: preparation"), points: Vec::new() };
        let mut drawing = Curve { name: format!("{name}: drawing"), points: Vec::new() };
        for balls in BALLS {
            let program = formula(kind, balls)?;
            let operations = program.operations();
            let [mut preparation, mut picture] = [Samples::default(), Samples::default()];
            for turn in 0..TURNS {
                let subject = Subject::new(&program, RADIUS)?;
                let taken = subject.draw(SIDE, &pool)?;
                preparation.push(subject.preparation);
                picture.push(taken);
                let counts = [balls.to_string(), operations.to_string(), turn.to_string()];
                let times = [subject.preparation, taken].map(|seconds| rounded(seconds, 5));
                results.row([name, &counts[0], &counts[1], &counts[2], &times[0], &times[1]])?;
            }
            let [preparation, picture] = [preparation, picture].map(|samples| 1e3 * samples.spread().median);
            let cells = [preparation, picture].map(|milliseconds| rounded(milliseconds, 3));
            println!("{name:<10}{balls:>8}{operations:>12}{:>14}{:>12}", cells[0], cells[1]);
            preparing.points.push((operations as f64, preparation));
            drawing.points.push((operations as f64, picture));
        }
        curves.extend([preparing, drawing]);
    }
    let axes = ["operations of the formula", "milliseconds"];
    plot("operations", axes, SeriesLabelPosition::UpperLeft, &curves)?;
    println!("\nEvery measurement is in benches/results/{}.", results.file_name());
    Ok(())
}

/// Balls spread over the cube by the golden ratio's sequence in three dimensions (Roberts 2018), smaller the more there are.
fn formula(kind: Kind, balls: usize) -> Result<Program, FormulaError> {
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    let squares = |ball: usize| {
        let place = STEPS.map(|step| 3.0 * ((0.5 + step * ball as f64) % 1.0) - 1.5);
        ["x", "y", "z"]
            .iter()
            .zip(place)
            .map(|(axis, at)| format!("({axis} - ({at:.4}))^2"))
            .collect::<Vec<_>>()
            .join(" + ")
    };
    let size = 0.9 * (balls as f64).powf(-1.0 / 3.0);
    let terms = (0..balls).map(|ball| match kind {
        Kind::Blended => format!("1/({} + 0.01)", squares(ball)),
        Kind::Union => format!("sqrt({}) - {size:.4}", squares(ball)),
    });
    let terms: Vec<_> = terms.collect();
    let text = match kind {
        Kind::Blended => format!("{:.4} - ({})", 2.0 / (size * size), terms.join(" + ")),
        Kind::Union => format!("min({})", terms.join(", ")),
    };
    Ok(Ast::parse(&text)?.lower(&[])?.minus_level(0.0).simplified())
}
