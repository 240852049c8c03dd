//! Rendering: tiles of pixels on all cores.

use std::sync::Mutex;
use std::time::Duration;

use glam::DVec3;
use iso_expr::CompileError;
use iso_grid::{Counters, Outcome, Ray, Surface, Tracer, Workspace, normals};
use rayon::prelude::*;
use thiserror::Error;

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
    let watch = Stopwatch::start();
    let layers = scene.plan.layers();
    let picture = Picture::with_room(size, layers).ok_or(RenderError::OutOfMemory(size))?;
    let finished = Mutex::new(Finished { picture, pixels: 0, trace: Duration::ZERO, shade: Duration::ZERO });
    tiles(size).into_par_iter().try_for_each_init(Tile::default, |tile, area| {
        if !tile.render(scene, size, area)? {
            return Ok(());
        }
        let mut finished = finished.lock().expect("no thread panics while it holds the picture");
        finished.take(tile);
        progress(finished.pixels, size.pixels() as u64);
        Ok::<(), RenderError>(())
    })?;
    let finished = finished.into_inner().expect("no thread panics while it holds the picture");
    Ok(finished.share_out(watch.elapsed()))
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
        let stop = scene.surface.stop();
        if stop.is_requested() {
            return Ok(false);
        }
        let mut watch = Stopwatch::start();
        let Self { workspace, outcomes, normals: found_normals, .. } = self;
        let rays = scene.camera.tile(area.column, area.row, area.width, area.height);
        self.area = area;
        outcomes.resize(rays.len(), Outcome::Miss);
        workspace.counters = Counters::default();
        scene.tracer.trace_tile(workspace, rays, outcomes);
        if stop.is_requested() {
            return Ok(false);
        }
        self.trace = watch.lap();
        if scene.plan.runs(Pass::Normals) {
            found_normals.resize(rays.len(), DVec3::NAN);
            normals(scene.surface, workspace, rays, outcomes, found_normals)?;
        }
        if scene.plan.runs(Pass::Shade) {
            self.color.clear();
            self.color.extend(rays.rays().enumerate().map(|(place, ray)| {
                let (row, normal) = (area.row + place as u32 / area.width, found_normals[place]);
                srgb_from_color(scene.shading.color(&outcomes[place], normal, ray.direction, row, size))
            }));
        }
        self.note(scene.plan.layers(), rays);
        self.shade = watch.lap();
        Ok(true)
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

/// Where on its ray something was found; `None` where nothing was.
fn found(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => Some(hit.t),
        Outcome::Miss | Outcome::Undecided(_) => None,
    }
}

/// Copies a tile's pixels to their place in a layer that the picture keeps.
fn put<T: Copy>(pixels: &[T], area: Area, layer: &mut [T], size: Size) {
    if layer.is_empty() {
        return;
    }
    let width = area.width as usize;
    for (row, pixels) in (area.row..).zip(pixels.chunks_exact(width)) {
        layer[size.offset(area.column, row)..][..width].copy_from_slice(pixels);
    }
}

/// What is finished so far.
struct Finished {
    picture: Picture,
    pixels: u64,
    trace: Duration,
    shade: Duration,
}

impl Finished {
    fn take(&mut self, tile: &Tile) {
        let picture = &mut self.picture;
        put(&tile.color, tile.area, &mut picture.color, picture.size);
        put(&tile.depth, tile.area, &mut picture.depth, picture.size);
        put(&tile.normals, tile.area, &mut picture.normals, picture.size);
        put(&tile.points, tile.area, &mut picture.points, picture.size);
        put(&tile.statuses, tile.area, &mut picture.statuses, picture.size);
        put(&tile.outcomes, tile.area, &mut picture.outcomes, picture.size);
        picture.counts += tile.counts;
        picture.counts.unfinished -= tile.outcomes.len() as u64;
        picture.counters += tile.workspace.counters;
        self.pixels += tile.outcomes.len() as u64;
        self.trace += tile.trace;
        self.shade += tile.shade;
    }

    fn share_out(mut self, wall: Duration) -> Picture {
        let busy = (self.trace + self.shade).as_secs_f64();
        let share = if busy > 0.0 { wall.as_secs_f64() / busy } else { 0.0 };
        self.picture.trace_seconds = share * self.trace.as_secs_f64();
        self.picture.shade_seconds = share * self.shade.as_secs_f64();
        self.picture
    }
}
