//! The pictures of a request: one, or a sequence in which the camera moves or parameters run.

use std::sync::Arc;

use iso_expr::Engine;
use iso_grid::{Stop, Surface};
use iso_render::{Plan, View};

use crate::clock::{Phases, add_to};
use crate::failure::Failure;
use crate::flags::{CameraFlags, PictureFlags, RenderFlags, SequenceFlags};
use crate::formula::{Source, Text, minus_level};
use crate::pictures::PictureFiles;
use crate::plan::plan;
use crate::summary::Frame;
use crate::values::{Setting, Sweep};

/// A surface, shared by all pictures in which it is the same: what is known of it is kept from one to the next.
pub(super) struct Subject {
    /// Its kernels.
    pub(super) surface: Surface,
    /// Definitions that its formula does without.
    pub(super) unused: Vec<String>,
    /// Operations of F − C before it was simplified.
    pub(super) operations_before: usize,
    /// What a picture of it takes.
    pub(super) plan: Plan,
}

/// One picture that is to be drawn.
pub(super) struct Shot {
    pub(super) subject: Arc<Subject>,
    pub(super) camera: CameraFlags,
    pub(super) files: PictureFiles,
    /// What it is in its sequence.
    pub(super) frame: Option<Frame>,
    /// What it took so far.
    pub(super) phases: Phases,
}

/// All pictures that `flags` ask for, in their order.
pub(super) fn shots(
    flags: &RenderFlags,
    engine: &Arc<dyn Engine>,
    stop: &Stop,
) -> Result<Vec<Shot>, Failure> {
    let RenderFlags { picture, sequence, .. } = flags;
    if sequence.frames.is_some() && !sequence.is_wanted() {
        return Err(Failure::usage(
            "--frames is given, but nothing changes from picture to picture",
            "add --turntable or --sweep NAME=FROM:TO, or leave it out",
        ));
    }
    let is_set = |sweep: &&Sweep| picture.formula.settings.iter().any(|setting| setting.name == sweep.name);
    if let Some(sweep) = sequence.sweep.iter().find(is_set) {
        let problem = format!("--set and --sweep both give values of {}", sweep.name);
        return Err(Failure::usage(problem, "leave out one of them"));
    }
    let source = Source::read(&picture.formula.formula)?;
    let mut phases = Phases::default();
    let text = add_to(&mut phases.parse, || source.parse())?;
    let maker = Maker { flags: picture, source, text, engine, stop };
    if !sequence.is_wanted() {
        let subject = maker.subject(&[], None, &mut phases)?;
        let files = PictureFiles::resolve(&picture.output)?;
        return Ok(vec![Shot { subject, camera: picture.camera.clone(), files, frame: None, phases }]);
    }
    let mut shots: Vec<Shot> = Vec::new();
    for frame in sequence.frames(&picture.camera) {
        let mut phases = std::mem::take(&mut phases);
        let before = shots.last().map(|shot| &shot.subject);
        let subject = maker.subject(&frame.settings, before, &mut phases)?;
        let mut camera = picture.camera.clone();
        camera.yaw = frame.yaw.or(camera.yaw);
        let files = PictureFiles::numbered(&picture.output, frame.number, sequence.count())?;
        shots.push(Shot { subject, camera, files, frame: Some(frame), phases });
    }
    Ok(shots)
}

/// Makes surfaces of a formula that is read once.
struct Maker<'a> {
    flags: &'a PictureFlags,
    source: Source,
    text: Text,
    engine: &'a Arc<dyn Engine>,
    stop: &'a Stop,
}

impl Maker<'_> {
    /// The surface with these values for some parameters, or the one `before` where it is the same.
    fn subject(
        &self,
        settings: &[Setting],
        before: Option<&Arc<Subject>>,
        phases: &mut Phases,
    ) -> Result<Arc<Subject>, Failure> {
        let settings = [self.flags.formula.settings.as_slice(), settings].concat();
        let (formula, operations_before, program) = add_to(&mut phases.parse, || {
            let formula = self.source.lower(&self.text, &settings)?;
            let program = minus_level(&formula, self.flags.level.level)?;
            Ok::<_, Failure>((formula, program.operations(), program.simplified()))
        })?;
        if let Some(before) = before.filter(|before| *before.surface.program() == program) {
            return Ok(Arc::clone(before));
        }
        let plan = plan(self.flags, &formula, &program)?;
        let surface = Surface::new(Arc::clone(self.engine), program).stopped_by(self.stop.clone());
        let unused = formula.unused().to_vec();
        Ok(Arc::new(Subject { surface, unused, operations_before, plan }))
    }
}

impl SequenceFlags {
    /// What each picture of the sequence is.
    fn frames(&self, camera: &CameraFlags) -> impl Iterator<Item = Frame> {
        let count = self.count();
        let View::Orbit { yaw: standard, .. } = View::DEFAULT else {
            unreachable!("cameras orbit the region by default");
        };
        let start = camera.yaw.unwrap_or(standard);
        (0..count).map(move |number| {
            let (turn, way) =
                (f64::from(number) / f64::from(count), f64::from(number) / f64::from(count - 1));
            Frame {
                number,
                yaw: self.turntable.then_some(start + 360.0 * turn),
                settings: self.sweep.iter().map(|sweep| sweep.at(way)).collect(),
            }
        })
    }
}
