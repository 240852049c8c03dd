//! Rendering: tiles of pixels on all cores.

use std::sync::Mutex;
use std::time::Duration;

use glam::DVec3;
use iso_expr::CompileError;
use iso_grid::{Counters, Outcome, Ray, Surface, Tracer, Workspace, normals};
use rayon::prelude::*;
use thiserror::Error;

use crate::bands::Band;
use crate::clock::Stopwatch;
use crate::color::srgb_from_color;
use crate::{Camera, Layers, Pass, Picture, Plan, Shading, Size, Status, StatusCounts};

/// What a picture shows, and how its rays are followed.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// What the picture takes.
    pub plan: &'a Plan,
    /// The surface, for its normals.
    pub surface: &'a Surface,
    /// The method of intersection, ready for the surface.
    pub tracer: &'a dyn Tracer,
    /// From where it is seen.
    pub camera: &'a Camera,
    /// How it is lit.
    pub shading: &'a Shading,
}

/// Told after each finished tile: pixels done so far, and all pixels.
pub type Progress<'a> = &'a (dyn Fn(u64, u64) + Sync);

/// Why a picture could not be made.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The buffers do not fit into memory.
    #[error("a picture of {}x{} pixels does not fit into this machine's memory", .0.width(), .0.height())]
    OutOfMemory(Size),
    /// A kernel could not be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
}

/// Width and height of a tile: small enough to balance cores, large enough to fill batches.
const TILE: u32 = 64;

/// Renders `scene` at `size` on the threads of the current rayon pool, keeping the layers of its plan.
///
/// The picture is the same bit for bit whatever the number of threads.
///
/// When the surface's [`Stop`](iso_grid::Stop) is requested, this returns soon: tiles that are finished by then are part of
/// the picture, and all other pixels are unfinished.
///
/// # Errors
/// When memory does not suffice or a kernel cannot be compiled.
pub fn render(scene: &Scene<'_>, size: Size, progress: Progress<'_>) -> Result<Picture, RenderError> {
    let mut picture = Picture::empty(size);
    render_over(scene, &mut picture, progress)?;
    Ok(picture)
}

/// Renders `scene` like [`render()`] in the size of `picture` and in its place. Layers that it has already are drawn over, for
/// memory that was used before is much faster than new one.
///
/// # Errors
/// Those of [`render()`]. The picture's pixels mean nothing then.
pub fn render_over(
    scene: &Scene<'_>,
    picture: &mut Picture,
    progress: Progress<'_>,
) -> Result<(), RenderError> {
    let watch = Stopwatch::start();
    let (size, layers) = (picture.size, scene.plan.layers());
    picture.make_room(layers).ok_or(RenderError::OutOfMemory(size))?;
    let bands = Band::all(picture, TILE);
    let work = Mutex::new(Work::default());
    tiles(size).into_par_iter().try_for_each_init(Tile::default, |tile, area| {
        let is_finished = tile.render(scene, size, area)?;
        if !is_finished {
            tile.mark_unfinished(layers);
        }
        let band = &bands[(area.row / TILE) as usize];
        tile.put(&mut band.lock().expect("no thread panics while it holds a band"), size);
        if is_finished {
            let mut work = work.lock().expect("no thread panics while it holds the sums");
            work.add(tile);
            progress(work.pixels, size.pixels() as u64);
        }
        Ok::<(), RenderError>(())
    })?;
    drop(bands);
    let work = work.into_inner().expect("no thread panics while it holds the sums");
    work.note(picture, watch.elapsed());
    Ok(())
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Default)]
struct Area {
    column: u32,
    row: u32,
    width: u32,
    height: u32,
}

fn tiles(size: Size) -> Vec<Area> {
    let starts = |length: u32| (0..length).step_by(TILE as usize);
    starts(size.height())
        .flat_map(|row| {
            starts(size.width()).map(move |column| Area {
                column,
                row,
                width: TILE.min(size.width() - column),
                height: TILE.min(size.height() - row),
            })
        })
        .collect()
}

/// A thread's part of the picture, rows from top to bottom: one tile after the other.
#[derive(Default)]
struct Tile {
    workspace: Workspace,
    area: Area,
    outcomes: Vec<Outcome>,
    /// The layers that the picture keeps, and the normals it is shaded by.
    color: Vec<[u8; 3]>,
    depth: Vec<f64>,
    normals: Vec<DVec3>,
    points: Vec<DVec3>,
    statuses: Vec<Status>,
    counts: StatusCounts,
    trace: Duration,
    shade: Duration,
}

impl Tile {
    /// Whether it was finished before work was stopped.
    fn render(&mut self, scene: &Scene<'_>, size: Size, area: Area) -> Result<bool, RenderError> {
        self.area = area;
        let stop = scene.surface.stop();
        if stop.is_requested() {
            return Ok(false);
        }
        let mut watch = Stopwatch::start();
        let Self { workspace, outcomes, normals: found_normals, .. } = self;
        let rays = scene.camera.tile(area.column, area.row, area.width, area.height);
        outcomes.resize(rays.len(), Outcome::Miss);
        workspace.counters = Counters::default();
        scene.tracer.trace_tile(workspace, rays, outcomes);
        if stop.is_requested() {
            return Ok(false);
        }
        self.trace = watch.lap();
        if scene.plan.runs(Pass::Normals) {
            found_normals.resize(rays.len(), DVec3::NAN);
            normals(scene.surface, Some(scene.tracer), workspace, rays, outcomes, found_normals)?;
        }
        if scene.plan.runs(Pass::Shade) {
            self.shade(scene.shading, rays, size);
        }
        self.note(scene.plan.layers(), rays);
        self.shade = watch.lap();
        Ok(true)
    }

