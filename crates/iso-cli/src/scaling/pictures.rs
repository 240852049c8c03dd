//! What a picture takes.

use std::sync::Arc;

use iso_expr::{Engine, Interpreter};
use iso_grid::Method;
use iso_render::{Camera, Projection, Size, View};

use super::evaluations::interpreted;
use super::{Family, Formula};
use crate::clock::{Deadline, Spread};
use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::measurement::{Sample, Subject, Turn, in_turns};

/// What a picture of a formula takes, by the interpreter and by native code, in milliseconds.
#[derive(Clone, Debug)]
pub(crate) struct PictureTimes {
    pub(crate) family: Family,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// Width and height in pixels.
    pub(crate) side: u32,
    /// From programs to colours.
    pub(crate) total: [Spread; 2],
    /// Compiling alone, which is part of it.
    pub(crate) compile: [Spread; 2],
    /// Kernels that are interpreted in any case.
    pub(crate) interpreted: Vec<&'static str>,
}

/// How many times longer a picture of twice the side is expected to take.
const GROWTH: f64 = 4.0;

/// Measures pictures by the method certified, the engines in turns, the small pictures of all formulas first. Larger pictures of
/// a formula are left out once one is expected to take more than `patience` milliseconds, and all once the deadline has come.
pub(crate) fn measure_pictures(
    formulas: &[Formula],
    sides: &[u32],
    rounds: usize,
    patience: f64,
    deadline: Deadline,
    mut progress: impl FnMut(usize, usize),
) -> Result<Vec<PictureTimes>, Failure> {
    let engines: [Arc<dyn Engine>; 2] = [Arc::new(Interpreter), engine(EngineName::Jit)?];
    let mut expected = vec![0.0; formulas.len()];
    let interpreted = formulas.iter().map(interpreted).collect::<Result<Vec<_>, _>>()?;
    let mut found = Vec::new();
    for (number, &side) in sides.iter().enumerate() {
        for (place, formula) in formulas.iter().enumerate() {
            progress(number * formulas.len() + place, sides.len() * formulas.len());
            if expected[place] > patience {
                continue;
            }
            let Some(samples) = measure(&subject(formula, side)?, &engines, rounds, deadline)? else {
                return Ok(found);
            };
            let spreads = |figure: fn(&Sample) -> f64| {
                [0, 1]
                    .map(|engine: usize| Spread::of(&samples[engine].iter().map(figure).collect::<Vec<_>>()))
            };
            let total = spreads(|sample| sample.total.wall);
            let next =
                sides.get(number + 1).map_or(GROWTH, |&next| (f64::from(next) / f64::from(side)).powi(2));
            expected[place] = next * total[0].median.max(total[1].median);
            found.push(PictureTimes {
                family: formula.family,
                operations: formula.program.operations(),
                side,
                total,
                compile: spreads(|sample| sample.phases.compile.wall),
                interpreted: interpreted[place].clone(),
            });
        }
    }
    Ok(found)
}

fn subject(formula: &Formula, side: u32) -> Result<Subject, Failure> {
    let (region, projection) = (Family::region(), Projection::DEFAULT);
    let size =
        Size::new(side, side).map_err(|error| Failure::usage(error.to_string(), "choose other --sides"))?;
    let camera = Camera::new(View::DEFAULT, projection, &region, size)?;
    Ok(Subject { program: formula.program.clone(), region, projection, camera, size })
}

/// What the picture takes by each engine; `None` where the deadline came first.
fn measure(
    subject: &Subject,
    engines: &[Arc<dyn Engine>; 2],
    rounds: usize,
    deadline: Deadline,
) -> Result<Option<[Vec<Sample>; 2]>, Failure> {
    let mut samples = [Vec::new(), Vec::new()];
    in_turns(engines.len(), rounds, deadline, |Turn { round: _, candidate }| {
        samples[candidate].push(subject.measure(&engines[candidate], &Method::CERTIFIED)?);
        Ok::<(), Failure>(())
    })?;
    Ok((!samples[1].is_empty()).then_some(samples))
}
