//! The settings of a sweep.

use iso_grid::{GridSettings, Method};
use serde::Serialize;

use crate::flags::EngineName;

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
    pub(crate) engine_name: &'static str,
    /// Cells along every axis, for methods that have them.
    pub(crate) grid: Option<u32>,
    /// Parts into which a cell is cut when it is examined again, for methods that have them.
    pub(crate) refine: Option<u32>,
    /// The step between samples in parts of a cell, for methods that have it.
    pub(crate) step: Option<f64>,
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
        let engine_name = engine.name();
        let mut flags = format!("--method {} --engine {engine_name}", method.name());
        if let Some(settings) = cells {
            flags.push_str(&format!(" --grid {}", settings.cells[0]));
        }
        if let Some(step) = step {
            flags.push_str(&format!(" --step {step}"));
        }
        Self {
            flags,
            name: method.name(),
            engine_name,
            grid: cells.map(|settings| settings.cells[0]),
            refine: cells.map(|settings| settings.refinement[0]),
            step,
            engine,
            method,
        }
    }
}

/// All settings of a sweep over `grids` and `steps`: by native code first, then by the interpreter.
pub(crate) fn settings(grids: &[u32], steps: &[f64]) -> Vec<Setting> {
    let mut methods = vec![Method::CERTIFIED];
    for &step in steps {
        methods.push(Method::Direct { step, roots: iso_grid::RootFinding::PAPER });
        for &grid in grids {
            let settings = GridSettings { step, ..GridSettings::new([grid; 3]) };
            methods.extend([Method::Grid(settings), Method::Octree(settings)]);
        }
    }
    [EngineName::Jit, EngineName::Interp]
        .into_iter()
        .flat_map(|engine| methods.iter().map(move |&method| Setting::new(engine, method)))
        .collect()
}
