//! Writes the models of `testdata/models` again: large formulas for tests, measurements and pictures.
//!
//!     cargo run --example models
//!
//! - `spheres.vm`: a union of 100 balls on a sphere, along a spiral of Fibonacci.
//! - `rotunda.vm`: a round temple, 30 parts united and cut by minima and maxima.
//! - `tree.vm`: a tree that forks five times, two balls at the end of every twig; about 2,000 operations.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::{fs, io};

use glam::DVec3;

/// Where the models are kept.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testdata/models");

/// The angle of two neighbours on a spiral of Fibonacci: the golden section of a circle.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

fn main() -> io::Result<()> {
    models().into_iter().try_for_each(|(name, text)| fs::write(format!("{FOLDER}/{name}.vm"), text))
}

/// All models: name and text.
fn models() -> [(&'static str, String); 3] {
    [("spheres", spheres()), ("rotunda", rotunda()), ("tree", tree())]
}

fn spheres() -> String {
    let mut model = Model::new("A union of 100 balls on a sphere, along a spiral of Fibonacci.");
    let count = 100;
    let balls = (0..count).map(|number| {
        let place = f64::from(number) + 0.5;
        let height = 1.0 - 2.0 * place / f64::from(count);
        let round = (1.0 - height * height).sqrt();
        let (sin, cos) = (GOLDEN_ANGLE * place).sin_cos();
        let center = DVec3::new(round * cos, round * sin, height);
        model.ball(center, 0.15 + 0.05 * (0.4 * place).sin())
    });
    let balls = balls.collect();
    model.union(balls);
    model.text
}

fn rotunda() -> String {
    let mut model = Model::new("A round temple: 30 parts.");
    let mut parts = Vec::new();
    // Three steps.
    for (number, radius) in [2.0, 1.85, 1.7].into_iter().enumerate() {
        let bottom = -1.5 + 0.12 * number as f64;
        parts.push(model.cylinder(DVec3::new(0.0, 0.0, bottom), radius, 0.12));
    }
    // Twelve columns, each with a capital.
    for number in 0..12 {
        let (sin, cos) = (TAU * (f64::from(number) + 0.5) / 12.0).sin_cos();
        let foot = DVec3::new(1.4 * cos, 1.4 * sin, -1.14);
        parts.push(model.cylinder(foot, 0.13, 1.5));
        parts.push(model.cylinder(foot + DVec3::Z * 1.5, 0.2, 0.1));
    }
    // A ring on them, and a dome that is open at its top.
    let ring = model.cylinder(DVec3::new(0.0, 0.0, 0.46), 1.65, 0.26);
    let base = DVec3::new(0.0, 0.0, 0.72);
    let shell = model.ball(base, 1.45);
    let below = model.below(0.72);
    let dome = model.apply("max", &[shell, below]);
    let roof = model.apply("min", &[ring, dome]);
    let room = model.ball(base, 1.3);
    let eye = model.cylinder(base, 0.35, 2.0);
    let void = model.apply("min", &[room, eye]);
    parts.push(model.difference(roof, void));
    model.union(parts);
    model.text
}

fn tree() -> String {
    let mut model = Model::new("A tree that forks five times, two balls at the end of every twig.");
    let mut parts = Vec::new();
    let trunk = Twig {
        start: DVec3::new(0.0, 0.0, -1.9),
        way: DVec3::Z * 1.15,
        across: DVec3::X,
        radius: 0.16,
        forks: 6,
    };
    trunk.grow(&mut model, &mut parts);
    model.union(parts);
    model.text
}

/// A part of a tree, and what grows from it.
struct Twig {
    start: DVec3,
    /// From the start to the end.
    way: DVec3,
    /// A direction across, in which it forks.
    across: DVec3,
    radius: f64,
    /// How often what begins here forks.
    forks: u32,
}

impl Twig {
    fn grow(&self, model: &mut Model, parts: &mut Vec<Value>) {
        if self.forks == 0 {
            parts.push(model.ball(self.start + 0.4 * self.way, 0.13));
            return;
        }
        let end = self.start + self.way;
        parts.push(model.capsule(self.start, self.way, self.radius));
        for (side, length) in [(1.0, 0.82), (-1.0, 0.7)] {
            let (sin, cos) = (side * PI / 6.5).sin_cos();
            let direction = self.way.normalize();
            let way = length * self.way.length() * (cos * direction + sin * self.across);
            // The next fork is turned about the twig, so that the crown becomes round.
            let across = way.normalize().cross(self.across).normalize();
            let across = (0.9 * across + 0.4 * way.normalize().cross(across)).normalize();
            let twig = Self { start: end, way, across, radius: 0.68 * self.radius, forks: self.forks - 1 };
            twig.grow(model, parts);
        }
    }
}

/// A line of a model.
#[derive(Clone, Copy)]
struct Value(usize);

/// A model as far as it is written. No two lines are equal. Where its last value is negative, there is matter.
struct Model {
    text: String,
    lines: HashMap<String, Value>,
}

impl Model {
    fn new(title: &str) -> Self {
        Self { text: format!("# {title}\n# Written by examples/models.rs.\n"), lines: HashMap::new() }
    }

    fn line(&mut self, line: String) -> Value {
        let next = Value(self.lines.len());
        let Self { text, lines } = self;
        *lines.entry(line).or_insert_with_key(|line| {
            text.push_str(&format!("_{:x} {line}\n", next.0));
            next
        })
    }

    /// Rounded to four decimals, so that all machines write the same.
    fn constant(&mut self, value: f64) -> Value {
        let rounded = (1e4 * value).round() / 1e4;
        // Adding zero makes −0 a plain 0.
        self.line(format!("const {}", rounded + 0.0))
    }

    fn apply(&mut self, operation: &str, operands: &[Value]) -> Value {
        let operands: Vec<String> = operands.iter().map(|Value(line)| format!("_{line:x}")).collect();
        self.line(format!("{operation} {}", operands.join(" ")))
    }

    fn union(&mut self, parts: Vec<Value>) -> Value {
        parts.into_iter().reduce(|a, b| self.apply("min", &[a, b])).expect("a model has parts")
    }

    fn difference(&mut self, body: Value, void: Value) -> Value {
        let outside = self.apply("neg", &[void]);
        self.apply("max", &[body, outside])
    }

    /// (x, y, z) − point.
    fn offset_from(&mut self, point: DVec3) -> [Value; 3] {
        [("var-x", point.x), ("var-y", point.y), ("var-z", point.z)].map(|(variable, coordinate)| {
            let (variable, coordinate) = (self.line(variable.to_owned()), self.constant(coordinate));
            self.apply("sub", &[variable, coordinate])
        })
    }

    /// The squared length of some coordinates, less a squared radius.
    fn beyond(&mut self, coordinates: &[Value], radius: f64) -> Value {
        let squares: Vec<Value> =
            coordinates.iter().map(|coordinate| self.apply("square", &[*coordinate])).collect();
        let sum =
            squares.into_iter().reduce(|a, b| self.apply("add", &[a, b])).expect("there are coordinates");
        let square = self.constant(radius * radius);
        self.apply("sub", &[sum, square])
    }

    fn ball(&mut self, center: DVec3, radius: f64) -> Value {
        let coordinates = self.offset_from(center);
        self.beyond(&coordinates, radius)
    }

    /// A cylinder that stands on `foot`.
    fn cylinder(&mut self, foot: DVec3, radius: f64, height: f64) -> Value {
        let [x, y, z] = self.offset_from(foot + DVec3::Z * (0.5 * height));
        let (round, slab) = (self.beyond(&[x, y], radius), self.beyond(&[z], 0.5 * height));
        self.apply("max", &[round, slab])
    }

    /// What lies not below a height, negative there.
    fn below(&mut self, height: f64) -> Value {
        let (height, z) = (self.constant(height), self.line("var-z".to_owned()));
        self.apply("sub", &[height, z])
    }

    /// All points no farther than `radius` from a segment.
    fn capsule(&mut self, start: DVec3, way: DVec3, radius: f64) -> Value {
        let from_start = self.offset_from(start);
        let scaled = (way / way.length_squared()).to_array().map(|component| self.constant(component));
        let parts = [0, 1, 2].map(|axis| self.apply("mul", &[from_start[axis], scaled[axis]]));
        let along = self.apply("add", &[parts[0], parts[1]]);
        let along = self.apply("add", &[along, parts[2]]);
        let (zero, one) = (self.constant(0.0), self.constant(1.0));
        let along = self.apply("max", &[along, zero]);
        let along = self.apply("min", &[along, one]);
        let from_segment = [0, 1, 2].map(|axis| {
            let component = self.constant(way[axis]);
            let foot = self.apply("mul", &[along, component]);
            self.apply("sub", &[from_start[axis], foot])
        });
        self.beyond(&from_segment, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_as_written_here() {
        for (name, text) in models() {
            assert!(
                fs::read_to_string(format!("{FOLDER}/{name}.vm")).unwrap() == text,
                "{name} is another one"
            );
        }
    }
}
