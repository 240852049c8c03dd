//! Honest measurements of pictures: in turns, so that a change of the machine's speed meets all alike.

use std::fs;
use std::sync::Arc;

use iso_expr::{Engine, Program};
use iso_grid::{Counters, Method, Region, Surface, Tracer};
use iso_render::{
    Camera, Layers, Picture, Plan, Projection, Scene, Shading, Size, Smoothing, Wanted, render,
};

use crate::clock::{Deadline, Phases, add_to, milliseconds, processor_time, timed};
use crate::failure::Failure;

/// Which candidate is measured for which time, both counted from 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) round: usize,
    pub(crate) candidate: usize,
}

/// Measures each candidate once a round, until all `rounds` are done or the deadline has come. Says whether all are done.
pub(crate) fn in_turns<E>(
    candidates: usize,
    rounds: usize,
    deadline: Deadline,
    mut measure: impl FnMut(Turn) -> Result<(), E>,
) -> Result<bool, E> {
    for round in 0..rounds {
        for candidate in 0..candidates {
            if deadline.is_over() {
                return Ok(false);
            }
            measure(Turn { round, candidate })?;
        }
    }
    Ok(true)
}

/// What one picture took once. Times are in milliseconds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// From programs to colours; parsing and files are left out.
    pub(crate) total: f64,
    /// The parts of `total`.
    pub(crate) phases: Phases,
    /// Time on processors, all threads together.
    pub(crate) processor: Option<f64>,
    /// The most memory that the process held meanwhile, in MiB.
    pub(crate) peak_memory: Option<f64>,
}

impl Sample {
    /// What of the total belongs to no phase.
    pub(crate) fn other(&self) -> f64 {
        self.total - self.phases.total()
    }
}

/// A picture to be drawn by one method or another.
pub(crate) struct Subject {
    /// The simplified program of F − C.
    pub(crate) program: Program,
    pub(crate) region: Region,
    pub(crate) projection: Projection,
    pub(crate) camera: Camera,
    pub(crate) size: Size,
}

impl Subject {
    /// Draws the picture once and says what it took.
    pub(crate) fn measure(&self, engine: &Arc<dyn Engine>, method: &Method) -> Result<Sample, Failure> {
        forget_peak_memory();
        let before = processor_time();
        let (drawn, total) = timed(|| self.draw(engine, method, Layers::COLOR, |tracer| tracer));
        let processor = before.zip(processor_time()).map(|(before, after)| milliseconds(after - before));
        let Drawn { phases, .. } = drawn?;
        Ok(Sample { total: milliseconds(total), phases, processor, peak_memory: peak_memory() })
    }

    /// Draws the picture with `layers`, following rays as `adapt` makes of the method.
    pub(crate) fn draw(
        &self,
        engine: &Arc<dyn Engine>,
        method: &Method,
        layers: Layers,
        adapt: impl FnOnce(Box<dyn Tracer>) -> Box<dyn Tracer>,
    ) -> Result<Drawn, Failure> {
        let mut phases = Phases::default();
        let plan = Plan::new(&Wanted {
            program: &self.program,
            method: *method,
            has_parameters: false,
            projection: Some(self.projection),
            box_is_given: true,
            layers,
            smoothing: Smoothing::NONE,
        });
        let surface = Surface::new(Arc::clone(engine), self.program.clone());
        add_to(&mut phases.compile, || plan.compile(&surface))?;
        let tracer = adapt(add_to(&mut phases.preprocess, || plan.tracer(&surface, self.region))?);
        let shading = Shading::new(&self.camera, false);
        let scene = Scene {
            plan: &plan,
            surface: &surface,
            tracer: tracer.as_ref(),
            camera: &self.camera,
            shading: &shading,
        };
        let picture = render(&scene, self.size, &|_, _| ())?;
        phases.trace = 1e3 * picture.trace_seconds;
        phases.shade = 1e3 * picture.shade_seconds;
        let mut counters = picture.counters;
        counters += tracer.preprocessing();
        Ok(Drawn { picture, counters, phases })
    }
}

/// A picture, and what drawing it took.
pub(crate) struct Drawn {
    pub(crate) picture: Picture,
    pub(crate) counters: Counters,
    pub(crate) phases: Phases,
}

/// Lets Linux count the peak of this process's memory anew; elsewhere nothing happens.
fn forget_peak_memory() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The most memory that this process held since the peak was forgotten, in MiB, where the system tells.
fn peak_memory() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn candidates_take_turns() {
        let mut turns = Vec::new();
        let done = in_turns(2, 2, Deadline::never(), |turn| {
            turns.push((turn.round, turn.candidate));
            Ok::<(), ()>(())
        });
        assert_eq!((done, turns), (Ok(true), vec![(0, 0), (0, 1), (1, 0), (1, 1)]));
    }

    #[test]
    fn nothing_is_begun_after_the_deadline() {
        let done = in_turns(2, 2, Deadline::after(Duration::ZERO), |_| Err("begun"));
        assert_eq!(done, Ok(false));
    }
}
