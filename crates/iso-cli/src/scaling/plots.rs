//! The plots of growing formulas and pictures.

use super::{Evaluation, Family, PictureTimes};
use crate::chart::{Chart, Line, Mark, Proportions};
use crate::clock::Spread;
use crate::flags::name_of;

/// The colours of kinds of evaluation, which can be told apart in print and by the colour-blind (Okabe and Ito 2008).
const ALONE: &str = "#d55e00";
const TOGETHER: &str = "#0072b2";
const COMPILING: &str = "#009e73";

/// The colours of growing formulas, from light to dark: steps of cividis (Nuñez, Anderton and Renslow 2018), which the
/// colour-blind see as others do.
const GROWING: [&str; 8] =
    ["#d5c164", "#b3a772", "#979078", "#7d7b78", "#666870", "#50576c", "#37476c", "#00336e"];

/// Nanoseconds of an evaluation, and milliseconds of compiling, against operations.
pub(crate) fn evaluation_plot(evaluations: &[Evaluation], family: Family) -> String {
    let of_family = || evaluations.iter().filter(move |evaluation| evaluation.family == family);
    let mut chart = Chart {
        title: format!("One evaluation against the size of a formula: {}", name_of(family)),
        x_name: "operations",
        y_name: "nanoseconds of an evaluation; microseconds of compiling",
        legend: vec![
            ("a point alone".to_owned(), ALONE),
            ("one of many".to_owned(), TOGETHER),
            ("compiling".to_owned(), COMPILING),
        ],
        hint: "filled: native code, hollow: interpreter",
        proportions: Proportions::Large,
        ..Chart::default()
    };
    type Kind = (&'static str, &'static str, f64, fn(&Evaluation) -> &[Spread; 2]);
    let kinds: [Kind; 3] = [
        ("a point alone, ns", ALONE, 1.0, |evaluation| &evaluation.point),
        ("one of many points, ns", TOGETHER, 1.0, |evaluation| &evaluation.batch),
        ("compiling, µs", COMPILING, 1e3, |evaluation| &evaluation.compile),
    ];
    for (name, color, scale, figure) in kinds {
        for (engine, engine_name) in ["interpreter", "native code"].into_iter().enumerate() {
            let value = |evaluation: &Evaluation| scale * figure(evaluation)[engine].median;
            let points = of_family().map(|evaluation| [evaluation.operations as f64, value(evaluation)]);
            chart.lines.push(Line { points: points.collect(), color, is_dashed: engine == 0 });
            chart.marks.extend(of_family().map(|evaluation| Mark {
                x: evaluation.operations as f64,
                spread: None,
                y: value(evaluation),
                color,
                is_filled: engine == 1,
                text: format!(
                    "{engine_name}, {} operations\n{name}: {:.3}",
                    evaluation.operations,
                    value(evaluation)
                ),
            }));
        }
    }
    chart.svg()
}

/// How many times faster native code, compiling included, is than the interpreter, against the side of the picture.
pub(crate) fn gain_plot(pictures: &[PictureTimes], family: Family) -> String {
    let of_family: Vec<&PictureTimes> = pictures.iter().filter(|picture| picture.family == family).collect();
    let mut sizes: Vec<usize> = of_family.iter().map(|picture| picture.operations).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let mut sides: Vec<f64> = of_family.iter().map(|picture| f64::from(picture.side)).collect();
    sides.sort_by(f64::total_cmp);
    sides.dedup();
    let mut chart = Chart {
        title: format!("What compiling pays: {}", name_of(family)),
        x_name: "side of the picture in pixels",
        y_name: "time of the interpreter ÷ time of native code",
        hint: "dashed: both take as long",
        proportions: Proportions::Large,
        ..Chart::default()
    };
    let ends = [sides.first(), sides.last()].map(|side| side.copied().unwrap_or(1.0));
    chart.lines.push(Line { points: ends.map(|side| [side, 1.0]).to_vec(), color: "#333", is_dashed: true });
    for (number, &size) in sizes.iter().enumerate() {
        let color = GROWING[number * (GROWING.len() - 1) / (sizes.len() - 1).max(1)];
        let of_size: Vec<&PictureTimes> =
            of_family.iter().copied().filter(|picture| picture.operations == size).collect();
        let gain = |picture: &PictureTimes| picture.total[0].median / picture.total[1].median;
        let points = of_size.iter().map(|picture| [f64::from(picture.side), gain(picture)]);
        chart.lines.push(Line { points: points.collect(), color, is_dashed: false });
        chart.legend.push((size.to_string(), color));
        chart.marks.extend(of_size.iter().map(|picture| Mark {
            x: f64::from(picture.side),
            spread: None,
            y: gain(picture),
            color,
            is_filled: true,
            text: format!(
                "{size} operations, {0}×{0} pixels\ninterpreter {1:.1} ms, native code {2:.1} ms, {3:.1} of them compiling",
                picture.side, picture.total[0].median, picture.total[1].median, picture.compile[1].median
            ),
        }));
    }
    chart.x_ticks = sides;
    chart.svg()
}
