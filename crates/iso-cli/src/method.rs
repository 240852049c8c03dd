//! The method of intersection and the region, from flags.

use iso_expr::CompileError;
use iso_grid::{Accuracy, Fitted, GridSettings, Method, Region, RootFinder, RootFinding, Surface, Workspace};

use crate::failure::Failure;
use crate::flags::{MethodFlags, MethodName, name_of};

/// The method that `flags` name, which encloses roots as narrowly as `usual` if it proves them and no accuracy is given. A setting that the method does
/// not have is an error.
pub(crate) fn method(flags: &MethodFlags, usual: Accuracy) -> Result<Method, Failure> {
    let refuse = |flag: &str, is_given: bool, methods: &str| {
        let method = name_of(flags.method);
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
    let refuse_sampling = || {
        let methods = "--method grid, octree or direct";
        refuse("--step", flags.step.is_some(), methods)?;
        refuse("--root-finder", flags.root_finder.is_some(), methods)?;
        refuse("--tolerance", flags.tolerance.is_some(), methods)
    };
    let refuse_accuracy = || refuse("--accuracy", flags.accuracy.is_some(), "--method certified");
    match flags.method {
        MethodName::Certified => {
            refuse_grid()?;
            refuse_sampling()?;
            Ok(Method::Certified { accuracy: flags.accuracy.map_or(usual, Accuracy::Relative) })
        }
        MethodName::Direct => {
            refuse_grid()?;
            refuse_accuracy()?;
            Ok(Method::Direct { step: flags.step.unwrap_or(GridSettings::STEP), roots: roots(flags) })
        }
        MethodName::Grid => {
            refuse_accuracy()?;
            Ok(Method::Grid(grid_settings(flags)))
        }
        MethodName::Octree => {
            refuse_accuracy()?;
            Ok(Method::Octree(grid_settings(flags)))
        }
    }
}

/// The region that was given, else one that fits the surface.
pub(crate) fn fitted_unless(given: Option<Region>, surface: &Surface) -> Result<Fitted, CompileError> {
    given.map_or_else(|| fitted(surface), |region| Ok(region.into()))
}

/// A region that fits the surface.
pub(crate) fn fitted(surface: &Surface) -> Result<Fitted, CompileError> {
    Fitted::around(surface, &mut Workspace::default())
}

/// The paper's settings, but for what `flags` say.
fn grid_settings(flags: &MethodFlags) -> GridSettings {
    let settings = flags.grid.map_or_else(GridSettings::default, GridSettings::new);
    GridSettings {
        refinement: flags.refine.unwrap_or(settings.refinement),
        step: flags.step.unwrap_or(settings.step),
        roots: roots(flags),
        ..settings
    }
}

/// The paper's root finding, but for what `flags` say.
fn roots(flags: &MethodFlags) -> RootFinding {
    RootFinding {
        finder: flags.root_finder.map_or(RootFinding::PAPER.finder, RootFinder::from),
        tolerance: flags.tolerance.unwrap_or(RootFinding::PAPER.tolerance),
    }
}
