//! The methods of intersection, by name and settings.

use crate::{
    Accuracy, Certified, Direct, Grid, GridError, GridSettings, Octree, Region, RootFinding, Surface, Tracer,
};

/// A method of intersection with its settings, not yet prepared for a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Prove every ray: [`Certified`].
    Certified {
        /// How narrowly roots are enclosed.
        accuracy: Accuracy,
    },
    /// The paper's grid: [`Grid`].
    Grid(GridSettings),
    /// The paper's grid, hierarchical: [`Octree`].
    Octree(GridSettings),
    /// Sample along the whole ray: [`Direct`].
    Direct {
        /// The step between samples: see [`Direct::new`].
        step: f64,
        /// How roots are found between samples.
        roots: RootFinding,
    },
}

impl Method {
    /// The certified method as it is unless told otherwise.
    pub const CERTIFIED: Self = Self::Certified { accuracy: Accuracy::NARROW };

    /// The method's name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Certified { .. } => "certified",
            Self::Grid(_) => "grid",
            Self::Octree(_) => "octree",
            Self::Direct { .. } => "direct",
        }
    }

    /// How narrowly the method encloses roots; `None` for a method that samples.
    pub fn accuracy(&self) -> Option<Accuracy> {
        match self {
            Self::Certified { accuracy } => Some(*accuracy),
            Self::Grid(_) | Self::Octree(_) | Self::Direct { .. } => None,
        }
    }

    /// How the method finds roots between samples; `None` for a method that does not sample.
    pub fn roots(&self) -> Option<RootFinding> {
        match self {
            Self::Certified { .. } => None,
            Self::Grid(settings) | Self::Octree(settings) => Some(settings.roots),
            Self::Direct { roots, .. } => Some(*roots),
        }
    }

    /// Prepares the method for a surface in a region.
    ///
    /// # Errors
    /// When a setting is out of range, there are too many cells, or the engine cannot compile the surface.
    pub fn prepare(&self, surface: &Surface, region: Region) -> Result<Box<dyn Tracer>, GridError> {
        Ok(match self {
            Self::Certified { accuracy } => {
                Box::new(Certified::new(surface, region)?.with_accuracy(*accuracy))
            }
            Self::Grid(settings) => Box::new(Grid::new(surface, region, settings)?),
            Self::Octree(settings) => Box::new(Octree::new(surface, region, settings)?),
            Self::Direct { step, roots } => Box::new(Direct::new(surface, region, *step, *roots)?),
        })
    }
}
