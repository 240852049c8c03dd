//! Honest measurements of pictures: in turns, so that a change of the machine's speed meets all alike.

use std::fs;
use std::sync::Arc;

use iso_expr::{Engine, Program};
use iso_grid::{Counters, Method, Region, Surface, Tracer};
use iso_render::{
    Camera, Layers, Look, Picture, Plan, Projection, Scene, Shading, Size, Smoothing, Wanted, render,
};

use crate::clock::{Cost, Deadline, weighed};
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

/// What one picture took once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// From programs to colours; parsing and files are left out.
    pub(crate) total: Cost,
    /// Its parts.
    pub(crate) phases: PhaseCosts,
    /// The most memory that the process held meanwhile, in MiB.
    pub(crate) peak_memory: Option<f64>,
}

/// What the phases of a picture cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhaseCosts {
    /// From programs to kernels.
    pub(crate) compile: Cost,
    /// What the method prepares before the first ray.
    pub(crate) preprocess: Cost,
    /// Following rays.
    pub(crate) trace: Cost,
    /// Normals and colours.
    pub(crate) shade: Cost,
}

impl Sample {
    /// What of the total belongs to no phase, on the wall.
    pub(crate) fn other(&self) -> f64 {
        let PhaseCosts { compile, preprocess, trace, shade } = self.phases;
        self.total.wall - (compile.wall + preprocess.wall + trace.wall + shade.wall)
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
        let (drawn, total) = weighed(|| self.draw(engine, method, Layers::COLOR, |tracer| tracer));
        Ok(Sample { total, phases: drawn?.phases, peak_memory: peak_memory() })
    }

    /// Draws the picture with `layers`, following rays as `adapt` makes of the method.
    pub(crate) fn draw(
        &self,
        engine: &Arc<dyn Engine>,
        method: &Method,
        layers: Layers,
        adapt: impl FnOnce(Box<dyn Tracer>) -> Box<dyn Tracer>,
    ) -> Result<Drawn, Failure> {
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
        let (compiled, compile) = weighed(|| plan.compile(&surface));
        compiled?;
        let (prepared, preprocess) = weighed(|| plan.tracer(&surface, self.region));
        let tracer = adapt(prepared?);
        let shading = Shading::new(&self.camera, &Look::DEFAULT);
        let scene = Scene {
            plan: &plan,
            surface: &surface,
            tracer: tracer.as_ref(),
            camera: &self.camera,
            shading: &shading,
        };
        let (rendered, cost) = weighed(|| render(&scene, self.size, &|_, _| ()));
        let picture = rendered?;
        // Threads trace and shade in turns: what they spent together is divided as their times on the wall are.
        let tracing = picture.trace_seconds / (picture.trace_seconds + picture.shade_seconds);
        let [trace, shade] = [tracing, 1.0 - tracing].map(|part| cost.share(part));
        let mut counters = picture.counters;
        counters += tracer.preprocessing();
        Ok(Drawn { picture, counters, phases: PhaseCosts { compile, preprocess, trace, shade } })
    }
}

/// A picture, and what drawing it took.
pub(crate) struct Drawn {
    pub(crate) picture: Picture,
    pub(crate) counters: Counters,
    pub(crate) phases: PhaseCosts,
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
