//! What one evaluation takes.

use std::sync::Arc;

use iso_expr::{Engine, Interpreter};
use iso_grid::{Kernel, Surface};
use serde::Serialize;

use super::{Family, Formula};
use crate::clock::{Deadline, Spread, milliseconds, timed};
use crate::engine::{engine, native_code};
use crate::evaluation::SpreadPoints;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::measurement::{Turn, in_turns};

/// What one evaluation of a formula takes, by the interpreter and by native code.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Evaluation {
    #[serde(skip)]
    pub(crate) family: Family,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// Nanoseconds when each point is asked for by itself.
    pub(crate) point: [Spread; 2],
    /// Nanoseconds when all points are asked for together.
    pub(crate) batch: [Spread; 2],
    /// Milliseconds of compiling for points that are asked for together.
    pub(crate) compile: [Spread; 2],
    /// Kernels that are interpreted in any case, since native code would be too large or need too much stack.
    pub(crate) interpreted: Vec<&'static str>,
}

/// One measurement: a point alone, a point of many, compiling.
type Measured = [f64; 3];

/// Measures all formulas and both engines in turns, as often as the deadline allows. Formulas that were not measured by both
/// engines are left out.
pub(crate) fn measure_evaluations(
    formulas: &[Formula],
    rounds: usize,
    deadline: Deadline,
    mut progress: impl FnMut(usize, usize),
) -> Result<Vec<Evaluation>, Failure> {
    let engines: [Arc<dyn Engine>; 2] = [Arc::new(Interpreter), engine(EngineName::Jit)?];
    let points = SpreadPoints::over(&Family::region());
    let mut samples: Vec<Vec<Measured>> = vec![Vec::new(); 2 * formulas.len()];
    let all = rounds * samples.len();
    let mut done = 0;
    in_turns(samples.len(), rounds, deadline, |Turn { round: _, candidate }| {
        let (formula, engine) = (&formulas[candidate / 2], &engines[candidate % 2]);
        samples[candidate].push(measure(formula, engine.as_ref(), &points)?);
        done += 1;
        progress(done, all);
        Ok::<(), Failure>(())
    })?;
    let measured = formulas.iter().zip(samples.chunks(2)).filter(|(_, samples)| !samples[1].is_empty());
    measured.map(|(formula, samples)| evaluation(formula, samples)).collect()
}

fn measure(formula: &Formula, engine: &dyn Engine, points: &SpreadPoints) -> Result<Measured, Failure> {
    let (batch, compile) = timed(|| engine.batch(&formula.program));
    let point = engine.point(&formula.program)?;
    Ok([points.one_by_one(&*point), points.together(&*batch?), milliseconds(compile)])
}

fn evaluation(formula: &Formula, samples: &[Vec<Measured>]) -> Result<Evaluation, Failure> {
    let spreads = |kind: usize| {
        [0, 1].map(|engine: usize| {
            Spread::of(&samples[engine].iter().map(|measured| measured[kind]).collect::<Vec<_>>())
        })
    };
    Ok(Evaluation {
        family: formula.family,
        operations: formula.program.operations(),
        point: spreads(0),
        batch: spreads(1),
        compile: spreads(2),
        interpreted: interpreted(formula)?,
    })
}

/// The kernels of a formula for which there is no native code.
pub(super) fn interpreted(formula: &Formula) -> Result<Vec<&'static str>, Failure> {
    let surface = Surface::new(native_code()?, formula.program.clone());
    let wanted = Kernel::ALL.into_iter().filter(|kernel| kernel.pays(&formula.program));
    let too_large = wanted.filter(|&kernel| surface.compile(kernel).is_err());
    Ok(too_large.map(Kernel::name).collect())
}
