//! The region of space that holds a surface F(x, y, z) = C: its preprocessing, its traversal by rays, and root finding
//! along them.
//!
//! A [`Surface`] offers the kernels of F − C, whatever engine made them. A [`Tracer`] is a method of intersection: it says
//! for every [`Ray`] how its search for the first root inside the [`Region`] ended, an [`Outcome`].

mod batch;
mod certified;
#[cfg(test)]
mod closed_forms;
mod counters;
mod direct;
mod error;
mod existence;
mod grid;
mod lattice;
#[cfg(test)]
mod limits;
mod lockstep;
mod normals;
mod octree;
mod ray;
mod region;
mod search;
mod settings;
mod sign;
mod stretch;
mod surface;
#[cfg(test)]
mod testing;
mod tracer;
mod walk;

pub use certified::Certified;
pub use counters::Counters;
pub use direct::Direct;
pub use error::GridError;
pub use grid::Grid;
pub use normals::normals;
pub use octree::Octree;
pub use ray::{Ray, Span};
pub use region::{Region, RegionError};
pub use settings::GridSettings;
pub use surface::Surface;
pub use tracer::{Hit, Outcome, Tracer, Workspace};
