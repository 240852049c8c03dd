//! Error against run time: one picture, drawn with every engine, method and setting.

mod advice;
mod chart;
mod page;
mod plots;
mod quality;
mod setting;
mod table;

use std::sync::Arc;

use iso_expr::Engine;
use iso_grid::{Counters, Method, Outcome, Ray, Tracer, Workspace};
use iso_render::{Layers, Picture};
use serde::Serialize;

use crate::clock::{Deadline, Spread};
use crate::comparison::Answers;
use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::machine::Machine;
use crate::measurement::{Sample, Subject, Turn, in_turns};

pub(crate) use page::write_page;
pub(crate) use plots::{cells_plot, error_plot};
pub(crate) use quality::Quality;
pub(crate) use setting::{Setting, settings};
pub(crate) use table::write_table;

/// A method with its settings, as measured. Its fields are the keys of `runs` in report.json.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Run {
    /// What was run.
    #[serde(flatten)]
    pub(crate) setting: Setting,
    /// How often it was measured.
    pub(crate) repetitions: usize,
    /// All of the picture from programs to colours.
    pub(crate) milliseconds: Spread,
    /// The parts of the middle repetition, whose sum is its time.
    pub(crate) phases: Parts,
    /// What the answers are worth.
    pub(crate) quality: Quality,
    /// What was done.
    pub(crate) counters: Counters,
}

/// What the middle repetition took: the lower one of two middle ones. Times are in milliseconds.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Parts {
    /// The sum of the five times that follow.
    pub(crate) total: f64,
    /// From programs to kernels.
    pub(crate) compile: f64,
    /// What the method prepares before the first ray.
    pub(crate) preprocess: f64,
    /// Following rays.
    pub(crate) trace: f64,
    /// Normals and colours.
    pub(crate) shade: f64,
    /// What belongs to none of these.
    pub(crate) other: f64,
    /// Time on processors, all threads together.
    pub(crate) processor: Option<f64>,
    /// The most memory that the process held in any repetition, in MiB; what earlier runs left to it is part of it.
    pub(crate) peak_memory: Option<f64>,
}

impl Parts {
    fn of(samples: &[Sample]) -> Self {
        let mut sorted = samples.to_vec();
        sorted.sort_by(|one, other| one.total.total_cmp(&other.total));
        let middle = sorted[(sorted.len() - 1) / 2];
        Self {
            total: middle.total,
            compile: middle.phases.compile,
            preprocess: middle.phases.preprocess,
            trace: middle.phases.trace,
            shade: middle.phases.shade,
            other: middle.other(),
            processor: middle.processor,
            peak_memory: samples.iter().filter_map(|sample| sample.peak_memory).reduce(f64::max),
        }
    }
}

/// All that was measured so far. Its fields are the keys of report.json.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    /// The version of `iso`.
    pub(crate) version: &'static str,
    /// Where and when it was measured.
    pub(crate) machine: Machine,
    /// The formula as it was given.
    pub(crate) formula: String,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// The lower corner of the box.
    pub(crate) box_min: [f64; 3],
    /// The upper corner of the box.
    pub(crate) box_max: [f64; 3],
    /// The picture's width in pixels.
    pub(crate) width: u32,
    /// The picture's height in pixels.
    pub(crate) height: u32,
    /// Threads that worked.
    pub(crate) threads: usize,
    /// What to use, and what it costs.
    pub(crate) advice: String,
    /// What to know before the figures are trusted.
    pub(crate) notes: Vec<String>,
    /// A row for each setting.
    pub(crate) runs: Vec<Run>,
}

/// The sweep over all settings.
pub(crate) struct Sweep {
    pub(crate) subject: Subject,
    pub(crate) formula: String,
    pub(crate) settings: Vec<Setting>,
    pub(crate) rounds: usize,
    pub(crate) deadline: Deadline,
}

/// What is known of a setting so far.
struct Measured {
    quality: Quality,
    counters: Counters,
    samples: Vec<Sample>,
}

