//! Surfaces for tests, given by functions of Rust.

use std::sync::Arc;

use glam::DVec3;
use iso_expr::engine::Points;
use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, PointKernel, Program, Scratch};

use crate::{Outcome, Ray, Surface, Tracer, Workspace};

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
}

impl BatchKernel for Functions {
    fn evaluate(&self, _: &mut Scratch, points: Points<'_>, values: &mut [f64]) {
        let count = points.x.len();
        for number in 0..count {
            let point = DVec3::new(points.x[number], points.y[number], points.z[number]);
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

/// The surface where `value` is zero.
pub(crate) fn surface(value: Function, gradient: Gradient) -> Surface {
    let mut program = Program::new();
    let output = program.literal(0.0);
    program.set_outputs(vec![output]);
    let mut with_gradient = program.clone();
    with_gradient.set_outputs(vec![output; 4]);
    Surface::new(Arc::new(Functions { value, gradient }), program, with_gradient)
}

/// The surface where `value` is zero, for tests that ask for no gradient.
pub(crate) fn surface_without_gradient(value: Function) -> Surface {
    surface(value, |_| DVec3::NAN)
}

/// How the search along one ray ends.
pub(crate) fn trace(tracer: &dyn Tracer, ray: Ray) -> Outcome {
    let mut outcomes = [Outcome::Miss];
    tracer.trace(&mut Workspace::default(), &[ray], &mut outcomes);
    outcomes[0]
}
