//! One surface, drawn as often as it takes.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use iso_expr::{Engine, Interpreter, Program};
use iso_grid::{Accuracy, Kernel, Method, Region, Surface, Tracer};
use iso_jit::Jit;
use iso_render::{
    Camera, Layers, Look, Plan, Projection, Scene, Shading, Size, Smoothing, View, Wanted, render,
};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// How rays are followed, as where colours are all that is written.
const METHOD: Method = Method::Certified { accuracy: Accuracy::Pixels };

/// A surface with everything prepared that can be before its picture is drawn.
pub struct Subject {
    surface: Surface,
    tracer: Box<dyn Tracer>,
    region: Region,
    radius: f64,
    /// Seconds that preparing took.
    pub preparation: f64,
}

impl Subject {
    /// The surface where `program` is zero, in a cube with sides of twice the radius around the origin.
    ///
    /// What is too large for native code is interpreted, as `iso render` does.
    ///
    /// # Errors
    /// When the formula cannot be compiled.
    pub fn new(program: &Program, radius: f64) -> Result<Self, Box<dyn Error>> {
        let start = Instant::now();
        Self::with_engine(Arc::new(Jit::new()?), program, radius, start)
            .or_else(|_| Self::with_engine(Arc::new(Interpreter), program, radius, start))
    }

    fn with_engine(
        engine: Arc<dyn Engine>,
        program: &Program,
        radius: f64,
        start: Instant,
    ) -> Result<Self, Box<dyn Error>> {
        let region = Region::new(DVec3::splat(-radius), DVec3::splat(radius))?;
        let surface = Surface::new(engine, program.clone());
        let tracer = METHOD.prepare(&surface, region)?;
        surface.by_signs().over_points(Kernel::Gradients)?;
        Ok(Self { surface, tracer, region, radius, preparation: start.elapsed().as_secs_f64() })
    }

    /// Seconds that a square picture of parallel rays takes: depth and normals.
    ///
    /// # Errors
    /// When memory does not suffice.
    pub fn draw(&self, side: u32, threads: &ThreadPool) -> Result<f64, Box<dyn Error>> {
        let size = Size::new(side, side)?;
        let projection = Projection::Orthographic { view_width: Some(2.0 * self.radius) };
        let camera = Camera::new(View::DEFAULT, projection, &self.region, size)?;
        let plan = Plan::new(&Wanted {
            program: self.surface.program(),
            method: METHOD,
            has_parameters: false,
            projection: Some(projection),
            box_is_given: true,
            layers: Layers { depth: true, normals: true, ..Layers::default() },
            smoothing: Smoothing::NONE,
        });
        let shading = Shading::new(&camera, &Look::DEFAULT);
        let scene = Scene {
            plan: &plan,
            surface: &self.surface,
            tracer: &*self.tracer,
            camera: &camera,
            shading: &shading,
        };
        let start = Instant::now();
        let picture = threads.install(|| render(&scene, size, &|_, _| {}))?;
        let seconds = start.elapsed().as_secs_f64();
        drop(picture);
        Ok(seconds)
    }
}

/// So many threads.
///
/// # Errors
/// When the machine refuses them.
pub fn threads(count: usize) -> Result<ThreadPool, Box<dyn Error>> {
    Ok(ThreadPoolBuilder::new().num_threads(count).build()?)
}
