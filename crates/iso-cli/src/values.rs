//! Values of flags, from text to types. Clap turns their errors into reports that name the flag.

use std::fmt::Display;
use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use glam::DVec3;
use iso_expr::Ast;
use iso_grid::{GridSettings, Ray, Region};
use iso_render::{Background, Size, Smoothing};
use serde::Serialize;

use crate::table::Digits;

/// A finite number, or a formula of one: `2pi`, `1/3`.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().or_else(|| constant(text));
    let value = value.ok_or_else(|| format!("expected a number, found `{text}`"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("expected a finite number, found {value}")) }
}

/// The value of a formula without x, y and z.
fn constant(text: &str) -> Option<f64> {
    let formula = Ast::parse(text).ok()?.lower(&[]).ok()?;
    formula.value().filter(|_| !formula.is_equation())
}

/// A finite number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.0 { Ok(value) } else { Err(format!("expected a number above zero, found {value}")) }
}

/// A whole number in a range.
pub(crate) fn whole<N>(range: RangeInclusive<N>) -> impl Fn(&str) -> Result<N, String> + Clone
where
    N: Clone + Display + FromStr + PartialOrd,
{
    move |text| {
        let (least, most) = (range.start(), range.end());
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        number.ok_or_else(|| format!("expected a whole number from {least} to {most}, found `{text}`"))
    }
}

/// How often something is done.
pub(crate) fn times(text: &str) -> Result<NonZeroU32, String> {
    text.trim().parse().map_err(|_| format!("expected a whole number from 1 on, found `{text}`"))
}

/// `a,b` for the cube with these ends along every axis, or `xmin,ymin,zmin,xmax,ymax,zmax`.
pub(crate) fn region(text: &str) -> Result<Region, String> {
    let (min, max, order) = match numbers(text)?[..] {
        [from, to] => (DVec3::splat(from), DVec3::splat(to), ""),
        [x, y, z, to_x, to_y, to_z] => {
            let order = "; the order is xmin,ymin,zmin,xmax,ymax,zmax";
            (DVec3::new(x, y, z), DVec3::new(to_x, to_y, to_z), order)
        }
        ref others => {
            return Err(format!(
                "expected 2 numbers (from,to along every axis) or 6 (xmin,ymin,zmin,xmax,ymax,zmax), found {}",
                others.len()
            ));
        }
    };
    Region::new(min, max).map_err(|error| format!("{error}{order}"))
}

/// `x,y,z`.
pub(crate) fn vector(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref others => Err(format!("expected 3 numbers (x,y,z), found {}", others.len())),
    }
}

/// `ox,oy,oz,dx,dy,dz`.
pub(crate) fn ray(text: &str) -> Result<Ray, String> {
    let [ox, oy, oz, dx, dy, dz] = numbers(text)?[..] else {
        return Err(format!("expected 6 numbers (an origin and a direction), found `{text}`"));
    };
    let (origin, direction) = (DVec3::new(ox, oy, oz), DVec3::new(dx, dy, dz));
    let is_still = direction == DVec3::ZERO;
    if is_still { Err("the direction is zero".to_owned()) } else { Ok(Ray { origin, direction }) }
}

/// `n` for the same count along every axis, or `i,j,k`, all of them in a range.
pub(crate) fn counts(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<[u32; 3], String> + Clone {
    let count = whole(range);
    move |text| {
        let counts = text.split(',').map(&count).collect::<Result<Vec<_>, _>>()?;
        match counts[..] {
            [same] => Ok([same; 3]),
            [i, j, k] => Ok([i, j, k]),
            ref others => Err(format!("expected 1 count or 3 (i,j,k), found {}", others.len())),
        }
    }
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',').map(finite).collect()
}

/// `widthxheight` in pixels, or one number for a square.
pub(crate) fn size(text: &str) -> Result<Size, String> {
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    let sides = [width, height].map(|side| side.trim().parse());
    let [Ok(width), Ok(height)] = sides else {
        return Err(format!("expected pixels such as `640x480`, or `512` for a square, found `{text}`"));
    };
    Size::new(width, height).map_err(|error| error.to_string())
}

