//! Normals of the surface where rays meet it.

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError, Scratch};

use crate::batch::PointBatch;
use crate::{Counters, Hit, Outcome, Ray, Surface, Tile, Workspace};

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
    normals.fill(DVec3::NAN);
    if !outcomes.iter().any(|outcome| matches!(outcome, Outcome::Hit(_) | Outcome::Touch(_))) {
        return Ok(());
    }
    let kernel = &**surface.gradients()?;
    let Workspace { scratch, counters, points, .. } = workspace;
    let mut gradients = Gradients { kernel, scratch, counters, points, places: Vec::with_capacity(BATCH) };
    let mut others = Vec::new();
    for (place, ((column, row), outcome)) in tile.positions().zip(outcomes).enumerate() {
        match *outcome {
            Outcome::Hit(hit) => gradients.ask(place, tile.ray(column, row).at(hit.t), normals),
            // The gradient there may be nothing but rounding.
            Outcome::Touch(hit) => others.push(Met { place, ray: tile.ray(column, row), hit }),
            Outcome::Miss | Outcome::Undecided(_) => {}
        }
    }
    gradients.answer(normals);
    for (place, ((column, row), outcome)) in tile.positions().zip(outcomes).enumerate() {
        if let (Outcome::Hit(hit), true) = (*outcome, normals[place].x.is_nan()) {
            others.push(Met { place, ray: tile.ray(column, row), hit });
        }
    }
    for approach in APPROACH {
        others.iter().for_each(|met| gradients.ask(met.place, met.point_in_front(approach), normals));
        gradients.answer(normals);
        others.retain(|met| normals[met.place].is_nan());
    }
    Ok(())
}

/// Points whose gradients are asked for together.
struct Gradients<'a> {
    kernel: &'a dyn BatchKernel,
    scratch: &'a mut Scratch,
    counters: &'a mut Counters,
    points: &'a mut PointBatch,
    /// Where the normal of each point is to stand.
    places: Vec<usize>,
}

impl Gradients<'_> {
    /// Asks for the normal at a point, which is to stand at a place of `normals`.
    fn ask(&mut self, place: usize, point: DVec3, normals: &mut [DVec3]) {
        if self.places.is_empty() {
            self.points.clear();
        }
        self.points.push(point);
        self.places.push(place);
        if self.places.len() == BATCH {
            self.answer(normals);
        }
    }

    /// Puts the normals asked for in their places, NaN where there is none.
    fn answer(&mut self, normals: &mut [DVec3]) {
        let count = self.places.len();
        if count == 0 {
            return;
        }
        self.counters.gradient_evaluations += count as u64;
        let outputs = self.points.evaluate(self.kernel, self.scratch, 4);
        let [x, y, z] = [1, 2, 3].map(|output| &outputs[output * count..][..count]);
        for (number, place) in self.places.drain(..).enumerate() {
            let gradient = DVec3::new(x[number], y[number], z[number]);
            normals[place] = unit(gradient).unwrap_or(DVec3::NAN);
        }
    }
}

/// A point of the surface that a ray meets, and the ray's place.
struct Met {
    place: usize,
    ray: Ray,
    hit: Hit,
}

impl Met {
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

/// The vector's direction, whatever its length: it is scaled by its largest component first where squares may overflow or
/// underflow. `None` for zero and for what is not finite.
fn unit(vector: DVec3) -> Option<DVec3> {
    let square = vector.length_squared();
    if (1e-200..1e200).contains(&square) {
        return Some(square.sqrt().recip() * vector);
    }
    let largest = vector.abs().max_element();
    (vector.is_finite() && largest > 0.0).then(|| (vector / largest).normalize())
}
