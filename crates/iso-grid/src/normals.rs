//! Normals of the surface where rays meet it.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError, Scratch};
use pulp::{Simd, WithSimd};

use crate::area::Area;
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::mean_slopes::Around;
use crate::point_rows::{PointRows, row_of};
use crate::{Hit, Kernel, Outcome, OutcomeKind, Outcomes, Ray, Span, Surface, Tile, Tracer, Workspace};

/// How many rows of points are asked about by one call of the kernel.
const ROWS: usize = 32;

/// Blocks of so many columns and rows may be answered by a shorter formula.
const BLOCK: usize = 8;

/// The distances in front of a point at which its normal is looked for when it has none itself, as powers of two of the distance
/// that the ray has come.
const NEAR: [i32; 3] = [-40, -37, -34];

/// Those where it is looked for farther in front, if the gradient vanishes up to there.
const FAR: [i32; 8] = [-31, -28, -25, -22, -19, -16, -13, -10];

/// The unit normal ∇F/|∇F| at each hit and touch, towards larger F whichever way the ray comes, and nothing new for other outcomes.
/// There is one of both for each ray of the tile, the normals NaN where they are not known yet: others were found on the way
/// by [`Tracer::trace_tile`] and stay.
///
/// A `tracer` for the surface may know [shorter formulas](Tracer::gradients_on) around neighbouring rays, which give the same normals. Those that
/// [`Certified`](crate::Certified) finds on the way are of [`Surface::by_signs`]: another function may give others in the last bits, or none where
/// it has no gradient.
///
/// At a touch, and where the gradient vanishes or is no finite vector, the normal is a limit: that of the points in front of the hit, on
/// the side that the ray comes from, the nearest that has one. So a double root such as (x² + y² + z² − 1)² = 0 has the
/// normal of the side that is seen. Where the gradient vanishes, it is looked for up to 2⁻¹⁰ of the ray's way in front; it stays NaN when there is none.
///
/// Where the gradient is not finite, as where a derivative overflows, another one is looked for up to 2⁻³⁴ of the ray's way in front only. Where
/// there is none, the normal is the direction of the mean slopes of F along the axes, which by the mean value theorem are derivatives nearby: over a step
/// of 2⁻³⁰, 2⁻²⁶ or 2⁻²² of the largest coordinate on the way, that at which longer and shorter ones agree best. It stays NaN where F itself is not
/// finite around the hit.
///
/// # Errors
/// When the engine cannot compile the gradient.
pub fn normals(
    surface: &Surface,
    tracer: Option<&dyn Tracer>,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    outcomes: &Outcomes,
    normals: &mut [DVec3],
) -> Result<(), CompileError> {
    assert!(
        tile.len() == outcomes.len() && tile.len() == normals.len(),
        "each ray has an outcome and a normal"
    );
    let shorter = tracer.filter(|_| surface.program().has_branches());
    let side = if shorter.is_some() { BLOCK } else { usize::MAX };
    let mut asked = std::mem::take(&mut workspace.asked);
    let mut others = Vec::new();
    asked.clear();
    for block in (Area { column: 0, row: 0, width: tile.width(), height: tile.height() }).blocks(side) {
        let first = asked.len();
        for places in block.places(tile.width()) {
            let kinds = outcomes.kinds()[places.clone()].iter();
            let known = normals[places.clone()].iter();
            let is_wanted = |(kind, normal): (&OutcomeKind, &DVec3)| {
                normal.x.is_nan() && matches!(kind, OutcomeKind::Hit | OutcomeKind::Touch)
            };
            for place in places.zip(kinds.zip(known)).filter_map(|(place, of)| is_wanted(of).then_some(place))
            {
                match outcomes.get(place) {
                    Outcome::Hit(Hit { t, .. }) => asked.push(Asked { place, t }),
                    // The gradient there may be nothing but rounding.
                    Outcome::Touch(Hit { bracket, .. }) => others.push(Met { place, bracket, t: None }),
                    _ => {}
                }
            }
        }
        if let Some(kernel) = shorter.and_then(|tracer| kernel_on(tracer, tile, &asked[first..])) {
            answer(&*kernel, workspace, tile, &asked[first..], normals);
            others.extend(unanswered(&asked[first..], outcomes, normals));
            asked.truncate(first);
        }
    }
    if !(asked.is_empty() && others.is_empty()) {
        let everywhere = &**surface.over_points(Kernel::Gradients)?;
        answer(everywhere, workspace, tile, &asked, normals);
        others.extend(unanswered(&asked, outcomes, normals));
        approach(everywhere, (workspace, tile), NEAR, &mut others, normals);
        let steep = steep(everywhere, workspace, tile, &mut others);
        if !steep.is_empty() {
            put_mean_slopes(&**surface.over_points(Kernel::Values)?, workspace, tile, &steep, normals);
        }
        approach(everywhere, (workspace, tile), FAR, &mut others, normals);
    }
    workspace.asked = asked;
    Ok(())
}

