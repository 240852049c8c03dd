//! Tiles hold what their rays hold when each is traced alone.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::random::Random;
use iso_expr::{Ast, Interpreter, Program};
use iso_grid::{
    Accuracy, Certified, Counters, Hit, Outcome, Outcomes, Raster, Ray, Region, Span, Surface, Tile, Tracer,
    Workspace,
};

/// Formulas, half sides of their regions, and what they are tried for.
const SCENES: [(&str, f64, &str); 62] = [
    ("(x^2+y^2-1)^2 + 4z^2 + 0.5x - 0.2", 1.5, "a classic"),
    ("x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8", 2.6, "parts in front of each other"),
    ("sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x)", 5.0, "cut by the region's faces"),
    ("x^2+y^2+z^2-1", 0.9, "cut by the region's faces, seen from all sides"),
    ("exp(-4((x-0.4)^2+y^2+z^2)) + exp(-4((x+0.4)^2+y^2+z^2)) - 0.6", 1.5, "flat far away"),
    ("abs(x^2+y^2+z^2-1) - 1e-6", 1.5, "a thin shell"),
    ("x^2+y^2+z^2 - 1e-8", 2.0, "a sphere thinner than a pixel"),
    ("tan(x) - y", 4.0, "poles"),
    ("1/x + 1/y + 1/z - 3", 1.5, "poles that meet"),
    ("floor(3x)/3 + y^2 + z^2 - 0.5", 1.5, "jumps"),
    ("(x^2+y^2+z^2-1)^2", 1.5, "a double root"),
    ("max(x^2+y^2+z^2-1, 0.6-sqrt((x-0.8)^2+y^2+z^2))", 1.5, "a crease"),
    ("sqrt(x) + y^2 + z - 0.5", 1.5, "an edge of the domain"),
    ("x^2+y^2+z^2+1", 1.5, "nothing"),
    ("y", 1.5, "a plane across parallel rays"),
    ("z", 1.5, "a plane along parallel rays"),
    ("0x", 1.5, "zero everywhere"),
    ("max(0, x^2+y^2+z^2-1)", 1.5, "a plateau"),
    (BALLS, 1.6, "a union of balls"),
    (BOX, 1.6, "a rounded box with a hole, smoothly blended with a ball"),
    ("(x^2+2.25y^2+z^2-1)^3 - x^2 z^3 - 0.1125y^2 z^3", 1.5, "a heart, followed by roots of cubes"),
    ("(x^2+2.25y^2+z^2-1)^3 - x^2 z^3 - 0.1125y^2 z^3 - 1e-9", 1.5, "a heart, all but flat along a curve"),
    ("3.5 - 1/((x-0.9)^2+y^2+z^2) - 1/((x+0.9)^2+y^2+z^2) - 1/(x^2+(y-0.8)^2+z^2)", 2.2, "poles inside"),
    ("max(sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x), x^2+y^2+z^2-9)", 3.2, "curved edges"),
    ("max(x^2+y^2+z^2-1, x+y-0.4, 0.2-x-y, z-0.5)", 1.5, "a slice with sharp edges"),
    ("max(x-0.5, y-0.6, z-0.4, -x-y-z-1)", 1.8, "a tetrahedron"),
    ("max(x^2+y^2+z^2-1, 0.5-(x+y)^2-z^2, 0.1-y^2-(x-z)^2)", 1.5, "a ball with two bores"),
    ("max(x^2+y^2+z^2-1, sin(9x)/3+sin(9y)/3+z, cos(11x)/4-y)", 1.3, "edges of wavy faces"),
    ("max(x^6+y^6+z^6-0.5, exp(3x)-4+y^3, exp(-4z)-3-x y)", 1.3, "edges of faces that bend more and more"),
    ("max(z-x^2-y^2, x^2+y^2-z-0.01)", 1.2, "a thin bowl, edges at the region's faces alone"),
    ("min(x^2+y^2+z^2-0.5, (x-0.6)^2+y^2+z^2-0.4, x^2+(y-0.7)^2+z^2-0.3)", 1.5, "seams of balls"),
    (
        "min(max(x-0.5,-x-0.5,y-0.5,-y-0.5,z-0.5,-z-0.5), max(x-0.9,-x-0.1,y-0.2,-y-0.9,z-0.3,-z-0.4))",
        1.5,
        "boxes",
    ),
    ("max(min(x^2+y^2-0.1, x^2+z^2-0.1, y^2+z^2-0.1), x^2+y^2+z^2-1)", 1.2, "crossed bars in a ball"),
    ("min(max(z, -z, x^2+y^2-1), x^2+y^2+z^2-0.1)", 1.3, "a plate of no thickness around a ball"),
    ("max(z-0.1, 0.1-z, x^2+y^2-1)", 1.2, "a plate of no thickness between two faces"),
    ("min(x^2+y^2+z^2-0.1, max(z-x^2/5, x^2/5-z, x^2+y^2-1))", 1.2, "a bent plate and a ball"),
    ("min(z - sin(9x)sin(9y)/9, x^2+y^2+z^2-0.4, y+0.5)", 1.2, "a ball on wavy ground"),
    ("min(x^2+y^2-z-0.3, 2-exp(x)-exp(z)+y^2, x^6+y^6+z^6-0.1)", 1.3, "seams of faces that bend both ways"),
    ("max(min(x+y, z-0.3), min(x-y, -z-0.3), x^2+y^2+z^2-1)", 1.4, "edges and seams that meet"),
    ("max(min(0.2-x^2-y^2, 0.3-z^2), min(x, y+z), x^2+y^2+z^2-1)", 1.3, "tubes that meet faces"),
    (
        "min(max(abs(x), abs(y), abs(z)) - 0.5, max(abs(x)-0.3, abs(y)-0.3, abs(z-1)-0.5))",
        1.6,
        "a box on a box",
    ),
    ("max(x^2+y^2-0.5, z-0.2x, 0.2x-z)", 1.3, "a disk without thickness"),
    ("min(max(0.1-x^2, y^2+z^2-0.5), max(0.1-y^2, x^2+z^2-0.5))", 1.3, "bodies with a cleft"),
    ("min(0.1-x^2-y^2, x^2+y^2+z^2-0.2, 0.3-x^2-(y-z)^2)", 1.2, "holes, and a ball in them"),
    ("max(min(-1, sqrt(0.3 - z)), x)", 1.0, "undefined where a part that decides nothing is"),
    ("min(max(1, y - 2, asin(z + 0.4)), x^2+y^2+z^2-0.7)", 1.0, "the same of a union"),
    ("(x-clamp(x,-0.5,0.7))^2+y^2+(z+x/3)^2-0.15", 1.3, "a limb, with joints"),
    (ROUNDED, 1.3, "a distance from a box, less a little"),
    ("abs(x)+abs(y)+abs(z)-0.9", 1.2, "an octahedron as a sum"),
    ("abs(abs(x)-0.5)+y^2+max(z,2z)^2-0.2", 1.3, "kinks within kinks"),
    ("max(x^2+y^2+z^2-1, 0.05-abs(y+abs(z)/3))", 1.3, "a bent cut"),
    ("x^2+y^2-z^2 where x^2+y^2+z^2 < 1", 1.3, "a cone cut by a ball"),
    ("x^2+y^2+z^2-1 where z < 0.5 and x+y < 0.6", 1.3, "a bowl with a notch"),
    ("z - x y where x^2+y^2 < 0.8 or x > 0.7", 1.3, "a saddle, in either of two parts"),
    ("z - x^2 where z > x^2 + 1e-9", 1.2, "a surface right behind its edge"),
    ("y where y > -1e-9 x", 1.2, "a surface that leaves its edge slowly"),
    (
        "min(x^2+y^2+z^2-0.4, max(abs(x)-0.9, y^2+z^2-0.1)) where 0.3 sin(7x) < y + z/3",
        1.2,
        "a body cut along a wave",
    ),
    ("max(x^2+y^2+z^2-1 + 0sqrt(0.2-z), 0.1-x^2-y^2)", 1.2, "a bore in what is cut"),
    (
        "(x^2+2.25y^2+z^2-1)^3 - x^2 z^3 - 0.1125y^2 z^3 where x < y + 0.3",
        1.4,
        "a heart, cut and followed by roots of cubes",
    ),
    ("x^2+y^2+z^2-1 + (1 + 0sqrt(x+0.3) - 1)*sqrt(y+0.4)", 1.2, "a cut that simplifying uncovers"),
    (SHARP, 1.3, "a sharp blend, whose exponentials underflow not far from the surface"),
    (CLOUDS, 1.3, "a union of long functions, undefined where one is that decides nothing"),
];

