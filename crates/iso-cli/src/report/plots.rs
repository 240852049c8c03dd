//! The plots of a formula's section.

use super::advice::front_by;
use super::{Run, Section};
use crate::chart::{Chart, Line, Mark, Proportions};
use crate::flags::EngineName;

/// A plot with what is to be said below it.
pub(crate) struct Plot {
    /// The name of its file, without an ending.
    pub(crate) name: &'static str,
    /// The plot as one SVG element.
    pub(crate) svg: String,
    /// What is to be seen.
    pub(crate) caption: &'static str,
    /// Whether it is one of several that stand side by side.
    pub(crate) is_small: bool,
}

/// The methods' colours, which can be told apart in print and by the colour-blind (Okabe and Ito 2008).
const COLORS: [(&str, &str); 4] =
    [("certified", "#0072b2"), ("grid", "#d55e00"), ("octree", "#009e73"), ("direct", "#cc79a7")];

fn color(method: &str) -> &'static str {
    COLORS.iter().find(|(name, _)| *name == method).map_or("#333", |(_, color)| color)
}

const ENGINES: &str = "filled: native code, hollow: interpreter";

/// The methods that were run, with their colours.
fn legend<'a>(runs: impl Iterator<Item = &'a Run>) -> Vec<(String, &'static str)> {
    let names: Vec<&str> = runs.map(|run| run.setting.name).collect();
    let ran = COLORS.iter().filter(|(name, _)| names.contains(name));
    ran.map(|&(name, color)| (name.to_owned(), color)).collect()
}

/// All plots that there is something to be seen on.
pub(crate) fn plots(section: &Section) -> Vec<Plot> {
    let mut plots = vec![wrong_plot(section), distance_plot(section)];
    let over_cells = OverCells::of(section);
    if over_cells.runs.len() > 1 {
        plots.extend(over_cells.plots(section));
    }
    plots
}

fn told(run: &Run) -> String {
    let (time, quality) = (run.time(), run.quality);
    format!(
        "{}\n{:.2} ms ({:.2} to {:.2}, {} times)\n{} missed, {} false, {} undecided pixels\n\
         99.9 % of |t − t*| within {:.1e}, {:.0} ulps",
        run.setting.flags,
        time.median,
        time.least,
        time.greatest,
        run.repetitions,
        quality.missed,
        quality.made_up,
        quality.undecided,
        quality.distance.p999,
        quality.ulps.p999
    )
}

/// An error against time, with the front of the runs that none beats.
fn error_plot(section: &Section, title: String, y_name: &'static str, error: impl Fn(&Run) -> f64) -> String {
    let mark = |run: &Run| Mark {
        x: run.time().median,
        spread: Some([run.time().least, run.time().greatest]),
        y: error(run),
        color: color(run.setting.name),
        is_filled: run.setting.engine == EngineName::Jit,
        text: told(run),
    };
    let runs = || section.runs.iter().filter(|run| !error(run).is_nan());
    let front = front_by(&section.runs, &error).into_iter().map(|run| [run.time().median, error(run)]);
    Chart {
        title,
        x_name: "time of a picture in milliseconds: median, least to greatest",
        y_name,
        marks: runs().map(mark).collect(),
        lines: vec![Line { points: front.collect(), color: "#333", is_dashed: true }],
        legend: legend(runs()),
        hint: ENGINES,
        ..Chart::default()
    }
    .svg()
}

fn wrong_plot(section: &Section) -> Plot {
    let title = format!("Wrong pixels against time: {}", section.name);
    Plot {
        name: "wrong",
        svg: error_plot(section, title, "wrong pixels", |run| run.quality.wrong() as f64),
        caption: "Wrong pixels, which are missed, false or undecided, against time. Bars reach from the least to the greatest \
            time; no setting beats those on the dashed line. Point at a mark to see its setting.",
        is_small: false,
    }
}

