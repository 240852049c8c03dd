//! Charts with logarithmic axes as SVG: light, printable, and every mark tells what it is when pointed at.

use std::fmt::Write;

use crate::html::escaped;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 440.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 64.0;
/// The room under the least positive value where zeros stand.
const ZERO_ROOM: f64 = 36.0;

/// A chart. Values are positive, but for those along y, which may be zero.
pub(super) struct Chart {
    pub(super) title: &'static str,
    pub(super) x_name: &'static str,
    pub(super) y_name: &'static str,
    pub(super) marks: Vec<Mark>,
    pub(super) lines: Vec<Line>,
    pub(super) legend: Vec<(String, &'static str)>,
}

/// A measured value.
pub(super) struct Mark {
    pub(super) x: f64,
    /// The least and greatest x that was measured.
    pub(super) spread: Option<[f64; 2]>,
    pub(super) y: f64,
    pub(super) color: &'static str,
    pub(super) is_filled: bool,
    /// What is told when it is pointed at.
    pub(super) text: String,
}

/// A line through values.
pub(super) struct Line {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) color: &'static str,
    pub(super) is_dashed: bool,
}

impl Chart {
    /// The whole chart as one SVG element.
    pub(super) fn svg(&self) -> String {
        let x = Axis::over(self.marks.iter().flat_map(|mark| mark.spread.unwrap_or([mark.x; 2])));
        let y = Axis::over(self.marks.iter().map(|mark| mark.y));
        let has_zeros = self.marks.iter().any(|mark| mark.y <= 0.0);
        let floor = HEIGHT - BOTTOM - if has_zeros { ZERO_ROOM } else { 0.0 };
        let place = Place { x, y, floor };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#333\">\n<title>{title}</title>\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#fff\"/>\n",
            title = escaped(self.title)
        );
        self.axes(&place, has_zeros, &mut svg);
        for line in &self.lines {
            line.draw(&place, &mut svg);
        }
        for mark in &self.marks {
            mark.draw(&place, &mut svg);
        }
        self.legend(&mut svg);
        svg.push_str("</svg>\n");
        svg
    }

    fn axes(&self, place: &Place, has_zeros: bool, svg: &mut String) {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for tick in place.x.ticks() {
            let x = place.x(tick);
            svg.push_str(&format!(
                "<path d=\"M{x:.1} {TOP}V{bottom}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{tick}</text>\n",
                y = bottom + 18.0
            ));
        }
        let zero = has_zeros.then_some(0.0);
        for tick in place.y.ticks().into_iter().chain(zero) {
            let y = place.y(tick);
            svg.push_str(&format!(
                "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{x}\" y=\"{baseline:.1}\" text-anchor=\"end\">{tick}</text>\n",
                x = LEFT - 8.0,
                baseline = y + 4.0
            ));
        }
        let middle = 0.5 * (TOP + bottom);
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {TOP}V{bottom}H{right}\" fill=\"none\" stroke=\"#888\"/>\n\
             <text x=\"{center}\" y=\"{below}\" text-anchor=\"middle\">{x_name}</text>\n\
             <text transform=\"translate(20 {middle}) rotate(-90)\" text-anchor=\"middle\">{y_name}</text>",
            center = 0.5 * (LEFT + right),
            below = HEIGHT - 20.0,
            x_name = escaped(self.x_name),
            y_name = escaped(self.y_name)
        );
    }

    fn legend(&self, svg: &mut String) {
        for (number, (name, color)) in self.legend.iter().enumerate() {
            let x = LEFT + 110.0 * number as f64;
            svg.push_str(&format!(
                "<circle cx=\"{x}\" cy=\"22\" r=\"5\" fill=\"{color}\"/>\
                 <text x=\"{after}\" y=\"26\">{name}</text>\n",
                after = x + 10.0,
                name = escaped(name)
            ));
        }
        svg.push_str(&format!(
            "<text x=\"{}\" y=\"26\" text-anchor=\"end\" fill=\"#777\">filled: native code, hollow: interpreter</text>\n",
            WIDTH - RIGHT
        ));
    }
}

impl Mark {
    fn draw(&self, place: &Place, svg: &mut String) {
        let (x, y, color) = (place.x(self.x), place.y(self.y), self.color);
        let fill = if self.is_filled { color } else { "#fff" };
        svg.push_str("<g class=\"mark\">");
        if let Some([least, greatest]) = self.spread {
            let (from, to) = (place.x(least), place.x(greatest));
            svg.push_str(&format!(
                "<path d=\"M{from:.1} {y:.1}H{to:.1}\" stroke=\"{color}\" stroke-opacity=\"0.5\"/>"
            ));
        }
        svg.push_str(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.6\">\
             <title>{}</title></circle></g>\n",
            escaped(&self.text)
        ));
    }
}

impl Line {
    fn draw(&self, place: &Place, svg: &mut String) {
        let points = self.points.iter().map(|&[x, y]| format!("{:.1},{:.1}", place.x(x), place.y(y)));
        let points = points.collect::<Vec<_>>().join(" ");
        let dashes = if self.is_dashed { " stroke-dasharray=\"5 4\"" } else { "" };
        svg.push_str(&format!(
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"{dashes}/>\n",
            self.color
        ));
    }
}

/// From values to places in the drawing.
struct Place {
    x: Axis,
    y: Axis,
    /// Where the least positive y stands.
    floor: f64,
}

impl Place {
    fn x(&self, value: f64) -> f64 {
        LEFT + self.x.share(value) * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, value: f64) -> f64 {
        if value > 0.0 {
            self.floor - self.y.share(value) * (self.floor - TOP)
        } else {
            HEIGHT - BOTTOM - 0.4 * ZERO_ROOM
        }
    }
}

/// A logarithmic axis, as powers of ten.
#[derive(Clone, Copy, Debug)]
struct Axis {
    least: f64,
    greatest: f64,
}

impl Axis {
    /// The axis that holds all positive `values` with a margin.
    fn over(values: impl Iterator<Item = f64>) -> Self {
        let logarithms = values.filter(|value| value.is_finite() && *value > 0.0).map(f64::log10);
        let ends = logarithms.fold(None, |ends: Option<[f64; 2]>, value| {
            let [least, greatest] = ends.unwrap_or([value; 2]);
            Some([least.min(value), greatest.max(value)])
        });
        let [least, greatest] = ends.unwrap_or([0.0, 1.0]);
        Self { least: least - 0.15, greatest: greatest + 0.15 }
    }

    /// Where a positive value stands, from 0 to 1.
    fn share(self, value: f64) -> f64 {
        (value.log10() - self.least) / (self.greatest - self.least)
    }

    /// Round values on the axis: powers of ten, with 2 and 5 times those where there are few.
    fn ticks(self) -> Vec<f64> {
        let multiples: &[f64] = if self.greatest - self.least < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        (self.least.floor() as i32..=self.greatest.ceil() as i32)
            .flat_map(|power| multiples.iter().map(move |multiple| multiple * 10f64.powi(power)))
            .filter(|tick| (0.0..=1.0).contains(&self.share(*tick)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_show_round_values() {
        let axis = Axis::over([4.0, 60.0, 0.0, f64::NAN].into_iter());
        assert_eq!(axis.ticks(), [5.0, 10.0, 20.0, 50.0]);
        assert!(axis.share(4.0) > 0.0 && axis.share(60.0) < 1.0);
        assert_eq!(Axis::over([1e-3, 1e3].into_iter()).ticks().len(), 7);
    }
}