/// Two clouds of sixteen puffs each, over 100 operations, below a height above which a function that is never below 3 is none.
const CLOUDS: &str = "puff(a,b,c) := exp(-20((x-a)^2+(y-b)^2+(z-c)^2)); row(a,b,c) := puff(a,b,c) + puff(a+0.2,b,c+0.1); \
    quad(a,b,c) := row(a,b,c) + row(a-0.1,b+0.2,c-0.1); oct(a,b,c) := quad(a,b,c) + quad(a,b-0.3,c+0.2); \
    cloud(a,b,c) := 0.5 - oct(a,b,c) - oct(a+0.1,b+0.1,c-0.3); \
    min(cloud(0.3,0.2,0), cloud(-0.5,0,0.1), 3.5 - cloud(0,0,0) + sqrt(0.1 - z))";

/// Of six balls and a slab, few count anywhere.
const BALLS: &str = "ball(a,b,c) := (x-a)^2+(y-b)^2+(z-c)^2 - 0.3; \
    max(min(min(min(ball(1,0,0), ball(-1,0,0)), min(ball(0,1,0), ball(0,-1,0))), min(ball(0,0,1), ball(0,0,-1))), abs(z+0.1) - 1)";
/// Inside as well as outside.
const ROUNDED: &str = "a := abs(x)-0.5; b := abs(y)-0.6; c := abs(z)-0.4; \
    sqrt(max(a,0)^2+max(b,0)^2+max(c,0)^2) + min(max(a,b,c),0) - 0.2";
