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
    tiles(size).into_par_iter().try_for_each_init(Workspace::default, |workspace, area| {
        let Some(tile) = Tile::render(scene, size, area, workspace)? else { return Ok(()) };
        let mut finished = finished.lock().expect("no thread panics while it holds the picture");
        finished.take(&tile);
        progress(finished.pixels, size.pixels() as u64);
        Ok::<(), RenderError>(())
    })?;
    let finished = finished.into_inner().expect("no thread panics while it holds the picture");
    Ok(finished.share_out(watch.elapsed()))
}

/// A rectangle of pixels.
#[derive(Clone, Copy)]
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

/// A finished part of the picture, rows from top to bottom.
struct Tile {
    area: Area,
    layers: Layers,
    outcomes: Vec<Outcome>,
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    color: Vec<[u8; 3]>,
    counters: Counters,
    trace: Duration,
    shade: Duration,
}

impl Tile {
    /// `None` when work was stopped before the tile was finished.
    fn render(
        scene: &Scene<'_>,
        size: Size,
        area: Area,
        workspace: &mut Workspace,
    ) -> Result<Option<Self>, RenderError> {
        let stop = scene.surface.stop();
        if stop.is_requested() {
            return Ok(None);
        }
        let mut watch = Stopwatch::start();
        let rays = scene.camera.tile(area.column, area.row, area.width, area.height);
        let mut outcomes = vec![Outcome::Miss; rays.len()];
        workspace.counters = Counters::default();
        scene.tracer.trace_tile(workspace, rays, &mut outcomes);
        if stop.is_requested() {
            return Ok(None);
        }
        let trace = watch.lap();

        let mut found_normals = Vec::new();
        if scene.plan.runs(Pass::Normals) {
            found_normals.resize(rays.len(), DVec3::NAN);
            normals(scene.surface, workspace, rays, &outcomes, &mut found_normals)?;
        }
        let mut color = Vec::new();
        if scene.plan.runs(Pass::Shade) {
            color.extend(rays.rays().enumerate().map(|(place, ray)| {
                let (row, normal) = (area.row + place as u32 / area.width, found_normals[place]);
                srgb_from_color(scene.shading.color(&outcomes[place], normal, ray.direction, row, size))
            }));
        }
        let shade = watch.lap();
        let counters = workspace.counters;
        let layers = scene.plan.layers();
        let mut points = Vec::new();
        if layers.points {
            let point = |(outcome, ray): (&Outcome, Ray)| found(outcome).map_or(DVec3::NAN, |t| ray.at(t));
            points.extend(outcomes.iter().zip(rays.rays()).map(point));
        }
        Ok(Some(Self { area, layers, outcomes, points, normals: found_normals, color, counters, trace, shade }))
    }
}

/// Where on its ray something was found; `None` where nothing was.
fn found(outcome: &Outcome) -> Option<f64> {
    match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => Some(hit.t),
        Outcome::Miss | Outcome::Undecided(_) => None,
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
        let width = tile.area.width as usize;
        for (line, row) in (tile.area.row..tile.area.row + tile.area.height).enumerate() {
            let from = line * width..(line + 1) * width;
            let start = picture.size.offset(tile.area.column, row);
            let to = start..start + width;
            if tile.layers.color {
                picture.color[to.clone()].copy_from_slice(&tile.color[from.clone()]);
            }
            if tile.layers.normals {
                picture.normals[to.clone()].copy_from_slice(&tile.normals[from.clone()]);
            }
            if tile.layers.points {
                picture.points[to.clone()].copy_from_slice(&tile.points[from.clone()]);
            }
            if tile.layers.outcomes {
                picture.outcomes[to.clone()].copy_from_slice(&tile.outcomes[from.clone()]);
            }
            for (place, pixel) in from.zip(to) {
                if tile.layers.depth {
                    picture.depth[pixel] = found(&tile.outcomes[place]).unwrap_or(f64::NAN);
                }
                if tile.layers.statuses {
                    picture.statuses[pixel] = Status::from(&tile.outcomes[place]);
                }
            }
        }
        let mut counts = StatusCounts::default();
        tile.outcomes.iter().for_each(|outcome| counts.count(Status::from(outcome)));
        picture.counts += counts;
        picture.counts.unfinished -= tile.outcomes.len() as u64;
        picture.counters += tile.counters;
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
