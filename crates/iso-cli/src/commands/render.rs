//! `iso render`: pictures of surfaces.

use std::io::{self, Write};
use std::sync::Arc;

use iso_expr::{Engine, Program};
use iso_grid::{Counters, Kernel, Region, Surface};
use iso_render::{Pass, Picture, Plan, Scene, Shading, Size, Smoothing, render};
use rayon::ThreadPool;

use crate::camera::camera;
use crate::clock::{Phases, add_to};
use crate::engine::{engine, threads};
use crate::failure::Failure;
use crate::flags::{CameraFlags, RenderFlags, SummaryFlags};
use crate::formula::{Source, minus_level};
use crate::interruption::Interruption;
use crate::method::region;
use crate::output::to_standard_output;
use crate::pictures::PictureFiles;
use crate::plan::{PlanReport, plan};
use crate::progress::Progress;
use crate::summary::Summary;

/// Draws a surface.
pub(crate) fn run(flags: RenderFlags) -> Result<(), Failure> {
    let mut phases = Phases::default();
    let request = Request::resolve(flags, &mut phases)?;
    let summary = request.fulfil(phases)?;
    match request.speech {
        Speech::Json => to_standard_output(|writer| summary.write_json(writer))?,
        Speech::Line => {
            // The picture is done: a summary that nobody can read does not spoil it.
            let _ = writeln!(io::stderr(), "{}", summary.line());
        }
        Speech::Nothing => {}
    }
    request.interruption.check_done(summary.pixels.unfinished, request.drawn.pixels() as u64, "pixels")
}

/// What is to be drawn, how, and where it goes: all that flags and files say, checked.
struct Request {
    /// F − C, simplified.
    program: Program,
    /// Operations of F − C before it was simplified.
    operations_before: usize,
    plan: Plan,
    region: Option<Region>,
    camera: CameraFlags,
    smoothing: Smoothing,
    /// The size in which the picture is drawn, before it is smoothed.
    drawn: Size,
    shows_status: bool,
    files: PictureFiles,
    speech: Speech,
    engine: Arc<dyn Engine>,
    threads: ThreadPool,
    interruption: Interruption,
}

/// What is said when the picture is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Speech {
    Nothing,
    Line,
    Json,
}

impl Speech {
    fn of(flags: &SummaryFlags) -> Self {
        match (flags.json, flags.quiet) {
            (true, _) => Self::Json,
            (false, true) => Self::Nothing,
            (false, false) => Self::Line,
        }
    }
}

impl Request {
    fn resolve(flags: RenderFlags, phases: &mut Phases) -> Result<Self, Failure> {
        let RenderFlags { picture: flags, summary } = flags;
        let interruption = Interruption::new(&flags.limit);
        let smoothing = flags.output.smooth;
        let files = PictureFiles::resolve(&flags.output)?;
        let source = Source::read(&flags.formula.formula)?;
        let (formula, operations_before, program) = add_to(&mut phases.parse, || {
            let formula = source.lower(&source.parse()?, &flags.formula.settings)?;
            let program = minus_level(&formula, flags.level.level)?;
            Ok::<_, Failure>((formula, program.operations(), program.simplified()))
        })?;
        Ok(Self {
            plan: plan(&flags, &formula, &program)?,
            program,
            operations_before,
            region: flags.method.region.region,
            camera: flags.camera,
            smoothing,
            drawn: smoothing
                .drawn(flags.output.size)
                .map_err(|error| Failure::usage(error.to_string(), "choose a smaller --size or --smooth"))?,
            shows_status: flags.output.show_status,
            files,
            speech: Speech::of(&summary),
            engine: add_to(&mut phases.compile, || engine(flags.engine.engine))?,
            threads: threads(&flags.threads)?,
            interruption,
        })
    }

    /// Draws the picture and writes its files.
    fn fulfil(&self, mut phases: Phases) -> Result<Summary, Failure> {
        let surface =
            Surface::new(Arc::clone(&self.engine), self.program.clone()).stopped_by(self.interruption.stop());
        add_to(&mut phases.compile, || self.plan.compile(&surface))?;
        let region = add_to(&mut phases.preprocess, || region(self.region, &surface))?;
        let (picture, preprocessing) = self.threads.install(|| self.draw(&surface, region, &mut phases))?;
        add_to(&mut phases.encode, || self.files.write(&picture))?;
        let mut counters = picture.counters;
        counters += preprocessing;
        Ok(Summary {
            files: self.files.names(),
            width: picture.size.width(),
            height: picture.size.height(),
            box_min: region.min().to_array(),
            box_max: region.max().to_array(),
            method: self.plan.method().name(),
            engine: self.engine.name(),
            threads: self.threads.current_num_threads(),
            operations: self.program.operations(),
            gradient_operations: self
                .plan
                .takes_gradient()
                .then(|| surface.program_of(Kernel::Gradients).operations()),
            plan: PlanReport::new(&self.plan, &surface, self.operations_before).after(&surface),
            pixels: picture.counts,
            counters,
            milliseconds: phases,
        })
    }

    /// The picture, and the work of preprocessing.
    fn draw(
        &self,
        surface: &Surface,
        region: Region,
        phases: &mut Phases,
    ) -> Result<(Picture, Counters), Failure> {
        let camera = camera(&self.camera, &region, self.drawn)?;
        let tracer = add_to(&mut phases.preprocess, || self.plan.tracer(surface, region))?;
        let shading = Shading::new(&camera, self.shows_status);
        let scene =
            Scene { plan: &self.plan, surface, tracer: tracer.as_ref(), camera: &camera, shading: &shading };
        let progress = Progress::new(self.speech == Speech::Line);
        let report = |done, all| progress.report(done, all);
        self.interruption.begin_work();
        let picture = render(&scene, self.drawn, &report);
        progress.finish();
        let mut picture = picture?;
        self.interruption.check_begun(picture.counts.unfinished, self.drawn.pixels() as u64)?;
        if self.plan.runs(Pass::Smooth) {
            add_to(&mut phases.shade, || self.smoothing.finish(&mut picture));
        }
        phases.trace += 1e3 * picture.trace_seconds;
        phases.shade += 1e3 * picture.shade_seconds;
        Ok((picture, tracer.preprocessing()))
    }
}
