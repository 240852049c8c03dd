//! Normals of the surface where rays meet it.

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError, Scratch};

use crate::batch::PointBatch;
use crate::{Hit, Outcome, Ray, Surface, Tile, Workspace};

/// Hits whose gradients are asked for by one call of the kernel.
const BATCH: usize = 256;
/// The distances in front of a point at which its normal is looked for when it has none itself, as parts of the distance
/// that the ray has come: 2⁻⁴⁰, and from there on in powers of 8 up to 2⁻¹⁰.
const APPROACH: [i32; 11] = [-40, -37, -34, -31, -28, -25, -22, -19, -16, -13, -10];

/// The unit normal ∇F/|∇F| at each hit and touch, towards larger F whichever way the ray comes; NaN for other outcomes.
/// Both slices hold something for each ray of the tile.
///
/// At a touch, and where the gradient vanishes or is no finite vector, the normal is a limit: that of the points in front of the hit, on
/// the side that the ray comes from, the nearest that has one. So a double root such as (x² + y² + z² − 1)² = 0 has the
/// normal of the side that is seen. NaN when no point up to 2⁻¹⁰ of the ray's way in front has one either.
///
/// # Errors
/// When the engine cannot compile the gradient.
pub fn normals(
    surface: &Surface,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    outcomes: &[Outcome],
    normals: &mut [DVec3],
) -> Result<(), CompileError> {
    assert!(
        tile.len() == outcomes.len() && tile.len() == normals.len(),
        "each ray has an outcome and a normal"
    );
    let Workspace { scratch, counters, points, .. } = workspace;
    normals.fill(DVec3::NAN);
    let found = outcomes.iter().enumerate();
    let mut met: Vec<Met> = found.filter_map(|(place, outcome)| Met::new(tile, place, outcome)).collect();
    if met.is_empty() {
        return Ok(());
    }
    let kernel = &**surface.gradients()?;
    let distances = std::iter::once(None).chain(APPROACH.map(Some));
    for approach in distances {
        counters.gradient_evaluations += met.len() as u64;
        for met in met.chunks(BATCH) {
            points.clear();
            for met in met {
                points.push(approach.map_or_else(|| met.point(), |power| met.point_in_front(power)));
            }
            unit_gradients(kernel, scratch, points, |number, normal| normals[met[number].place] = normal);
        }
        met.retain(|met| normals[met.place].is_nan());
    }
    Ok(())
}

/// A point of the surface that a ray meets, and the ray's place.
struct Met {
    place: usize,
    ray: Ray,
    hit: Hit,
    touches: bool,
}

impl Met {
    fn new(tile: Tile<'_>, place: usize, outcome: &Outcome) -> Option<Self> {
        match *outcome {
            Outcome::Hit(hit) => Some(Self { place, ray: tile.ray_at(place), hit, touches: false }),
            Outcome::Touch(hit) => Some(Self { place, ray: tile.ray_at(place), hit, touches: true }),
            Outcome::Miss | Outcome::Undecided(_) => None,
        }
    }

    /// The point itself. At a touch the gradient may be nothing but rounding, so there it is the nearest point in front.
    fn point(&self) -> DVec3 {
        if self.touches { self.point_in_front(APPROACH[0]) } else { self.ray.at(self.hit.t) }
    }

    /// The point in front of the bracket by 2 to this power of the way to it, or of the bracket's length if that is more.
    fn point_in_front(&self, power: i32) -> DVec3 {
        let bracket = self.hit.bracket;
        let way = bracket
            .end
            .abs()
            .max(self.ray.origin.abs().max_element() / self.ray.direction.abs().max_element());
        let nearest = way * 2_f64.powi(APPROACH[0]);
        let distance = nearest.max(bracket.end - bracket.start) * 2_f64.powi(power - APPROACH[0]);
        self.ray.at(bracket.start - distance)
    }
}

/// Passes on each point's number and unit gradient, NaN where there is none.
fn unit_gradients(
    kernel: &dyn BatchKernel,
    scratch: &mut Scratch,
    points: &mut PointBatch,
    mut pass: impl FnMut(usize, DVec3),
) {
    let count = points.len();
    let outputs = points.evaluate(kernel, scratch, 4);
    for number in 0..count {
        let derivative = |axis: usize| outputs[(axis + 1) * count + number];
        let gradient = DVec3::new(derivative(0), derivative(1), derivative(2));
        pass(number, unit(gradient).unwrap_or(DVec3::NAN));
    }
}

/// The vector's direction, whatever its length: it is scaled by its largest component first, so that no square overflows
/// or underflows. `None` for zero and for what is not finite.
fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    (vector.is_finite() && largest > 0.0).then(|| (vector / largest).normalize())
}
