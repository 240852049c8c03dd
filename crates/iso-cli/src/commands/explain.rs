//! `iso explain`: what a picture takes, and what becomes of its formula on the way to machine code.

use std::io::{self, Write};
use std::sync::Arc;
use std::time::Duration;

use clap::ValueEnum;
use iso_expr::{Interpreter, Program};
use iso_grid::Surface;
use iso_jit::{Jit, Kind};
use serde::Serialize;
use serde_json::{Map, Value};

use crate::clock::{milliseconds, timed};
use crate::failure::Failure;
use crate::flags::{ExplainFlags, KernelName, Section};
use crate::formula::{Source, Text, minus_level};
use crate::hints::{Hint, hints};
use crate::output::to_standard_output;
use crate::plan::{PlanReport, plan};

/// Shows the plan of a picture and the stages of its formula.
pub(crate) fn run(flags: ExplainFlags) -> Result<(), Failure> {
    let wanted =
        |section: &Section| flags.sections.sections.is_empty() || flags.sections.sections.contains(section);
    let sections = sections(&flags)?;
    let shown = || sections.iter().filter(|(section, _)| wanted(section));
    to_standard_output(|writer| {
        if flags.sections.json {
            let object: Map<String, Value> = shown()
                .map(|(section, shown)| Ok((section.name(), serde_json::to_value(shown)?)))
                .collect::<serde_json::Result<_>>()?;
            serde_json::to_writer_pretty(&mut *writer, &object)?;
            return writeln!(writer);
        }
        shown().try_for_each(|(section, shown)| match shown {
            Shown::Plan(plan) => plan.write(writer),
            Shown::Stage(stage) => stage.write(writer, &section.name()),
        })
    })
}

impl Section {
    /// The section's name on the command line and in reports.
    fn name(self) -> String {
        self.to_possible_value().expect("no section is hidden").get_name().to_owned()
    }
}

/// What a section shows.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Shown {
    Plan(PlanReport),
    Stage(Stage),
}

/// What stands at the end of a stage.
#[derive(Debug, Serialize)]
struct Stage {
    size: usize,
    unit: &'static str,
    milliseconds: f64,
    text: String,
}

impl Stage {
    fn new(size: usize, unit: &'static str, time: Duration, text: String) -> Self {
        Self { size, unit, milliseconds: milliseconds(time), text }
    }

    fn hints((hints, time): &(Vec<Hint>, Duration)) -> Self {
        Self::new(hints.len(), "hints", *time, hints.iter().map(|hint| format!("{hint}\n")).collect())
    }

    fn program((program, time): &(Program, Duration)) -> Self {
        Self::new(program.operations(), "operations", *time, program.to_string())
    }

    fn write(&self, writer: &mut dyn Write, name: &str) -> io::Result<()> {
        writeln!(writer, "{name}: {} {}, {:.3} ms", self.size, self.unit, self.milliseconds)?;
        for line in self.text.lines() {
            writeln!(writer, "    {line}")?;
        }
        writeln!(writer)
    }
}

fn sections(flags: &ExplainFlags) -> Result<Vec<(Section, Shown)>, Failure> {
    let picture = &flags.picture;
    let source = Source::read(&picture.formula.formula)?;
    let (text, parse_time) = timed(|| source.parse());
    let text = text?;
    let (lowered, lower_time) = timed(|| {
        let formula = source.lower(&text, &picture.formula.settings)?;
        let program = minus_level(&formula, picture.level.level)?;
        Ok::<_, Failure>((formula, program))
    });
    let (formula, program) = lowered?;
    let hints = timed(|| hints(&program));
    let simplified = timed(|| program.simplified());
    let gradient = timed(|| simplified.0.with_gradient().simplified());
    let listing = Jit::new()?.listing(&simplified.0, kind(flags.sections.kernel))?;
    // A model has no tree: its lines are the program.
    let tree = match &text {
        Text::Formula(ast) => ast.outline().to_string(),
        Text::Model(_) => String::new(),
    };
    let surface = Surface::new(Arc::new(Interpreter), simplified.0.clone());
    let plan = PlanReport::new(&plan(picture, &formula, &simplified.0)?, &surface, program.operations());
    let stages = [
        (Section::Tree, Stage::new(tree.lines().count(), "lines", parse_time, tree)),
        (Section::Program, Stage::program(&(program, lower_time))),
        (Section::Hints, Stage::hints(&hints)),
        (Section::Simplified, Stage::program(&simplified)),
        (Section::Gradient, Stage::program(&gradient)),
        (
            Section::Clif,
            Stage::new(listing.clif.lines().count(), "lines", listing.compile_time, listing.clif),
        ),
        (Section::Assembly, Stage::new(listing.code_bytes, "bytes", listing.compile_time, listing.assembly)),
    ];
    let stages = stages.map(|(section, stage)| (section, Shown::Stage(stage)));
    Ok([(Section::Plan, Shown::Plan(plan))].into_iter().chain(stages).collect())
}

fn kind(name: KernelName) -> Kind {
    match name {
        KernelName::Point => Kind::Point,
        KernelName::Batch => Kind::Batch,
        KernelName::Boxes => Kind::Boxes,
    }
}
