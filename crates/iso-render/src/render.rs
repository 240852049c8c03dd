//! Rendering: tiles of pixels on all cores.

use std::iter::repeat;
use std::sync::Mutex;
use std::time::Duration;

use glam::{DVec3, Vec3};
use iso_expr::CompileError;
use iso_grid::{Counters, OutcomeKind, Outcomes, Surface, Traced, Tracer, Workspace};
use rayon::prelude::*;
use thiserror::Error;

use crate::bands::Band;
use crate::clock::Stopwatch;
use crate::color::srgb_from_color;
use crate::mosaic::{Area, TILE};
use crate::{Camera, Pass, Picture, Plan, Shading, Size, Status, StatusCounts};

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

/// Why what threads share is always whole.
const UNHARMED: &str = "no thread panics while it holds a lock";

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
    let bands = Band::all(picture);
    let work = Mutex::new(Work::default());
    let idle = Mutex::new(Vec::<Tile>::new());
    // One by one, so that at the end no thread is left with many.
    Area::tiles(size).into_par_iter().with_max_len(1).try_for_each(|area| {
        let mut tile = idle.lock().expect(UNHARMED).pop().unwrap_or_default();
        tile.render(scene, size, area)?;
        let band = &bands[(area.row / TILE) as usize];
        tile.put(&mut band.lock().expect(UNHARMED), scene.camera, size);
        if tile.content != Content::Unfinished {
            let mut work = work.lock().expect(UNHARMED);
            work.add(&tile);
            progress(work.pixels, size.pixels() as u64);
        }
        idle.lock().expect(UNHARMED).push(tile);
        Ok::<(), RenderError>(())
    })?;
    drop(bands);
    let work = work.into_inner().expect(UNHARMED);
    work.note(picture, watch.elapsed());
    Ok(())
}

/// What is known of a tile's pixels.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Content {
    /// Work was stopped before all are known.
    #[default]
    Unfinished,
    /// None of their rays meets anything.
    Nothing,
    /// What stands in the tile's layers.
    Found,
}

/// The part of the picture that a thread works on, rows from top to bottom: one after the other, in the same memory, for to
/// come by new memory takes longer than many a tile.
#[derive(Default)]
struct Tile {
    workspace: Workspace,
    area: Area,
    content: Content,
    outcomes: Outcomes,
    /// Empty when there is no need of them.
    color: Vec<[u8; 3]>,
    normals: Vec<DVec3>,
    counts: StatusCounts,
    trace: Duration,
    shade: Duration,
}

impl Tile {
    /// Finds out about its pixels, unless work is stopped before that is done.
    fn render(&mut self, scene: &Scene<'_>, size: Size, area: Area) -> Result<(), RenderError> {
        // Where nothing was found before, all are without normals still.
        let is_clear = self.content == Content::Nothing;
        (self.area, self.content) = (area, Content::Unfinished);
        let stop = scene.surface.stop();
        if stop.is_requested() {
            return Ok(());
        }
        let mut watch = Stopwatch::start();
        let Self { workspace, outcomes, normals, .. } = self;
        let rays = scene.camera.tile(area.column, area.row, area.width, area.height);
        workspace.counters = Counters::default();
        let are_normals_wanted = scene.plan.runs(Pass::Normals);
        if !is_clear {
            normals.clear();
        }
        normals.resize(if are_normals_wanted { rays.len() } else { 0 }, DVec3::NAN);
        let on_the_way = are_normals_wanted.then_some(&mut normals[..]);
        let traced = scene.tracer.trace_tile(workspace, rays, outcomes, on_the_way);
        if stop.is_requested() {
            return Ok(());
        }
        self.trace = watch.lap();
        (self.content, self.counts) = match traced {
            Traced::Nothing => {
                (Content::Nothing, StatusCounts { miss: rays.len() as u64, ..StatusCounts::default() })
            }
            _ => (Content::Found, StatusCounts::of(outcomes.kinds())),
        };
        if are_normals_wanted && traced == Traced::Outcomes {
            iso_grid::normals(
                scene.plan.followed(scene.surface),
                Some(scene.tracer),
                workspace,
                rays,
                outcomes,
                normals,
            )?;
        }
        if scene.plan.runs(Pass::Shade) {
            self.shade(scene.shading, rays, size);
        }
        self.shade = watch.lap();
        Ok(())
    }

