//! `iso explain`: what a picture takes, and what becomes of its formula on the way to machine code.

use std::io::{self, Write};
use std::sync::Arc;
use std::time::Duration;

use iso_expr::{Interpreter, Program};
use iso_grid::Surface;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::clock::{milliseconds, timed};
use crate::failure::Failure;
use crate::flags::{ExplainFlags, Section, name_of};
use crate::formula::{Source, Text, minus_level};
use crate::hints::{Hint, hints};
use crate::notes::counted;
use crate::output::to_standard_output;
use crate::pictures::check_names;
use crate::plan::{PlanReport, plan};

/// Shows the plan of a picture and the stages of its formula.
pub(crate) fn run(flags: ExplainFlags) -> Result<(), Failure> {
    let sections = sections(&flags)?;
    let shown = || sections.iter().filter(|(section, _)| flags.shows(*section));
    to_standard_output(|writer| {
        if flags.sections.json {
            let object: Map<String, Value> = shown()
                .map(|(section, shown)| Ok((name_of(*section), serde_json::to_value(shown)?)))
                .collect::<serde_json::Result<_>>()?;
            serde_json::to_writer_pretty(&mut *writer, &object)?;
            return writeln!(writer);
        }
        shown().try_for_each(|(section, shown)| match shown {
            Shown::Plan(plan) => plan.write(writer),
            Shown::Stage(stage) => stage.write(writer, &name_of(*section)),
        })
    })
}

impl ExplainFlags {
    /// Whether a section is asked for: all are unless some are named.
    fn shows(&self, section: Section) -> bool {
        let named = &self.sections.sections;
        named.is_empty() || named.contains(&section)
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
        let size = counted(self.size, self.unit.trim_end_matches('s'));
        writeln!(writer, "{name}: {size}, {:.3} ms", self.milliseconds)?;
        for line in self.text.lines() {
            writeln!(writer, "    {line}")?;
        }
        writeln!(writer)
    }
}

fn sections(flags: &ExplainFlags) -> Result<Vec<(Section, Shown)>, Failure> {
    let picture = &flags.picture;
    check_names(&picture.output)?;
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
    let surface = Surface::new(Arc::new(Interpreter), simplified.0.clone());
    let plan = plan(picture, &formula, &simplified.0)?;
    let (followed, time) = timed(|| plan.followed(&surface).program().clone());
    let signs = match followed == simplified.0 {
        true => Stage::new(followed.operations(), "operations", time, "F itself, as simplified".to_owned()),
        false => Stage::program(&(followed.clone(), time)),
    };
    let gradient = timed(|| followed.with_gradient().simplified());
    let native = native_stages(flags, &followed)?;
    // A model has no tree: its lines are the program.
    let tree = match &text {
        Text::Formula(ast) => ast.outline().to_string(),
        Text::Model(_) => String::new(),
    };
    let plan = PlanReport::new(&plan, &surface, program.operations());
    let stages = [
        (Section::Tree, Stage::new(tree.lines().count(), "lines", parse_time, tree)),
        (Section::Program, Stage::program(&(program, lower_time))),
        (Section::Hints, Stage::hints(&hints)),
        (Section::Simplified, Stage::program(&simplified)),
        (Section::Signs, signs),
        (Section::Gradient, Stage::program(&gradient)),
    ];
    let stages = stages.into_iter().chain(native).map(|(section, stage)| (section, Shown::Stage(stage)));
    Ok([(Section::Plan, Shown::Plan(plan))].into_iter().chain(stages).collect())
}

/// What becomes of a program on the way to native code, if that is asked for.
#[cfg(feature = "jit")]
fn native_stages(flags: &ExplainFlags, program: &Program) -> Result<Vec<(Section, Stage)>, Failure> {
    use crate::flags::KernelName;
    use iso_expr::CompileError;
    use iso_jit::{Jit, Kind};

    let kind = match flags.sections.kernel {
        KernelName::Point => Kind::Point,
        KernelName::Batch => Kind::Batch,
        KernelName::Boxes => Kind::Boxes,
    };
    if ![Section::Clif, Section::Assembly].into_iter().any(|section| flags.shows(section)) {
        return Ok(Vec::new());
    }
    let listing = match Jit::new()?.listing(program, kind) {
        Err(refusal @ CompileError::TooLarge { .. }) => {
            let refused = |unit| Stage::new(0, unit, Duration::ZERO, refusal.to_string());
            return Ok(vec![(Section::Clif, refused("lines")), (Section::Assembly, refused("bytes"))]);
        }
        listing => listing?,
    };
    let clif = Stage::new(listing.clif.lines().count(), "lines", listing.compile_time, listing.clif);
    let assembly = Stage::new(listing.code_bytes, "bytes", listing.compile_time, listing.assembly);
    Ok(vec![(Section::Clif, clif), (Section::Assembly, assembly)])
}

/// There are none in a program that is built without native code.
#[cfg(not(feature = "jit"))]
fn native_stages(_: &ExplainFlags, _: &Program) -> Result<Vec<(Section, Stage)>, Failure> {
    Ok(Vec::new())
}
