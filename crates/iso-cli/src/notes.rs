//! What results do not show by themselves: why nothing is seen, what is cut off, what is not known.

use iso_grid::{Fitted, Region, Surface, Workspace};
use iso_render::StatusCounts;

use crate::failure::Failure;

/// That nothing depends on where one looks.
const CONSTANT: &str = "F − C does not depend on x, y or z";

/// So many things, which are called `thing` one by one.
pub(crate) fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// A picture that was drawn.
pub(crate) struct Drawn<'a> {
    pub(crate) surface: &'a Surface,
    /// Definitions that its formula does without.
    pub(crate) unused: &'a [String],
    pub(crate) fitted: Fitted,
    pub(crate) pixels: StatusCounts,
    /// How many rays meet the region.
    pub(crate) rays_in_region: u64,
    /// Whether the method proves what it says.
    pub(crate) is_certified: bool,
    /// Whether colours tell what is not known.
    pub(crate) shows_status: bool,
}

impl Drawn<'_> {
    /// Each with what to try, for people.
    pub(crate) fn notes(&self) -> Result<Vec<String>, Failure> {
        let StatusCounts { hit, touch, undecided, unfinished, .. } = self.pixels;
        let mut notes: Vec<_> =
            self.unused.iter().map(|name| format!("`{name}` is defined, but not used")).collect();
        if undecided > 0 && !self.shows_status {
            notes.push(format!("{undecided} undecided, in grey: --show-status paints them magenta"));
        }
        if hit + touch + undecided + unfinished == 0 {
            notes.push(format!("nothing is seen: {}", self.why_nothing()?));
        } else if self.surface.program().arguments() == 0 {
            notes.push(format!("{CONSTANT}: all of the box is the surface"));
        } else {
            notes.extend(outside("that is shown", &self.fitted));
        }
        Ok(notes)
    }

    /// Why no ray meets the surface.
    fn why_nothing(&self) -> Result<String, Failure> {
        let Self { surface, fitted: Fitted { region, .. }, .. } = self;
        let shown = extent(region);
        let mut workspace = Workspace::default();
        if surface.program().arguments() == 0 {
            return Ok(CONSTANT.to_owned());
        }
        if region.enclosure(surface, &mut workspace)?.interval.is_empty() {
            return Ok(format!("F is defined nowhere in the box, {shown}: --box sets another"));
        }
        if !region.may_hold(surface, &mut workspace)? {
            return Ok(format!(
                "no point of the box, {shown}, is on the surface: try another --box or --level"
            ));
        }
        if self.rays_in_region == 0 {
            return Ok(format!("the camera looks past the box, {shown}"));
        }
        if !self.is_certified {
            let finer = "a finer --grid or --step may find it, and --method certified proves what there is";
            return Ok(format!("no ray was found to meet the surface in the box, {shown}: {finer}"));
        }
        let reasons = "it may consist of points and curves, or lie where the camera does not look";
        Ok(format!("no ray meets the surface in the box, {shown}: {reasons}"))
    }
}

/// That the surface goes on outside of a region that was fitted, or may go on: a box of which `role` says what it is for.
pub(crate) fn outside(role: &str, fitted: &Fitted) -> Option<String> {
    let said = match fitted {
        Fitted { goes_on: true, .. } => "the surface goes on",
        Fitted { is_cut_off: true, .. } => "it is not known whether the surface goes on",
        _ => return None,
    };
    Some(format!("{said} outside of the box {role}, {}: --box sets another", extent(&fitted.region)))
}

/// How far a region reaches along each axis, in three digits.
fn extent(region: &Region) -> String {
    let sides = region.min().to_array().into_iter().zip(region.max().to_array());
    let sides = ["x", "y", "z"]
        .into_iter()
        .zip(sides)
        .map(|(axis, (lo, hi))| format!("{axis} {}..{}", short(lo), short(hi)));
    sides.collect::<Vec<_>>().join(", ")
}

/// A number in three digits at least, without zeros at its end.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    // No zero has a sign.
    let value = value + 0.0;
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (2.0, "2"),
            (-1.09375, "-1.09"),
            (0.00123456, "0.00123"),
            (123.456, "123"),
            (99_999.4, "99999"),
            (3e-12, "3.00e-12"),
            (-1e300, "-1.00e300"),
        ] {
            assert_eq!(short(value), expected);
        }
    }
}