/// One colour for both, or two: names of CSS, or `#rrggbb`.
pub(crate) fn colors(text: &str) -> Result<[[u8; 3]; 2], String> {
    let colors = text.split(',').map(color).collect::<Result<Vec<_>, _>>()?;
    match colors[..] {
        [both] => Ok([both; 2]),
        [one, other] => Ok([one, other]),
        ref others => Err(format!("expected 1 colour or 2, found {}", others.len())),
    }
}

fn color(text: &str) -> Result<[u8; 3], String> {
    let text = text.trim();
    let unknown = || format!("expected a colour such as `orange` or `#3a7bd5`, found `{text}`");
    // Digits alone would be one, too.
    let is_bare = text.chars().all(|letter| letter.is_ascii_hexdigit());
    let found = csscolorparser::parse(text).ok().filter(|_| !is_bare).ok_or_else(unknown)?;
    let [red, green, blue, alpha] = found.to_rgba8();
    let is_opaque = alpha == u8::MAX;
    is_opaque
        .then_some([red, green, blue])
        .ok_or_else(|| format!("`{text}` is transparent; only --background none is"))
}

/// `none`, or [`colors`] from top to bottom.
pub(crate) fn background(text: &str) -> Result<Background, String> {
    if text.trim() == "none" {
        return Ok(Background::Transparent);
    }
    colors(text).map(|[top, bottom]| Background::Colors { top, bottom })
}

/// A step between samples in parts of a cell.
pub(crate) fn step(text: &str) -> Result<f64, String> {
    within("a step", GridSettings::LEAST_STEP..=1.0, text)
}

/// The width, relative to t, to which roots are narrowed.
pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    within("a width", 0.0..=1.0, text)
}

/// The width, relative to t, to which roots are enclosed.
pub(crate) fn accuracy(text: &str) -> Result<f64, String> {
    positive(text)?;
    tolerance(text)
}

fn within(what: &str, range: RangeInclusive<f64>, text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    let [least, most, found] = [*range.start(), *range.end(), value].map(Digits);
    let error = || format!("expected {what} from {least} to {most}, found {found}");
    if range.contains(&value) { Ok(value) } else { Err(error()) }
}

/// How many pixels, across and down, are averaged.
pub(crate) fn smoothing(text: &str) -> Result<Smoothing, String> {
    let count = whole(1..=Smoothing::MOST)(text)?;
    Ok(Smoothing::new(count).expect("the count is in range"))
}

/// A time: a number above zero with its unit, `ms`, `s`, `m` or `h`; seconds where there is none.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let text = text.trim();
    let unit = text.trim_start_matches(|character: char| !character.is_ascii_alphabetic());
    let seconds = match unit {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "m" => 60.0,
        "h" => 3600.0,
        other => return Err(format!("expected a time such as 90s, 1.5m or 200ms, found the unit `{other}`")),
    };
    let count = positive(&text[..text.len() - unit.len()])?;
    Duration::try_from_secs_f64(count * seconds).map_err(|error| error.to_string())
}

/// A value for a parameter of the formula.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Setting {
    /// The parameter's name.
    pub(crate) name: String,
    /// Its value.
    pub(crate) value: f64,
}

impl FromStr for Setting {
    type Err = String;

    /// `name=value`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) =
            text.split_once('=').ok_or_else(|| format!("expected name=number, found `{text}`"))?;
        match name.trim() {
            "" => Err("expected name=number, but the name is missing".to_owned()),
            name => Ok(Self { name: name.to_owned(), value: finite(value)? }),
        }
    }
}

/// A parameter that runs from one value to another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sweep {
    pub(crate) name: String,
    from: f64,
    to: f64,
}

impl FromStr for Sweep {
    type Err = String;

    /// `name=from:to`.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=').and_then(|(name, range)| Some((name, range.split_once(':')?)));
        let Some((name, (from, to))) = parts.filter(|(name, _)| !name.trim().is_empty()) else {
            return Err(format!("expected NAME=FROM:TO, as in `a=0:2`, found `{text}`"));
        };
        Ok(Self { name: name.trim().to_owned(), from: finite(from)?, to: finite(to)? })
    }
}

