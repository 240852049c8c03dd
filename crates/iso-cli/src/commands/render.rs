//! `iso render`: pictures of surfaces.

use std::io::{self, Write};
use std::sync::Arc;

use iso_expr::Engine;
use iso_grid::{Counters, GridError, Region, Surface};
use iso_render::{Picture, Scene, Shading, Size, Smoothing, render};
use rayon::ThreadPool;

use crate::camera::camera;
use crate::clock::{Phases, add_to};
use crate::engine::{engine, threads};
use crate::failure::Failure;
use crate::flags::{CameraFlags, RenderFlags};
use crate::formula::{Programs, Source, minus_level};
use crate::interruption::Interruption;
use crate::method::{Method, region};
use crate::output::to_standard_output;
use crate::pictures::PictureFiles;
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
    request.interruption.check(summary.pixels.unfinished, request.drawn.pixels() as u64, "pixels")
}

/// What is to be drawn, how, and where it goes: all that flags and files say, checked.
struct Request {
    programs: Programs,
    region: Option<Region>,
    method: Method,
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

impl Request {
    fn resolve(flags: RenderFlags, phases: &mut Phases) -> Result<Self, Failure> {
        let interruption = Interruption::new(&flags.limit);
        let method = Method::resolve(&flags.method)?;
        let smoothing = flags.output.smooth;
        let files = PictureFiles::resolve(&flags.output)?;
        let speech = match (flags.output.json, flags.output.quiet) {
            (true, _) => Speech::Json,
            (false, true) => Speech::Nothing,
            (false, false) => Speech::Line,
        };
        let source = Source::read(&flags.formula.formula)?;
        let programs = add_to(&mut phases.parse, || {
            let formula = source.lower(&source.parse()?, &flags.formula.settings)?;
            Ok::<_, Failure>(Programs::new(&minus_level(&formula, flags.level.level)?))
        })?;
        Ok(Self {
            programs,
            region: flags.method.region,
            method,
            camera: flags.camera,
            smoothing,
            drawn: smoothing
                .drawn(flags.output.size)
                .map_err(|error| Failure::usage(error.to_string(), "choose a smaller --size or --smooth"))?,
            shows_status: flags.output.show_status,
            files,
            speech,
            engine: add_to(&mut phases.compile, || engine(flags.engine.engine))?,
            threads: threads(&flags.threads)?,
            interruption,
        })
    }

    /// Draws the picture and writes its files.
    fn fulfil(&self, mut phases: Phases) -> Result<Summary, Failure> {
        let surface = self.programs.surface(Arc::clone(&self.engine)).stopped_by(self.interruption.stop());
        add_to(&mut phases.compile, || self.method.compile(&surface))?;
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
            method: self.method.name(),
            engine: self.engine.name(),
            threads: self.threads.current_num_threads(),
            operations: self.programs.value.operations(),
            gradient_operations: self.programs.value_and_gradient.operations(),
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
        let tracer = add_to(&mut phases.preprocess, || self.method.prepare(surface, region))
            .map_err(|error| self.interruption.explain(error))?;
        let shading = Shading::new(&camera, self.shows_status);
        let scene = Scene { surface, tracer: tracer.as_ref(), camera: &camera, shading: &shading };
        let progress = Progress::new(self.speech == Speech::Line);
        let report = |done, all| progress.report(done, all);
        let picture = render(&scene, self.drawn, self.files.layers(), &report);
        progress.finish();
        let mut picture = picture?;
        if picture.counts.unfinished == self.drawn.pixels() as u64 {
            return Err(self.interruption.explain(GridError::Stopped));
        }
        add_to(&mut phases.shade, || self.smoothing.finish(&mut picture));
        phases.trace += 1e3 * picture.trace_seconds;
        phases.shade += 1e3 * picture.shade_seconds;
        Ok((picture, tracer.preprocessing()))
    }
}
