//! The program `iso`: see F(x, y, z) = C.
//!
//! Raw flags ([`flags`]) become checked requests, and requests become results ([`commands`]). Whatever goes wrong comes up as
//! one [`failure::Failure`], which [`report`] draws.

mod camera;
mod chart;
mod clock;
mod commands;
mod comparison;
mod diagnostics;
mod engine;
mod evaluation;
mod failure;
mod flags;
mod formula;
mod hints;
mod html;
mod interruption;
mod machine;
mod measurement;
mod method;
mod notes;
mod output;
mod pictures;
mod plan;
mod progress;
mod report;
mod rounding;
mod scaling;
mod stress;
mod summary;
mod table;
mod values;

use std::env;
use std::process::ExitCode;

use clap::Parser;

use failure::Failure;
use flags::{Command, Flags};

fn main() -> ExitCode {
    let flags = Flags::try_parse().unwrap_or_else(|error| {
        let words: Vec<String> = env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
        flags::with_tip(error, &words).exit()
    });
    match run(flags.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_closed_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            diagnostics::print(&failure);
            ExitCode::from(failure.exit_code())
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    interruption::listen()?;
    match command {
        Command::Render(flags) => commands::render::run(*flags),
        Command::Eval(flags) => commands::eval::run(flags),
        Command::Trace(flags) => commands::trace::run(flags),
        Command::Explain(flags) => commands::explain::run(*flags),
        Command::Bench(flags) => commands::bench::run(flags),
        Command::Engines(flags) => commands::engines::run(flags),
        Command::Report(flags) => commands::report::run(*flags),
        Command::Stress(flags) => commands::stress::run(flags),
        Command::Completions { shell } => commands::completions::run(shell),
    }
}
