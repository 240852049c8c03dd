//! What is to be drawn, how, and where it goes; and drawing it.

use std::io::Write;
use std::sync::Arc;

use iso_expr::Engine;
use iso_grid::{Counters, Fitted, GridError, Kernel, Method, Region, Tracer};
use iso_render::{Animation, Look, Pass, Picture, Scene, Shading, Size, Smoothing, render_over};
use rayon::ThreadPool;

use super::shots::{Shot, Subject, shots};
use crate::camera::camera;
use crate::clock::{Phases, add_to};
use crate::engine::{engine, threads};
use crate::failure::Failure;
use crate::flags::{FormulaFlags, RenderFlags};
use crate::formula::file_of;
use crate::interruption::Interruption;
use crate::method::fitted;
use crate::notes::Drawn;
use crate::output::{OutputFile, is_standard_output};
use crate::pictures::{animation, check_paint};
use crate::plan::{PlanReport, kernels_compiled};
use crate::progress::{Progress, waiting};
use crate::summary::Summary;

/// All that flags and files say, checked.
pub(super) struct Request {
    formula: FormulaFlags,
    level: Option<f64>,
    shots: Vec<Shot>,
    region: Option<Region>,
    smoothing: Smoothing,
    /// The size in which pictures are drawn, before they are smoothed.
    drawn: Size,
    look: Look,
    /// Where all pictures go together.
    animation: Option<OutputFile>,
    engine: Arc<dyn Engine>,
    threads: ThreadPool,
    pub(super) interruption: Interruption,
}

/// A surface whose rays can be followed: kept while pictures show the same one.
struct Prepared {
    subject: Arc<Subject>,
    tracer: Box<dyn Tracer>,
}

impl Prepared {
    /// Compiles what the plan names and prepares the method. `None` when work is stopped before that is done.
    fn new(subject: &Arc<Subject>, region: Region, phases: &mut Phases) -> Result<Option<Self>, Failure> {
        let Subject { surface, plan, .. } = &**subject;
        add_to(&mut phases.compile, || plan.compile(surface))?;
        let tracer = add_to(&mut phases.preprocess, || plan.tracer(surface, region));
        match tracer {
            Err(GridError::Stopped) => Ok(None),
            tracer => Ok(Some(Self { subject: Arc::clone(subject), tracer: tracer? })),
        }
    }
}

impl Request {
    pub(super) fn resolve(flags: RenderFlags) -> Result<Self, Failure> {
        let interruption = Interruption::new(&flags.limit);
        let picture = &flags.picture;
        if flags.summary.json && picture.output.output.as_deref().is_some_and(is_standard_output) {
            let problem = "--json and the picture both go to standard output";
            return Err(Failure::usage(problem, "name a file for the picture, or leave out --json"));
        }
        check_paint(&flags.paint, &picture.output)?;
        let smoothing = picture.output.smooth;
        let drawn = smoothing
            .drawn(picture.output.size)
            .map_err(|error| Failure::usage(error.to_string(), "choose a smaller --size or --smooth"))?;
        let mut compile = 0.0;
        let engine = add_to(&mut compile, || engine(flags.engine.engine))?;
        let mut shots = shots(&flags, &engine, &interruption.stop())?;
        shots[0].phases.compile += compile;
        let animation = flags.sequence.is_wanted().then(|| animation(&picture.output)).transpose()?.flatten();
        if let Some(source) = file_of(&picture.formula.formula) {
            let mut files = shots.iter().flat_map(|shot| shot.files.all()).chain(&animation);
            files.try_for_each(|file| file.spares(&source))?;
        }
        Ok(Self {
            shots,
            region: picture.method.region.region,
            smoothing,
            drawn,
            look: flags.paint.look(picture.output.background),
            animation,
            engine,
            threads: threads(&flags.threads)?,
            interruption,
            level: picture.level.level,
            formula: flags.picture.formula,
        })
    }

    /// Pixels of all pictures, as they are drawn.
    pub(super) fn pixels(&self) -> u64 {
        self.shots.len() as u64 * self.drawn.pixels() as u64
    }

    /// Draws the pictures and writes their files, and says what each took. Those that are not begun when work is stopped
    /// are left out.
    pub(super) fn fulfil(mut self, shows_progress: bool) -> Result<Vec<Summary>, Failure> {
        let region = waiting("looking for the surface", shows_progress, || self.region())?;
        let mut bytes = Vec::new();
        let mut animated = self.animation.as_ref().map(|_| Animation::new(&mut bytes)).transpose()?;
        let all = self.pixels();
        let progress = Progress::new(shows_progress);
        let summaries = self.draw_all(region, animated.as_mut(), &progress);
        progress.finish();
        drop(animated);
        let mut summaries = summaries?;
        if summaries.is_empty() {
            self.interruption.check_begun(all, all)?;
        }
        if let Some(file) = &self.animation {
            file.write(|writer| writer.write_all(&bytes))?;
            summaries.iter_mut().for_each(|summary| summary.files.push(file.path().display().to_string()));
        }
        Ok(summaries)
    }