    /// Colours all pixels.
    fn shade(&mut self, shading: &Shading, rays: iso_grid::Tile<'_>, size: Size) {
        self.color.clear();
        let width = rays.width();
        for (line, kinds) in self.outcomes.kinds().chunks_exact(width).enumerate() {
            let background = shading.background(self.area.row + line as u32, size);
            let nothing = srgb_from_color(background);
            self.color.extend(kinds.iter().enumerate().map(|(column, kind)| match kind {
                OutcomeKind::Miss => nothing,
                _ => {
                    let (place, view) = (line * width + column, rays.ray(column, line).direction);
                    let outcome = self.outcomes.get(place);
                    srgb_from_color(shading.color(&outcome, self.normals[place], view, background))
                }
            }));
        }
    }
}

impl Tile {
    /// Puts the layers in their place in the band that holds the tile.
    fn put(&self, band: &mut Band<'_>, camera: &Camera, size: Size) {
        let Self { color, normals, outcomes, area, .. } = self;
        band.clear();
        if self.content == Content::Unfinished {
            self.fill_layer(Picture::UNFINISHED, band.color, size);
            self.fill_layer(u8::MAX, band.coverage, size);
            self.fill_layer(Status::Unfinished, band.statuses, size);
            band.depth.put(*area, repeat(f64::NEG_INFINITY));
            band.normals.put(*area, repeat(Vec3::ZERO));
            return;
        }
        self.put_layer(band.color, size, color.iter().copied());
        if self.content == Content::Found {
            let kinds = outcomes.kinds().iter();
            let coverage = |kind: &OutcomeKind| if *kind == OutcomeKind::Miss { 0 } else { u8::MAX };
            let point = |(place, t): (usize, &f64)| {
                let (column, row) = (place as u32 % area.width, place as u32 / area.width);
                camera.ray(area.column + column, area.row + row).at(*t)
            };
            self.put_layer(band.coverage, size, kinds.clone().map(coverage));
            self.put_layer(band.statuses, size, kinds.map(|kind| Status::from(*kind)));
            self.put_layer(band.outcomes, size, outcomes.iter());
            band.depth.put(*area, outcomes.distances().iter().copied());
            band.normals.put(*area, normals.iter().map(|normal| normal.as_vec3()));
            band.points.put(*area, outcomes.distances().iter().enumerate().map(point));
        }
    }

    /// Puts what is known of each of the tile's pixels into one layer, if the picture keeps it.
    fn put_layer<T>(&self, layer: &mut [T], size: Size, mut pixels: impl Iterator<Item = T>) {
        for row in self.rows(layer, size) {
            row.iter_mut().zip(&mut pixels).for_each(|(place, pixel)| *place = pixel);
        }
    }

    /// Fills one layer, if the picture keeps it.
    fn fill_layer<T: Copy>(&self, pixel: T, layer: &mut [T], size: Size) {
        self.rows(layer, size).for_each(|row| row.fill(pixel));
    }

    /// The tile's part of each row of a band's layer; no rows of a layer that is not kept.
    fn rows<'a, T>(&self, layer: &'a mut [T], size: Size) -> impl Iterator<Item = &'a mut [T]> + use<'a, T> {
        let (column, width) = (self.area.column as usize, self.area.width as usize);
        let rows = layer.chunks_exact_mut(size.width() as usize).take(self.area.height as usize);
        rows.map(move |row| &mut row[column..][..width])
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
