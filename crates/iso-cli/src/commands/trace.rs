//! `iso trace`: rays, followed to the surface.

use std::io::{self, Write};
use std::iter;
use std::path::Path;

use glam::DVec3;
use iso_expr::CompileError;
use iso_grid::{Accuracy, Outcome, OutcomeKind, Outcomes, Ray, Surface, Tracer, Workspace, normals};
use iso_render::Status;
use rayon::prelude::*;

use crate::engine::{engine, threads};
use crate::failure::Failure;
use crate::flags::TraceFlags;
use crate::formula::{file_of, minus_level, understand};
use crate::interruption::Interruption;
use crate::method::{fitted_unless, method};
use crate::notes::outside;
use crate::output::Destination;
use crate::pictures::status_name;
use crate::plan::plan_of_rays;
use crate::table::{self, TableError, TableWriter, digits};

/// Rays that a thread follows at a time.
const BATCH: usize = 1024;

/// Follows rays.
pub(crate) fn run(flags: TraceFlags) -> Result<(), Failure> {
    let interruption = Interruption::new(&flags.limit);
    let method = method(&flags.method, Accuracy::NARROW)?;
    let form = flags.table.form();
    let destination = Destination::new(flags.table.output)?;
    let formula_file = file_of(&flags.formula.formula);
    let mut sources = flags.rays.rays.iter().chain(&formula_file);
    sources.try_for_each(|source| destination.spares(source))?;
    let formula = understand(&flags.formula)?;
    let program = minus_level(&formula, flags.level.level)?.simplified();
    let rays = flags.rays.rays.as_deref().map_or(Ok(flags.rays.ray), read_rays)?;
    let plan = plan_of_rays(method, &program, flags.method.region.region.is_some());
    let surface = Surface::new(engine(flags.engine.engine)?, program).stopped_by(interruption.stop());
    plan.compile(&surface)?;
    let (fitted, followed) = threads(&flags.threads)?.install(|| {
        let fitted = fitted_unless(flags.method.region.region, &surface)?;
        let tracer = plan.tracer(&surface, fitted.region)?;
        interruption.begin_work();
        Ok::<_, Failure>((fitted, follow(plan.followed(&surface), tracer.as_ref(), &rays)?))
    })?;
    let unfinished = followed.iter().filter(|end| end.is_none()).count() as u64;
    let all = rays.len() as u64;
    interruption.check_begun(unfinished, all)?;
    destination.write(|writer| {
        let mut table = TableWriter::new(writer, COLUMNS.map(str::to_owned).to_vec(), form)?;
        let mut rows = rays.iter().zip(&followed);
        rows.try_for_each(|(ray, end)| table.row(fields(ray, end.as_ref())))?;
        table.finish()
    })?;
    let is_miss = |(outcome, _): &(Outcome, _)| *outcome == Outcome::Miss;
    if let Some(note) = outside("in which rays are followed", &fitted)
        && followed.iter().flatten().any(is_miss)
    {
        // A note that nobody can read is no failure.
        let _ = writeln!(io::stderr(), "note: {note}");
    }
    interruption.check_done(unfinished, all, "rays")
}

fn read_rays(path: &Path) -> Result<Vec<Ray>, TableError> {
    let table = table::read(path, ["ox", "oy", "oz", "dx", "dy", "dz"])?;
    let ray = |row| {
        let [ox, oy, oz, dx, dy, dz] = table.row(row);
        let ray = Ray { origin: DVec3::new(ox, oy, oz), direction: DVec3::new(dx, dy, dz) };
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return Err(table.meaningless(row, "a ray needs six finite numbers"));
        }
        if ray.direction == DVec3::ZERO {
            return Err(table.meaningless(row, "the direction (dx, dy, dz) is zero"));
        }
        Ok(ray)
    };
    (0..table.rows()).map(ray).collect()
}

/// How the search along a ray ended, and the normal there.
type End = (Outcome, DVec3);

/// What becomes of each ray; `None` where work was stopped before it was known.
fn follow(surface: &Surface, tracer: &dyn Tracer, rays: &[Ray]) -> Result<Vec<Option<End>>, CompileError> {
    let mut followed = vec![None; rays.len()];
    rays.par_chunks(BATCH).zip(followed.par_chunks_mut(BATCH)).try_for_each_init(
        Workspace::default,
        |workspace, (rays, followed)| {
            if surface.stop().is_requested() {
                return Ok(());
            }
            let mut outcomes = Outcomes::default();
            let mut found_normals = vec![DVec3::NAN; rays.len()];
            tracer.trace(workspace, rays, &mut outcomes);
            if surface.stop().is_requested() {
                return Ok(());
            }
            normals(surface, None, workspace, rays.into(), &outcomes, &mut found_normals)?;
            for ((place, outcome), normal) in followed.iter_mut().zip(outcomes.iter()).zip(found_normals) {
                *place = Some((outcome, normal));
            }
            Ok(())
        },
    )?;
    Ok(followed)
}

/// The columns of the result.
const COLUMNS: [&str; 10] = ["status", "t", "t_lo", "t_hi", "x", "y", "z", "nx", "ny", "nz"];

/// What became of a ray, column by column.
fn fields(ray: &Ray, end: Option<&End>) -> impl Iterator<Item = String> {
    let (status, numbers) = match end {
        Some((outcome, normal)) => (Status::from(OutcomeKind::from(*outcome)), numbers(ray, outcome, normal)),
        None => (Status::Unfinished, [f64::NAN; COLUMNS.len() - 1]),
    };
    iter::once(status_name(status).to_owned()).chain(numbers.map(digits))
}

/// The numbers of a ray that was followed.
fn numbers(ray: &Ray, outcome: &Outcome, normal: &DVec3) -> [f64; COLUMNS.len() - 1] {
    let (t, t_lo, t_hi) = match outcome {
        Outcome::Hit(hit) | Outcome::Touch(hit) => (hit.t, hit.bracket.start, hit.bracket.end),
        Outcome::Miss => (f64::NAN, f64::NAN, f64::NAN),
        Outcome::Undecided(span) => (f64::NAN, span.start, span.end),
    };
    let point = ray.at(t);
    [t, t_lo, t_hi, point.x, point.y, point.z, normal.x, normal.y, normal.z]
}
