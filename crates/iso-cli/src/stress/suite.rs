//! The cases as they stand in `testdata/stability`, built into the program.

use glam::DVec3;
use iso_expr::{Ast, FormulaError, Program};
use iso_grid::{Ray, Region};
use serde::Deserialize;

use super::shapes::{HalfSpace, Shape};

/// The families with their files, in the order of reports.
const FAMILIES: [(&str, &str); 22] = [
    ("steep", include_str!("../../../../testdata/stability/steep.toml")),
    ("scale", include_str!("../../../../testdata/stability/scale.toml")),
    ("degree", include_str!("../../../../testdata/stability/degree.toml")),
    ("cancellation", include_str!("../../../../testdata/stability/cancellation.toml")),
    ("sheets", include_str!("../../../../testdata/stability/sheets.toml")),
    ("thin", include_str!("../../../../testdata/stability/thin.toml")),
    ("multiple", include_str!("../../../../testdata/stability/multiple.toml")),
    ("poles", include_str!("../../../../testdata/stability/poles.toml")),
    ("jumps", include_str!("../../../../testdata/stability/jumps.toml")),
    ("cuts", include_str!("../../../../testdata/stability/cuts.toml")),
    ("domain", include_str!("../../../../testdata/stability/domain.toml")),
    ("indeterminate", include_str!("../../../../testdata/stability/indeterminate.toml")),
    ("extremes", include_str!("../../../../testdata/stability/extremes.toml")),
    ("iteration", include_str!("../../../../testdata/stability/iteration.toml")),
    ("powers", include_str!("../../../../testdata/stability/powers.toml")),
    ("classic", include_str!("../../../../testdata/stability/classic.toml")),
    ("constants", include_str!("../../../../testdata/stability/constants.toml")),
    ("missing", include_str!("../../../../testdata/stability/missing.toml")),
    ("empty", include_str!("../../../../testdata/stability/empty.toml")),
    ("filled", include_str!("../../../../testdata/stability/filled.toml")),
    ("one_cell", include_str!("../../../../testdata/stability/one_cell.toml")),
    ("frequency", include_str!("../../../../testdata/stability/frequency.toml")),
];

/// A family of cases: one file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Family {
    /// What its cases have in common.
    about: String,
    case: Vec<Entry>,
}

/// A surface, what makes it hard, and what is true of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: String,
    formula: String,
    #[serde(rename = "box")]
    region: [f64; 6],
    hard: String,
    surface: Option<Vec<Shape>>,
    #[serde(default)]
    within: Vec<HalfSpace>,
    same_as: Option<String>,
    #[serde(default)]
    filled: bool,
    open: Option<String>,
    #[serde(default)]
    ray: Vec<StatedRay>,
}

/// A case of the suite.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// Its family.
    pub(crate) family: &'static str,
    /// What the cases of the family have in common.
    pub(crate) about: String,
    /// Its name, different from all others.
    pub(crate) name: String,
    /// An equation, or an expression that is zero on the surface.
    pub(crate) formula: String,
    /// Where it is looked for.
    pub(crate) region: Region,
    /// What makes it hard.
    pub(crate) hard: String,
    /// What the surface is.
    pub(crate) surface: Stated,
    /// Why rays may end as a touch or undecided; where it is missing, every ray ends as a hit or a miss.
    pub(crate) open: Option<String>,
    /// Rays whose ends are stated.
    pub(crate) rays: Vec<StatedRay>,
}

/// What is true of a surface inside its box.
#[derive(Clone, Debug)]
pub(crate) enum Stated {
    /// It is the union of these shapes, inside all of these half-spaces.
    Shapes(Vec<Shape>, Vec<HalfSpace>),
    /// It is the surface of this formula, which is easier.
    SameAs(String),
    /// It is every point of the box.
    Filled,
    /// It is known along some rays only.
    AlongRays,
}

/// A ray whose end follows from a closed form.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StatedRay {
    origin: [f64; 3],
    direction: [f64; 3],
    /// How it ends.
    pub(crate) ends: StatedEnd,
    /// Where it ends, unless it is a miss.
    pub(crate) t: Option<f64>,
}

/// How a stated ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum StatedEnd {
    /// With a crossing.
    Hit,
    /// With a root that is no crossing.
    Touch,
    /// Without a root.
    Miss,
}

impl StatedRay {
    /// The ray.
    pub(crate) fn ray(&self) -> Ray {
        Ray { origin: DVec3::from_array(self.origin), direction: DVec3::from_array(self.direction) }
    }
}

/// All cases, family by family.
pub(crate) fn cases() -> Vec<Case> {
    let family = |(name, text): &(&'static str, &str)| {
        let Family { about, case } =
            toml::from_str(text).unwrap_or_else(|error| panic!("testdata/stability/{name}.toml: {error}"));
        case.into_iter().map(|entry| entry.case(name, &about)).collect::<Vec<_>>()
    };
    FAMILIES.iter().flat_map(family).collect()
}

impl Entry {
    fn case(self, family: &'static str, about: &str) -> Case {
        let [x0, y0, z0, x1, y1, z1] = self.region;
        let region = Region::new(DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1));
        let surface = match (self.surface, self.same_as, self.filled) {
            (Some(shapes), None, false) => Stated::Shapes(shapes, self.within),
            (None, Some(formula), false) => Stated::SameAs(formula),
            (None, None, true) => Stated::Filled,
            (None, None, false) if !self.ray.is_empty() => Stated::AlongRays,
            _ => panic!("{}: one thing is stated of a surface", self.name),
        };
        Case {
            family,
            about: about.to_owned(),
            region: region.unwrap_or_else(|error| panic!("{}: {error}", self.name)),
            name: self.name,
            formula: self.formula,
            hard: self.hard,
            surface,
            open: self.open,
            rays: self.ray,
        }
    }
}

/// The program of F of a formula of the suite.
pub(crate) fn program(formula: &str) -> Result<Program, FormulaError> {
    Ok(Ast::parse(formula)?.lower(&[])?.program().clone())
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn there_are_enough_cases_and_each_has_its_own_name() {
        let cases = cases();
        let names: HashSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        assert_eq!(names.len(), cases.len());
        assert!(cases.len() >= 60, "{} cases", cases.len());
    }

    #[test]
    fn every_formula_is_in_the_language() {
        for case in cases() {
            program(&case.formula).unwrap_or_else(|error| panic!("{}: {error}", case.name));
            if let Stated::SameAs(formula) = &case.surface {
                program(formula).unwrap_or_else(|error| panic!("{}: {error}", case.name));
            }
        }
    }

    #[test]
    fn every_file_is_built_in() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/stability");
        let files: HashSet<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        let built_in: HashSet<String> = FAMILIES.iter().map(|(name, _)| format!("{name}.toml")).collect();
        assert_eq!(files, built_in);
    }
}
