//! What is true of a ray, and whether an answer agrees with it.

use glam::DVec3;
use iso_grid::{Hit, Outcome, Ray, Region, Span};

use super::shapes::{Crossing, HalfSpace, Shape};
use super::suite::{StatedEnd, StatedRay};

/// How the search along a ray must end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Truth {
    /// Without a root.
    Empty,
    /// With the first root in this stretch.
    Root(Span),
    /// The closed form cannot tell, since the ray grazes a shape, an edge of it or the box.
    Unknown,
}

impl Truth {
    /// Where a ray first meets one of `shapes` inside the region and all half-spaces.
    pub(crate) fn of_shapes(region: &Region, shapes: &[Shape], within: &[HalfSpace], ray: &Ray) -> Self {
        let Some(inside) = region.clip(ray) else { return Self::Empty };
        let mut crossings: Vec<Crossing> = shapes.iter().flat_map(|shape| shape.crossings(ray)).collect();
        crossings.sort_by(|a, b| a.t.total_cmp(&b.t));
        let edge = edge_slack(ray, inside);
        for Crossing { t, slack, is_certain } in crossings {
            let slack = slack + 1e-12 * t.abs();
            let near = slack + edge;
            let borders = within.iter().map(|half_space| height(half_space, ray, t, near));
            let border = borders.fold(Border::Inside, Border::and);
            let in_box = match () {
                () if t < inside.start - near || t > inside.end + near => Border::Outside,
                () if t < inside.start + near || t > inside.end - near => Border::On,
                () => Border::Inside,
            };
            match border.and(in_box) {
                Border::Outside => continue,
                Border::Inside if is_certain => return Self::Root(Span { start: t - slack, end: t + slack }),
                Border::Inside | Border::On => return Self::Unknown,
            }
        }
        Self::Empty
    }

    /// Where a ray enters a region of which every point is a root.
    pub(crate) fn of_filled(region: &Region, ray: &Ray) -> Self {
        region.clip(ray).map_or(Self::Unknown, |inside| {
            let slack = edge_slack(ray, inside);
            Self::Root(Span { start: inside.start - slack, end: inside.start + slack })
        })
    }

    /// What the certified method proved of a formula whose surface is the same.
    pub(crate) fn of_proven(outcome: &Outcome) -> Self {
        match *outcome {
            Outcome::Hit(hit) => Self::Root(hit.bracket),
            Outcome::Miss => Self::Empty,
            Outcome::Touch(_) | Outcome::Undecided(_) => Self::Unknown,
        }
    }

    /// What is stated of a ray.
    pub(crate) fn of_stated(stated: &StatedRay) -> Self {
        match (stated.ends, stated.t) {
            (StatedEnd::Miss, _) | (_, None) => Self::Empty,
            (StatedEnd::Hit | StatedEnd::Touch, Some(t)) => {
                let slack = 1e-14 * (t.abs() + stated.ray().origin.abs().max_element());
                Self::Root(Span { start: t - slack, end: t + slack })
            }
        }
    }

    /// Whether a certified outcome agrees; what is left open, touches and undecided rays, only where it `may_be_open`.
    pub(crate) fn judge(&self, outcome: &Outcome, may_be_open: bool) -> Judgement {
        // What is left open says only that no root lies before.
        let stretch = match *outcome {
            Outcome::Hit(Hit { bracket, .. }) => Some(bracket),
            Outcome::Touch(Hit { bracket: Span { start, .. }, .. })
            | Outcome::Undecided(Span { start, .. }) => Some(Span { start, end: f64::INFINITY }),
            Outcome::Miss => None,
        };
        let is_open = matches!(outcome, Outcome::Touch(_) | Outcome::Undecided(_));
        let agrees = match (self, stretch) {
            (Self::Unknown, _) => return Judgement::Unknown,
            (Self::Empty, None) => true,
            (Self::Empty, Some(_)) => is_open,
            (Self::Root(_), None) => false,
            (Self::Root(root), Some(stretch)) => stretch.start <= root.end && root.start <= stretch.end,
        };
        match agrees {
            false => Judgement::Wrong,
            true if is_open && !may_be_open => Judgement::LeftOpen,
            true => Judgement::Right,
        }
    }
}

