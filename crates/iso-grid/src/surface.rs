//! The surface F − C = 0 as kernels, compiled when first needed.

use std::sync::{Arc, OnceLock};

use iso_expr::{BatchKernel, BoxKernel, CompileError, Engine, Program};

use crate::Stop;

/// The kernels of F − C and of its gradient. Each is compiled when it is first asked for.
pub struct Surface {
    engine: Arc<dyn Engine>,
    value: Program,
    value_and_gradient: Program,
    value_batch: OnceLock<Result<Arc<dyn BatchKernel>, CompileError>>,
    gradient_batch: OnceLock<Result<Arc<dyn BatchKernel>, CompileError>>,
    value_boxes: OnceLock<Result<Arc<dyn BoxKernel>, CompileError>>,
    gradient_boxes: OnceLock<Result<Arc<dyn BoxKernel>, CompileError>>,
    rounding_boxes: OnceLock<Result<Arc<dyn BoxKernel>, CompileError>>,
    stop: Stop,
}

impl Surface {
    /// The surface where `value`'s one output is zero. `value_and_gradient` computes the same value, then ∂x, ∂y and ∂z.
    ///
    /// # Panics
    /// When the programs have other numbers of outputs.
    pub fn new(engine: Arc<dyn Engine>, value: Program, value_and_gradient: Program) -> Self {
        assert_eq!((value.outputs().len(), value_and_gradient.outputs().len()), (1, 4));
        Self {
            engine,
            value,
            value_and_gradient,
            value_batch: OnceLock::new(),
            gradient_batch: OnceLock::new(),
            value_boxes: OnceLock::new(),
            gradient_boxes: OnceLock::new(),
            rounding_boxes: OnceLock::new(),
            stop: Stop::default(),
        }
    }

    /// The same surface, on which all work ends when `stop` is requested.
    pub fn stopped_by(self, stop: Stop) -> Self {
        Self { stop, ..self }
    }

    /// What ends work on this surface.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }

    /// The program of F − C.
    pub fn program(&self) -> &Program {
        &self.value
    }

    /// F − C at points.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn values(&self) -> Result<&Arc<dyn BatchKernel>, CompileError> {
        compiled(&self.value_batch, || self.engine.batch(&self.value))
    }

    /// F − C and its three derivatives at points.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn gradients(&self) -> Result<&Arc<dyn BatchKernel>, CompileError> {
        compiled(&self.gradient_batch, || self.engine.batch(&self.value_and_gradient))
    }

    /// F − C over boxes.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn value_enclosures(&self) -> Result<&Arc<dyn BoxKernel>, CompileError> {
        compiled(&self.value_boxes, || self.engine.boxes(&self.value))
    }

    /// F − C and its three derivatives over boxes.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn gradient_enclosures(&self) -> Result<&Arc<dyn BoxKernel>, CompileError> {
        compiled(&self.gradient_boxes, || self.engine.boxes(&self.value_and_gradient))
    }

    /// F − C, [what rounding does to it](Program::with_rounding) and its three derivatives over boxes.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn rounding_bounds(&self) -> Result<&Arc<dyn BoxKernel>, CompileError> {
        compiled(&self.rounding_boxes, || self.engine.boxes(&self.value.with_rounding().simplified()))
    }
}

fn compiled<K>(
    cell: &OnceLock<Result<K, CompileError>>,
    compile: impl FnOnce() -> Result<K, CompileError>,
) -> Result<&K, CompileError> {
    cell.get_or_init(compile).as_ref().map_err(Clone::clone)
}
