//! Milliseconds that native kernels take to compile, against the number of operations.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use iso_benches::machine::Machine;
use iso_benches::results::Results;
use iso_benches::samples::{Samples, rounded};
use iso_benches::surfaces::SUBJECTS;
use iso_expr::{Ast, CompileError, Engine, FormulaError, Program};
use iso_grid::Kernel;
use iso_jit::Jit;

/// How often each kernel is compiled.
const TURNS: usize = 9;
/// Terms of the sums, for growth: each term takes seven operations.
const TERMS: [usize; 7] = [3, 10, 30, 100, 300, 700, 1_400];
/// The kernels of one formula, from the point kernel of F to the affine forms of F and its gradient.
const KERNELS: [&str; 9] = [
    "point",
    "batch",
    "batch+slope",
    "batch+gradient",
    "boxes",
    "boxes+gradient",
    "boxes+rounding",
    "forms",
    "parallel forms",
];

fn main() -> Result<(), Box<dyn Error>> {
    let machine = Machine::here();
    let columns = ["formula", "operations", "kernel", "kernel's operations", "turn", "milliseconds"];
    let mut results = Results::create("compile", &machine, &columns)?;
    println!("{machine}\nMilliseconds to compile: median of {TURNS}; - where the engine refuses.\n");
    print!("{:<12}{:>10}", "formula", "operations");
    KERNELS.iter().for_each(|kernel| print!("{kernel:>16}"));
    println!("{:>10}{:>10}", "all", "ahead");
    let surfaces = SUBJECTS.iter().map(|subject| (subject.name.to_owned(), subject.program()));
    let sums = TERMS.iter().map(|terms| (format!("sum {terms}"), sum_of_products(*terms)));
    for (name, program) in surfaces.chain(sums) {
        measure(&name, &program?, &mut results)?;
    }
    println!("\nEvery measurement is in benches/results/{}.", results.file_name());
    Ok(())
}

/// ∑ k·(x + aₖ)·(y − bₖ)·z: as deep as it is long, and all terms are different.
fn sum_of_products(terms: usize) -> Result<Program, FormulaError> {
    let term = |k: usize| format!("{k}.5*(x + 0.{k})*(y - 0.{k}1)*z");
    let text = (1..=terms).map(term).collect::<Vec<_>>().join(" + ");
    Ok(Ast::parse(&text)?.lower(&[])?.minus_level(1.0).simplified())
}

/// Compiles all kernels of a formula in turns, and prints a row.
fn measure(name: &str, value: &Program, results: &mut Results) -> Result<(), Box<dyn Error>> {
    let jit = Jit::new()?;
    let (gradient, rounding) = (value.with_gradient().simplified(), value.with_rounding().simplified());
    let has_forms = Kernel::Forms.pays(value);
    let forms = has_forms.then(|| gradient.with_forms()).flatten();
    let slope = value.with_slope().simplified();
    let parallel_forms = has_forms.then(|| slope.with_forms()).flatten();
    let operations = value.operations().to_string();
    let (mut all, mut ahead) = (0.0, 0.0);
    print!("{name:<12}{operations:>10}");
    for kernel in KERNELS {
        let program = match kernel {
            "batch+slope" => Some(&slope),
            "batch+gradient" | "boxes+gradient" => Some(&gradient),
            "boxes+rounding" => Some(&rounding),
            "forms" => forms.as_ref(),
            "parallel forms" => parallel_forms.as_ref(),
            _ => Some(value),
        };
        let Some(program) = program else {
            print!("{:>16}", "-");
            continue;
        };
        let mut milliseconds = Samples::default();
        for turn in 0..TURNS {
            let start = Instant::now();
            if compile(&jit, kernel, program).is_err() {
                break;
            }
            let time = start.elapsed().as_secs_f64() * 1e3;
            milliseconds.push(time);
            let (own, turn) = (program.operations().to_string(), turn.to_string());
            results.row([name, &operations, kernel, &own, &turn, &rounded(time, 5)])?;
        }
        if milliseconds.values().is_empty() {
            print!("{:>16}", "-");
        } else {
            let median = milliseconds.spread().median;
            all += median;
            ahead += if is_ahead(kernel, has_forms) { median } else { 0.0 };
            print!("{:>16}", rounded(median, 3));
        }
    }
    println!("{:>10}{:>10}", rounded(all, 3), rounded(ahead, 3));
    Ok(())
}

/// Whether a picture of parallel rays with normals compiles the kernel ahead.
fn is_ahead(kernel: &str, has_forms: bool) -> bool {
    match kernel {
        "batch" | "batch+slope" | "batch+gradient" | "boxes" => true,
        "parallel forms" => has_forms,
        "boxes+gradient" => !has_forms,
        _ => false,
    }
}

fn compile(jit: &Jit, kernel: &str, program: &Program) -> Result<(), CompileError> {
    match kernel {
        "point" => drop(black_box(jit.point(program)?)),
        "batch" | "batch+slope" | "batch+gradient" | "forms" | "parallel forms" => {
            drop(black_box(jit.batch(program)?))
        }
        _ => drop(black_box(jit.boxes(program)?)),
    }
    Ok(())
}