    /// Puts the marks of unfinished pixels in all layers.
    fn mark_unfinished(&mut self, layers: Layers) {
        let Area { width, height, .. } = self.area;
        let count = |is_kept: bool| if is_kept { (width * height) as usize } else { 0 };
        refill(&mut self.color, count(layers.color), Picture::UNFINISHED);
        refill(&mut self.depth, count(layers.depth), f64::NEG_INFINITY);
        refill(&mut self.normals, count(layers.normals), DVec3::ZERO);
        refill(&mut self.points, count(layers.points), DVec3::NAN);
        refill(&mut self.statuses, count(layers.statuses), Status::Unfinished);
        refill(&mut self.outcomes, count(layers.outcomes), Outcome::Miss);
    }

    /// Colours all pixels.
    fn shade(&mut self, shading: &Shading, rays: iso_grid::Tile<'_>, size: Size) {
        self.color.clear();
        let width = rays.width();
        for (line, outcomes) in self.outcomes.chunks_exact(width).enumerate() {
            let background = shading.background(self.area.row + line as u32, size);
            let nothing = srgb_from_color(background);
            let normals = &self.normals[line * width..];
            self.color.extend(outcomes.iter().enumerate().map(|(column, outcome)| match outcome {
                Outcome::Miss => nothing,
                _ => {
                    let view = rays.ray(column, line).direction;
                    srgb_from_color(shading.color(outcome, normals[column], view, background))
                }
            }));
        }
    }

    /// Takes from the outcomes what `layers` show.
    fn note(&mut self, layers: Layers, rays: iso_grid::Tile<'_>) {
        let outcomes = &self.outcomes;
        let founds = || outcomes.iter().map(found);
        if layers.depth {
            self.depth.clear();
            self.depth.extend(founds().map(|t| t.unwrap_or(f64::NAN)));
        }
        if layers.points {
            self.points.clear();
            let point = |(t, ray): (Option<f64>, Ray)| t.map_or(DVec3::NAN, |t| ray.at(t));
            self.points.extend(founds().zip(rays.rays()).map(point));
        }
        if layers.statuses {
            self.statuses.clear();
            self.statuses.extend(outcomes.iter().map(Status::from));
        }
        self.counts = StatusCounts::default();
        outcomes.iter().for_each(|outcome| self.counts.count(Status::from(outcome)));
    }
}

impl Tile {
    /// Copies the layers to their place in the band that holds the tile.
    fn put(&self, band: &mut Band<'_>, size: Size) {
        self.put_layer(&self.color, band.color, size);
        self.put_layer(&self.depth, band.depth, size);
        self.put_layer(&self.normals, band.normals, size);
        self.put_layer(&self.points, band.points, size);
        self.put_layer(&self.statuses, band.statuses, size);
        self.put_layer(&self.outcomes, band.outcomes, size);
    }

    /// Copies one layer, if the picture keeps it.
    fn put_layer<T: Copy>(&self, pixels: &[T], layer: &mut [T], size: Size) {
        if layer.is_empty() {
            return;
        }
        let (column, width) = (self.area.column as usize, self.area.width as usize);
        let rows = layer.chunks_exact_mut(size.width() as usize);
        for (pixels, row) in pixels.chunks_exact(width).zip(rows) {
            row[column..][..width].copy_from_slice(pixels);
        }
    }
}

/// Puts so many times the same into a buffer.
fn refill<T: Clone>(buffer: &mut Vec<T>, count: usize, value: T) {
    buffer.clear();
    buffer.resize(count, value);
}

/// Where on its ray something was found; `None` where nothing was.
fn found(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => Some(hit.t),
        Outcome::Miss | Outcome::Undecided(_) => None,
    }
}

/// What tiles took, and what was found in them.
#[derive(Default)]
struct Work {
    pixels: u64,
    counts: StatusCounts,
    counters: Counters,
    trace: Duration,
    shade: Duration,
}

impl Work {
    fn add(&mut self, tile: &Tile) {
        self.pixels += tile.outcomes.len() as u64;
        self.counts += tile.counts;
        self.counters += tile.workspace.counters;
        self.trace += tile.trace;
        self.shade += tile.shade;
    }

    /// Notes it with a picture that took `wall`.
    fn note(self, picture: &mut Picture, wall: Duration) {
        picture.counts = self.counts;
        picture.counts.unfinished = picture.size.pixels() as u64 - self.pixels;
        picture.counters = self.counters;
        let busy = (self.trace + self.shade).as_secs_f64();
        let share = if busy > 0.0 { wall.as_secs_f64() / busy } else { 0.0 };
        picture.trace_seconds = share * self.trace.as_secs_f64();
        picture.shade_seconds = share * self.shade.as_secs_f64();
    }
}