/// A point at which a normal is asked for: where on the ray of this place in a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) place: usize,
    pub(crate) t: f64,
}

/// Puts the normals of points in front of where these rays meet the surface in their places, the nearest that has one. Rays that have theirs are
/// left out.
fn approach<const N: usize>(
    kernel: &dyn BatchKernel,
    (workspace, tile): (&mut Workspace, Tile<'_>),
    distances: [i32; N],
    others: &mut Vec<Met>,
    normals: &mut [DVec3],
) {
    for power in distances {
        if others.is_empty() {
            return;
        }
        let asked: Vec<_> = others.iter().map(|met| met.in_front(&tile, power)).collect();
        answer(kernel, workspace, tile, &asked, normals);
        others.retain(|met| normals[met.place].is_nan());
    }
}

/// Takes the rays out that have no finite gradient where their normals are looked for.
fn steep(
    kernel: &dyn BatchKernel,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    others: &mut Vec<Met>,
) -> Vec<Met> {
    let Workspace { points, scratch, counters, .. } = workspace;
    points.clear();
    others.iter().for_each(|met| points.push(met.point(&tile)));
    counters.gradient_evaluations += points.len() as u64;
    let outputs = points.evaluate(kernel, scratch, 4);
    let (count, mut number) = (others.len(), 0..);
    let is_steep = |_: &mut Met| {
        let number = number.next().expect("numbers do not end");
        (1..4).any(|output| !outputs[output * count + number].is_finite())
    };
    others.extract_if(.., is_steep).collect()
}

/// Puts the directions of mean slopes in the places of these rays.
fn put_mean_slopes(
    kernel: &dyn BatchKernel,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    rays: &[Met],
    normals: &mut [DVec3],
) {
    let Workspace { points, scratch, counters, .. } = workspace;
    for rays in rays.chunks(ROWS) {
        let around = |met: &Met| Around { point: met.point(&tile), scale: met.scale(&tile) };
        points.clear();
        rays.iter().flat_map(|met| around(met).points()).for_each(|point| points.push(point));
        counters.gradient_evaluations += points.len() as u64;
        let values = points.evaluate(kernel, scratch, 1);
        for (met, values) in rays.iter().zip(values.chunks_exact(Around::POINTS)) {
            normals[met.place] = around(met).normal(values);
        }
    }
}

/// The shorter formula that the tracer knows around some points of a block.
fn kernel_on(tracer: &dyn Tracer, tile: Tile<'_>, asked: &[Asked]) -> Option<Arc<dyn BatchKernel>> {
    if asked.is_empty() {
        return None;
    }
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for Asked { place, t } in asked {
        let point = tile.ray(place % tile.width(), place / tile.width()).at(*t);
        (lo, hi) = (lo.min(point), hi.max(point));
    }
    tracer.gradients_on(lo, hi)
}

/// The hits that were asked about and have no normal.
fn unanswered(asked: &[Asked], outcomes: &Outcomes, normals: &[DVec3]) -> impl Iterator<Item = Met> {
    asked.iter().filter(|asked| normals[asked.place].x.is_nan()).filter_map(|Asked { place, .. }| {
        match outcomes.get(*place) {
            Outcome::Hit(Hit { t, bracket }) => Some(Met { place: *place, bracket, t: Some(t) }),
            _ => None,
        }
    })
}

/// Puts the normals in their places that are asked for along the rays of a tile; says whether there is each of them.
pub(crate) fn answer(
    kernel: &dyn BatchKernel,
    workspace: &mut Workspace,
    tile: Tile<'_>,
    asked: &[Asked],
    normals: &mut [DVec3],
) -> bool {
    let Workspace { arch, scratch, counters, point_rows, .. } = workspace;
    counters.gradient_evaluations += asked.len() as u64;
    arch.dispatch(Search { kernel, tile, asked, points: point_rows, scratch, normals })
}

/// The search for the normals of points on the rays of a tile.
struct Search<'a> {
    kernel: &'a dyn BatchKernel,
    tile: Tile<'a>,
    asked: &'a [Asked],
    points: &'a mut PointRows,
    scratch: &'a mut Scratch,
    normals: &'a mut [DVec3],
}

