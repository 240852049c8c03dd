//! The region of space that holds a surface F(x, y, z) = C: its preprocessing, its traversal by rays, and root finding
//! along them.
//!
//! A [`Surface`] offers the kernels of F − C, whatever engine made them. A [`Tracer`] is a method of intersection: it says
//! for every [`Ray`] how its search for the first root inside the [`Region`] ended, an [`Outcome`].

mod counters;
mod normal;
mod ray;
mod region;
mod surface;
mod tracer;

pub use counters::Counters;
pub use normal::normals;
pub use ray::{Ray, Span};
pub use region::{Region, RegionError};
pub use surface::Surface;
pub use tracer::{Hit, Outcome, Tracer, Workspace};
