//! How far rounding moves what is found.

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{Decoration, Interval};
use iso_grid::{Kernel, Surface, Workspace};

use super::Verdict;

/// How far rounding alone may move a root and its normal.
pub(crate) struct Rounding {
    /// The rounding error of F at the root over its slope along the ray.
    pub(crate) of_t: f64,
    /// The rounding error of the gradient over its length.
    pub(crate) of_normal: f64,
}

impl Rounding {
    /// At the root of a ray that hits.
    pub(crate) fn at(surface: &Surface, verdict: &Verdict) -> Self {
        let [value, gradient @ ..] = enclosures(surface, verdict, 0.0);
        let widths = DVec3::from_array(gradient.map(Interval::width));
        let middle = DVec3::from_array(gradient.map(Interval::midpoint));
        let slope = middle.dot(verdict.ray.direction).abs() - widths.dot(verdict.ray.direction.abs());
        let of_t = value.width() / slope.max(0.0);
        let [_, gradient @ ..] = enclosures(surface, verdict, of_t);
        let widths = DVec3::from_array(gradient.map(Interval::width));
        let scale = middle.abs().max_element();
        Self { of_t, of_normal: (widths / scale).length() / (middle / scale).length() }
    }
}

/// Encloses F and its gradient at the points of the ray that are no further from the root than `slack`.
fn enclosures(surface: &Surface, verdict: &Verdict, slack: f64) -> [Interval; 4] {
    let ends = [0, 1, 2].map(|axis| {
        let (origin, direction) = (verdict.ray.origin[axis], verdict.ray.direction[axis]);
        let (point, slack) = (origin + verdict.t * direction, slack * direction.abs());
        let slack = slack + f64::EPSILON * (point.abs() + (verdict.t * direction).abs());
        (point - slack, point + slack)
    });
    let (lo, hi) = (ends.map(|(lo, _)| [lo]), ends.map(|(_, hi)| [hi]));
    let (mut low, mut high, mut decoration) = ([0.0; 4], [0.0; 4], [Decoration::Trivial; 4]);
    surface.over_boxes(Kernel::GradientEnclosures).expect("the scenes compile").evaluate(
        &mut Workspace::default().scratch,
        Boxes { lo: lo.each_ref().map(|end| &end[..]), hi: hi.each_ref().map(|end| &end[..]) },
        Enclosures { lo: &mut low, hi: &mut high, decoration: &mut decoration },
    );
    std::array::from_fn(|output| Interval { lo: low[output], hi: high[output] })
}