/// Two balls.
const SHARP: &str = "a := sqrt(x^2+y^2+z^2) - 0.5; b := sqrt((x-0.7)^2+y^2+z^2) - 0.4; \
    -ln(exp(-3000a) + exp(-3000b))/3000";
/// A distance, roots of zero and exponentials included.
const BOX: &str = "d := sqrt(max(abs(x)-0.6,0)^2 + max(abs(y)-0.6,0)^2 + max(abs(z)-0.4,0)^2) - 0.1; \
    b := sqrt((x-0.7)^2+y^2+(z-0.5)^2) - 0.4; \
    max(-ln(exp(-9d) + exp(-9b))/9, 0.3 - sqrt(x^2+y^2))";

fn certified(value: &Program, half_side: f64) -> Certified {
    let value = value.simplified();
    let surface = Surface::new(Arc::new(Interpreter), value);
    let corner = DVec3::splat(half_side);
    Certified::new(&surface, Region::new(-corner, corner).unwrap()).unwrap()
}

fn read(formula: &str) -> Program {
    Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0)
}

/// A picture's rays, how many there are in a row, and the raster that they come from, if any.
#[derive(Clone)]
struct View {
    name: &'static str,
    rays: Vec<Ray>,
    width: usize,
    raster: Option<Raster>,
}

/// Where the first ray of a picture is in its raster.
fn first(width: usize, height: usize) -> [f64; 2] {
    [width, height].map(|length| 0.5 - 0.5 * length as f64)
}

/// Views of a region of half side `half` in `width` columns and `height` rows: parallel rays along an axis and slanted,
/// and rays that spread from an eye outside and from one inside.
fn views(half: f64, width: usize, height: usize) -> [View; 4] {
    let (right, up) = (DVec3::new(0.8, 0.6, 0.0), DVec3::new(-0.24, 0.32, 0.916_515_138_991_168));
    let forward = up.cross(right);
    let (column, row) = (2.0 / width as f64, -2.0 / height as f64);
    let of_raster = |name, raster: Raster| {
        let rays = Tile::of(&raster, first(width, height), width, height).rays().collect();
        View { name, rays, width, raster: Some(raster) }
    };
    let offset = |at: usize, length: usize| 2.0 * (at as f64 + 0.5) / length as f64 - 1.0;
    let places = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let inside = places.map(|(column, row)| {
        let (a, b) = (offset(column, width), -offset(row, height));
        Ray { origin: half * DVec3::new(0.05, -0.3, 0.21), direction: forward + 0.9 * (a * right + b * up) }
    });
    [
        of_raster(
            "along an axis",
            Raster::Parallel {
                middle: -3.0 * half * DVec3::Y,
                right: 1.1 * half * column * DVec3::X,
                down: 1.1 * half * row * DVec3::Z,
                direction: DVec3::Y,
            },
        ),
        of_raster(
            "slanted",
            Raster::Parallel {
                middle: -4.0 * half * forward,
                right: 1.7 * half * column * right,
                down: 1.7 * half * row * up,
                direction: 0.7 * forward,
            },
        ),
        of_raster(
            "from outside",
            Raster::Spreading {
                eye: -5.0 * half * forward,
                forward,
                right: 0.35 * column * right,
                down: 0.35 * row * up,
            },
        ),
        View { name: "from inside", rays: inside.collect(), width, raster: None },
    ]
}