fn distance_plot(section: &Section) -> Plot {
    let title = format!("Distance of roots against time: {}", section.name);
    Plot {
        name: "distance",
        svg: error_plot(section, title, "|t − t*|, 99.9th percentile", |run| run.quality.distance.p999),
        caption: "How far found points are from proven ones along the ray, in units of x, y and z, against time. 99.9 % of the \
            pixels that show the proven root are no further off.",
        is_small: false,
    }
}

/// The runs that differ in nothing but engine, method and N, with N; 0 for none.
struct OverCells<'a> {
    runs: Vec<(&'a Run, f64)>,
}

impl<'a> OverCells<'a> {
    /// At the first step.
    fn of(section: &'a Section) -> Self {
        let step = section.runs.iter().find_map(|run| run.setting.step).unwrap_or(0.0);
        let runs = section.runs.iter().filter(|run| run.setting.is_plain(step));
        Self { runs: runs.map(|run| (run, f64::from(run.setting.grid.unwrap_or(0)))).collect() }
    }

    fn plots(&self, section: &Section) -> Vec<Plot> {
        let plot = |name, what: &str, y_name, caption, figure: fn(&Run) -> f64| Plot {
            name,
            svg: self.svg(format!("{what} against cells: {}", section.name), y_name, figure),
            caption,
            is_small: true,
        };
        vec![
            plot(
                "cells",
                "Time",
                "milliseconds",
                "Time of a picture, as in the paper’s figure 1. N = 0 is the method direct.",
                |run| run.time().median,
            ),
            plot(
                "preprocess",
                "Preprocessing",
                "milliseconds",
                "Time that the method takes before the first ray.",
                |run| run.milliseconds.spread.preprocess.median,
            ),
            plot("trace", "Traversal", "milliseconds", "Time that following rays takes.", |run| {
                run.milliseconds.spread.trace.median
            }),
            plot(
                "evaluations",
                "Evaluations",
                "evaluations of F",
                "Evaluations of F at points, in preprocessing and along rays.",
                |run| (run.counters.preprocess_evaluations + run.counters.trace_evaluations) as f64,
            ),
            plot(
                "missed",
                "Missed pixels",
                "missed pixels",
                "Pixels that show nothing, or a later root.",
                |run| run.quality.missed as f64,
            ),
            plot("memory", "Peak memory", "MiB", "The most memory that the whole process held.", |run| {
                run.peak_memory.unwrap_or(f64::NAN)
            }),
        ]
    }

    fn svg(&self, title: String, y_name: &'static str, figure: fn(&Run) -> f64) -> String {
        let mark = |&(run, cells): &(&Run, f64)| Mark {
            x: cells,
            spread: None,
            y: figure(run),
            color: color(run.setting.name),
            is_filled: run.setting.engine == EngineName::Jit,
            text: told(run),
        };
        let line = |method: &str, engine: EngineName| {
            let of_line = |run: &Run| run.setting.name == method && run.setting.engine == engine;
            let mut points: Vec<[f64; 2]> = self
                .runs
                .iter()
                .filter(|(run, _)| of_line(run))
                .map(|(run, cells)| [*cells, figure(run)])
                .collect();
            points.sort_by(|one, other| one[0].total_cmp(&other[0]));
            Line { points, color: color(method), is_dashed: engine == EngineName::Interp }
        };
        let engines = [EngineName::Jit, EngineName::Interp];
        let mut x_ticks: Vec<f64> = self.runs.iter().map(|(_, cells)| *cells).collect();
        x_ticks.sort_by(f64::total_cmp);
        x_ticks.dedup();
        Chart {
            title,
            x_name: "N, cells along every axis",
            y_name,
            x_ticks,
            marks: self.runs.iter().map(mark).filter(|mark| mark.y.is_finite()).collect(),
            lines: ["grid", "octree"]
                .into_iter()
                .flat_map(|method| engines.map(|engine| line(method, engine)))
                .collect(),
            legend: legend(self.runs.iter().map(|(run, _)| *run)),
            hint: "dashed: interpreter",
            proportions: Proportions::Small,
        }
        .svg()
    }
}
