//! Nanoseconds an evaluation: the interpreter and the JIT beside the same formulas in Rust.
//!
//! Before anything is measured, all contenders must agree to the last bit.

mod batch;
mod contest;
mod formulas;
mod native;
mod operations;

use std::error::Error;
use std::time::Duration;

use iso_benches::machine::Machine;
use iso_benches::results::Results;
use iso_benches::samples::{Contender, Samples, measure_in_turns, rounded};
use iso_benches::surfaces::Subject;

use batch::{Batch, COUNT};
use contest::{Discipline, Entry, Formula};
use native::NATIVES;

/// How often each contender is measured.
const TURNS: usize = 51;
/// The least that one measurement takes: far more than the clock's resolution, and less than other programs are given at a
/// time, so that most measurements are not interrupted.
const LEAST: Duration = Duration::from_micros(300);

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Machine::here();
    let columns = ["formula", "operations", "kernel", "engine", "turn", "nanoseconds"];
    let mut results = Results::create("kernels", &machine, &columns)?;
    println!("{machine}\nNanoseconds an evaluation in batches of {COUNT}: median [quartiles].\n");
    print_heading();
    for native in &NATIVES {
        let subject = Subject::named(native.name).ok_or("a measured formula is not among the surfaces")?;
        let value = subject.program()?;
        let (slope, gradient) = (value.with_slope().simplified(), value.with_gradient().simplified());
        let batch = Batch::within(subject.radius);
        let formula = Formula { value: &value, slope: &slope, gradient: &gradient, native, batch: &batch };
        for discipline in Discipline::ALL {
            let entries = formula.entries(discipline)?;
            let measured = measure(native.name, discipline, entries)?;
            print_row(native.name, discipline, &measured);
            for (engine, nanoseconds) in &measured {
                for (turn, nanoseconds) in nanoseconds.values().iter().enumerate() {
                    let operations = value.with_powers_expanded().operations().to_string();
                    let (turn, nanoseconds) = (turn.to_string(), rounded(*nanoseconds, 5));
                    results.row([
                        native.name,
                        &operations,
                        discipline.name(),
                        engine,
                        &turn,
                        &nanoseconds,
                    ])?;
                }
            }
        }
    }
    println!("\nEvery measurement is in benches/results/{}.", results.file_name());
    Ok(())
}

/// Checks that all entries agree bit for bit, then measures them in turns: nanoseconds an evaluation.
fn measure(
    formula: &str,
    discipline: Discipline,
    mut entries: Vec<Entry<'_>>,
) -> Result<Vec<(&'static str, Samples)>, Box<dyn Error>> {
    let outputs: Vec<Vec<u64>> = entries.iter_mut().map(|entry| bits(entry, discipline)).collect();
    for (entry, output) in entries.iter().zip(&outputs) {
        if let Some(place) = (0..output.len()).find(|&place| output[place] != outputs[0][place]) {
            let [expected, given] = [&outputs[0], output].map(|output| f64::from_bits(output[place]));
            let (name, reference) = (entry.name, entries[0].name);
            return Err(format!(
                "{formula}, {}: {name} gives {given:?} for value {place}, {reference} {expected:?}",
                discipline.name()
            )
            .into());
        }
    }
    let mut contenders: Vec<_> = entries
        .into_iter()
        .map(|Entry { name, mut fill }| {
            let mut buffer = vec![0.0; discipline.room()];
            Contender::new(name, move || fill(std::hint::black_box(&mut buffer)))
        })
        .collect();
    measure_in_turns(&mut contenders, TURNS, LEAST);
    let nanoseconds = |contender: &Contender<'_>| -> Samples {
        contender.seconds.values().iter().map(|seconds| seconds * 1e9 / COUNT as f64).collect()
    };
    Ok(contenders.iter().map(|contender| (contender.name, nanoseconds(contender))).collect())
}

/// What an entry computes, any NaN standing for all of them.
fn bits(entry: &mut Entry<'_>, discipline: Discipline) -> Vec<u64> {
    let mut buffer = vec![0.0; discipline.room()];
    (entry.fill)(&mut buffer);
    buffer.iter().map(|value| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }).collect()
}

fn print_heading() {
    let names =
        ["interpreter", "assembled", "JIT", "Rust", "Rust, AVX-512", "JIT / Rust", "interpreter / JIT"];
    print!("{:<11}{:<15}", "formula", "kernel");
    names.iter().for_each(|name| print!("{name:>23}"));
    println!();
}

fn print_row(formula: &str, discipline: Discipline, measured: &[(&'static str, Samples)]) {
    let samples =
        |name: &str| measured.iter().find(|(engine, _)| *engine == name).map(|(_, samples)| samples);
    let ratio = |a: &str, b: &str| Some(samples(a)?.over(samples(b)?));
    let columns =
        ["interpreter", "assembled", "jit", "rust", "rust avx512"].map(|name| samples(name).cloned());
    print!("{formula:<11}{:<15}", discipline.name());
    for samples in columns.into_iter().chain([ratio("jit", "rust"), ratio("interpreter", "jit")]) {
        print!("{:>23}", samples.map_or("-".to_owned(), |samples| samples.spread().to_string()));
    }
    println!();
}
