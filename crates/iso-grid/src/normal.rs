//! Normals of the surface at the points that a tracer found.

use glam::DVec3;
use iso_expr::CompileError;
use iso_expr::engine::Points;

use crate::{Outcome, Ray, Surface, Workspace};

/// Writes the unit normal at each found point, towards larger F whichever way the ray comes; NaN where nothing was found
/// or the gradient is zero, infinite or undefined.
///
/// All slices are equally long.
///
/// # Errors
/// When the gradient's kernel cannot be compiled.
pub fn normals(
    surface: &Surface,
    workspace: &mut Workspace,
    rays: &[Ray],
    outcomes: &[Outcome],
    normals: &mut [DVec3],
) -> Result<(), CompileError> {
    normals.fill(DVec3::NAN);
    let found: Vec<(usize, DVec3)> = outcomes
        .iter()
        .enumerate()
        .filter_map(|(place, outcome)| match outcome {
            Outcome::Hit(hit) | Outcome::Touch(hit) => Some((place, rays[place].at(hit.t))),
            Outcome::Miss | Outcome::Undecided(_) => None,
        })
        .collect();
    if found.is_empty() {
        return Ok(());
    }
    let count = found.len();
    let coordinates = |axis: usize| found.iter().map(|(_, point)| point[axis]).collect::<Vec<_>>();
    let (x, y, z) = (coordinates(0), coordinates(1), coordinates(2));
    let mut values = vec![0.0; 4 * count];
    surface.gradients()?.evaluate(&mut workspace.scratch, Points { x: &x, y: &y, z: &z }, &mut values);
    workspace.counters.gradient_evaluations += count as u64;
    for (i, (place, _)) in found.into_iter().enumerate() {
        normals[place] = unit(DVec3::new(values[count + i], values[2 * count + i], values[3 * count + i]));
    }
    Ok(())
}

/// The unit vector along `gradient`, free of overflow and underflow; NaN when there is none.
fn unit(gradient: DVec3) -> DVec3 {
    let largest = gradient.abs().max_element();
    if largest == 0.0 || !gradient.is_finite() {
        return DVec3::NAN;
    }
    // Two steps, for the reciprocal of a subnormal number overflows.
    (gradient / largest).normalize()
}
