//! Proofs shared by the rays of a tile.
//!
//! A *beam* is a rectangle of the tile's rays. Over a stretch of it F and its slope are enclosed once for all its points, by affine
//! forms or the mean value theorem, whose excess shrinks with the square of the beam's size, and that says one of these things:
//! - F is nowhere zero: no ray of the beam has a root in the stretch;
//! - F is monotone along every ray: each ray has at most one root there, and one step of the interval Newton method
//!   over the beam tells about where. Then each ray's own root is approached by doubles from the beam's linear model, eight rays side by side. A
//!   double computed for F, with a bound of its rounding that holds all over the stretch, and the beam's slopes prove and
//!   enclose the root: no ray needs an interval of its own;
//! - neither, as where rays graze the surface. If the second derivatives of F, enclosed as well, show that F bends one way along
//!   every ray, each has at most two roots, and values of F tell them apart or that there are none. If F is made of several functions by
//!   minima and maxima, as at an edge of a body, or has kinks inside, that is said of each of them, and their signs together tell where F has its root;
//! - nothing: the stretch is cut, or the beam.
//!
//! What is left when beams are small goes to the search along single rays. A ray's stretches are looked at front to back
//! whatever beams it goes through, so that the first root found is its first root.

mod beam;
mod bend;
mod bows;
mod bundle;
mod course;
mod cubic;
mod cuts;
mod edges;
mod faces;
mod form;
mod grazing;
mod made;
mod met;
mod monotone;
mod narrowing;
mod open_rays;
mod packet;
mod pixels;
mod pursuit;
mod rounding;
mod sheaf;
mod signs;
mod slabs;
mod spread;
mod subdivision;

pub(crate) use subdivision::Memory;
pub(super) use subdivision::Subdivision;

#[cfg(test)]
mod tests;
