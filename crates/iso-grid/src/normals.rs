//! Normals of the surface where rays meet it.

use glam::DVec3;
use iso_expr::{BatchKernel, CompileError, Scratch};
use pulp::{Simd, WithSimd};

use crate::area::Area;
use crate::batch::PointBatch;
use crate::lanes::{Lanes, ROW, Row, parts};
use crate::{Hit, Outcome, Span, Surface, Tile, Tracer, Workspace};

/// How many rows of points are asked about by one call of the kernel.
const ROWS: usize = 32;

/// Blocks of so many columns and rows may be answered by a shorter formula.
const BLOCK: usize = 16;
/// They are when so many normals are asked for there.
const MANY: usize = 64;

/// The distances in front of a point at which its normal is looked for when it has none itself, as parts of the distance
/// that the ray has come: 2⁻⁴⁰, and from there on in powers of 8 up to 2⁻¹⁰.
const APPROACH: [i32; 11] = [-40, -37, -34, -31, -28, -25, -22, -19, -16, -13, -10];

/// The unit normal ∇F/|∇F| at each hit and touch, towards larger F whichever way the ray comes; NaN for other outcomes.
/// Both slices hold something for each ray of the tile.
///
/// A `tracer` for the surface may know [shorter formulas](Tracer::gradients_on) around neighbouring rays, which give the same normals.
///
/// At a touch, and where the gradient vanishes or is no finite vector, the normal is a limit: that of the points in front of the hit, on
/// the side that the ray comes from, the nearest that has one. So a double root such as (x² + y² + z² − 1)² = 0 has the
/// normal of the side that is seen. NaN when no point up to 2⁻¹⁰ of the ray's way in front has one either.
///
/// # Errors
/// When the engine cannot compile the gradient.
pub fn normals(
    surface: &Surface,
    tracer: Option<&dyn Tracer>,
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
    let everywhere = surface.gradients()?;
    let mut asked = std::mem::take(&mut workspace.asked);
    asked.clear();
    asked.extend(
        outcomes.iter().map(|outcome| if let Outcome::Hit(hit) = outcome { hit.t } else { f64::NAN }),
    );
    let all = Area { column: 0, row: 0, width: tile.width(), height: tile.height() };
    if let (Some(tracer), true) = (tracer, surface.program().has_branches()) {
        for block in all.blocks(BLOCK) {
            answer_block(tracer, workspace, (tile, block), &mut asked, normals);
        }
    }
    answer(&**everywhere, workspace, (tile, all), &asked, normals);
    let mut others: Vec<Met> = Vec::new();
    for (place, outcome) in outcomes.iter().enumerate() {
        match *outcome {
            Outcome::Hit(Hit { bracket, .. }) if normals[place].x.is_nan() => {
                others.push(Met { place, bracket })
            }
            // The gradient there may be nothing but rounding.
            Outcome::Touch(Hit { bracket, .. }) => others.push(Met { place, bracket }),
            _ => {}
        }
    }
    for approach in APPROACH {
        if others.is_empty() {
            break;
        }
        asked.fill(f64::NAN);
        for met in &others {
            asked[met.place] = met.in_front(&tile, approach);
        }
        answer(&**everywhere, workspace, (tile, all), &asked, normals);
        others.retain(|met| normals[met.place].is_nan());
    }
    workspace.asked = asked;
    Ok(())
}

