//! The paper's methods against surfaces whose roots and normals are known in closed form.

use glam::DVec3;

use crate::testing::{normal, surface, surface_without_gradient, trace};
use crate::{
    Direct, Grid, GridSettings, Hit, Octree, Outcome, Outcomes, Ray, Region, RootFinder, RootFinding,
    Surface, Tracer, Workspace, normals,
};

fn cube(half_side: f64) -> Region {
    Region::new(DVec3::splat(-half_side), DVec3::splat(half_side)).unwrap()
}

/// Every method of the paper on one surface, with every root finder.
fn methods(surface: &Surface, region: Region, cells: u32) -> Vec<Box<dyn Tracer>> {
    let with_finder = |finder| -> [Box<dyn Tracer>; 3] {
        let roots = RootFinding { finder, tolerance: 0.0 };
        let settings = GridSettings { roots, ..GridSettings::new([cells; 3]) };
        [
            Box::new(Direct::new(surface, region, settings.step, roots).unwrap()),
            Box::new(Grid::new(surface, region, &settings).unwrap()),
            Box::new(Octree::new(surface, region, &settings).unwrap()),
        ]
    };
    RootFinder::ALL.into_iter().flat_map(with_finder).collect()
}

/// Rays towards points around the origin from points around it, none of them along an axis.
fn rays() -> Vec<Ray> {
    let mut rays = Vec::new();
    for number in 0..400 {
        let around = |turns: f64, radius: f64| {
            let (angle, height) = (std::f64::consts::TAU * turns, (3.7 * turns).sin());
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.6 * radius * height)
        };
        let number = f64::from(number);
        let (origin, target) = (around(number / 17.3, 3.0), around(number / 5.1, 0.9 * (number / 400.0)));
        rays.push(Ray { origin, direction: (0.1 + 0.01 * number) * (target - origin) });
    }
    rays
}

fn the_hit(outcome: Outcome) -> Hit {
    match outcome {
        Outcome::Hit(hit) => hit,
        other => panic!("no hit but {other:?}"),
    }
}

/// Checks each ray's outcome and normal against `expected`, its t and normal, `None` for a miss.
fn check(surface: &Surface, region: Region, expected: impl Fn(&Ray) -> Option<(f64, DVec3)>) {
    let rays = rays();
    for tracer in methods(surface, region, 25) {
        let mut workspace = Workspace::default();
        let mut outcomes = Outcomes::default();
        let mut found = vec![DVec3::NAN; rays.len()];
        tracer.trace(&mut workspace, &rays, &mut outcomes);
        workspace.counters.gradient_evaluations = 0;
        normals(surface, None, &mut workspace, rays.as_slice().into(), &outcomes, &mut found).unwrap();
        let mut hits = 0;
        for (number, ray) in rays.iter().enumerate() {
            match (expected(ray), outcomes.get(number)) {
                (Some((t, normal)), Outcome::Hit(hit)) => {
                    assert!((hit.t - t).abs() <= 1e-13 * t.max(1.0), "t {} for {t}, ray {number}", hit.t);
                    assert!(found[number].distance(normal) < 1e-12, "{} for {normal}", found[number]);
                    let [start, end] = [hit.bracket.start, hit.bracket.end];
                    assert!(start <= hit.t && hit.t <= end && end <= start.next_up());
                    hits += 1;
                }
                (None, Outcome::Miss) => assert!(found[number].is_nan()),
                (expected, outcome) => panic!("{expected:?} but {outcome:?}, ray {number} {ray:?}"),
            }
        }
        assert_eq!(workspace.counters.gradient_evaluations, hits);
        assert!(hits > 100, "{hits} hits");
    }
}

/// The lesser root of |o + t·d|² = 1, without cancellation.
fn unit_sphere(ray: &Ray) -> Option<f64> {
    let (a, b) = (ray.direction.length_squared(), ray.origin.dot(ray.direction));
    let foot = ray.at(-b / a);
    let discriminant = a * (1.0 - foot.length_squared());
    (discriminant > 0.0).then(|| (-b - discriminant.sqrt()) / a)
}

#[test]
fn sphere() {
    let surface = surface(|p| p.length_squared() - 1.0, |p| 2.0 * p);
    check(&surface, cube(1.3), |ray| unit_sphere(ray).map(|t| (t, ray.at(t).normalize())));
}

#[test]
fn plane() {
    let tilted = DVec3::new(0.3, -0.5, 0.8);
    let surface = surface(|p| 0.3 * p.x - 0.5 * p.y + 0.8 * p.z, |_| DVec3::new(0.3, -0.5, 0.8));
    let region = cube(1.3);
    check(&surface, region, |ray| {
        let t = -ray.origin.dot(tilted) / ray.direction.dot(tilted);
        let span = region.clip(ray)?;
        (span.start < t && t < span.end).then(|| (t, tilted.normalize()))
    });
}