    fn draw_all(
        &mut self,
        region: Fitted,
        mut animation: Option<&mut Animation<&mut Vec<u8>>>,
        progress: &Progress,
    ) -> Result<Vec<Summary>, Failure> {
        let (all, of_one) = (self.pixels(), self.drawn.pixels() as u64);
        let (mut prepared, mut picture) = (None, Picture::empty(self.drawn));
        let mut summaries: Vec<Summary> = Vec::new();
        for (shot, before) in std::mem::take(&mut self.shots).into_iter().zip((0..).step_by(of_one as usize))
        {
            let report = |done, _| progress.report(before + done, all);
            let drawn =
                self.threads.install(|| self.draw(shot, region, &mut prepared, &mut picture, &report))?;
            let Some(mut summary) = drawn else { break };
            if let Some(animation) = &mut animation {
                add_to(&mut summary.milliseconds.encode, || animation.add(&picture))?;
            }
            summaries.push(summary);
        }
        Ok(summaries)
    }

    /// The region that was asked for, else the least that fits every surface, so that the camera stands still where it may.
    fn region(&mut self) -> Result<Fitted, Failure> {
        if let Some(region) = self.region {
            return Ok(region.into());
        }
        let mut hull: Option<Fitted> = None;
        let mut before: Option<Arc<Subject>> = None;
        for Shot { subject, phases, .. } in &mut self.shots {
            if before.as_ref().is_some_and(|before| Arc::ptr_eq(before, subject)) {
                continue;
            }
            add_to(&mut phases.compile, || subject.surface.by_signs().compile(Kernel::ValueEnclosures))?;
            let fitted = add_to(&mut phases.preprocess, || fitted(&subject.surface))?;
            hull = Some(hull.map_or(Ok(fitted), |hull| hull.hull(&fitted))?);
            before = Some(Arc::clone(subject));
        }
        Ok(hull.expect("there is a picture to be drawn"))
    }

    /// Draws a picture over the one before, writes its files and says what it took. `None` when work is stopped before anything is
    /// finished.
    fn draw(
        &self,
        shot: Shot,
        fitted: Fitted,
        prepared: &mut Option<Prepared>,
        picture: &mut Picture,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Option<Summary>, Failure> {
        let Shot { subject, camera: flags, files, frame, mut phases } = shot;
        let Subject { surface, unused, operations_before, plan } = &*subject;
        let region = fitted.region;
        let camera = camera(&flags, &fitted, self.drawn)?;
        let mut counters = Counters::default();
        let known = prepared.take().filter(|known| Arc::ptr_eq(&known.subject, &subject));
        let kernels_before = if known.is_some() { kernels_compiled(plan, surface) } else { 0 };
        let known = match known {
            Some(known) => known,
            None => {
                let Some(new) = Prepared::new(&subject, region, &mut phases)? else { return Ok(None) };
                counters += new.tracer.preprocessing();
                new
            }
        };
        let shading = Shading::new(&camera, &self.look);
        let tracer = &*prepared.insert(known).tracer;
        let scene = Scene { plan, surface, tracer, camera: &camera, shading: &shading };
        self.interruption.begin_work();
        if picture.size != self.drawn {
            *picture = Picture::empty(self.drawn);
        }
        render_over(&scene, picture, progress)?;
        if picture.counts.unfinished == self.drawn.pixels() as u64 {
            return Ok(None);
        }
        if plan.runs(Pass::Smooth) {
            add_to(&mut phases.shade, || self.smoothing.finish(picture));
        }
        phases.trace += 1e3 * picture.trace_seconds;
        phases.shade += 1e3 * picture.shade_seconds;
        counters += picture.counters;
        add_to(&mut phases.encode, || files.write(picture))?;
        let pixels = picture.counts;
        let drawn = Drawn {
            surface,
            unused,
            fitted,
            pixels,
            rays_in_region: picture.counters.rays_in_region,
            is_certified: matches!(plan.method(), Method::Certified { .. }),
            shows_status: self.look.shows_statuses,
        };
        Ok(Some(Summary {
            formula: self.formula.formula.to_string_lossy().into_owned(),
            level: self.level,
            settings: self.formula.settings.clone(),
            files: files.names(),
            frame,
            width: picture.size.width(),
            height: picture.size.height(),
            box_min: region.min().to_array(),
            box_max: region.max().to_array(),
            camera: camera.raster().into(),
            method: plan.method().name(),
            engine: self.engine.name(),
            threads: self.threads.current_num_threads(),
            operations: surface.program().operations(),
            gradient_operations: plan
                .takes_gradient()
                .then(|| plan.followed(surface).program_of(Kernel::Gradients).operations()),
            plan: PlanReport::new(plan, surface, *operations_before)
                .after(kernels_compiled(plan, surface) - kernels_before),
            pixels,
            counters,
            milliseconds: phases,
            notes: drawn.notes()?,
        }))
    }
}
