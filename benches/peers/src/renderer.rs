//! What every program offers to the comparison.

use std::error::Error;

use crate::depths::Depths;

/// A program with one surface and one view, everything prepared that can be prepared beforehand.
pub trait Renderer {
    /// The program's name in tables.
    fn name(&self) -> &'static str;

    /// Renders depth and normals, and says how many seconds that took.
    ///
    /// # Errors
    /// When the program fails.
    fn render(&mut self) -> Result<f64, Box<dyn Error>>;

    /// The depths of the picture rendered last.
    ///
    /// # Errors
    /// When there is none.
    fn depths(&self) -> Result<Depths, Box<dyn Error>>;
}
