//! The methods of the paper, which know the signs of F − C at points and nothing else.
//!
//! Preprocessing finds the cells of a grid that hold the surface ([`existence`], [`octree`]); a ray walks through cells
//! ([`walk`]); what it passes of existence cells is sampled ([`search`]), and narrowed down where the sign changes ([`roots`](crate::roots)),
//! many rays at a time ([`lockstep`]).

mod direct;
mod existence;
mod grid;
mod lattice;
mod lockstep;
mod octree;
mod search;
mod settings;
mod stretch;
mod walk;

#[cfg(test)]
mod tests;

pub use direct::Direct;
pub use grid::Grid;
pub use octree::Octree;
pub use settings::GridSettings;