/// How the rays of a view end together: those of its raster, and the same ones listed.
fn together(tracer: &dyn Tracer, view: &View) -> Vec<Vec<Outcome>> {
    let (width, height) = (view.width, view.rays.len() / view.width);
    let of_raster = view.raster.iter().map(|raster| Tile::of(raster, first(width, height), width, height));
    let tiles = of_raster.chain([Tile::listed(&view.rays, width)]);
    let trace = |tile| {
        let mut outcomes = Outcomes::default();
        tracer.trace_tile(&mut Workspace::default(), tile, &mut outcomes, None);
        outcomes.iter().collect()
    };
    tiles.map(trace).collect()
}

fn alone(tracer: &dyn Tracer, rays: &[Ray]) -> Vec<Outcome> {
    let mut outcomes = Outcomes::default();
    tracer.trace(&mut Workspace::default(), rays, &mut outcomes);
    outcomes.iter().collect()
}

fn overlap(a: Span, b: Span) -> bool {
    a.start <= b.end && b.start <= a.end
}

/// Whether two proofs about one ray can both be right: two first roots are one, and nothing is free of roots for one and
/// holds a root for the other.
fn agree(a: Outcome, b: Outcome) -> bool {
    match (a, b) {
        (Outcome::Hit(a), Outcome::Hit(b)) => overlap(a.bracket, b.bracket),
        (Outcome::Hit(_), Outcome::Miss) | (Outcome::Miss, Outcome::Hit(_)) => false,
        (Outcome::Hit(hit), Outcome::Touch(Hit { bracket: open, .. }) | Outcome::Undecided(open))
        | (Outcome::Touch(Hit { bracket: open, .. }) | Outcome::Undecided(open), Outcome::Hit(hit)) => {
            open.start <= hit.bracket.end
        }
        _ => true,
    }
}

/// Whether two rays end alike, and touch the surface at about the same place if they do.
fn is_same(a: Outcome, b: Outcome) -> bool {
    let is_near = match (a, b) {
        (Outcome::Touch(Hit { bracket: a, .. }), Outcome::Touch(Hit { bracket: b, .. })) => {
            a.start - b.end <= 1e-6 && b.start - a.end <= 1e-6
        }
        _ => true,
    };
    is_near && std::mem::discriminant(&a) == std::mem::discriminant(&b)
}

fn is_narrow(outcome: Outcome) -> bool {
    match outcome {
        Outcome::Hit(Hit { t, bracket }) => {
            bracket.start <= t && t <= bracket.end && bracket.end - bracket.start <= 1e-12 * t.max(1.0)
        }
        _ => true,
    }
}

