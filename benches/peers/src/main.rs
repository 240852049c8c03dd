//! The same surfaces, view, size and threads for this project, fidget and POV-Ray: time and depth errors.

mod arguments;
mod comparison;
mod depths;
mod fidget_engines;
mod fidget_trees;
mod iso;
mod model;
mod povray;
mod renderer;
mod summary;
mod view;

use std::error::Error;

use clap::Parser;
use iso_benches::machine::Machine;
use iso_benches::results::Results;

use arguments::Arguments;
use comparison::Comparison;
use povray::PovRay;
use summary::Summary;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let subjects = arguments.subjects()?;
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let machine = Machine::here();
    println!("{machine}; {} threads", arguments.threads);
    if !PovRay::is_installed() {
        println!("POV-Ray is not installed; it is left out.");
    }
    let mut times = Results::create("peers-times", &machine, &Comparison::TIME_COLUMNS)?;
    let mut errors = Results::create("peers-errors", &machine, &Comparison::ERROR_COLUMNS)?;
    for &size in &arguments.sizes {
        let mut summary = Summary::default();
        summary.print_heading(size);
        for subject in &subjects {
            let comparison = Comparison::run(subject, size, &arguments)?;
            comparison.write(&mut times, &mut errors)?;
            summary.add(&comparison);
        }
        summary.print_end();
    }
    println!("\nEvery measurement is in benches/results/{} and {}.", times.file_name(), errors.file_name());
    Ok(())
}