impl Sweep {
    /// The value after a part of the way, from 0 to 1. The ends are exact.
    pub(crate) fn at(&self, way: f64) -> Setting {
        Setting { name: self.name.clone(), value: (1.0 - way) * self.from + way * self.to }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_two_numbers_or_six() {
        let cube = region("-2,2").unwrap();
        assert_eq!((cube.min(), cube.max()), (DVec3::splat(-2.0), DVec3::splat(2.0)));
        let long = region("-1, -2,-3 ,4,5,6").unwrap();
        assert_eq!((long.min(), long.max()), (DVec3::new(-1.0, -2.0, -3.0), DVec3::new(4.0, 5.0, 6.0)));
        for wrong in ["", "1", "1,2,3", "2,-2", "0,inf", "a,b", "0,0", "1,2,3,4,5,6,7"] {
            assert!(region(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_may_be_formulas() {
        use std::f64::consts::PI;
        let waves = region("-2pi,2pi").unwrap();
        assert_eq!((waves.min(), waves.max()), (DVec3::splat(-2.0 * PI), DVec3::splat(2.0 * PI)));
        assert_eq!(vector("sqrt(2), 1/3, -e^2"), Ok(DVec3::new(2f64.sqrt(), 1.0 / 3.0, -1f64.exp().powi(2))));
        for wrong in ["x", "1 = 2", "1/0", "ln(-1)", "pi(", "a", "1;2"] {
            assert!(finite(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn whole_numbers_are_in_their_range() {
        assert_eq!([whole(2..=9)("2"), whole(2..=9)(" 9")], [Ok(2), Ok(9)]);
        for wrong in ["", "1", "10", "-3", "2.0", "99999999999", "two"] {
            assert!(whole(2..=9)(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn counts_are_one_or_three() {
        let counts = counts(1..=40);
        assert_eq!(counts("30"), Ok([30, 30, 30]));
        assert_eq!(counts("30,30, 20"), Ok([30, 30, 20]));
        for wrong in ["", "-1", "0", "41", "30,0,30", "1,2", "1.5", "99999999999"] {
            assert!(counts(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_size_is_one_number_or_two() {
        let plain = |text| size(text).map(|size| (size.width(), size.height()));
        assert_eq!(plain("64"), Ok((64, 64)));
        assert_eq!(plain("640x480"), Ok((640, 480)));
        for wrong in ["", "0x4", "4x", "4x4x4", "-4x4", "1e3x1e3", "99999x99999"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_time_has_a_unit_or_means_seconds() {
        for (text, milliseconds) in
            [("2", 2000), ("1.5s", 1500), ("200ms", 200), ("0.5m", 30_000), ("1 h", 3_600_000)]
        {
            assert_eq!(duration(text), Ok(Duration::from_millis(milliseconds)), "{text}");
        }
        for wrong in ["", "s", "0", "-1s", "1d", "1e400", "1e300h", "nan", "inf", "1s2"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_setting_is_a_name_and_a_finite_number() {
        assert_eq!("a=-.5".parse(), Ok(Setting { name: "a".to_owned(), value: -0.5 }));
        for wrong in ["", "a", "=1", "a=", "a=b", "a=nan", "a=inf"] {
            assert!(wrong.parse::<Setting>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_sweep_runs_from_end_to_end() {
        let sweep: Sweep = "a=-1:0.3".parse().unwrap();
        assert_eq!([0.0, 0.5, 1.0].map(|way| sweep.at(way).value), [-1.0, -0.35, 0.3]);
        assert_eq!(sweep.at(0.0).name, "a");
        for wrong in ["", "a", "a=1", "=1:2", "a=1:", "a=:2", "a=1:nan", "a=1:2:3"] {
            assert!(wrong.parse::<Sweep>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_that_must_be_positive_are() {
        assert_eq!(positive("0.05"), Ok(0.05));
        assert!(positive("0").is_err() && positive("-1").is_err() && positive("NaN").is_err());
    }
}
