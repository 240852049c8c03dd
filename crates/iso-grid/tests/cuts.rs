//! Cut quadrics end rays where the roots of quadratic equations say.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::random::Random;
use iso_expr::{Ast, Interpreter};
use iso_grid::{
    Accuracy, Certified, Outcome, Outcomes, Raster, Ray, Region, Surface, Tile, Tracer, Workspace,
};

/// Columns and rows of a picture.
const SIDE: usize = 40;

const ACCURACIES: [Accuracy; 4] =
    [Accuracy::NARROW, Accuracy::Relative(1e-6), Accuracy::Relative(1e-3), Accuracy::Pixels];

/// Where a margin, a discriminant, a slope or the distance from a face of the region is less, a ray is not compared.
const UNCLEAR: f64 = 1e-5;

/// The coefficients of x², y², z², x·y, y·z, x, y, z and 1: eighths.
type Quadric = [f64; 9];

fn quadric(random: &mut Random, is_bent: bool) -> Quadric {
    let eighth = |random: &mut Random| random.below(17) as f64 / 8.0 - 1.0;
    std::array::from_fn(|place| match place {
        0..5 if !is_bent => 0.0,
        8 => 0.5 * eighth(random),
        _ => eighth(random),
    })
}

fn text(quadric: &Quadric) -> String {
    let terms = ["x^2", "y^2", "z^2", "x*y", "y*z", "x", "y", "z", "1"];
    let terms: Vec<_> =
        quadric.iter().zip(terms).map(|(factor, term)| format!("({factor})*{term}")).collect();
    terms.join(" + ")
}

/// a, b and c of a·t² + b·t + c along a ray.
fn along(quadric: &Quadric, Ray { origin: o, direction: d }: Ray) -> [f64; 3] {
    let [xx, yy, zz, xy, yz, x, y, z, one] = *quadric;
    let squared =
        |v: DVec3| xx * v.x * v.x + yy * v.y * v.y + zz * v.z * v.z + xy * v.x * v.y + yz * v.y * v.z;
    let linear = |v: DVec3| x * v.x + y * v.y + z * v.z;
    [squared(d), squared(o + d) - squared(o) - squared(d) + linear(d), squared(o) + linear(o) + one]
}

fn value([a, b, c]: [f64; 3], t: f64) -> f64 {
    (a * t + b) * t + c
}

/// The roots of a quadratic in order; `None` where there may be two or none, or they are too close.
fn roots([a, b, c]: [f64; 3]) -> Option<Vec<f64>> {
    let discriminant = b * b - 4.0 * a * c;
    match discriminant {
        _ if discriminant.abs() < UNCLEAR => None,
        ..0.0 => Some(vec![]),
        _ if a.abs() < UNCLEAR => (a == 0.0).then(|| vec![-c / b]),
        _ => {
            let q = -0.5 * (b + discriminant.sqrt().copysign(b));
            let mut roots = vec![q / a, c / q];
            roots.sort_by(f64::total_cmp);
            Some(roots)
        }
    }
}

/// How a condition joins two margins.
#[derive(Clone, Copy)]
enum Joined {
    And,
    Or,
}

struct Scene {
    surface: Quadric,
    margins: [Quadric; 2],
    joined: Joined,
}

impl Scene {
    fn random(random: &mut Random) -> Self {
        let is_bent = random.below(3) > 0;
        Self {
            surface: quadric(random, true),
            margins: [quadric(random, is_bent), quadric(random, true)],
            joined: random.choose(&[Joined::And, Joined::Or]),
        }
    }

    fn formula(&self) -> String {
        let [one, other] = self.margins.each_ref().map(text);
        let joined = match self.joined {
            Joined::And => "and",
            Joined::Or => "or",
        };
        format!("{} = 0 where {one} > 0 {joined} {other} > 0", text(&self.surface))
    }

    /// Where a ray meets the surface first in the cube from −1 to 1; `None` where that is unclear.
    fn first_root(&self, ray: Ray) -> Option<Option<f64>> {
        let surface = along(&self.surface, ray);
        for t in roots(surface)? {
            let point = ray.origin + t * ray.direction;
            let margins = self.margins.map(|margin| value(along(&margin, ray), t));
            let margin = match self.joined {
                Joined::And => margins[0].min(margins[1]),
                Joined::Or => margins[0].max(margins[1]),
            };
            // How far inside it is.
            let least = margin.min(1.0 - point.abs().max_element()).min(t);
            if least.abs() < UNCLEAR {
                return None;
            }
            if least > 0.0 {
                return Some(Some(t));
            }
        }
        Some(None)
    }
}

fn raster(random: &mut Random) -> Raster {
    let mut vector = || DVec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)));
    let forward = vector().normalize();
    let right = forward.cross(vector()).normalize();
    let down = forward.cross(right);
    let (eye, step) = (-3.0 * forward + 0.3 * vector(), 1.0 / SIDE as f64);
    if random.below(2) == 0 {
        Raster::Parallel {
            middle: eye,
            right: 2.5 * step * right,
            down: 2.5 * step * down,
            direction: forward,
        }
    } else {
        Raster::Spreading { eye, forward, right: 0.9 * step * right, down: 0.9 * step * down }
    }
}

#[test]
fn cut_quadrics_are_met_where_quadratic_equations_say() {
    let mut random = Random::new(5);
    let [mut hits, mut misses, mut open] = [0; 3];
    for number in 0..240 {
        let (scene, raster) = (Scene::random(&mut random), raster(&mut random));
        let accuracy = ACCURACIES[number % ACCURACIES.len()];
        let formula = scene.formula();
        let program = Ast::parse(&formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        let surface = Surface::new(Arc::new(Interpreter), program);
        let region = Region::new(DVec3::NEG_ONE, DVec3::ONE).unwrap();
        let certified = Certified::new(&surface, region).unwrap().with_accuracy(accuracy);
        let tile = Tile::of(&raster, [0.5 - 0.5 * SIDE as f64; 2], SIDE, SIDE);
        let mut outcomes = Outcomes::default();
        certified.trace_tile(&mut Workspace::default(), tile, &mut outcomes, None);
        for (ray, outcome) in tile.rays().zip(outcomes.iter()) {
            let Some(expected) = scene.first_root(ray) else { continue };
            match (expected, outcome) {
                (Some(t), Outcome::Hit(hit)) => {
                    let is_near = hit.bracket.start - 1e-9 <= t && t <= hit.bracket.end + 1e-9;
                    assert!(is_near, "{formula} along {ray:?}: {t}, found {hit:?}");
                    hits += 1;
                }
                (None, Outcome::Miss) => misses += 1,
                (_, Outcome::Undecided(_) | Outcome::Touch(_)) => open += 1,
                _ => panic!("{formula} along {ray:?}: expected {expected:?}, found {outcome:?}"),
            }
        }
    }
    assert!(hits > 50_000 && misses > 50_000 && open == 0, "{hits} hits, {misses} misses, {open} left open");
}
