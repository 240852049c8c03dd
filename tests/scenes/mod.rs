//! The scenes of `testdata/oracle` and their rays, whose ends an independent program decided (`tools/oracle/README.md`).

pub(crate) mod rounding;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use iso_expr::{Ast, Engine};
use iso_grid::{Ray, Region, Span, Surface};
use serde::Deserialize;

/// One surface in its region.
#[derive(Deserialize)]
pub(crate) struct Scene {
    pub(crate) name: String,
    formula: String,
    level: f64,
    #[serde(rename = "box")]
    region: [f64; 6],
    pub(crate) tags: Vec<String>,
}

/// What the independent program says of one ray.
pub(crate) struct Verdict {
    pub(crate) ray: Ray,
    pub(crate) status: Status,
    /// The first root, or where the program stopped; NaN for a miss.
    pub(crate) t: f64,
    /// Where the root certainly is, or where the program stopped.
    pub(crate) place: Span,
    /// The unit gradient at the root; NaN where there is none.
    pub(crate) normal: DVec3,
}

/// How a ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Hit,
    Miss,
    Touch,
    Undecided,
}

/// All scenes in the order of the file; only those whose name contains the environment variable `ISO_SCENES`, if it is
/// set.
pub(crate) fn all() -> Vec<Scene> {
    #[derive(Deserialize)]
    struct File {
        scene: Vec<Scene>,
    }
    let wanted = std::env::var("ISO_SCENES").unwrap_or_default();
    let text = fs::read_to_string(folder().join("scenes.toml")).expect("the scenes are in the repository");
    let file: File = toml::from_str(&text).expect("the scenes are well-formed");
    file.scene.into_iter().filter(|scene| scene.name.contains(&wanted)).collect()
}

impl Scene {
    /// The box of the scene.
    pub(crate) fn region(&self) -> Region {
        let [x0, y0, z0, x1, y1, z1] = self.region;
        Region::new(DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1)).expect("the scenes have proper boxes")
    }

    /// The kernels of F − level.
    pub(crate) fn surface(&self, engine: Arc<dyn Engine>) -> Surface {
        let ast = Ast::parse(&self.formula).expect("the scenes' formulas are in the language");
        let formula = ast.lower(&[]).expect("the scenes' formulas have no parameters");
        let value = formula.minus_level(self.level).simplified();
        Surface::new(engine, value)
    }

    /// The rays of the scene, row by row.
    pub(crate) fn verdicts(&self) -> Vec<Verdict> {
        let mut verdicts: Vec<Verdict> = rows(&self.name, "csv").map(|row| verdict(&row)).collect();
        for row in rows(&self.name, "aux.csv") {
            let verdict = &mut verdicts[row[0].parse::<usize>().expect("rows are numbered")];
            verdict.place = Span { start: number(&row, 3), end: number(&row, 4) };
        }
        verdicts
    }
}

impl Verdict {
    /// Whether `stretch` may hold what the program found.
    pub(crate) fn overlaps(&self, stretch: Span) -> bool {
        stretch.start <= self.place.end && self.place.start <= stretch.end
    }
}

/// The rows of one of a scene's files.
fn rows(scene: &str, ending: &str) -> impl Iterator<Item = csv::StringRecord> {
    let file = folder().join("hits").join(format!("{scene}.{ending}"));
    let reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).from_path(file).expect("each scene has its rays");
    reader.into_records().map(|row| row.expect("the rows are well-formed"))
}

fn number(row: &csv::StringRecord, column: usize) -> f64 {
    row[column].parse().expect("the columns hold numbers")
}

/// Columns: ox,oy,oz,dx,dy,dz,t0,t1,status,t,nx,ny,nz
fn verdict(row: &csv::StringRecord) -> Verdict {
    /// The program encloses its hits to this part of the ray's end.
    const PROGRAM_ACCURACY: f64 = 1e-14;
    let vector = |column| DVec3::new(number(row, column), number(row, column + 1), number(row, column + 2));
    let (t, slack) = (number(row, 9), PROGRAM_ACCURACY * number(row, 7));
    Verdict {
        ray: Ray { origin: vector(0), direction: vector(3) },
        status: match &row[8] {
            "hit" => Status::Hit,
            "miss" => Status::Miss,
            "touch" => Status::Touch,
            "undecided" => Status::Undecided,
            other => panic!("`{other}` is no status"),
        },
        t,
        place: Span { start: t - slack, end: t + slack },
        normal: vector(10),
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/oracle")
}
