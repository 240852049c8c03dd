//! The suites: scenes of `testdata/oracle`, built into the program.

use glam::DVec3;
use iso_expr::{Ast, Program};
use iso_grid::Region;
use serde::Deserialize;

use crate::flags::SuiteName;

const SCENES: &str = include_str!("../../../../testdata/oracle/scenes.toml");

/// A surface of a suite.
#[derive(Debug)]
pub(crate) struct Scene {
    /// Its name, different from all others.
    pub(crate) name: String,
    /// The formula, with its level.
    pub(crate) formula: String,
    /// What is to be known of it.
    pub(crate) note: String,
    /// The simplified program of F − C.
    pub(crate) program: Program,
    /// Where it is looked for.
    pub(crate) region: Region,
}

#[derive(Deserialize)]
struct File {
    scene: Vec<Entry>,
}

/// A scene as it stands in the file.
#[derive(Deserialize)]
struct Entry {
    name: String,
    formula: String,
    level: f64,
    #[serde(rename = "box")]
    region: [f64; 6],
    tags: Vec<String>,
    note: String,
}

/// The scenes of a suite, in the order of the file.
///
/// # Panics
/// When the file is not as the tests have seen it.
pub(crate) fn scenes(suite: SuiteName) -> Vec<Scene> {
    let file: File = toml::from_str(SCENES).expect("the scenes are well-formed");
    let is_wanted = |entry: &Entry| match suite {
        SuiteName::Classic => entry.tags.iter().any(|tag| tag == "classic"),
        SuiteName::Stiff => entry.tags.iter().any(|tag| tag == "stiff"),
        SuiteName::All => true,
    };
    file.scene.into_iter().filter(is_wanted).map(Scene::from).collect()
}

impl From<Entry> for Scene {
    fn from(entry: Entry) -> Self {
        let [x0, y0, z0, x1, y1, z1] = entry.region;
        let ast = Ast::parse(&entry.formula).expect("the scenes' formulas are in the language");
        let formula = ast.lower(&[]).expect("the scenes' formulas have no parameters");
        Self {
            name: entry.name,
            formula: format!("{} = {}", entry.formula, entry.level),
            note: entry.note,
            program: formula.minus_level(entry.level).simplified(),
            region: Region::new(DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1))
                .expect("the scenes have proper boxes"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn suites_hold_scenes_of_different_names() {
        let [classic, stiff, all] = [SuiteName::Classic, SuiteName::Stiff, SuiteName::All].map(scenes);
        assert!(!classic.is_empty() && !stiff.is_empty() && classic.len() + stiff.len() < all.len());
        let names: HashSet<&str> = all.iter().map(|scene| scene.name.as_str()).collect();
        assert_eq!(names.len(), all.len());
    }
}
