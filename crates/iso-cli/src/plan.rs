//! The plan of a picture, from flags to reports.

use std::io::{self, Write};

use iso_expr::{Axis, Formula, Program};
use iso_grid::{Accuracy, Kernel, Method, Surface};
use iso_render::{Buffer, Decision, Given, Layers, Pass, Plan, Smoothing, Wanted};
use serde::Serialize;

use crate::camera::projection;
use crate::failure::Failure;
use crate::flags::{LayerFlags, PictureFlags};
use crate::method::method;
use crate::pictures::layers;

/// The plan of the picture that `flags` describe, of the surface of a formula whose F − C is simplified to `program`.
pub(crate) fn plan(flags: &PictureFlags, formula: &Formula, program: &Program) -> Result<Plan, Failure> {
    Ok(Plan::new(&Wanted {
        program,
        method: method(&flags.method, usual_accuracy(&flags.output))?,
        has_parameters: !formula.parameters().is_empty(),
        projection: Some(projection(&flags.camera)),
        box_is_given: flags.method.region.region.is_some(),
        layers: layers(&flags.output),
        smoothing: flags.output.smooth,
    }))
}

/// How narrowly roots are enclosed unless asked otherwise: colours need a share of a pixel, numbers that are written more.
fn usual_accuracy(output: &LayerFlags) -> Accuracy {
    let are_numbers_written =
        [&output.depth, &output.normals, &output.points].into_iter().any(Option::is_some);
    if are_numbers_written { Accuracy::NARROW } else { Accuracy::Pixels }
}

/// The plan of following rays that are no picture's by `method`, up to outcomes and normals.
pub(crate) fn plan_of_rays(method: Method, program: &Program, box_is_given: bool) -> Plan {
    Plan::new(&Wanted {
        program,
        method,
        has_parameters: false,
        projection: None,
        box_is_given,
        layers: Layers { normals: true, outcomes: true, ..Layers::default() },
        smoothing: Smoothing::NONE,
    })
}

/// A plan as it is reported. Its fields are the keys of the object `plan`.
#[derive(Debug, Serialize)]
pub(crate) struct PlanReport {
    /// The method of intersection.
    method: &'static str,
    /// How narrowly it encloses roots, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<String>,
    /// Operations of the program of F − C.
    operations: Operations,
    /// The arguments that F takes.
    arguments: Vec<Line>,
    /// What is a constant of the kernels.
    constants: Vec<Line>,
    /// The kernels.
    kernels: Vec<Line>,
    /// How many of them are compiled.
    kernels_compiled: usize,
    /// The stages of the work.
    passes: Vec<Line>,
    /// How many of them are left out.
    passes_skipped: usize,
    /// What is kept for each pixel.
    buffers: Vec<Line>,
}

/// How many operations one evaluation takes.
#[derive(Debug, Serialize)]
struct Operations {
    /// As the formula was read.
    before: usize,
    /// After simplification.
    after: usize,
    /// Of another function with the same signs, if rays are followed by one.
    #[serde(skip_serializing_if = "Option::is_none")]
    by_signs: Option<usize>,
}

/// A decision.
#[derive(Debug, Serialize)]
struct Line {
    name: &'static str,
    taken: bool,
    /// Of a kernel that is taken: the operations of one evaluation.
    #[serde(skip_serializing_if = "Option::is_none")]
    operations: Option<usize>,
    reason: &'static str,
}

impl PlanReport {
    /// What `plan` decides for `surface`, whose program took `before` operations before it was simplified.
    pub(crate) fn new(plan: &Plan, surface: &Surface, before: usize) -> Self {
        let followed = plan.followed(surface);
        let kernels = plan.kernels().iter().map(|decision| {
            let operations = decision.taken.then(|| {
                let surface = plan.surface_of(decision.subject, surface);
                surface.program_of(decision.subject).operations()
            });
            Line { operations, ..Line::new(decision, Kernel::name) }
        });
        let [after, by_signs] = [surface, followed].map(|surface| surface.program().operations());
        let by_signs = (surface.program() != followed.program()).then_some(by_signs);
        Self {
            method: plan.method().name(),
            accuracy: plan.method().accuracy().map(|accuracy| accuracy.to_string()),
            operations: Operations { before, after, by_signs },
            arguments: lines(plan.arguments(), Axis::name),
            constants: lines(plan.constants(), Given::name),
            kernels: kernels.collect(),
            kernels_compiled: plan.compiled_ahead().count(),
            passes: lines(plan.passes(), Pass::name),
            passes_skipped: plan.passes().iter().filter(|pass| !pass.taken).count(),
            buffers: lines(plan.buffers(), Buffer::name),
        }
    }

    /// The same after the work, for which so many kernels were compiled.
    pub(crate) fn after(self, kernels_compiled: usize) -> Self {
        Self { kernels_compiled, ..self }
    }

    /// Writes the plan for people: a line for each decision.
    pub(crate) fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        let Operations { before, after, by_signs } = self.operations;
        writeln!(
            writer,
            "plan: kernels compiled {}, passes skipped {}",
            self.kernels_compiled, self.passes_skipped
        )?;
        writeln!(
            writer,
            "    method {}; F − C takes {after} operations, {before} before simplification",
            self.method
        )?;
        if let Some(accuracy) = &self.accuracy {
            writeln!(writer, "    roots are enclosed to {accuracy}")?;
        }
        if let Some(operations) = by_signs {
            writeln!(
                writer,
                "    rays are followed by {operations} operations of a function with its signs, of roots for cubes and of lower polynomials"
            )?;
        }
        for (title, lines) in [
            ("arguments", &self.arguments),
            ("constants", &self.constants),
            ("kernels", &self.kernels),
            ("passes", &self.passes),
            ("buffers", &self.buffers),
        ] {
            writeln!(writer, "    {title}")?;
            lines.iter().try_for_each(|line| line.write(writer))?;
        }
        writeln!(writer)
    }
}

/// How many kernels that a plan takes of a surface are compiled by now.
pub(crate) fn kernels_compiled(plan: &Plan, surface: &Surface) -> usize {
    let is_compiled = |kernel: &Kernel| plan.surface_of(*kernel, surface).is_compiled(*kernel);
    Kernel::ALL.iter().filter(|kernel| is_compiled(kernel)).count()
}

fn lines<T: Copy>(decisions: &[Decision<T>], name: fn(T) -> &'static str) -> Vec<Line> {
    decisions.iter().map(|decision| Line::new(decision, name)).collect()
}

impl Line {
    fn new<T: Copy>(decision: &Decision<T>, name: fn(T) -> &'static str) -> Self {
        let Decision { subject, taken, reason } = *decision;
        Self { name: name(subject), taken, operations: None, reason }
    }

    fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        let answer = if self.taken { "yes" } else { "no" };
        let operations = self.operations.map_or_else(String::new, |count| format!(" ({count} operations)"));
        writeln!(writer, "        {:<19} {answer:<3} {}{operations}", self.name, self.reason)
    }
}
