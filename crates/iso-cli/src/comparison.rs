//! What a method says of rays, held against what the certified method proved of the same rays.

use glam::DVec3;
use iso_expr::CompileError;
use iso_grid::{Hit, Kernel, Outcome, Outcomes, Ray, Surface, Workspace, normals};

use crate::rounding::rounded;

/// What became of rays: how each ended, and the unit normal there, NaN where there is none.
#[derive(Clone, Debug)]
pub(crate) struct Answers {
    /// How each ray ended.
    pub(crate) outcomes: Outcomes,
    /// The normal of each end.
    pub(crate) normals: Vec<DVec3>,
}

impl Answers {
    /// The outcomes of `rays`, and the normals of the surface where they end.
    ///
    /// # Errors
    /// When the engine cannot compile the gradient.
    pub(crate) fn new(
        surface: &Surface,
        workspace: &mut Workspace,
        rays: &[Ray],
        outcomes: Outcomes,
    ) -> Result<Self, CompileError> {
        let mut found = vec![DVec3::NAN; rays.len()];
        normals(surface, None, workspace, rays.into(), &outcomes, &mut found)?;
        Ok(Self { outcomes, normals: found })
    }
}

/// What a method's answer to one ray is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// It is proven that the ray meets nothing, and that is what the method says.
    Empty,
    /// The method found the proven root.
    Found(Distance),
    /// There is a root, and the method says that there is none, or found a later one.
    Missed,
    /// The method found a root where it is proven that there is none.
    False,
    /// The method says that it could not decide, though it is proven how the ray ends.
    Undecided,
    /// The certified method itself left open how the ray ends, and the method does not contradict what it did prove.
    Open,
}

/// How far a found root is from the proven one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Distance {
    /// |t − t*| · |direction|: in units of x, y and z.
    pub(crate) length: f64,
    /// |t − t*| in units in the last place of t*.
    pub(crate) ulps: f64,
    /// |F − C| at the point that the method found.
    pub(crate) residual: f64,
    /// The bound of the rounding error with which that residual was computed.
    pub(crate) rounding: f64,
    /// The angle between the normals in radians; NaN where there is none.
    pub(crate) angle: f64,
}

impl Distance {
    /// The residual in units of its own rounding error: not above 1 where the point could not be told from the surface.
    pub(crate) fn residual_in_roundings(&self) -> f64 {
        if self.residual == 0.0 { 0.0 } else { self.residual / self.rounding }
    }
}

/// A root is the proven one if their distances differ by no more than this part of the way, unless their brackets meet.
const SAME_ROOT: f64 = 1e-6;

/// What the `answers` of a method to `rays` are worth, ray by ray, when `proven` are those of the certified method.
///
/// # Errors
/// When the engine cannot compile the surface.
pub(crate) fn compare(
    surface: &Surface,
    rays: &[Ray],
    proven: &Answers,
    answers: &Answers,
) -> Result<Vec<Verdict>, CompileError> {
    let residuals = residuals(surface, rays, &answers.outcomes)?;
    let verdict = |place: usize| {
        let ray = &rays[place];
        match agreement(ray, proven.outcomes.get(place), answers.outcomes.get(place)) {
            Agreement::Root { proven: expected, found } => {
                let length = (found.t - expected.t).abs();
                let [residual, rounding] = residuals[place];
                Verdict::Found(Distance {
                    length: length * ray.direction.length(),
                    ulps: length / (expected.t.abs().next_up() - expected.t.abs()),
                    residual,
                    rounding,
                    angle: angle(proven.normals[place], answers.normals[place]),
                })
            }
            Agreement::Verdict(verdict) => verdict,
        }
    };
    Ok((0..rays.len()).map(verdict).collect())
}

/// How two outcomes of a ray go together.
enum Agreement {
    Root { proven: Hit, found: Hit },
    Verdict(Verdict),
}

/// A touch may be no root: F is only known to come within rounding of zero there. So it may be passed by.
fn agreement(ray: &Ray, proven: Outcome, answer: Outcome) -> Agreement {
    Agreement::Verdict(match (proven, answer) {
        (Outcome::Hit(proven) | Outcome::Touch(proven), Outcome::Hit(found) | Outcome::Touch(found))
            if is_same(ray, proven, found) =>
        {
            return Agreement::Root { proven, found };
        }
        (Outcome::Undecided(_) | Outcome::Touch(_), Outcome::Undecided(_)) => Verdict::Open,
        (_, Outcome::Undecided(_)) => Verdict::Undecided,
        (Outcome::Miss, Outcome::Miss) => Verdict::Empty,
        (Outcome::Miss, Outcome::Hit(_) | Outcome::Touch(_)) => Verdict::False,
        (Outcome::Hit(_), Outcome::Miss) => Verdict::Missed,
        (Outcome::Touch(_) | Outcome::Undecided(_), Outcome::Miss) => Verdict::Open,
        (Outcome::Hit(proven), Outcome::Hit(found) | Outcome::Touch(found)) => {
            if found.t > proven.t {
                Verdict::Missed
            } else {
                Verdict::False
            }
        }
        (Outcome::Touch(Hit { bracket, .. }), Outcome::Hit(found) | Outcome::Touch(found))
        | (Outcome::Undecided(bracket), Outcome::Hit(found) | Outcome::Touch(found)) => {
            if found.bracket.end + slack(ray, bracket.start) < bracket.start {
                Verdict::False
            } else {
                Verdict::Open
            }
        }
    })
}

