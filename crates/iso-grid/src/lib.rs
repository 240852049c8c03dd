//! The region of space that holds a surface F(x, y, z) = C: its preprocessing, its traversal by rays, and root finding
//! along them.
//!
//! A [`Surface`] offers the kernels of F − C, whatever engine made them. A [`Tracer`] is a method of intersection: it says
//! for every [`Ray`] how its search for the first root inside the [`Region`] ended, an [`Outcome`].

mod accuracy;
mod area;
mod batch;
mod certified;
mod counters;
mod error;
mod fitted;
mod kernel;
mod lanes;
mod mean_slopes;
mod method;
mod normals;
mod outcomes;
mod paper;
mod point_rows;
mod raster;
mod ray;
mod region;
mod roots;
mod sign;
mod stop;
mod surface;
#[cfg(test)]
mod testing;
mod tracer;

pub use accuracy::Accuracy;
pub use certified::Certified;
pub use counters::Counters;
pub use error::GridError;
pub use fitted::{Facing, Fitted, Sphere};
pub use kernel::Kernel;
pub use method::Method;
pub use normals::normals;
pub use outcomes::{Hit, Outcome, OutcomeKind, Outcomes};
pub use paper::{Direct, Grid, GridSettings, Octree};
pub use raster::{Raster, Tile};
pub use ray::{Ray, Span};
pub use region::{Region, RegionError};
pub use roots::{RootFinder, RootFinding};
pub use stop::Stop;
pub use surface::Surface;
pub use tracer::{Traced, Tracer, Workspace};
