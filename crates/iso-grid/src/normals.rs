//! Normals of the surface where rays meet it.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError, Scratch};
use pulp::{Simd, WithSimd};

use crate::area::Area;
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::point_rows::PointRows;
use crate::{Hit, Kernel, Outcome, OutcomeKind, Outcomes, Span, Surface, Tile, Tracer, Workspace};

/// How many rows of points are asked about by one call of the kernel.
const ROWS: usize = 32;

/// Blocks of so many columns and rows may be answered by a shorter formula.
const BLOCK: usize = 8;

/// The distances in front of a point at which its normal is looked for when it has none itself, as parts of the distance
/// that the ray has come: 2⁻⁴⁰, and from there on in powers of 8 up to 2⁻¹⁰.
const APPROACH: [i32; 11] = [-40, -37, -34, -31, -28, -25, -22, -19, -16, -13, -10];

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
/// normal of the side that is seen. It stays NaN when no point up to 2⁻¹⁰ of the ray's way in front has one either.
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
                    Outcome::Touch(Hit { bracket, .. }) => others.push(Met { place, bracket }),
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
        for approach in APPROACH {
            if others.is_empty() {
                break;
            }
            asked.clear();
            asked.extend(others.iter().map(|met| met.in_front(&tile, approach)));
            answer(everywhere, workspace, tile, &asked, normals);
            others.retain(|met| normals[met.place].is_nan());
        }
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
            Outcome::Hit(Hit { bracket, .. }) => Some(Met { place: *place, bracket }),
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
            for (asked, coordinates) in asked.chunks(ROW).zip(points.replace(count)) {
                let (mut columns, mut rows, mut ts) = (Row::default(), Row::default(), [f64::NAN; ROW]);
                for (lane, Asked { place, t }) in asked.iter().enumerate() {
                    columns[lane] = (place % tile.width()) as f64;
                    rows[lane] = (place / tile.width()) as f64;
                    ts[lane] = *t;
                }
                tile.row(simd, &columns, &rows).at(simd, &ts, coordinates);
            }
            let outputs = points.evaluate(kernel, scratch, 4);
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
fn unit_of(vector: DVec3) -> DVec3 {
    let largest = vector.abs().max_element();
    if vector.is_finite() && largest > 0.0 { (vector / largest).normalize() } else { DVec3::NAN }
}

/// The ray of this place in a tile meets the surface in a bracket.
struct Met {
    place: usize,
    bracket: Span,
}

impl Met {
    /// Where the ray is in front of the bracket by 2 to this power of the way to it, or of the bracket's length if that is more.
    fn in_front(&self, tile: &Tile<'_>, power: i32) -> Asked {
        let Self { place, bracket: Span { start, end } } = *self;
        let ray = tile.ray(place % tile.width(), place / tile.width());
        let way = end.abs().max(ray.origin.abs().max_element() / ray.direction.abs().max_element());
        let nearest = way * 2_f64.powi(APPROACH[0]);
        let distance = nearest.max(end - start) * 2_f64.powi(power - APPROACH[0]);
        Asked { place, t: start - distance }
    }
}
