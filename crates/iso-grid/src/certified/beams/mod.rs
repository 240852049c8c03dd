//! Proofs shared by the rays of a tile.
//!
//! A *beam* is a rectangle of the tile's rays. Over a stretch of it F and its gradient are enclosed once for all its
//! points, and the mean value form, whose excess shrinks with the square of the beam's size, says one of three things:
//! - F is nowhere zero: no ray of the beam has a root in the stretch;
//! - F is monotone along every ray: each ray has at most one root there, and one step of the interval Newton method
//!   over the beam tells about where. Then each ray's own root is approached by doubles from the beam's linear model. A
//!   double computed for F, with a bound of its rounding that holds all over the stretch, and the beam's slopes prove and
//!   enclose the root: no ray needs an interval of its own;
//! - neither: the stretch is cut, or the beam.
//!
//! What is left when beams are small goes to the search along single rays. A ray's stretches are looked at front to back
//! whatever beams it goes through, so that the first root found is its first root.

mod arcs;
mod area;
mod beam;
mod bend;
mod creases;
mod form;
mod grazing;
mod monotone;
mod pixels;
mod rounding;
mod spread;
mod subdivision;

pub(crate) use subdivision::Memory;
pub(super) use subdivision::Subdivision;
