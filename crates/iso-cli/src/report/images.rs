//! Where errors sit in the picture.

use iso_render::{EncodeError, Picture, Size};

use super::Run;
use crate::comparison::Verdict;
use crate::html::image_address;

/// What is painted where a picture is not as proven; the colours can be told apart by the colour-blind (Okabe and Ito 2008).
const MISSED: [u8; 3] = [213, 94, 0];
const FALSE: [u8; 3] = [0, 114, 178];
const UNDECIDED: [u8; 3] = [204, 121, 167];
/// What is painted where too little is proven to judge.
const OPEN: [u8; 3] = [240, 228, 66];
/// Where it is proven that nothing is seen, and nothing is.
const EMPTY: [u8; 3] = [255; 3];

/// The greys of found points, from those that are exact to those that are [`FAR`] off.
const GREYS: [f64; 2] = [226.0, 40.0];
/// The distance, in units in the last place of t*, from which on a point is darkest.
const FAR: f64 = 1e9;

/// What the colours of [`error_image`] mean.
pub(super) const LEGEND: &str = "Orange: missed. Blue: false. Pink: undecided. Yellow: open. Those are painted three pixels wide. Grey: found, \
    from light (exact) to dark (10⁹ units in the last place of t or more off).";

/// An image of the page.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    /// The image itself, as an address that holds it.
    pub(super) address: String,
    /// What it shows.
    pub(super) caption: String,
}

/// The proven picture.
pub(super) fn proven_image(proven: &Picture) -> Result<Image, EncodeError> {
    let address = image_address(proven.size, proven.color.to_vec())?;
    Ok(Image { address, caption: "The picture as proven, ray by ray.".to_owned() })
}

/// Where the errors of a run are.
pub(super) fn error_image(run: &Run, size: Size, verdicts: &[Verdict]) -> Result<Image, EncodeError> {
    let quality = &run.quality;
    let difference = match quality.psnr {
        Some(psnr) => format!("{psnr:.1} dB, a channel differs by up to {}", quality.worst_channel),
        None => "the same colours".to_owned(),
    };
    let caption = format!(
        "{}: {} missed, {} false, {} undecided; {difference}.",
        run.setting.flags, quality.missed, quality.made_up, quality.undecided
    );
    Ok(Image { address: image_address(size, colors(size, verdicts))?, caption })
}

fn colors(size: Size, verdicts: &[Verdict]) -> Vec<[u8; 3]> {
    let (width, height) = (size.width() as usize, size.height() as usize);
    let mut colors: Vec<[u8; 3]> = verdicts.iter().map(color).collect();
    // So that a single pixel is not overlooked.
    for (pixel, verdict) in verdicts.iter().enumerate() {
        if matches!(verdict, Verdict::Missed | Verdict::False | Verdict::Undecided) {
            let (row, column) = (pixel / width, pixel % width);
            for row in row.saturating_sub(1)..(row + 2).min(height) {
                for column in column.saturating_sub(1)..(column + 2).min(width) {
                    colors[row * width + column] = color(verdict);
                }
            }
        }
    }
    colors
}

fn color(verdict: &Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Empty => EMPTY,
        Verdict::Missed => MISSED,
        Verdict::False => FALSE,
        Verdict::Undecided => UNDECIDED,
        Verdict::Open => OPEN,
        Verdict::Found(distance) => {
            let share = (distance.ulps.max(1.0).log10() / FAR.log10()).min(1.0);
            [(GREYS[0] + share * (GREYS[1] - GREYS[0])) as u8; 3]
        }
    }
}

/// The runs whose errors tell most: the worst of each method by native code, in wrong pixels and then in distance, unless
/// it is proven.
pub(super) fn telling(runs: &[Run]) -> Vec<&Run> {
    let mut found: Vec<&Run> = Vec::new();
    for name in ["direct", "grid", "octree"] {
        let of_method = runs.iter().filter(|run| run.setting.name == name);
        let first_engine = of_method.clone().next().map(|run| run.setting.engine);
        let worst = of_method.filter(|run| Some(run.setting.engine) == first_engine).max_by(|one, other| {
            let wrong = one.quality.wrong().cmp(&other.quality.wrong());
            wrong.then(one.quality.ulps.p999.total_cmp(&other.quality.ulps.p999))
        });
        found.extend(worst);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::Distance;

    #[test]
    fn wrong_pixels_are_three_wide_and_others_grey() {
        let found =
            |ulps| Verdict::Found(Distance { length: 0.0, ulps, residual: 0.0, rounding: 0.0, angle: 0.0 });
        let verdicts = [found(0.0), found(1e12), Verdict::Empty, Verdict::Empty, Verdict::Missed];
        let colors = colors(Size::new(5, 1).unwrap(), &verdicts);
        assert_eq!(colors, [[226; 3], [40; 3], EMPTY, MISSED, MISSED]);
    }
}