#[test]
fn every_ray_of_a_tile_ends_as_it_does_alone() {
    let mut wrong = Vec::new();
    for (formula, half, what) in SCENES {
        let tracer = certified(&read(formula), half);
        // Sides that are no powers of two, so that beams are cut unevenly.
        for view in views(half, 45, 37) {
            let alone = alone(&tracer, &view.rays);
            for outcomes in together(&tracer, &view) {
                for (number, (a, b)) in outcomes.into_iter().zip(&alone).enumerate() {
                    if !(is_same(a, *b) && agree(a, *b) && is_narrow(a)) {
                        let place = format!("{}, ray {number}", view.name);
                        wrong.push(format!("{formula} ({what}), {place}: {a:?}, alone {b:?}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} rays differ:\n{}", wrong.len(), wrong.join("\n"));
}

/// Along a single ray the nearer of two coinciding faces changes all the time, so that often no more is seen than that F touches
/// zero. A tile tells the faces apart, each of which changes sign.
#[test]
fn tiles_prove_no_less_where_faces_coincide() {
    for formula in [
        "min(x^2+y^2+z^2-0.5, x^2/2+y^2/2+z^2/2-0.25, z+0.2)",
        // A disk without thickness on a box.
        "min(max(abs(x), abs(y), abs(z)) - 0.5, max(x^2+y^2-0.2, z-0.5, 0.5-z))",
    ] {
        let tracer = certified(&read(formula), 1.3);
        for view in views(1.3, 45, 37) {
            let alone = alone(&tracer, &view.rays);
            for outcomes in together(&tracer, &view) {
                for (number, (a, b)) in outcomes.into_iter().zip(&alone).enumerate() {
                    let is_no_less = is_same(a, *b) || matches!((a, b), (Outcome::Hit(_), Outcome::Touch(_)));
                    assert!(
                        is_no_less && agree(a, *b) && is_narrow(a),
                        "{formula}, {}, ray {number}: {a:?}, {b:?}",
                        view.name
                    );
                }
            }
        }
    }
}

#[test]
fn no_tile_contradicts_its_rays_whatever_the_formula() {
    let mut random = Random::new(7);
    let mut decided = 0;
    for number in 0..60 {
        let program = random.program(4 + number % 12);
        let tracer = certified(&program, 2.0);
        for view in views(2.0, 12, 9) {
            let alone = alone(&tracer, &view.rays);
            for outcomes in together(&tracer, &view) {
                for (a, b) in outcomes.into_iter().zip(&alone) {
                    assert!(agree(a, *b), "{program}\n{}: {a:?}, alone {b:?}", view.name);
                    decided += usize::from(matches!((a, b), (Outcome::Hit(_), Outcome::Hit(_))));
                }
            }
        }
    }
    assert!(decided > 500, "{decided} rays hit");
}

/// A body put together by so many levels of unions, intersections and differences, some of them shrunk or grown.
fn random_body(random: &mut Random, levels: u32) -> String {
    let mut number = |lo, hi| random.between(lo, hi);
    if levels == 0 {
        let [a, b, c] = [(); 3].map(|()| number(-1.0, 1.0));
        let size = number(0.1, 0.9);
        return match random.below(8) {
            // Limbs, which have joints, boxes with round edges, what ends where it is defined, and stairs.
            7 => format!("(z - {c} - floor(3(x-{a}))/7)"),
            4 => format!("((x-{a}-clamp(x,{b},{b}+{size}))^2 + (y-{b})^2 + (z+x/3-{c})^2 - 0.1)"),
            5 => format!("(sqrt(max(abs(x-{a})-0.3,0)^2 + max(abs(y+{b})-{size},0)^2 + (z-{c})^2) - 0.2)"),
            6 => format!("(sqrt(x-{a}) - {size} - abs(y-{b}))"),
            0 => format!("(sqrt((x-{a})^2 + (y-{b})^2 + (z-{c})^2) - {size})"),
            1 => format!("((x-{a})^2 + (z-{c})^2 - {size}^2)"),
            2 => format!("max(abs(x-{a}), abs(y-{b}), abs(z-{c})) - {size}"),
            _ => format!("({a} x + {b} y + {c} z - {size}/9)"),
        };
    }
    let change = number(-0.2, 0.2);
    let [a, b] = [(); 2].map(|()| random_body(random, levels - 1));
    match random.below(6) {
        5 => format!("(abs({a}) - {change}^2)"),
        0 => format!("max({a}, {b})"),
        1 => format!("max({a}, -({b}))"),
        2 => format!("(min({a}, {b}) - {change})"),
        _ => format!("min({a}, {b})"),
    }
}

/// Along single rays the whole formula is asked for, in tiles what is left of it.
#[test]
fn what_is_left_of_bodies_in_places_proves_what_they_do() {
    let mut random = Random::new(8);
    let (mut same, mut all) = (0, 0);
    for number in 0..40 {
        let body = random_body(&mut random, 2 + number % 4);
        let tracer = certified(&read(&body), 1.7);
        for view in views(1.7, 24, 20) {
            let alone = alone(&tracer, &view.rays);
            for outcomes in together(&tracer, &view) {
                for (a, b) in outcomes.into_iter().zip(&alone) {
                    assert!(agree(a, *b) && is_narrow(a), "{body}\n{}: {a:?}, alone {b:?}", view.name);
                    same += u32::from(is_same(a, *b));
                    all += 1;
                }
            }
        }
    }
    assert!(same > all - all / 100, "{same} of {all} rays end alike");
}

/// Roundings of x hide the constant, unless x is known to cancel before it is rounded.
#[test]
fn tiles_know_that_a_tiny_constant_is_not_zero() {
    let tracer = certified(&read("x - x + 1e-300"), 1.0);
    for view in views(1.0, 24, 20) {
        for outcomes in together(&tracer, &view) {
            assert!(outcomes.iter().all(|outcome| *outcome == Outcome::Miss), "{}", view.name);
        }
    }
}

/// Brackets may be so wide that those of both roots of a face overlap one of another face.
#[test]
fn what_is_proven_coarsely_is_proven_narrowly_too() {
    let view = {
        let step = 0.9 / 65.0;
        let (middle, right, down) = (-3.0 * DVec3::Z, step * DVec3::X, -step * DVec3::Y);
        let raster = Raster::Parallel { middle, right, down, direction: DVec3::Z };
        let rays = Tile::of(&raster, first(65, 65), 65, 65).rays().collect();
        View { name: "along z", rays, width: 65, raster: Some(raster) }
    };
    let double = "u := z - 0.37y; min(max(u^2 + 100x^2 - 1e-8, -u - 40u^3, 0.02 - u), u^2 + 0.5x + 0.003)";
    let inside_out =
        "u := z - 0.37y; max(min(u^2 + 100x^2 - 1e-8, u + 40u^3, u - 0.02), -u^2 - 0.5x - 0.003)";
    let scenes = SCENES.map(|(formula, half, _)| (formula, half, views(half, 24, 20).to_vec()));
    let cases = [double, inside_out].map(|formula| (formula, 1.0, vec![view.clone()]));
    for (formula, half, views) in cases.into_iter().chain(scenes) {
        let program = read(formula);
        for view in views {
            let narrow = alone(&certified(&program, half), &view.rays);
            for accuracy in [Accuracy::Relative(1e-2), Accuracy::Relative(1e-4), Accuracy::Pixels] {
                let coarse = certified(&program, half).with_accuracy(accuracy);
                for (number, (a, b)) in
                    together(&coarse, &view).concat().iter().zip(narrow.iter().cycle()).enumerate()
                {
                    assert!(
                        agree(*a, *b),
                        "{formula}, {}, ray {number}, {accuracy:?}: {a:?}, {b:?}",
                        view.name
                    );
                }
            }
        }
    }
}

/// The derivative is less than any double, and its product with the length of a ray is not.
#[test]
fn no_plane_is_lost_where_its_slope_underflows() {
    let tracer = certified(&read("1e-200*(1e-130*x)"), 1e60);
    for view in views(1e60, 45, 37) {
        let alone = alone(&tracer, &view.rays);
        assert!(alone.iter().any(|outcome| *outcome != Outcome::Miss) || view.name == "along an axis");
        for outcomes in together(&tracer, &view) {
            assert!(outcomes.iter().zip(&alone).all(|(a, b)| is_same(*a, *b)), "{}", view.name);
        }
    }
}

#[test]
fn unrelated_rays_may_be_called_a_tile() {
    let tracer = certified(&read("x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8"), 2.6);
    let mut random = Random::new(3);
    let mut vector = || DVec3::from_array([(); 3].map(|()| random.between(-3.0, 3.0)));
    let mut rays: Vec<Ray> = (0..96).map(|_| Ray { origin: vector(), direction: vector() }).collect();
    rays[17].direction = DVec3::ZERO;
    for width in [1, 8, 96] {
        let view = View { name: "unrelated", rays: rays.clone(), width, raster: None };
        for (a, b) in together(&tracer, &view).into_iter().flatten().zip(alone(&tracer, &rays)) {
            assert!(is_same(a, b) && agree(a, b), "{a:?}, alone {b:?}");
        }
    }
    for strange in [f64::NAN, f64::INFINITY, 1e200] {
        rays[21].origin.x = strange;
        let view = View { name: "strange", rays: rays.clone(), width: 8, raster: None };
        assert_eq!(together(&tracer, &view), [alone(&tracer, &rays)], "{strange}");
    }
}

/// They leave the region at no t that a double holds.
#[test]
fn rays_of_a_tile_may_be_too_slow() {
    let tracer = certified(&read("x^2 + y^2 + z^2 - 1"), 2.0);
    let ray = |place: u32| {
        let [y, z] = [place % 12, place / 12].map(|step| 0.2 * f64::from(step) - 1.1);
        Ray { origin: DVec3::new(-3.0, y, z), direction: DVec3::new(2e-308, 0.0, 0.0) }
    };
    let view = View { name: "slow", rays: (0..144).map(ray).collect(), width: 12, raster: None };
    let alone = alone(&tracer, &view.rays);
    let hits = alone.iter().filter(|outcome| matches!(outcome, Outcome::Hit(_))).count();
    // A disk of radius 1 in squares of 0.2.
    assert!(hits.abs_diff(79) < 10, "{hits} hits");
    for (a, b) in together(&tracer, &view).into_iter().flatten().zip(alone) {
        assert!(is_same(a, b) && agree(a, b) && is_narrow(a), "{a:?}, alone {b:?}");
    }
}

/// What a tile holds, and what that took.
fn counted(tracer: &Certified, tile: Tile<'_>) -> (Vec<Outcome>, Counters) {
    let (mut workspace, mut outcomes) = (Workspace::default(), Outcomes::default());
    tracer.trace_tile(&mut workspace, tile, &mut outcomes, None);
    (outcomes.iter().collect(), workspace.counters)
}

#[test]
fn shortened_formulas_prove_what_whole_ones_do() {
    for (formula, half, name) in [SCENES[18], SCENES[19]] {
        let value = read(formula);
        let (shortened, whole) = (certified(&value, half), certified(&value, half).with_whole_formula());
        let (mut fewer, mut more) = (0, 0);
        for View { name: view, rays, width, .. } in views(half, 48, 40) {
            let [short, long] =
                [(&shortened, &mut fewer), (&whole, &mut more)].map(|(tracer, operations)| {
                    let (outcomes, counters) = counted(tracer, Tile::listed(&rays, width));
                    *operations += counters.operations;
                    outcomes
                });
            for (ray, (short, long)) in rays.iter().zip(short.iter().zip(&long)) {
                let agree = match (short, long) {
                    (Outcome::Hit(a), Outcome::Hit(b)) => {
                        a.bracket.start <= b.bracket.end && b.bracket.start <= a.bracket.end
                    }
                    (Outcome::Miss, Outcome::Miss) => true,
                    (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b),
                };
                assert!(agree, "{name}, {view}, {ray:?}: {short:?} and {long:?}");
            }
        }
        assert!(fewer < more, "{name}: {fewer} operations instead of {more}");
    }
}

/// What is found free of roots near an edge is not looked at over and over.
#[test]
fn cut_balls_take_about_as_many_enclosures_as_whole_ones() {
    let mut random = Random::new(8);
    let mut balls = String::from("9");
    for _ in 0..60 {
        let [x, y, z] = [(); 3].map(|()| random.between(-1.0, 1.0));
        balls = format!("min({balls}, sqrt((x - ({x}))^2 + (y - ({y}))^2 + (z - ({z}))^2) - 0.12)");
    }
    let whole = certified(&read(&balls), 1.2);
    let cut = certified(&read(&format!("({balls}) where z < 0.3")), 1.2);
    for View { name, rays, width, .. } in views(1.2, 64, 64) {
        let [whole, cut] = [&whole, &cut].map(|tracer| counted(tracer, Tile::listed(&rays, width)).1);
        let is_about = |cut: u64, whole: u64| 4 * cut < 5 * whole;
        assert!(is_about(cut.box_evaluations, whole.box_evaluations), "{name}: {cut:?}, whole {whole:?}");
        assert!(is_about(cut.operations, whole.operations), "{name}: {cut:?}, whole {whole:?}");
    }
}
