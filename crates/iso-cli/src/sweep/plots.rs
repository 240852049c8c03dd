//! The plots of a report.

use super::advice::front;
use super::chart::{Chart, Line, Mark};
use super::{Report, Run};
use crate::flags::EngineName;

/// The methods' colours, which can be told apart in print and by the colour-blind (Okabe and Ito 2008).
const COLORS: [(&str, &str); 4] =
    [("certified", "#0072b2"), ("grid", "#d55e00"), ("octree", "#009e73"), ("direct", "#cc79a7")];

fn color(method: &str) -> &'static str {
    COLORS.iter().find(|(name, _)| *name == method).map_or("#333", |(_, color)| color)
}

fn legend() -> Vec<(String, &'static str)> {
    COLORS.iter().map(|&(name, color)| (name.to_owned(), color)).collect()
}

fn told(run: &Run) -> String {
    let (time, quality) = (run.milliseconds, run.quality);
    format!(
        "{}\n{:.2} ms ({:.2} to {:.2}, {} times)\n{} missed, {} false, {} undecided pixels",
        run.setting.flags,
        time.median,
        time.least,
        time.greatest,
        run.repetitions,
        quality.missed,
        quality.made_up,
        quality.undecided
    )
}

/// Wrong pixels against time, with the front of the runs that none beats.
pub(crate) fn error_plot(report: &Report) -> String {
    let wrong = |run: &Run| run.quality.wrong() as f64;
    let mark = |run: &Run| Mark {
        x: run.milliseconds.median,
        spread: Some([run.milliseconds.least, run.milliseconds.greatest]),
        y: wrong(run),
        color: color(run.setting.name),
        is_filled: run.setting.engine == EngineName::Jit,
        text: told(run),
    };
    let front = front(&report.runs).into_iter().map(|run| [run.milliseconds.median, wrong(run)]).collect();
    Chart {
        title: "Wrong pixels against time",
        x_name: "time of a picture in milliseconds: median, least to greatest",
        y_name: "wrong pixels",
        marks: report.runs.iter().map(mark).collect(),
        lines: vec![Line { points: front, color: "#333", is_dashed: true }],
        legend: legend(),
    }
    .svg()
}

/// Time against cells of the grid, as in the paper's figure 1, at the largest step.
pub(crate) fn cells_plot(report: &Report) -> String {
    let step = report.runs.iter().filter_map(|run| run.setting.step).fold(0.0, f64::max);
    let runs = report.runs.iter().filter(|run| run.setting.step == Some(step));
    let runs: Vec<(&Run, f64)> = runs.filter_map(|run| Some((run, f64::from(run.setting.grid?)))).collect();
    let mark = |&(run, grid): &(&Run, f64)| Mark {
        x: grid,
        spread: None,
        y: run.milliseconds.median,
        color: color(run.setting.name),
        is_filled: run.setting.engine == EngineName::Jit,
        text: told(run),
    };
    let line = |method: &str, engine: EngineName| {
        let of_line =
            runs.iter().filter(|(run, _)| run.setting.name == method && run.setting.engine == engine);
        let mut points: Vec<[f64; 2]> = of_line.map(|(run, grid)| [*grid, run.milliseconds.median]).collect();
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        Line { points, color: color(method), is_dashed: engine == EngineName::Interp }
    };
    let engines = [EngineName::Jit, EngineName::Interp];
    Chart {
        title: "Time against cells of the grid",
        x_name: "cells along every axis",
        y_name: "milliseconds",
        marks: runs.iter().map(mark).collect(),
        lines: ["grid", "octree"]
            .into_iter()
            .flat_map(|method| engines.map(|engine| line(method, engine)))
            .collect(),
        legend: legend(),
    }
    .svg()
}
