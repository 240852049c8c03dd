//! fidget's two engines as renderers.

use std::error::Error;
use std::time::Instant;

use fidget::eval::{Function, MathFunction};
use fidget::raster::voxel::{Image, RenderConfig};
use fidget::render::{RenderHints, VoxelSize};
use fidget::shape::{Shape, ShapeVars};
use iso_expr::Program;

use crate::depths::Depths;
use crate::fidget_trees::fidget_graph;
use crate::renderer::Renderer;
use crate::view::SquareView;

/// fidget's engine for functions of type `F`.
pub struct Fidget<F> {
    name: &'static str,
    shape: Shape<F>,
    config: RenderConfig,
    view: SquareView,
    image: Option<Image>,
}

impl<F: MathFunction> Fidget<F> {
    /// Builds the shape. fidget makes its tapes, native code among them, while it renders.
    ///
    /// # Errors
    /// When fidget lacks an operation of the formula.
    pub fn new(name: &'static str, program: &Program, view: SquareView) -> Result<Self, Box<dyn Error>> {
        let (context, root) = fidget_graph(program)?;
        let shape = Shape::new(&context, root)?;
        let config = RenderConfig {
            image_size: VoxelSize::from(view.size),
            world_to_model: view.fidget().world_to_model(),
        };
        Ok(Self { name, shape, config, view, image: None })
    }
}

impl<F: Function + MathFunction + RenderHints> Renderer for Fidget<F> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn render(&mut self) -> Result<f64, Box<dyn Error>> {
        self.image = None;
        let variables = ShapeVars::new();
        let start = Instant::now();
        let image = self.config.run(self.shape.bind(&variables)?);
        let seconds = start.elapsed().as_secs_f64();
        self.image = Some(image);
        Ok(seconds)
    }

    /// A pixel of depth d has its first voxel inside the surface at d − 1 and the last one outside at d, counted from the
    /// back; the surface is taken to be in the middle between them.
    fn depths(&self) -> Result<Depths, Box<dyn Error>> {
        let image = self.image.as_ref().ok_or("nothing was rendered yet")?;
        let middle = 0.5 * f64::from(self.view.size);
        let depth = |voxels: u32| match voxels {
            0 => f64::NAN,
            voxels => self.view.pixel() * (middle - (f64::from(voxels) - 0.5)),
        };
        Ok(Depths(image.iter().map(|pixel| depth(pixel.depth)).collect()))
    }
}