impl Sweep {
    /// Measures all settings in turns. `publish` is given what is known, and how many of all measurements are done, after
    /// each of them, and at last.
    pub(crate) fn run(
        &self,
        mut publish: impl FnMut(&Report, usize, usize) -> Result<(), Failure>,
    ) -> Result<Report, Failure> {
        let proven = self.proven()?;
        let engines = [engine(EngineName::Jit)?, engine(EngineName::Interp)?];
        let mut measured: Vec<Option<Measured>> = self.settings.iter().map(|_| None).collect();
        let (mut done, all) = (0, self.rounds * self.settings.len());
        let complete =
            in_turns(self.settings.len(), self.rounds, self.deadline, |Turn { round: _, candidate }| {
                let setting = &self.settings[candidate];
                let engine = &engines[usize::from(setting.engine == EngineName::Interp)];
                if measured[candidate].is_none() {
                    // It also fills caches, so that the first repetition is like the others.
                    measured[candidate] = Some(self.judge(engine, &setting.method, &proven)?);
                }
                let sample = self.subject.measure(engine, &setting.method)?;
                if let Some(measured) = &mut measured[candidate] {
                    measured.samples.push(sample);
                }
                done += 1;
                publish(&self.report(&measured, &proven, false), done, all)
            })?;
        let report = self.report(&measured, &proven, complete);
        publish(&report, done, all)?;
        Ok(report)
    }

    /// What is proven of each ray by itself.
    fn proven(&self) -> Result<Picture, Failure> {
        let method = Method::CERTIFIED;
        let layers = Layers { normals: true, outcomes: true, ..Layers::COLOR };
        let alone = |tracer| Box::new(Alone(tracer)) as Box<dyn Tracer>;
        Ok(self.subject.draw(&engine(EngineName::Jit)?, &method, layers, alone)?.picture)
    }

    fn judge(
        &self,
        engine: &Arc<dyn Engine>,
        method: &Method,
        proven: &Picture,
    ) -> Result<Measured, Failure> {
        let layers = Layers { normals: true, outcomes: true, ..Layers::COLOR };
        let drawn = self.subject.draw(engine, method, layers, |tracer| tracer)?;
        let quality = Quality::of(&self.subject, proven, &drawn.picture)?;
        Ok(Measured { quality, counters: drawn.counters, samples: Vec::new() })
    }

    fn report(&self, measured: &[Option<Measured>], proven: &Picture, complete: bool) -> Report {
        let measured_settings = self.settings.iter().zip(measured);
        let runs: Vec<Run> = measured_settings
            .filter_map(|(setting, measured)| Some((setting, measured.as_ref()?)))
            .filter(|(_, measured)| !measured.samples.is_empty())
            .map(|(setting, measured)| {
                let totals: Vec<f64> = measured.samples.iter().map(|sample| sample.total).collect();
                Run {
                    setting: setting.clone(),
                    repetitions: totals.len(),
                    milliseconds: Spread::of(&totals),
                    phases: Parts::of(&measured.samples),
                    quality: measured.quality,
                    counters: measured.counters,
                }
            })
            .collect();
        let mut notes = advice::notes(&runs, proven);
        if !complete {
            let wanted = self.rounds;
            notes.push(format!(
                "The sweep was stopped early: {} of {} settings were measured, {} of them {wanted} times.",
                runs.len(),
                self.settings.len(),
                runs.iter().filter(|run| run.repetitions == wanted).count()
            ));
        }
        let Subject { program, region, size, .. } = &self.subject;
        Report {
            version: env!("CARGO_PKG_VERSION"),
            machine: Machine::here(),
            formula: self.formula.clone(),
            operations: program.operations(),
            box_min: region.min().to_array(),
            box_max: region.max().to_array(),
            width: size.width(),
            height: size.height(),
            threads: rayon::current_num_threads(),
            advice: advice::advice(&runs, size.pixels()),
            notes,
            runs,
        }
    }
}

/// A method that follows each ray by itself, so that what it says of a ray owes nothing to the ray's neighbours.
struct Alone(Box<dyn Tracer>);

impl Tracer for Alone {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut [Outcome]) {
        self.0.trace(workspace, rays, outcomes);
    }

    fn preprocessing(&self) -> Counters {
        self.0.preprocessing()
    }
}

/// The answers that a picture with the layers `outcomes` and `normals` holds.
fn answers(picture: &Picture) -> Answers {
    Answers { outcomes: picture.outcomes.clone(), normals: picture.normals.clone() }
}