impl WithSimd for Search<'_> {
    /// Whether there is each of them.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { kernel, tile, asked, points, scratch, normals } = self;
        let (mut units, mut is_each_there) = ([[0.0; ROW]; 4], true);
        for asked in asked.chunks(ROW * ROWS) {
            let count = asked.len().div_ceil(ROW);
            let mut coordinates = points.replace(count);
            for (number, asked) in asked.chunks(ROW).enumerate() {
                let (mut columns, mut rows, mut ts) = (Row::default(), Row::default(), [f64::NAN; ROW]);
                for (lane, Asked { place, t }) in asked.iter().enumerate() {
                    columns[lane] = (place % tile.width()) as f64;
                    rows[lane] = (place / tile.width()) as f64;
                    ts[lane] = *t;
                }
                tile.row(simd, &columns, &rows).at(simd, &ts, row_of(&mut coordinates, number));
            }
            let (outputs, _) = points.evaluate(kernel, scratch, 4);
            for (number, asked) in asked.chunks(ROW).enumerate() {
                let gradients = [1, 2, 3].map(|output| &outputs[output * count + number]);
                put_units(simd, gradients, &mut units);
                for (lane, Asked { place, .. }) in asked.iter().enumerate() {
                    let [x, y, z, is_plain] = units.each_ref().map(|row| row[lane]);
                    normals[*place] = if is_plain > 0.0 {
                        DVec3::new(x, y, z)
                    } else {
                        let found = unit_of(DVec3::from_array(gradients.map(|row| row[lane])));
                        is_each_there &= !found.is_nan();
                        found
                    };
                }
            }
        }
        is_each_there
    }
}

/// The directions of vectors, coordinate by coordinate, and beside them 1 where squares neither overflow nor underflow, or else 0.
#[inline(always)]
pub(crate) fn put_units<S: Simd>(simd: S, vectors: [&Row; 3], [units @ .., are_plain]: &mut [Row; 4]) {
    let all = |number| Lanes::all(simd, number);
    for part in 0..parts::<S>() {
        let [x, y, z] = vectors;
        let (x, y, z) = (Lanes::of(simd, x, part), Lanes::of(simd, y, part), Lanes::of(simd, z, part));
        let square = x * x + y * y + z * z;
        let is_plain = all(1e-200).is_at_most(square) & square.is_less(all(1e200));
        let scale = all(1.0) / square.sqrt();
        for (vector, unit) in [x, y, z].into_iter().zip(&mut *units) {
            (scale * vector).put(unit, part);
        }
        is_plain.select(all(1.0), all(0.0)).put(are_plain, part);
    }
}

/// The direction of a vector whatever its length, NaN for zero and for what is not finite: it is scaled by its largest component
/// first, where squares may overflow or underflow.
#[cold]
pub(crate) fn unit_of(vector: DVec3) -> DVec3 {
    let largest = vector.abs().max_element();
    if vector.is_finite() && largest > 0.0 { (vector / largest).normalize() } else { DVec3::NAN }
}

/// The ray of this place in a tile meets the surface in a bracket.
struct Met {
    place: usize,
    bracket: Span,
    /// Where it does at a hit; at a touch the gradient may be nothing but rounding.
    t: Option<f64>,
}

impl Met {
    fn ray(&self, tile: &Tile<'_>) -> Ray {
        tile.ray(self.place % tile.width(), self.place / tile.width())
    }

    /// The largest coordinate on the way to the bracket, of the ray's origin or relative to it.
    fn scale(&self, tile: &Tile<'_>) -> f64 {
        let Ray { origin, direction } = self.ray(tile);
        origin.abs().max_element().max(self.bracket.end.abs() * direction.abs().max_element())
    }

    /// Where the ray is in front of the bracket by 2 to this power of the way to it, or of the bracket's length if that is more.
    fn in_front(&self, tile: &Tile<'_>, power: i32) -> Asked {
        let Self { place, bracket: Span { start, end }, .. } = *self;
        let ray = self.ray(tile);
        let way = end.abs().max(ray.origin.abs().max_element() / ray.direction.abs().max_element());
        let nearest = way * 2_f64.powi(NEAR[0]);
        let distance = nearest.max(end - start) * 2_f64.powi(power - NEAR[0]);
        Asked { place, t: start - distance }
    }

    /// The point whose normal is looked for: that of a hit, or one in front of a touch.
    fn point(&self, tile: &Tile<'_>) -> DVec3 {
        let t = self.t.unwrap_or_else(|| self.in_front(tile, NEAR[NEAR.len() - 1]).t);
        self.ray(tile).at(t)
    }
}
