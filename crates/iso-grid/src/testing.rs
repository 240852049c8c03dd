//! What tests share: surfaces given by functions of Rust, and rays of every kind.

use std::iter;
use std::sync::Arc;

use glam::DVec3;
use iso_expr::{
    Ast, Axis, BatchKernel, BoxKernel, CompileError, Engine, Interpreter, Operation, PointKernel, Program,
    Scratch,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::{Outcome, Outcomes, Ray, Surface, Tracer, Workspace, normals};

/// F − C at a point.
pub(crate) type Function = fn(DVec3) -> f64;
/// The gradient of F at a point.
pub(crate) type Gradient = fn(DVec3) -> DVec3;

/// An engine that computes the same functions whatever it is asked to compile.
struct Functions {
    value: Function,
    gradient: Gradient,
}

impl Engine for Functions {
    fn name(&self) -> &'static str {
        "functions"
    }

    fn point(&self, _: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        unreachable!("this crate asks for batches")
    }

    fn batch(&self, _: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        Ok(Arc::new(Self { ..*self }))
    }

    fn boxes(&self, _: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        unreachable!("the paper's methods ask for no boxes")
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        unreachable!("the paper's methods shorten nothing")
    }
}

impl BatchKernel for Functions {
    fn evaluate(&self, _: &mut Scratch, arguments: &[&[f64]], values: &mut [f64]) {
        let count = arguments[0].len();
        for number in 0..count {
            let point = DVec3::from_array([0, 1, 2].map(|axis| arguments[axis][number]));
            values[number] = (self.value)(point);
            if values.len() == 4 * count {
                let gradient = (self.gradient)(point);
                for axis in 0..3 {
                    values[(axis + 1) * count + number] = gradient[axis];
                }
            }
        }
    }
}

/// The surface of a formula, interpreted.
pub(crate) fn surface_of(formula: &str) -> Surface {
    let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
    Surface::new(Arc::new(Interpreter), program)
}

/// The surface where `value` is zero.
pub(crate) fn surface(value: Function, gradient: Gradient) -> Surface {
    // The engine does not look at the program, but methods ask it which arguments the function takes.
    let mut program = Program::new();
    let arguments = Axis::ALL.map(|axis| program.variable(axis));
    let output = program.apply(Operation::Select, &arguments);
    program.set_outputs(vec![output]);
    Surface::new(Arc::new(Functions { value, gradient }), program)
}

/// The surface where `value` is zero, for tests that ask for no gradient.
pub(crate) fn surface_without_gradient(value: Function) -> Surface {
    surface(value, |_| DVec3::NAN)
}

/// How the search along one ray ends.
pub(crate) fn trace(tracer: &dyn Tracer, ray: Ray) -> Outcome {
    let mut outcomes = Outcomes::default();
    tracer.trace(&mut Workspace::default(), &[ray], &mut outcomes);
    outcomes.get(0)
}

/// The normal where a ray ends.
pub(crate) fn normal(surface: &Surface, ray: Ray, outcome: Outcome) -> DVec3 {
    let mut found = [DVec3::NAN];
    normals(
        surface,
        None,
        &mut Workspace::default(),
        [ray].as_slice().into(),
        &iter::once(outcome).collect(),
        &mut found,
    )
    .expect("functions are not compiled");
    found[0]
}

/// Property tests of this many cases, the same at every run.
pub(crate) fn property(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    }
}

/// Rays around a box of side 2 or so: from planes between cells, from cells and from outside; along axes, slanted and
/// backwards, of very small and very large components.
pub(crate) fn ray() -> impl Strategy<Value = Ray> {
    let coordinate = prop_oneof![(-12..=12).prop_map(|quarter| f64::from(quarter) / 4.0), -3.0..3.0];
    let component = prop_oneof![
        Just(0.0),
        Just(-0.0),
        (-2..=2).prop_map(f64::from),
        -1.0..1.0,
        Just(1e-300),
        -1e200..1e200
    ];
    (proptest::array::uniform3(coordinate), proptest::array::uniform3(component)).prop_map(
        |(origin, direction)| Ray {
            origin: DVec3::from_array(origin),
            direction: DVec3::from_array(direction),
        },
    )
}
