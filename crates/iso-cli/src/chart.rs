//! Charts with logarithmic axes as SVG: light, printable, and every mark tells what it is when pointed at.

use std::fmt::Write;

use crate::html::escaped;

const LEFT: f64 = 84.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 64.0;
/// The room before the least positive value where zeros stand.
const ZERO_ROOM: f64 = 36.0;
/// About the width of a letter.
const LETTER: f64 = 6.4;

/// How wide and high a chart is; letters have one size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Proportions {
    /// As wide as the page.
    #[default]
    Large,
    /// One of several side by side.
    Small,
}

impl Proportions {
    fn size(self) -> [f64; 2] {
        match self {
            Self::Large => [760.0, 440.0],
            Self::Small => [480.0, 320.0],
        }
    }
}

/// A chart of values that are positive or zero.
#[derive(Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x_name: &'static str,
    pub(crate) y_name: &'static str,
    /// Values to be named along x; round ones where there are none.
    pub(crate) x_ticks: Vec<f64>,
    pub(crate) marks: Vec<Mark>,
    pub(crate) lines: Vec<Line>,
    pub(crate) legend: Vec<(String, &'static str)>,
    /// What filled and hollow marks are.
    pub(crate) hint: &'static str,
    pub(crate) proportions: Proportions,
}

/// A measured value.
pub(crate) struct Mark {
    pub(crate) x: f64,
    /// The least and greatest x that was measured.
    pub(crate) spread: Option<[f64; 2]>,
    pub(crate) y: f64,
    pub(crate) color: &'static str,
    pub(crate) is_filled: bool,
    /// What is told when it is pointed at.
    pub(crate) text: String,
}

/// A line through values.
pub(crate) struct Line {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) color: &'static str,
    pub(crate) is_dashed: bool,
}

impl Chart {
    /// The whole chart as one SVG element.
    pub(crate) fn svg(&self) -> String {
        let [width, height] = self.proportions.size();
        let place = Place {
            x: Axis::over(
                self.marks.iter().flat_map(|mark| mark.spread.unwrap_or([mark.x; 2])),
                LEFT,
                width - RIGHT,
            ),
            y: Axis::over(self.marks.iter().map(|mark| mark.y), height - BOTTOM, TOP),
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#333\">\n<title>{title}</title>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
            title = escaped(&self.title)
        );
        self.axes(&place, &mut svg);
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

    fn axes(&self, place: &Place, svg: &mut String) {
        let [width, height] = self.proportions.size();
        let (right, bottom) = (width - RIGHT, height - BOTTOM);
        let x_ticks = if self.x_ticks.is_empty() { place.x.ticks() } else { self.x_ticks.clone() };
        for tick in x_ticks {
            let x = place.x.place(tick);
            svg.push_str(&format!(
                "<path d=\"M{x:.1} {TOP}V{bottom}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{text}</text>\n",
                y = bottom + 18.0,
                text = tick_text(tick)
            ));
        }
        for tick in place.y.ticks() {
            let y = place.y.place(tick);
            svg.push_str(&format!(
                "<path d=\"M{LEFT} {y:.1}H{right}\" stroke=\"#e4e4e4\"/>\
                 <text x=\"{x}\" y=\"{baseline:.1}\" text-anchor=\"end\">{text}</text>\n",
                x = LEFT - 8.0,
                baseline = y + 4.0,
                text = tick_text(tick)
            ));
        }
        let middle = 0.5 * (TOP + bottom);
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {TOP}V{bottom}H{right}\" fill=\"none\" stroke=\"#888\"/>\n\
             <text x=\"{center}\" y=\"{below}\" text-anchor=\"middle\">{x_name}</text>\n\
             <text transform=\"translate(20 {middle}) rotate(-90)\" text-anchor=\"middle\">{y_name}</text>",
            center = 0.5 * (LEFT + right),
            below = height - 20.0,
            x_name = escaped(self.x_name),
            y_name = escaped(self.y_name)
        );
    }

    fn legend(&self, svg: &mut String) {
        let [width, _] = self.proportions.size();
        let mut x = LEFT;
        for (name, color) in &self.legend {
            svg.push_str(&format!(
                "<circle cx=\"{x:.1}\" cy=\"22\" r=\"5\" fill=\"{color}\"/>\
                 <text x=\"{after:.1}\" y=\"26\">{name}</text>\n",
                after = x + 10.0,
                name = escaped(name)
            ));
            x += 34.0 + LETTER * name.chars().count() as f64;
        }
        svg.push_str(&format!(
            "<text x=\"{}\" y=\"26\" text-anchor=\"end\" fill=\"#666\">{}</text>\n",
            width - RIGHT,
            escaped(self.hint)
        ));
    }
}

impl Mark {
    fn draw(&self, place: &Place, svg: &mut String) {
        let (x, y, color) = (place.x.place(self.x), place.y.place(self.y), self.color);
        let fill = if self.is_filled { color } else { "#fff" };
        svg.push_str("<g class=\"mark\">");
        if let Some([least, greatest]) = self.spread {
            let (from, to) = (place.x.place(least), place.x.place(greatest));
            svg.push_str(&format!(
                "<path d=\"M{from:.1} {y:.1}H{to:.1}\" stroke=\"{color}\" stroke-opacity=\"0.5\"/>"
            ));
        }
        svg.push_str(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.6\">\
             <title>{text}</title></circle></g>\n",
            text = escaped(&self.text)
        ));
    }
}