/// Whether an answer is what it must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Judgement {
    Right,
    /// It contradicts the truth.
    Wrong,
    /// It contradicts nothing, but should have been decided.
    LeftOpen,
    /// Nothing is known of the ray.
    Unknown,
}

/// On which side of a border a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Border {
    Inside,
    On,
    Outside,
}

impl Border {
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Outside, _) | (_, Self::Outside) => Self::Outside,
            (Self::On, _) | (_, Self::On) => Self::On,
            (Self::Inside, Self::Inside) => Self::Inside,
        }
    }
}

fn height([a, b, c, d]: &HalfSpace, ray: &Ray, t: f64, slack: f64) -> Border {
    let normal = DVec3::new(*a, *b, *c);
    let (height, error) = (normal.dot(ray.at(t)) - d, slack * normal.dot(ray.direction).abs() + 1e-12);
    match () {
        () if height > error => Border::Inside,
        () if height < -error => Border::Outside,
        () => Border::On,
    }
}

/// How far rounding may move the places where a ray enters and leaves a box.
fn edge_slack(ray: &Ray, inside: Span) -> f64 {
    let farthest = ray.origin.abs().max_element() / ray.direction.abs().max_element();
    1e-11 * (inside.end - inside.start) + 16.0 * f64::EPSILON * (inside.end + farthest)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(start: f64, end: f64) -> Outcome {
        Outcome::Hit(Hit { t: start, bracket: Span { start, end } })
    }

    #[test]
    fn judgements() {
        let root = Truth::Root(Span { start: 1.0, end: 1.0 });
        let undecided = |start| Outcome::Undecided(Span { start, end: start });
        assert_eq!(root.judge(&outcome(0.9, 1.1), false), Judgement::Right);
        assert_eq!(root.judge(&outcome(1.1, 1.2), false), Judgement::Wrong);
        assert_eq!(root.judge(&Outcome::Miss, true), Judgement::Wrong);
        assert_eq!(root.judge(&undecided(0.5), true), Judgement::Right);
        assert_eq!(root.judge(&undecided(0.5), false), Judgement::LeftOpen);
        assert_eq!(root.judge(&undecided(1.5), true), Judgement::Wrong);
        assert_eq!(Truth::Empty.judge(&outcome(1.0, 1.0), true), Judgement::Wrong);
        assert_eq!(Truth::Empty.judge(&undecided(1.0), true), Judgement::Right);
        assert_eq!(Truth::Unknown.judge(&outcome(1.0, 1.0), false), Judgement::Unknown);
    }

    #[test]
    fn the_first_crossing_inside_counts() {
        let region = Region::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
        let ray = Ray { origin: DVec3::new(-4.0, 0.0, 0.0), direction: DVec3::X };
        let shapes = [Shape::Plane([1.0, 0.0, 0.0, -3.0]), Shape::Sphere([0.0, 0.0, 0.0, 1.0])];
        let place = |within: &[HalfSpace]| match Truth::of_shapes(&region, &shapes, within, &ray) {
            Truth::Root(span) => Some(0.5 * (span.start + span.end)),
            _ => None,
        };
        assert!((place(&[]).unwrap() - 3.0).abs() < 1e-12);
        assert!((place(&[[1.0, 0.0, 0.0, 0.0]]).unwrap() - 5.0).abs() < 1e-12);
        assert_eq!(Truth::of_shapes(&region, &shapes[..1], &[], &ray), Truth::Empty);
        assert_eq!(
            Truth::of_shapes(&region, &[Shape::Plane([1.0, 0.0, 0.0, 2.0])], &[], &ray),
            Truth::Unknown
        );
    }
}
