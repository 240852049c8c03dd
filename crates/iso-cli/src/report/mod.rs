//! Error against run time: pictures, drawn with every engine, method and setting.

mod advice;
mod axes;
mod images;
mod page;
mod phases;
mod plots;
mod quality;
mod scenes;
mod section;
mod table;

use serde::Serialize;

use crate::clock::Deadline;
use crate::failure::Failure;
use crate::machine::Machine;
use crate::measurement::Subject;
use crate::scaling::{Evaluation, Formula, measure_evaluations};

pub(crate) use axes::{Axes, Setting};
pub(crate) use page::write_page;
pub(crate) use plots::plots;
pub(crate) use scenes::scenes;
pub(crate) use section::{Run, Section};
pub(crate) use table::write_table;

use section::Study;

/// A surface to be drawn in all ways.
pub(crate) struct Case {
    /// What it is called.
    pub(crate) name: String,
    /// The formula as it was given.
    pub(crate) formula: String,
    /// What is to be known of it; empty where there is nothing.
    pub(crate) note: String,
    pub(crate) subject: Subject,
}

/// All that was measured so far. Its fields are the keys of report.json.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    /// The version of `iso`.
    pub(crate) version: &'static str,
    /// Where and when it was measured.
    pub(crate) machine: Machine,
    /// The pictures' width in pixels.
    pub(crate) width: u32,
    /// The pictures' height in pixels.
    pub(crate) height: u32,
    /// Threads that worked.
    pub(crate) threads: usize,
    /// What to know of the report as a whole.
    pub(crate) notes: Vec<String>,
    /// What was measured of each formula.
    pub(crate) formulas: Vec<Section>,
    /// What an evaluation takes by each engine as formulas grow; empty unless both engines are compared.
    pub(crate) engines: Vec<Evaluation>,
}

/// The sweep over all settings, for each of the cases.
pub(crate) struct Sweep {
    /// At least one. All pictures have one size.
    pub(crate) cases: Vec<Case>,
    pub(crate) settings: Vec<Setting>,
    /// Formulas on which the engines are compared, from small to large.
    pub(crate) growing: Vec<Formula>,
    pub(crate) rounds: usize,
    /// For all cases together: each gets a fair part of what those before it left.
    pub(crate) deadline: Deadline,
}

/// How often evaluations of growing formulas are measured at most, and the part of the budget that they may take.
const MOST_ROUNDS: usize = 3;
const CLAIMANTS: usize = 6;

impl Sweep {
    /// Measures all settings of each case in turns. After each measurement `publish` is told how many of all are done, and
    /// may ask for the report of what is known.
    pub(crate) fn run(
        &self,
        mut publish: impl FnMut(usize, usize, &dyn Fn() -> Report) -> Result<(), Failure>,
    ) -> Result<Report, Failure> {
        let (rounds, share) = (self.rounds.min(MOST_ROUNDS), self.deadline.share(CLAIMANTS));
        let engines = measure_evaluations(&self.growing, rounds, share, |_, _| ())?;
        let each = self.rounds * self.settings.len();
        let mut finished: Vec<Section> = Vec::new();
        for (number, case) in self.cases.iter().enumerate() {
            if self.deadline.is_over() {
                break;
            }
            let deadline = self.deadline.share(self.cases.len() - number);
            let mut study = Study::new(case, &self.settings)?;
            study.run(self.rounds, deadline, |study, done| {
                let report =
                    || self.report(finished.iter().cloned().chain([study.section()]).collect(), &engines);
                publish(number * each + done, self.cases.len() * each, &report)
            })?;
            finished.push(study.finish()?);
        }
        Ok(self.report(finished, &engines))
    }

    fn report(&self, formulas: Vec<Section>, engines: &[Evaluation]) -> Report {
        let size = self.cases[0].subject.size;
        let left_out: Vec<&str> =
            self.cases[formulas.len()..].iter().map(|case| case.name.as_str()).collect();
        let mut notes = Vec::new();
        if !left_out.is_empty() {
            notes.push(format!(
                "The sweep was stopped early: nothing was measured of {}.",
                left_out.join(", ")
            ));
        }
        Report {
            version: env!("CARGO_PKG_VERSION"),
            machine: Machine::here(),
            width: size.width(),
            height: size.height(),
            threads: rayon::current_num_threads(),
            notes,
            formulas,
            engines: engines.to_vec(),
        }
    }
}
