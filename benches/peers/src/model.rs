//! Published models in fidget's text form.

use std::error::Error;
use std::path::Path;

use iso_expr::{Formula, Program};

/// Reads a model: the last line is the function.
///
/// # Errors
/// When the file cannot be read or a line is no operation.
pub fn read_model(path: &Path) -> Result<Program, Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let formula = Formula::read_model(&text).map_err(|error| {
        let line = 1 + text[..error.span.start].matches('\n').count();
        format!("{}, line {line}: {error}", path.display())
    })?;
    Ok(formula.program().clone())
}
