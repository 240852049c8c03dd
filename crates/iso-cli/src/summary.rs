//! What a picture took, for programs (`--json`) and for people.

use std::fmt::{self, Display, Formatter};

use iso_grid::{Counters, Raster};
use iso_render::StatusCounts;
use serde::Serialize;

use crate::clock::Phases;
use crate::plan::PlanReport;
use crate::values::Setting;

/// What a picture took. Its fields are the keys of `iso render --json`.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    /// The formula as it was given, or how its file was named.
    pub(crate) formula: String,
    /// The level, if one was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) level: Option<f64>,
    /// The parameters that were given values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) settings: Vec<Setting>,
    /// The files that were written.
    pub(crate) files: Vec<String>,
    /// Which picture of a sequence it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) frame: Option<Frame>,
    /// The picture's width in pixels.
    pub(crate) width: u32,
    /// The picture's height in pixels.
    pub(crate) height: u32,
    /// The lower corner of the box.
    pub(crate) box_min: [f64; 3],
    /// The upper corner of the box.
    pub(crate) box_max: [f64; 3],
    /// From where it is seen.
    pub(crate) camera: CameraReport,
    /// The method of intersection.
    pub(crate) method: &'static str,
    /// The engine that evaluated the formula.
    pub(crate) engine: &'static str,
    /// Threads that worked.
    pub(crate) threads: usize,
    /// Operations of the simplified program of F − C.
    pub(crate) operations: usize,
    /// Operations of the simplified program of F − C and its gradient, if the gradient is needed.
    pub(crate) gradient_operations: Option<usize>,
    /// What was computed, what was left out, and why.
    pub(crate) plan: PlanReport,
    /// Drawn pixels by status: more than the picture has, if it is smoothed.
    pub(crate) pixels: StatusCounts,
    /// Counts of work.
    pub(crate) counters: Counters,
    /// Times.
    pub(crate) milliseconds: Phases,
    /// What the picture does not show by itself, for people.
    pub(crate) notes: Vec<String>,
}

/// From where a picture is seen: vectors from one drawn pixel to its right and to its lower neighbour, and what tells the ray through
/// the middle of the picture.
#[derive(Debug, Serialize)]
#[serde(tag = "projection", rename_all = "lowercase")]
pub(crate) enum CameraReport {
    /// The ray `across` pixels to the right of the middle and `along` below it begins at middle + across·right + along·down.
    Orthographic { middle: [f64; 3], direction: [f64; 3], right: [f64; 3], down: [f64; 3] },
    /// It has the direction of forward + across·right + along·down.
    Perspective { eye: [f64; 3], forward: [f64; 3], right: [f64; 3], down: [f64; 3] },
}

impl From<&Raster> for CameraReport {
    fn from(raster: &Raster) -> Self {
        match *raster {
            Raster::Parallel { middle, right, down, direction } => Self::Orthographic {
                middle: middle.to_array(),
                direction: direction.to_array(),
                right: right.to_array(),
                down: down.to_array(),
            },
            Raster::Spreading { eye, forward, right, down } => Self::Perspective {
                eye: eye.to_array(),
                forward: forward.to_array(),
                right: right.to_array(),
                down: down.to_array(),
            },
        }
    }
}

/// What a picture is in its sequence.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frame {
    /// Its place, from 0.
    pub(crate) number: u32,
    /// Degrees around the z axis, where the camera walks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) yaw: Option<f64>,
    /// The parameters that run, and their values.
    pub(crate) settings: Vec<Setting>,
}

impl Summary {
    /// Drawn pixels that are finished.
    pub(crate) fn finished_pixels(&self) -> u64 {
        let StatusCounts { hit, touch, miss, undecided, unfinished: _ } = self.pixels;
        hit + touch + miss + undecided
    }

    /// How many rays each pixel is made of, in words, if that is more than one.
    fn rays_each(&self) -> String {
        let rays = self.finished_pixels() + self.pixels.unfinished;
        match rays / (u64::from(self.width) * u64::from(self.height)) {
            1 => String::new(),
            each => format!(", {each} rays each"),
        }
    }
}

/// The summary in one line, and a line for each note.
impl Display for Summary {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { width, height, pixels, milliseconds, .. } = self;
        write!(f, "{}: {width}x{height} pixels{}: ", self.files.join(", "), self.rays_each())?;
        write_line(f, pixels, milliseconds)?;
        self.notes.iter().try_for_each(|note| write!(f, "\nnote: {note}"))
    }
}

/// What a sequence of pictures took. Its fields are the keys of `iso render --json` for sequences.
#[derive(Debug, Serialize)]
pub(crate) struct SequenceSummary {
    /// All files that were written.
    files: Vec<String>,
    /// Drawn pixels of all pictures by status.
    pixels: StatusCounts,
    /// Counts of work for all pictures.
    counters: Counters,
    /// Times of all pictures.
    milliseconds: Phases,
    /// Each picture.
    frames: Vec<Summary>,
}

impl SequenceSummary {
    /// The summary of pictures, one at least.
    pub(crate) fn of(frames: Vec<Summary>) -> Self {
        let mut whole = Self {
            files: Vec::new(),
            pixels: StatusCounts::default(),
            counters: Counters::default(),
            milliseconds: Phases::default(),
            frames: Vec::new(),
        };
        for frame in &frames {
            for file in &frame.files {
                if !whole.files.contains(file) {
                    whole.files.push(file.clone());
                }
            }
            whole.pixels += frame.pixels;
            whole.counters += frame.counters;
            whole.milliseconds += frame.milliseconds;
        }
        Self { frames, ..whole }
    }
}

/// The summary in one line, and a line for each note.
impl Display for SequenceSummary {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.files[..] {
            [first, .., last] => write!(f, "{first} … {last}")?,
            files => write!(f, "{}", files.concat())?,
        }
        let first @ Summary { width, height, .. } = &self.frames[0];
        write!(f, ": {} pictures of {width}x{height} pixels{}: ", self.frames.len(), first.rays_each())?;
        write_line(f, &self.pixels, &self.milliseconds)?;
        let mut notes: Vec<(&str, u32)> = Vec::new();
        for note in self.frames.iter().flat_map(|frame| &frame.notes) {
            match notes.iter_mut().find(|(known, _)| known == note) {
                Some((_, pictures)) => *pictures += 1,
                None => notes.push((note, 1)),
            }
        }
        notes.iter().try_for_each(|(note, pictures)| write!(f, "\nnote on {pictures} of them: {note}"))
    }
}

fn write_line(f: &mut Formatter<'_>, pixels: &StatusCounts, milliseconds: &Phases) -> fmt::Result {
    let StatusCounts { hit, touch, miss, undecided, unfinished } = pixels;
    write!(f, "{hit} hit, {touch} touch, {miss} miss, {undecided} undecided")?;
    if *unfinished > 0 {
        write!(f, ", {unfinished} unfinished")?;
    }
    let Phases { parse, compile, preprocess, trace, shade, encode } = milliseconds;
    write!(f, "; {:.1} ms (parse {parse:.1}, compile {compile:.1}, ", milliseconds.total())?;
    write!(f, "preprocess {preprocess:.1}, trace {trace:.1}, shade {shade:.1}, encode {encode:.1})")
}