fn is_same(ray: &Ray, proven: Hit, found: Hit) -> bool {
    let brackets_meet =
        proven.bracket.start <= found.bracket.end && found.bracket.start <= proven.bracket.end;
    brackets_meet || (proven.t - found.t).abs() <= slack(ray, proven.t)
}

/// How far apart places near `t` may be for the same root: besides [`SAME_ROOT`], as far as the coordinates of points of
/// the ray are apart.
fn slack(ray: &Ray, t: f64) -> f64 {
    let farthest = ray.origin.abs().max(ray.at(t).abs()).max_element();
    SAME_ROOT * t.abs() + 4.0 * f64::EPSILON * farthest / ray.direction.abs().max_element()
}

/// The angle between two unit vectors, to full accuracy however small it is.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// |F − C| where each ray ends and the bound of its rounding error; NaN where nothing was found.
fn residuals(surface: &Surface, rays: &[Ray], outcomes: &Outcomes) -> Result<Vec<[f64; 2]>, CompileError> {
    let points: Vec<DVec3> = rays.iter().zip(outcomes.distances()).map(|(ray, t)| ray.at(*t)).collect();
    let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<f64>>());
    let (values, enclosures) =
        (surface.over_points(Kernel::Values)?, surface.over_boxes(Kernel::ValueEnclosures)?);
    let points = [&x[..], &y, &z];
    let rounded = rounded(&**values, &**enclosures, &mut Workspace::default().scratch, points, 1);
    Ok(rounded.into_iter().map(|value| [value.value.abs(), value.error]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use iso_grid::Span;

    const RAY: Ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };

    fn hit(t: f64) -> Outcome {
        Outcome::Hit(Hit { t, bracket: Span { start: t, end: t } })
    }

    fn touch(t: f64) -> Outcome {
        Outcome::Touch(Hit { t, bracket: Span { start: t, end: t } })
    }

    fn verdict(proven: Outcome, answer: Outcome) -> Option<Verdict> {
        match agreement(&RAY, proven, answer) {
            Agreement::Root { .. } => None,
            Agreement::Verdict(verdict) => Some(verdict),
        }
    }

    #[test]
    fn every_pair_of_outcomes_is_judged() {
        let open = Outcome::Undecided(Span { start: 2.0, end: 3.0 });
        let cases = [
            (hit(2.0), hit(2.0 + 1e-9), None),
            (hit(2.0), touch(2.0), None),
            (touch(2.0), hit(2.0), None),
            (hit(2.0), hit(2.1), Some(Verdict::Missed)),
            (hit(2.0), hit(1.9), Some(Verdict::False)),
            (hit(2.0), Outcome::Miss, Some(Verdict::Missed)),
            (hit(2.0), open, Some(Verdict::Undecided)),
            (Outcome::Miss, Outcome::Miss, Some(Verdict::Empty)),
            (Outcome::Miss, hit(1.0), Some(Verdict::False)),
            (Outcome::Miss, open, Some(Verdict::Undecided)),
            (touch(2.0), Outcome::Miss, Some(Verdict::Open)),
            (touch(2.0), hit(1.0), Some(Verdict::False)),
            (touch(2.0), hit(3.0), Some(Verdict::Open)),
            (open, hit(1.0), Some(Verdict::False)),
            (open, hit(2.5), Some(Verdict::Open)),
            (open, Outcome::Miss, Some(Verdict::Open)),
            (open, open, Some(Verdict::Open)),
        ];
        for (proven, answer, expected) in cases {
            assert_eq!(verdict(proven, answer), expected, "{proven:?} and {answer:?}");
        }
    }

    #[test]
    fn brackets_that_meet_hold_the_same_root() {
        let coarse = Outcome::Hit(Hit { t: 2.5, bracket: Span { start: 1.0, end: 3.0 } });
        assert_eq!(verdict(hit(2.0), coarse), None);
    }

    #[test]
    fn small_angles_are_not_rounded_away() {
        let tilted = DVec3::new(1.0, 1e-12, 0.0);
        assert!((angle(DVec3::X, tilted) - 1e-12).abs() < 1e-20);
    }
}
