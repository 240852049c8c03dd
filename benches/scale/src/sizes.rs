//! Nanoseconds a pixel against the width of the picture, on one thread and on two.

use std::error::Error;

use iso_benches::machine::Machine;
use iso_benches::results::Results;
use iso_benches::samples::{Samples, rounded};
use iso_benches::surfaces::Subject as Formula;
use plotters::chart::SeriesLabelPosition;

use crate::picture::{Subject, threads};
use crate::plot::{Curve, plot};

/// Widths of the square pictures, in pixels.
const SIDES: [u32; 6] = [128, 256, 512, 1024, 2048, 4096];
/// How often each is drawn.
const TURNS: usize = 5;
const SURFACES: [&str; 5] = ["paper", "tanglecube", "barth", "heart", "gyroid"];

/// Measures, prints a table, and draws a plot.
///
/// # Errors
/// When a picture cannot be drawn or a file cannot be written.
pub fn measure(machine: &Machine) -> Result<(), Box<dyn Error>> {
    let columns = ["surface", "side", "threads", "turn", "seconds"];
    let mut results = Results::create("scale-sizes", machine, &columns)?;
    let pools = [threads(1)?, threads(2)?];
    println!(
        "\nNanoseconds a pixel on two threads (and how many times faster that is than one): medians of {TURNS}.\n"
    );
    print!("{:<12}", "surface");
    SIDES.iter().for_each(|side| print!("{side:>16}"));
    println!();
    let mut curves = Vec::new();
    for name in SURFACES {
        let formula = Formula::named(name).ok_or("the surface is one of the common ones")?;
        let subject = Subject::new(&formula.program()?, formula.radius)?;
        let mut curve = Curve { name: name.to_owned(), points: Vec::new() };
        print!("{name:<12}");
        for side in SIDES {
            let mut seconds = [Samples::default(), Samples::default()];
            subject.draw(side, &pools[1])?;
            for turn in 0..TURNS {
                for (count, (pool, seconds)) in pools.iter().zip(&mut seconds).enumerate() {
                    let taken = subject.draw(side, pool)?;
                    seconds.push(taken);
                    let [side, count, turn] = [side.to_string(), (count + 1).to_string(), turn.to_string()];
                    results.row([name, &side, &count, &turn, &rounded(taken, 5)])?;
                }
            }
            let gain = seconds[0].over(&seconds[1]).spread().median;
            let pixel = 1e9 * seconds[1].spread().median / f64::from(side).powi(2);
            print!("{:>16}", format!("{} ({})", rounded(pixel, 3), rounded(gain, 3)));
            curve.points.push((f64::from(side), pixel));
        }
        println!();
        curves.push(curve);
    }
    let axes = ["width of the picture, pixels", "nanoseconds a pixel"];
    plot("sizes", axes, SeriesLabelPosition::UpperRight, &curves)?;
    println!("\nEvery measurement is in benches/results/{}.", results.file_name());
    Ok(())
}