#[test]
fn torus_from_above() {
    let (ring, tube) = (0.8_f64, 0.3_f64);
    let surface = surface(
        |p| (p.length_squared() + 0.8 * 0.8 - 0.3 * 0.3).powi(2) - 4.0 * 0.8 * 0.8 * (p.x * p.x + p.y * p.y),
        |p| {
            let outer = 4.0 * (p.length_squared() + 0.8 * 0.8 - 0.3 * 0.3);
            outer * p - 8.0 * 0.8 * 0.8 * DVec3::new(p.x, p.y, 0.0)
        },
    );
    for tracer in methods(&surface, cube(1.3), 30) {
        for number in 0..100 {
            let (angle, radius) = (f64::from(number), ring + 0.28 * (2.0 * f64::from(number)).sin());
            let origin = DVec3::new(radius * angle.cos(), radius * angle.sin(), 5.0);
            let ray = Ray { origin, direction: DVec3::new(0.0, -0.0, -2.0) };
            let outcome = trace(&*tracer, ray);
            let height = (tube * tube - (radius - ring).powi(2)).sqrt();
            assert!((the_hit(outcome).t - (5.0 - height) / 2.0).abs() < 1e-14);
            let side = (radius - ring) / tube;
            let expected = DVec3::new(side * angle.cos(), side * angle.sin(), height / tube);
            assert!(normal(&surface, ray, outcome).distance(expected) < 1e-12);
        }
    }
}

#[test]
fn rays_from_a_hit_onwards_meet_the_far_side_alone() {
    let surface = surface_without_gradient(|p| p.length_squared() - 1.0);
    for tracer in methods(&surface, cube(1.3), 25) {
        for ray in rays() {
            let Some(t) = unit_sphere(&ray) else { continue };
            let end = the_hit(trace(&*tracer, ray)).bracket.end;
            let point = ray.at(end + 1e-12 * end);
            let onwards = the_hit(trace(&*tracer, Ray { origin: point, ..ray }));
            let far = -2.0 * ray.at(t).dot(ray.direction) / ray.direction.length_squared();
            assert!((onwards.t - far).abs() < 1e-10, "{} for {far}", onwards.t);
            let back = ray.at(end - 1e-11 * end);
            assert_eq!(trace(&*tracer, Ray { origin: back, direction: -ray.direction }), Outcome::Miss);
        }
    }
}

#[test]
fn a_ray_from_inside_meets_what_is_before_it() {
    let surface = surface_without_gradient(|p| p.length_squared() - 1.0);
    for tracer in methods(&surface, cube(1.3), 25) {
        let ray = Ray { origin: DVec3::new(0.3, 0.1, 0.0), direction: DVec3::new(-0.01, 0.0, 0.0) };
        assert!((the_hit(trace(&*tracer, ray)).t - (0.3 + 0.99_f64.sqrt()) / 0.01).abs() < 1e-11);
    }
}

#[test]
fn outcomes_do_not_depend_on_neighbours_in_the_slice() {
    let surface = surface_without_gradient(|p| (9.0 * p.x).sin() + (7.0 * p.y).sin() * p.z);
    for tracer in methods(&surface, cube(1.3), 12) {
        let rays = rays();
        let mut together = Outcomes::default();
        tracer.trace(&mut Workspace::default(), &rays, &mut together);
        for (ray, outcome) in rays.iter().zip(together.iter()) {
            assert_eq!(trace(&*tracer, *ray), outcome);
        }
    }
}

/// What each root finder makes of the same rays: ends of the same kind, roots as far apart as the tolerance allows.
#[test]
fn root_finders_agree_and_newton_takes_fewer_evaluations() {
    let surface = surface(
        |p| p.length_squared() * p.length_squared() + p.x - 0.7,
        |p| 4.0 * p.length_squared() * p + DVec3::X,
    );
    let rays = rays();
    let traced = |finder, tolerance| {
        let settings =
            GridSettings { roots: RootFinding { finder, tolerance }, ..GridSettings::new([20; 3]) };
        let mut outcomes = Outcomes::default();
        let mut workspace = Workspace::default();
        Grid::new(&surface, cube(1.3), &settings).unwrap().trace(&mut workspace, &rays, &mut outcomes);
        let counters = workspace.counters;
        (outcomes, counters.trace_evaluations + counters.gradient_evaluations)
    };
    for tolerance in [0.0, 1e-9, 1e-4] {
        let (bisected, most) = traced(RootFinder::Bisection, tolerance);
        for finder in [RootFinder::Itp, RootFinder::Newton] {
            let (outcomes, evaluations) = traced(finder, tolerance);
            assert!(evaluations < most, "{finder:?}: {evaluations} of {most}");
            for (one, other) in bisected.iter().zip(outcomes.iter()) {
                match (one, other) {
                    (Outcome::Hit(one), Outcome::Hit(other)) => {
                        let allowed = (2.0 * tolerance).max(1e-14) * one.t;
                        assert!((one.t - other.t).abs() <= allowed, "{finder:?}: {one:?} {other:?}");
                    }
                    (one, other) => assert_eq!(one, other),
                }
            }
        }
    }
}
