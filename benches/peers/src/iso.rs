//! This project as a renderer.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use clap::ValueEnum;
use iso_expr::{Engine, Interpreter, Program};
use iso_grid::{Accuracy, GridSettings, Kernel, Surface, Tracer};
use iso_jit::Jit;
use iso_render::{
    Camera, Layers, Look, Picture, Plan, Projection, Scene, Shading, Smoothing, Status, StatusCounts, Wanted,
    render_over,
};

use crate::depths::Depths;
use crate::renderer::Renderer;
use crate::view::SquareView;

/// How rays are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// With proof.
    Certified,
    /// The paper's, with 30 cells along each axis.
    Grid,
}

/// How narrowly the certified method encloses roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Width {
    /// To 1/256 of a pixel, as pictures are drawn.
    Pixels,
    /// To 1e-12 of the distance, as tables are made.
    Narrow,
}

/// What evaluates formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EngineName {
    /// Native code.
    Jit,
    /// The interpreter.
    Interpreter,
}

/// What this project says about a picture's pixels.
pub struct Answer {
    /// Where the surface is.
    pub depths: Depths,
    /// Which pixels are decided, either way.
    pub decided: Vec<bool>,
    /// Pixels by status.
    pub counts: StatusCounts,
}

/// One surface, ready to be rendered.
pub struct Iso {
    width: Width,
    surface: Surface,
    method: iso_grid::Method,
    tracer: Box<dyn Tracer>,
    camera: Camera,
    shading: Shading,
    view: SquareView,
    picture: Option<Picture>,
}

impl Width {
    /// The name in tables of this project with such enclosures.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pixels => "iso",
            Self::Narrow => "iso, 1e-12",
        }
    }

    fn accuracy(self) -> Accuracy {
        match self {
            Self::Pixels => Accuracy::Pixels,
            Self::Narrow => Accuracy::NARROW,
        }
    }
}

impl Iso {
    /// Compiles the kernels and prepares the method. What is too large for native code is interpreted.
    ///
    /// # Errors
    /// When the formula cannot be compiled.
    pub fn new(
        program: &Program,
        view: SquareView,
        (method, width): (Method, Width),
        engine: EngineName,
    ) -> Result<Self, Box<dyn Error>> {
        let interpreted = || Self::with_engine(Arc::new(Interpreter), program, view, (method, width));
        match engine {
            EngineName::Jit => Self::with_engine(Arc::new(Jit::new()?), program, view, (method, width))
                .or_else(|_| interpreted()),
            EngineName::Interpreter => interpreted(),
        }
    }

    fn with_engine(
        engine: Arc<dyn Engine>,
        program: &Program,
        view: SquareView,
        (method, width): (Method, Width),
    ) -> Result<Self, Box<dyn Error>> {
        let surface = Surface::new(engine, program.clone());
        let region = view.region()?;
        let method = match method {
            Method::Certified => iso_grid::Method::Certified { accuracy: width.accuracy() },
            Method::Grid => iso_grid::Method::Grid(GridSettings::default()),
        };
        let tracer = method.prepare(&surface, region)?;
        let followed = if method.roots().is_none() { surface.by_signs() } else { &surface };
        for kernel in Kernel::ALL.into_iter().filter(|kernel| kernel.pays(followed.program())) {
            // What is too large to be compiled is left as it is.
            followed.compile(kernel).ok();
        }
        let camera = view.camera()?;
        let shading = Shading::new(&camera, &Look::DEFAULT);
        Ok(Self { width, surface, method, tracer, camera, shading, view, picture: None })
    }

    fn draw_over(&self, picture: &mut Picture, layers: Layers) -> Result<(), Box<dyn Error>> {
        let plan = Plan::new(&Wanted {
            program: self.surface.program(),
            method: self.method,
            has_parameters: false,
            projection: Some(Projection::Orthographic { view_width: None }),
            box_is_given: true,
            layers,
            smoothing: Smoothing::NONE,
        });
        let scene = Scene {
            plan: &plan,
            surface: &self.surface,
            tracer: &*self.tracer,
            camera: &self.camera,
            shading: &self.shading,
        };
        Ok(render_over(&scene, picture, &|_, _| {})?)
    }

    fn depths_of(&self, picture: &Picture) -> Depths {
        Depths(picture.depth.iter().map(|distance| distance - self.view.eye_distance()).collect())
    }

    /// All that is known of the picture, rendered for this purpose alone.
    ///
    /// # Errors
    /// When memory does not suffice.
    pub fn answer(&self) -> Result<Answer, Box<dyn Error>> {
        let layers = Layers { depth: true, statuses: true, ..Layers::default() };
        let mut picture = Picture::empty(self.view.size()?);
        self.draw_over(&mut picture, layers)?;
        Ok(Answer {
            depths: self.depths_of(&picture),
            decided: picture.statuses.iter().map(|status| *status != Status::Undecided).collect(),
            counts: picture.counts,
        })
    }
}

impl Renderer for Iso {
    fn name(&self) -> &'static str {
        self.width.name()
    }

    fn render(&mut self) -> Result<f64, Box<dyn Error>> {
        let size = self.view.size()?;
        let mut picture = self.picture.take().unwrap_or_else(|| Picture::empty(size));
        let start = Instant::now();
        // What was found out for the picture before is forgotten: other programs find everything out anew.
        self.tracer = self.method.prepare(&self.surface, self.view.region()?)?;
        self.draw_over(&mut picture, Layers { depth: true, normals: true, ..Layers::default() })?;
        let seconds = start.elapsed().as_secs_f64();
        self.picture = Some(picture);
        Ok(seconds)
    }

    fn depths(&self) -> Result<Depths, Box<dyn Error>> {
        Ok(self.depths_of(self.picture.as_ref().ok_or("nothing was rendered yet")?))
    }
}
