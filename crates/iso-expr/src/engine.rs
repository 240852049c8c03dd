//! What every engine offers: kernels over a point, over a batch of points, and over a batch of boxes.
//!
//! A [`Program`] says what is computed, the kernel's kind over what. All engines agree bit for bit on every kernel and
//! every input, any NaN counting as equal to any other.

use std::sync::Arc;

use thiserror::Error;

use crate::{Decorated, Decoration, Program};

/// Turns programs into kernels. The interpreter is one engine, native code another.
pub trait Engine: Send + Sync {
    /// The engine's name on the command line and in reports.
    fn name(&self) -> &'static str;

    /// A kernel over one point.
    ///
    /// # Errors
    /// When the engine cannot compile the program.
    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError>;

    /// A kernel over batches of points.
    ///
    /// # Errors
    /// When the engine cannot compile the program.
    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError>;

    /// A kernel over batches of boxes.
    ///
    /// # Errors
    /// When the engine cannot compile the program.
    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError>;

    /// The engine for programs that run too few times to be worth more preparation than a pass over their nodes. As all
    /// engines agree, no result depends on it.
    fn for_few_runs(&self) -> Arc<dyn Engine>;
}

/// Evaluates a program at one point. Immutable, so that threads share it.
pub trait PointKernel: Send + Sync {
    /// Writes every output of the program at (x, y, z) into `values`, whose length is their number.
    ///
    /// # Panics
    /// When `values` has another length.
    fn evaluate(&self, scratch: &mut Scratch, x: f64, y: f64, z: f64, values: &mut [f64]);
}

/// Evaluates a program at many points. Immutable, so that threads share it.
pub trait BatchKernel: Send + Sync {
    /// Writes every output of the program at every point into `values`: output `k` at point `i` stands at `k·n + i`,
    /// where `n` is the number of points. Each of the `arguments`, x, y and z for a program of F, is given for all points, and
    /// there may be more than the program takes.
    ///
    /// # Panics
    /// When the lengths do not fit each other, or the program takes more arguments.
    fn evaluate(&self, scratch: &mut Scratch, arguments: &[&[f64]], values: &mut [f64]);
}

/// Encloses a program's range over many boxes. Immutable, so that threads share it.
pub trait BoxKernel: Send + Sync {
    /// Writes a decorated enclosure of every output over every box into `enclosures`, laid out as for [`BatchKernel`].
    ///
    /// # Panics
    /// When the lengths do not fit each other.
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>);
}

/// A batch of boxes, end by end. All six slices are equally long; a box with a NaN end is empty.
#[derive(Clone, Copy, Debug)]
pub struct Boxes<'a> {
    /// The lower ends along x, y and z.
    pub lo: [&'a [f64]; 3],
    /// The upper ends along x, y and z.
    pub hi: [&'a [f64]; 3],
}

/// Room for decorated enclosures, end by end. All three slices are equally long; an empty enclosure has NaN ends.
#[derive(Debug)]
pub struct Enclosures<'a> {
    /// Lower ends.
    pub lo: &'a mut [f64],
    /// Upper ends.
    pub hi: &'a mut [f64],
    /// Decorations.
    pub decoration: &'a mut [Decoration],
}

/// Working memory for kernels, one for each thread, reused from call to call. It carries no results.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Registers of the interpreter's point and batch kernels.
    pub(crate) values: Vec<f64>,
    /// Registers of the interpreter's box kernels.
    pub(crate) enclosures: Vec<Decorated>,
}

impl Scratch {
    /// Room for `count` doubles of any value, allocated only when it is more than ever before.
    pub fn values(&mut self, count: usize) -> &mut [f64] {
        if self.values.len() < count {
            self.values.resize(count, 0.0);
        }
        &mut self.values[..count]
    }

    /// Room for `count` enclosures of any value, allocated only when it is more than ever before.
    pub(crate) fn enclosures(&mut self, count: usize) -> &mut [Decorated] {
        if self.enclosures.len() < count {
            self.enclosures.resize(count, Decorated::EMPTY);
        }
        &mut self.enclosures[..count]
    }
}

/// Why a program could not be compiled.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum CompileError {
    /// The program is larger than the engine's limit.
    #[error("the formula takes {given} operations; the {engine} engine allows {allowed}")]
    TooLarge {
        /// The engine's name.
        engine: &'static str,
        /// The program's operations.
        given: usize,
        /// The engine's limit.
        allowed: usize,
    },
    /// The program has more values at a time than the engine has room for.
    #[error("the formula takes {given} bytes of stack; the {engine} engine allows {allowed}")]
    FrameTooLarge {
        /// The engine's name.
        engine: &'static str,
        /// The bytes of stack that its code would take.
        given: u32,
        /// The engine's limit.
        allowed: u32,
    },
    /// The code generator refused the program or the machine.
    #[error("the {engine} engine cannot compile this formula: {reason}")]
    Backend {
        /// The engine's name.
        engine: &'static str,
        /// What it said.
        reason: String,
    },
}
