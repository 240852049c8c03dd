//! The methods of intersection, from flags to tracers.

use iso_expr::CompileError;
use iso_grid::{
    Certified, Direct, Grid, GridError, GridSettings, Octree, Region, Surface, Tracer, Workspace,
};

use crate::failure::Failure;
use crate::flags::{MethodFlags, MethodName};

/// A method of intersection with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Method {
    /// Prove every ray.
    Certified {
        /// The width to which roots are enclosed.
        accuracy: f64,
    },
    /// The paper's grid.
    Grid(GridSettings),
    /// The paper's grid, hierarchical.
    Octree(GridSettings),
    /// Sample along the whole ray.
    Direct {
        /// The step between samples.
        step: f64,
    },
}

impl Method {
    /// The method that `flags` name. A setting that the method does not have is an error.
    pub(crate) fn resolve(flags: &MethodFlags) -> Result<Self, Failure> {
        let refuse = |flag: &str, is_given: bool, methods: &str| {
            let method = flags.method.name();
            if !is_given {
                return Ok(());
            }
            let problem = format!("{flag} has no meaning for the method {method}");
            Err(Failure::usage(problem, format!("leave it out, or choose {methods}")))
        };
        let refuse_grid = || {
            refuse("--grid", flags.grid.is_some(), "--method grid or octree")?;
            refuse("--refine", flags.refine.is_some(), "--method grid or octree")
        };
        let refuse_accuracy = || refuse("--accuracy", flags.accuracy.is_some(), "--method certified");
        match flags.method {
            MethodName::Certified => {
                refuse_grid()?;
                refuse("--step", flags.step.is_some(), "--method grid, octree or direct")?;
                Ok(Self::Certified { accuracy: flags.accuracy.unwrap_or(Certified::ACCURACY) })
            }
            MethodName::Direct => {
                refuse_grid()?;
                refuse_accuracy()?;
                Ok(Self::Direct { step: flags.step.unwrap_or(GridSettings::STEP) })
            }
            MethodName::Grid => {
                refuse_accuracy()?;
                Ok(Self::Grid(grid_settings(flags)))
            }
            MethodName::Octree => {
                refuse_accuracy()?;
                Ok(Self::Octree(grid_settings(flags)))
            }
        }
    }

    /// The method's name on the command line.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Certified { .. } => MethodName::Certified,
            Self::Grid(_) => MethodName::Grid,
            Self::Octree(_) => MethodName::Octree,
            Self::Direct { .. } => MethodName::Direct,
        }
        .name()
    }

    /// Compiles the kernels that the method and the normals need, so that the time it takes is known.
    pub(crate) fn compile(&self, surface: &Surface) -> Result<(), CompileError> {
        surface.gradients()?;
        match self {
            Self::Certified { .. } => {
                surface.value_enclosures()?;
                surface.gradient_enclosures()?;
            }
            Self::Grid(_) | Self::Octree(_) | Self::Direct { .. } => {
                surface.values()?;
            }
        }
        Ok(())
    }

    /// Prepares the method for a surface in a region.
    pub(crate) fn prepare(&self, surface: &Surface, region: Region) -> Result<Box<dyn Tracer>, GridError> {
        Ok(match self {
            Self::Certified { accuracy } => {
                Box::new(Certified::new(surface, region)?.with_accuracy(*accuracy))
            }
            Self::Grid(settings) => Box::new(Grid::new(surface, region, settings)?),
            Self::Octree(settings) => Box::new(Octree::new(surface, region, settings)?),
            Self::Direct { step } => Box::new(Direct::new(surface, region, *step)?),
        })
    }
}

/// The region that was asked for, else one that fits the surface.
pub(crate) fn region(given: Option<Region>, surface: &Surface) -> Result<Region, CompileError> {
    given.map_or_else(|| Region::fitted(surface, &mut Workspace::default()), Ok)
}

/// The paper's settings, but for what `flags` say.
fn grid_settings(flags: &MethodFlags) -> GridSettings {
    let settings = flags.grid.map_or_else(GridSettings::default, GridSettings::new);
    GridSettings {
        refinement: flags.refine.unwrap_or(settings.refinement),
        step: flags.step.unwrap_or(settings.step),
        ..settings
    }
}
