//! The axes of a sweep, and the settings along them.

use iso_grid::{Accuracy, GridSettings, Method, RootFinder, RootFinding};
use serde::Serialize;

use crate::flags::{EngineName, MethodName, name_of};

/// What is varied. No list is empty.
#[derive(Clone, Debug)]
pub(crate) struct Axes {
    pub(crate) methods: Vec<MethodName>,
    pub(crate) engines: Vec<EngineName>,
    /// N: cells along every axis.
    pub(crate) grids: Vec<u32>,
    /// M, beside the paper's own: parts into which a cell is cut when it is examined again.
    pub(crate) refinements: Vec<u32>,
    pub(crate) steps: Vec<f64>,
    pub(crate) root_finders: Vec<RootFinder>,
    pub(crate) tolerances: Vec<f64>,
    /// Whether all combinations are made, and not only those that leave the first of each list along one axis at a time.
    pub(crate) is_crossed: bool,
}

/// An engine and a method with its settings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Setting {
    /// As on the command line: all that tells this setting from others.
    pub(crate) flags: String,
    /// The method's name.
    #[serde(rename = "method")]
    pub(crate) name: &'static str,
    /// The engine's name.
    #[serde(rename = "engine")]
    pub(crate) engine_name: String,
    /// N: cells along every axis, for methods that have them.
    pub(crate) grid: Option<u32>,
    /// M: parts into which a cell is cut when it is examined again, for methods that do so.
    pub(crate) refine: Option<u32>,
    /// The step between samples in parts of a cell, for methods that have it.
    pub(crate) step: Option<f64>,
    /// How roots are found between samples, for methods that sample.
    pub(crate) root_finder: Option<&'static str>,
    /// The width, relative to t, to which roots are narrowed or enclosed.
    pub(crate) tolerance: f64,
    #[serde(skip)]
    pub(crate) engine: EngineName,
    #[serde(skip)]
    pub(crate) method: Method,
}

impl Setting {
    fn new(engine: EngineName, method: Method) -> Self {
        let cells = match method {
            Method::Grid(settings) | Method::Octree(settings) => Some(settings),
            Method::Certified { .. } | Method::Direct { .. } => None,
        };
        let step = match method {
            Method::Direct { step, .. } => Some(step),
            _ => cells.map(|settings| settings.step),
        };
        let accuracy = match method {
            Method::Certified { accuracy: Accuracy::Relative(width) } => width,
            _ => 0.0,
        };
        let roots = method.roots();
        Self {
            flags: flags(engine, method, cells, step),
            name: method.name(),
            engine_name: name_of(engine),
            grid: cells.map(|settings| settings.cells[0]),
            refine: cells.map(|settings| settings.refinement[0]),
            step,
            root_finder: roots.map(|roots| roots.finder.name()),
            tolerance: roots.map_or(accuracy, |roots| roots.tolerance),
            engine,
            method,
        }
    }

    /// Whether all but the engine, the method and N are as in the paper, at this step.
    pub(crate) fn is_plain(&self, step: f64) -> bool {
        let is_papers = |grid: u32| self.refine == Some(GridSettings::new([grid; 3]).refinement[0]);
        self.step == Some(step)
            && self.grid.is_none_or(is_papers)
            && self.method.roots() == Some(RootFinding::PAPER)
    }
}

/// What is not as it is unless told otherwise.
fn flags(engine: EngineName, method: Method, cells: Option<GridSettings>, step: Option<f64>) -> String {
    let mut flags = format!("--method {} --engine {}", method.name(), name_of(engine));
    if let Some(settings) = cells {
        flags.push_str(&format!(" --grid {}", settings.cells[0]));
        if settings.refinement != GridSettings::new(settings.cells).refinement {
            flags.push_str(&format!(" --refine {}", settings.refinement[0]));
        }
    }
    if let Some(step) = step {
        flags.push_str(&format!(" --step {step}"));
    }
    let roots = method.roots().unwrap_or(RootFinding::PAPER);
    if roots.finder != RootFinding::PAPER.finder {
        flags.push_str(&format!(" --root-finder {}", roots.finder.name()));
    }
    if roots.tolerance != RootFinding::PAPER.tolerance {
        flags.push_str(&format!(" --tolerance {:e}", roots.tolerance));
    }
    if let Method::Certified { accuracy: Accuracy::Relative(width) } = method {
        flags.push_str(&format!(" --accuracy {width:e}"));
    }
    flags
}

/// A point of the sweep, as places along the axes. The paper's own M comes before those of the list.
#[derive(Clone, Copy)]
struct Point {
    engine: usize,
    grid: usize,
    refinement: usize,
    step: usize,
    finder: usize,
    tolerance: usize,
}

