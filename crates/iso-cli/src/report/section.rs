//! What is measured of one formula.

use std::sync::Arc;

use iso_expr::Engine;
use iso_grid::{Counters, Method, Outcomes, Ray, Tracer, Workspace};
use iso_render::{Layers, Picture};
use serde::Serialize;

use super::images::{Image, error_image, proven_image, telling};
use super::phases::Times;
use super::quality::{Quality, verdicts};
use super::{Case, Setting, advice};
use crate::clock::{Deadline, Spread};
use crate::comparison::Verdict;
use crate::engine::engine;
use crate::failure::Failure;
use crate::flags::EngineName;
use crate::measurement::{Drawn, Sample, Subject, Turn, in_turns};

/// What was measured of one formula. Its fields are the keys of `formulas` in report.json.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Section {
    /// What the formula is called.
    pub(crate) name: String,
    /// The formula as it was given.
    pub(crate) formula: String,
    /// What is to be known of the surface; empty where there is nothing.
    pub(crate) note: String,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// The lower corner of the box.
    pub(crate) box_min: [f64; 3],
    /// The upper corner of the box.
    pub(crate) box_max: [f64; 3],
    /// What to use, and what it costs.
    pub(crate) advice: String,
    /// What to know before the figures are trusted.
    pub(crate) notes: Vec<String>,
    /// A row for each setting.
    pub(crate) runs: Vec<Run>,
    /// The proven picture, and where errors sit in others.
    #[serde(skip)]
    pub(crate) images: Vec<Image>,
}

/// A method with its settings, as measured. Its fields are the keys of `runs` in report.json.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Run {
    /// What was run.
    #[serde(flatten)]
    pub(crate) setting: Setting,
    /// How often it was measured.
    pub(crate) repetitions: usize,
    /// Milliseconds of the picture and its phases.
    pub(crate) milliseconds: Times,
    /// The most memory that the process held in any repetition, in MiB; what earlier runs left to it is part of it.
    pub(crate) peak_memory: Option<f64>,
    /// What the answers are worth.
    pub(crate) quality: Quality,
    /// What was done.
    pub(crate) counters: Counters,
}

impl Run {
    /// The time of the whole picture.
    pub(crate) fn time(&self) -> Spread {
        self.milliseconds.spread.total
    }
}

/// The measurements of one formula, as far as they have come.
pub(super) struct Study<'a> {
    case: &'a Case,
    settings: &'a [Setting],
    engines: [Arc<dyn Engine>; 2],
    /// What is proven of each ray by itself.
    proven: Picture,
    measured: Vec<Option<Measured>>,
    wanted: usize,
    is_complete: bool,
    images: Vec<Image>,
}

/// What is known of a setting so far.
struct Measured {
    quality: Quality,
    counters: Counters,
    samples: Vec<Sample>,
}

/// What is kept of pictures that are judged.
const JUDGED: Layers = Layers { outcomes: true, ..Layers::COLOR };

impl<'a> Study<'a> {
    pub(super) fn new(case: &'a Case, settings: &'a [Setting]) -> Result<Self, Failure> {
        let engines = [engine(EngineName::Jit)?, engine(EngineName::Interp)?];
        let alone = |tracer| Box::new(Alone(tracer)) as Box<dyn Tracer>;
        let proven = case.subject.draw(&engines[0], &Method::CERTIFIED, JUDGED, alone)?.picture;
        Ok(Self {
            case,
            settings,
            engines,
            proven,
            measured: settings.iter().map(|_| None).collect(),
            wanted: 0,
            is_complete: false,
            images: Vec::new(),
        })
    }

    /// Measures all settings in turns, and says how many measurements are done after each of them.
    pub(super) fn run(
        &mut self,
        rounds: usize,
        deadline: Deadline,
        mut publish: impl FnMut(&Self, usize) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.wanted = rounds;
        let mut done = 0;
        self.is_complete =
            in_turns(self.settings.len(), rounds, deadline, |Turn { round: _, candidate }| {
                self.measure(candidate)?;
                done += 1;
                publish(self, done)
            })?;
        Ok(())
    }

    fn measure(&mut self, candidate: usize) -> Result<(), Failure> {
        let setting = &self.settings[candidate];
        if self.measured[candidate].is_none() {
            // It also fills caches, so that the first repetition is like the others.
            let (drawn, verdicts) = self.judge(setting)?;
            let quality = Quality::of(&verdicts, &self.proven, &drawn.picture);
            self.measured[candidate] =
                Some(Measured { quality, counters: drawn.counters, samples: Vec::new() });
        }
        let sample = self.case.subject.measure(self.engine(setting), &setting.method)?;
        if let Some(measured) = &mut self.measured[candidate] {
            measured.samples.push(sample);
        }
        Ok(())
    }

    fn engine(&self, setting: &Setting) -> &Arc<dyn Engine> {
        &self.engines[usize::from(setting.engine == EngineName::Interp)]
    }

    fn judge(&self, setting: &Setting) -> Result<(Drawn, Vec<Verdict>), Failure> {
        let subject = &self.case.subject;
        let drawn = subject.draw(self.engine(setting), &setting.method, JUDGED, |tracer| tracer)?;
        let verdicts = verdicts(subject, &self.proven, &drawn.picture)?;
        Ok((drawn, verdicts))
    }

    /// What is known by now, and where the errors of the most telling settings are.
    pub(super) fn finish(mut self) -> Result<Section, Failure> {
        self.images.push(proven_image(&self.proven)?);
        let runs = self.runs();
        for run in telling(&runs) {
            let (_, verdicts) = self.judge(&run.setting)?;
            self.images.push(error_image(run, self.case.subject.size, &verdicts)?);
        }
        Ok(self.section())
    }

    /// What is known by now.
    pub(super) fn section(&self) -> Section {
        let runs = self.runs();
        let mut notes = advice::notes(&runs, &self.proven);
        if !self.is_complete {
            notes.push(format!(
                "The sweep was stopped early: {} of {} settings were measured, {} of them {} times.",
                runs.len(),
                self.settings.len(),
                runs.iter().filter(|run| run.repetitions == self.wanted).count(),
                self.wanted
            ));
        }
        let Case { name, formula, note, subject } = self.case;
        let Subject { program, region, size, .. } = subject;
        Section {
            name: name.clone(),
            formula: formula.clone(),
            note: note.clone(),
            operations: program.operations(),
            box_min: region.min().to_array(),
            box_max: region.max().to_array(),
            advice: advice::advice(&runs, size.pixels()),
            notes,
            runs,
            images: self.images.clone(),
        }
    }

    fn runs(&self) -> Vec<Run> {
        let measured = self.settings.iter().zip(&self.measured);
        measured.filter_map(|(setting, measured)| run(setting, measured.as_ref()?)).collect()
    }
}

fn run(setting: &Setting, measured: &Measured) -> Option<Run> {
    let Measured { quality, counters, samples } = measured;
    (!samples.is_empty()).then(|| Run {
        setting: setting.clone(),
        repetitions: samples.len(),
        milliseconds: Times::of(samples),
        peak_memory: samples.iter().filter_map(|sample| sample.peak_memory).reduce(f64::max),
        quality: *quality,
        counters: *counters,
    })
}

/// A method that follows each ray by itself, so that what it says of a ray owes nothing to the ray's neighbours.
struct Alone(Box<dyn Tracer>);

impl Tracer for Alone {
    fn trace(&self, workspace: &mut Workspace, rays: &[Ray], outcomes: &mut Outcomes) {
        self.0.trace(workspace, rays, outcomes);
    }

    fn preprocessing(&self) -> Counters {
        self.0.preprocessing()
    }
}