/// Answers what is asked for in a block, and asks for it no more, where the tracer knows a shorter formula.
fn answer_block(
    tracer: &dyn Tracer,
    workspace: &mut Workspace,
    (tile, block): (Tile<'_>, Area),
    asked: &mut [f64],
    normals: &mut [DVec3],
) {
    let Some((lo, hi)) = around(tile, block, asked) else { return };
    let Some(kernel) = tracer.gradients_on(lo, hi) else { return };
    answer(&*kernel, workspace, (tile, block), asked, normals);
    for row in block.rows() {
        asked[row * tile.width()..][block.columns()].fill(f64::NAN);
    }
}

/// The corners of a box around the points of a block at which normals are asked for, if there are many.
fn around(tile: Tile<'_>, block: Area, asked: &[f64]) -> Option<(DVec3, DVec3)> {
    let (mut count, mut lo, mut hi) = (0, DVec3::INFINITY, DVec3::NEG_INFINITY);
    for row in block.rows() {
        for column in block.columns() {
            let t = asked[row * tile.width() + column];
            if !t.is_nan() {
                let point = tile.ray(column, row).at(t);
                (count, lo, hi) = (count + 1, lo.min(point), hi.max(point));
            }
        }
    }
    (count >= MANY).then_some((lo, hi))
}

/// Puts the normals in their places that are asked for in an area: at these t of the rays of a tile, NaN where none is.
fn answer(
    kernel: &dyn BatchKernel,
    workspace: &mut Workspace,
    (tile, area): (Tile<'_>, Area),
    asked: &[f64],
    normals: &mut [DVec3],
) {
    let Workspace { arch, scratch, counters, points, .. } = workspace;
    counters.gradient_evaluations +=
        arch.dispatch(Search { kernel, tile, area, asked, points, scratch, normals });
}

/// The search for the normals of an area of a tile.
struct Search<'a> {
    kernel: &'a dyn BatchKernel,
    tile: Tile<'a>,
    area: Area,
    asked: &'a [f64],
    points: &'a mut PointBatch,
    scratch: &'a mut Scratch,
    normals: &'a mut [DVec3],
}

impl WithSimd for Search<'_> {
    /// How many normals were asked for.
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        let Self { kernel, tile, area, asked, points, scratch, normals } = self;
        let mut units = [[0.0; ROW]; 4];
        let lanes_of = |column: usize| ROW.min(area.column + area.width - column);
        let mut rows = area
            .rows()
            .flat_map(|row| area.columns().step_by(ROW).map(move |column| (row, column)))
            .map(|(row, column)| (row * tile.width() + column, lanes_of(column)))
            .filter(|(first, lanes)| asked[*first..][..*lanes].iter().any(|t| !t.is_nan()));
        let mut firsts = [(0, 0); ROWS];
        let mut answered = 0;
        loop {
            let mut count = 0;
            for (place, first) in firsts.iter_mut().zip(&mut rows) {
                *place = first;
                count += 1;
            }
            if count == 0 {
                return answered;
            }
            for ((first, lanes), coordinates) in firsts.iter().zip(points.rows(count)) {
                let t = row_of(&asked[*first..][..*lanes]);
                tile.row_from(simd, *first).at(simd, &t, coordinates);
            }
            let outputs = points.evaluate(kernel, scratch, 4);
            let (outputs, _) = outputs.as_chunks::<ROW>();
            for (number, (first, lanes)) in firsts[..count].iter().enumerate() {
                let gradients = [1, 2, 3].map(|output| &outputs[output * count + number]);
                put_units(simd, gradients, &mut units);
                for (lane, t) in asked[*first..][..*lanes].iter().enumerate() {
                    if t.is_nan() {
                        continue;
                    }
                    answered += 1;
                    let [x, y, z, is_plain] = units.each_ref().map(|row| row[lane]);
                    let found = || unit_of(DVec3::from_array(gradients.map(|row| row[lane])));
                    normals[first + lane] = if is_plain > 0.0 { DVec3::new(x, y, z) } else { found() };
                }
            }
        }
    }
}

/// Up to a row of numbers; NaN behind the last.
#[inline(always)]
fn row_of(numbers: &[f64]) -> Row {
    let mut row = [f64::NAN; ROW];
    row[..numbers.len()].copy_from_slice(numbers);
    row
}

/// The directions of vectors, coordinate by coordinate, and beside them 1 where squares neither overflow nor underflow, or else 0.
#[inline(always)]
fn put_units<S: Simd>(simd: S, vectors: [&Row; 3], [units @ .., are_plain]: &mut [Row; 4]) {
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
    fn in_front(&self, tile: &Tile<'_>, power: i32) -> f64 {
        let Span { start, end } = self.bracket;
        let ray = tile.ray(self.place % tile.width(), self.place / tile.width());
        let way = end.abs().max(ray.origin.abs().max_element() / ray.direction.abs().max_element());
        let nearest = way * 2_f64.powi(APPROACH[0]);
        let distance = nearest.max(end - start) * 2_f64.powi(power - APPROACH[0]);
        start - distance
    }
}