impl Axes {
    /// The settings of the sweep, each once, those near the first of every list before the others.
    pub(crate) fn settings(&self) -> Vec<Setting> {
        let mut points: Vec<(usize, Point)> =
            self.points().map(|point| (point.departures(), point)).collect();
        points.retain(|(departures, point)| self.is_crossed || *departures <= 1 && self.is_wanted(point));
        points.sort_by_key(|(departures, _)| *departures);
        let mut settings: Vec<Setting> = Vec::new();
        for (_, point) in points {
            for &method in &self.methods {
                let setting = Setting::new(self.engines[point.engine], self.method(method, &point));
                if !settings.contains(&setting) {
                    settings.push(setting);
                }
            }
        }
        settings
    }

    fn points(&self) -> impl Iterator<Item = Point> {
        let counts = [
            self.engines.len(),
            self.refinements.len() + 1,
            self.steps.len(),
            self.root_finders.len(),
            self.tolerances.len(),
            self.grids.len(),
        ];
        (0..counts.iter().product()).map(move |mut number| {
            let mut place = |count: usize| {
                let place = number % count;
                number /= count;
                place
            };
            let [engine, refinement, step, finder, tolerance, grid] = counts.map(&mut place);
            Point { engine, grid, refinement, step, finder, tolerance }
        })
    }

    /// Roots are found alike in all grids: unless all is combined, they vary in the middle one.
    fn is_wanted(&self, point: &Point) -> bool {
        point.finder + point.tolerance == 0 || point.grid == self.grids.len() / 2
    }

    fn method(&self, name: MethodName, point: &Point) -> Method {
        let roots = RootFinding {
            finder: self.root_finders[point.finder],
            tolerance: self.tolerances[point.tolerance],
        };
        let step = self.steps[point.step];
        let papers = GridSettings { step, roots, ..GridSettings::new([self.grids[point.grid]; 3]) };
        let settings = match point.refinement {
            0 => papers,
            place => GridSettings { refinement: [self.refinements[place - 1]; 3], ..papers },
        };
        match name {
            MethodName::Certified if roots.tolerance > 0.0 => {
                Method::Certified { accuracy: Accuracy::Relative(roots.tolerance) }
            }
            MethodName::Certified => Method::CERTIFIED,
            MethodName::Grid => Method::Grid(settings),
            MethodName::Octree => Method::Octree(settings),
            MethodName::Direct => Method::Direct { step, roots },
        }
    }
}

impl Point {
    /// Along how many axes but N it leaves the first of the list. Root finder and tolerance go together.
    fn departures(&self) -> usize {
        let departs =
            [self.engine, self.refinement, self.step, self.finder + self.tolerance].map(|place| place > 0);
        departs.into_iter().filter(|departs| *departs).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(is_crossed: bool) -> Axes {
        Axes {
            methods: vec![MethodName::Certified, MethodName::Grid, MethodName::Octree, MethodName::Direct],
            engines: vec![EngineName::Jit, EngineName::Interp],
            grids: vec![8, 15, 30],
            refinements: vec![2, 3],
            steps: vec![0.05, 0.01],
            root_finders: RootFinder::ALL.to_vec(),
            tolerances: vec![0.0, 1e-6],
            is_crossed,
        }
    }

    #[test]
    fn all_combinations_are_made_once_where_asked_for() {
        // With cells: 2 engines, 3 N, 2 M (one of two is the paper's), 2 steps and 6 ways to find roots.
        let (cells, direct, certified) = (2 * 3 * 2 * 2 * 6, 2 * 2 * 6, 2 * 2);
        assert_eq!(axes(true).settings().len(), 2 * cells + direct + certified);
    }

    #[test]
    fn one_axis_at_a_time_leaves_the_first_of_its_list() {
        // With cells: 3 N, each as it is, with another M, another step or another engine; the middle one with 5 other ways.
        let (cells, direct, certified) = (3 * 4 + 5, 1 + 1 + 1 + 5, 1 + 1 + 1);
        let settings = axes(false).settings();
        assert_eq!(settings.len(), 2 * cells + direct + certified);
        let flags: Vec<&str> = settings.iter().map(|setting| setting.flags.as_str()).collect();
        for expected in [
            "--method certified --engine jit --accuracy 1e-12",
            "--method certified --engine jit --accuracy 1e-6",
            "--method octree --engine interp --grid 30 --step 0.05",
            "--method grid --engine jit --grid 8 --refine 2 --step 0.05",
            "--method grid --engine jit --grid 15 --step 0.05 --root-finder newton --tolerance 1e-6",
            "--method direct --engine jit --step 0.01",
        ] {
            assert!(flags.contains(&expected), "{expected} is not among {flags:#?}");
        }
        assert_eq!(settings.iter().filter(|setting| setting.is_plain(0.05)).count(), 2 * (2 * 3 + 1));
    }
}