impl Line {
    fn draw(&self, place: &Place, svg: &mut String) {
        let point = |[x, y]: &[f64; 2]| format!("{:.1} {:.1}", place.x.place(*x), place.y.place(*y));
        let points: Vec<String> = self.points.iter().map(point).collect();
        if points.len() > 1 {
            let dashes = if self.is_dashed { " stroke-dasharray=\"5 4\"" } else { "" };
            svg.push_str(&format!(
                "<path d=\"M{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\" stroke-opacity=\"0.8\"{dashes}/>\n",
                points.join("L"),
                self.color
            ));
        }
    }
}

/// From values to places in the drawing.
struct Place {
    x: Axis,
    y: Axis,
}

/// A logarithmic axis, with a place for zeros before its least value if there are any.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// The powers of ten at its ends.
    powers: [f64; 2],
    /// Where those are in the drawing.
    places: [f64; 2],
    /// Where zeros are.
    zero: Option<f64>,
}

impl Axis {
    /// The axis from one place to another that holds all `values` with a margin.
    fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut least, mut greatest, mut has_zeros) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values.filter(|value| value.is_finite()) {
            if value > 0.0 {
                (least, greatest) = (value.log10().min(least), value.log10().max(greatest));
            } else {
                has_zeros = true;
            }
        }
        if least > greatest {
            (least, greatest) = (0.0, 1.0);
        }
        let room = if has_zeros { ZERO_ROOM.copysign(to - from) } else { 0.0 };
        Self {
            powers: [least - 0.15, greatest + 0.15],
            places: [from + room, to],
            zero: has_zeros.then_some(from + 0.4 * room),
        }
    }

    fn place(self, value: f64) -> f64 {
        let [from, to] = self.places;
        if value > 0.0 { from + self.share(value) * (to - from) } else { self.zero.unwrap_or(from) }
    }

    /// Where a positive value stands, from 0 to 1.
    fn share(self, value: f64) -> f64 {
        let [least, greatest] = self.powers;
        (value.log10() - least) / (greatest - least)
    }

    /// Zero, if there is any, and round values: powers of ten, not too many, with their multiples where there are few.
    fn ticks(self) -> Vec<f64> {
        let [least, greatest] = self.powers;
        let multiples: &[f64] = match greatest - least {
            ..0.8 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            ..2.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let every = ((greatest - least) / 9.0).ceil() as usize;
        let powers = (least.floor() as i32..=greatest.ceil() as i32)
            .filter(|power| power.rem_euclid(every as i32) == 0);
        let ticks =
            powers.flat_map(|power| multiples.iter().map(move |multiple| multiple * 10f64.powi(power)));
        let inside = ticks.filter(|tick| (0.0..=1.0).contains(&self.share(*tick)));
        self.zero.map(|_| 0.0).into_iter().chain(inside).collect()
    }
}

/// A round number as people write it.
fn tick_text(tick: f64) -> String {
    if tick == 0.0 || (1e-3..1e5).contains(&tick) {
        // Multiples of powers of ten are a digit or two, but for rounding.
        let rounded: f64 = format!("{tick:.3e}").parse().unwrap_or(tick);
        return rounded.to_string();
    }
    let power = tick.log10().floor();
    let multiple = (tick / 10f64.powf(power)).round();
    let raised: String = (power as i32).to_string().chars().map(superscript).collect();
    if multiple == 1.0 { format!("10{raised}") } else { format!("{multiple}·10{raised}") }
}

fn superscript(character: char) -> char {
    match character {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32('⁰' as u32 + character as u32 - '0' as u32).unwrap_or(character),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_show_round_values() {
        let axis = Axis::over([4.0, 60.0, f64::NAN].into_iter(), 0.0, 100.0);
        assert_eq!(axis.ticks(), [5.0, 10.0, 20.0, 50.0]);
        assert!(axis.place(4.0) > 0.0 && axis.place(60.0) < 100.0);
        let wide = |greatest: f64| Axis::over([1e-3, greatest].into_iter(), 0.0, 1.0).ticks().len();
        assert_eq!((wide(1e3), wide(1e300) < 12), (7, true));
        assert!(Axis::over([100.0, 130.0].into_iter(), 0.0, 1.0).ticks().len() > 1);
    }

    #[test]
    fn zeros_stand_before_all_other_values() {
        for [from, to] in [[10.0, 200.0], [300.0, 40.0]] {
            let axis = Axis::over([0.0, 5.0, 50.0].into_iter(), from, to);
            let distance = |value| (axis.place(value) - from).abs();
            assert!(0.0 < distance(0.0) && distance(0.0) < distance(5.0) && distance(5.0) < distance(50.0));
            assert_eq!(axis.ticks()[0], 0.0);
        }
        assert!(Axis::over([].into_iter(), 0.0, 1.0).place(0.0).is_finite());
    }

    #[test]
    fn ticks_are_written_as_people_do() {
        let texts = [0.0, 0.001, 0.3, 5.0, 20000.0, 1e5, 2e-7, 1e-16].map(tick_text);
        assert_eq!(texts, ["0", "0.001", "0.3", "5", "20000", "10⁵", "2·10⁻⁷", "10⁻¹⁶"]);
    }
}
