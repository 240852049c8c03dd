//! Plots with logarithmic axes for the documentation.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

/// What is measured of one thing.
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// What was measured, from left to right.
    pub points: Vec<(f64, f64)>,
}

/// Colours that are told apart by everybody (Okabe and Ito 2008).
const COLORS: [RGBColor; 5] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
];

/// Draws curves into docs/performance/NAME.svg.
///
/// # Errors
/// When the file cannot be written.
pub fn plot(
    name: &str,
    axes: [&str; 2],
    legend: SeriesLabelPosition,
    curves: &[Curve],
) -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/performance");
    std::fs::create_dir_all(&folder)?;
    let path = folder.join(format!("{name}.svg"));
    let area = SVGBackend::new(&path, (760, 440)).into_drawing_area();
    area.fill(&WHITE)?;
    let range = |pick: fn(&(f64, f64)) -> f64| {
        let values = || curves.iter().flat_map(|curve| &curve.points).map(pick);
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
        least / 1.3..most * 1.3
    };
    let (x, y) = (range(|point| point.0), range(|point| point.1));
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        .x_desc(axes[0])
        .y_desc(axes[1])
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(("sans-serif", 14))
        .axis_desc_style(("sans-serif", 15))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()?;
    for (curve, color) in curves.iter().zip(COLORS.iter().cycle()) {
        let line = LineSeries::new(curve.points.iter().copied(), color.stroke_width(2)).point_size(3);
        chart
            .draw_series(line)?
            .label(&curve.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], color.stroke_width(2)));
    }
    chart
        .configure_series_labels()
        .label_font(("sans-serif", 14))
        .background_style(WHITE.mix(0.85))
        .position(legend)
        .draw()?;
    area.present()?;
    println!("docs/performance/{name}.svg");
    Ok(())
}

/// 1, 2 and 5 times powers of ten; between them there is no room.
fn label(value: &f64) -> String {
    let digit = value / 10f64.powf(value.log10().floor());
    let is_named = [1.0, 2.0, 5.0].iter().any(|named| (digit - named).abs() < 1e-6);
    if is_named { format!("{value:.0}") } else { String::new() }
}
