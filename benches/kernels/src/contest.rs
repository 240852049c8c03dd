//! Who competes in each discipline. Every contender fills one buffer with all outputs of a whole batch.

use std::hint::black_box;

use iso_expr::engine::Enclosures;
use iso_expr::{
    BatchKernel, BoxKernel, CompileError, Decoration, Engine, Interpreter, PointKernel, Program, Scratch,
};
use iso_jit::Jit;

use crate::batch::{Batch, COUNT};
use crate::native::{BoxSweep, Native, SlopeSweep, Sweep, has_avx512};

/// What is evaluated, over what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Discipline {
    /// F, called as a function of three doubles.
    Function,
    /// F at one point a call.
    Point,
    /// F over a batch of points.
    Batch,
    /// F and its slope along a direction over a batch of points.
    BatchSlope,
    /// F and its gradient over a batch of points.
    BatchGradient,
    /// F over a batch of boxes.
    Boxes,
    /// F and its gradient over a batch of boxes.
    BoxesGradient,
    /// The affine forms of F and its gradient over a batch of sets of points.
    Forms,
    /// Those of F and its slope along parallel rays.
    ParallelForms,
}

impl Discipline {
    /// All of them, from the least work to the most.
    pub const ALL: [Self; 9] = [
        Self::Function,
        Self::Point,
        Self::Batch,
        Self::BatchSlope,
        Self::BatchGradient,
        Self::Boxes,
        Self::BoxesGradient,
        Self::Forms,
        Self::ParallelForms,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Function => "function",
            Self::Point => "point",
            Self::Batch => "batch",
            Self::BatchSlope => "batch+slope",
            Self::BatchGradient => "batch+gradient",
            Self::Boxes => "boxes",
            Self::BoxesGradient => "boxes+gradient",
            Self::Forms => "forms",
            Self::ParallelForms => "parallel forms",
        }
    }

    /// How many doubles a contender writes.
    pub fn room(self) -> usize {
        match self {
            Self::Function | Self::Point | Self::Batch => COUNT,
            Self::BatchSlope => 2 * COUNT,
            Self::BatchGradient => 4 * COUNT,
            Self::Boxes => 2 * COUNT,
            Self::BoxesGradient => 2 * 4 * COUNT,
            Self::Forms => Program::FORM * 4 * COUNT,
            Self::ParallelForms => Program::FORM * 2 * COUNT,
        }
    }
}

/// Fills a buffer of [`Discipline::room`] with the outputs for a whole batch.
pub type Fill<'a> = Box<dyn FnMut(&mut [f64]) + 'a>;

/// One way of evaluating a batch.
pub struct Entry<'a> {
    /// The engine, or what Rust was compiled for.
    pub name: &'static str,
    /// Evaluates it.
    pub fill: Fill<'a>,
}

impl<'a> Entry<'a> {
    fn new(name: &'static str, fill: impl FnMut(&mut [f64]) + 'a) -> Self {
        Self { name, fill: Box::new(fill) }
    }
}

/// A formula in every form that its contenders need.
pub struct Formula<'a> {
    /// F.
    pub value: &'a Program,
    /// F and its slope along a direction.
    pub slope: &'a Program,
    /// F and its gradient.
    pub gradient: &'a Program,
    /// The same in Rust.
    pub native: &'a Native,
    /// Where it is evaluated.
    pub batch: &'a Batch,
}

impl<'a> Formula<'a> {
    /// Who competes.
    ///
    /// # Errors
    /// When an engine cannot compile the formula.
    pub fn entries(&self, discipline: Discipline) -> Result<Vec<Entry<'a>>, CompileError> {
        let (interpreter, jit) = (Interpreter, Jit::new()?);
        let assembler = jit.for_few_runs();
        let engines: [(&'static str, &dyn Engine); 2] = [("interpreter", &interpreter), ("jit", &jit)];
        let (points, boxes, native) = (self.batch.points(), self.batch.boxes(), self.native);
        let mut entries = Vec::new();
        match discipline {
            Discipline::Function => {
                let function = jit.function(self.value)?;
                entries.push(Entry::new("jit", each_point(points, move |x, y, z| function.call(x, y, z))));
                entries.push(Entry::new("rust", each_point(points, black_box(native.value))));
            }
            Discipline::Point => {
                for (name, engine) in engines {
                    entries.push(Entry::new(name, point_kernel(engine.point(self.value)?, points)));
                }
                entries.push(Entry::new("rust", point_kernel(black_box(native.point)(), points)));
            }
            Discipline::Batch | Discipline::BatchGradient => {
                let (program, narrow, wide) = match discipline {
                    Discipline::Batch => (self.value, native.values, native.wide_values),
                    _ => (self.gradient, native.gradients, native.wide_gradients),
                };
                for (name, engine) in engines {
                    entries.push(Entry::new(name, batch_kernel(engine.batch(program)?, points.to_vec())));
                }
                entries.push(Entry::new("rust", sweep(narrow, points)));
                if has_avx512() {
                    entries.push(Entry::new("rust avx512", sweep(wide, points)));
                }
            }
            Discipline::BatchSlope => {
                let arguments = self.batch.points_and_directions();
                for (name, engine) in engines {
                    let kernel = engine.batch(self.slope)?;
                    entries.push(Entry::new(name, batch_kernel(kernel, arguments.to_vec())));
                }
                let rust = |sweep: SlopeSweep| move |values: &mut [f64]| sweep(black_box(arguments), values);
                entries.push(Entry::new("rust", rust(native.slopes)));
                if has_avx512() {
                    entries.push(Entry::new("rust avx512", rust(native.wide_slopes)));
                }
            }
            Discipline::Boxes | Discipline::BoxesGradient => {
                let (program, rust) = match discipline {
                    Discipline::Boxes => (self.value, native.boxes),
                    _ => (self.gradient, native.gradient_boxes),
                };
                for (name, engine) in engines.into_iter().chain([("assembled", &*assembler)]) {
                    entries.push(Entry::new(name, box_kernel(engine.boxes(program)?, self.batch)));
                }
                if let Some(rust) = rust {
                    entries.push(Entry::new("rust", box_sweep(rust, boxes)));
                }
            }
            Discipline::Forms | Discipline::ParallelForms => {
                let forms = match discipline {
                    Discipline::Forms => self.gradient.with_forms(),
                    _ => self.slope.with_forms(),
                };
                let program = forms.expect("the measured formulas have forms");
                for (name, engine) in engines {
                    let arguments = self.batch.forms();
                    entries.push(Entry::new(name, batch_kernel(engine.batch(&program)?, arguments)));
                }
            }
        }
        Ok(entries)
    }
}

fn each_point<'a>(
    [x, y, z]: [&'a [f64]; 3],
    function: impl Fn(f64, f64, f64) -> f64 + 'a,
) -> impl FnMut(&mut [f64]) + 'a {
    move |values| {
        for (place, value) in values.iter_mut().enumerate() {
            *value = function(x[place], y[place], z[place]);
        }
    }
}

fn point_kernel<'a>(
    kernel: std::sync::Arc<dyn PointKernel>,
    [x, y, z]: [&'a [f64]; 3],
) -> impl FnMut(&mut [f64]) + 'a {
    let mut scratch = Scratch::default();
    move |values| {
        for (place, value) in values.chunks_exact_mut(1).enumerate() {
            kernel.evaluate(&mut scratch, x[place], y[place], z[place], value);
        }
    }
}

fn batch_kernel<'a>(
    kernel: std::sync::Arc<dyn BatchKernel>,
    arguments: Vec<&'a [f64]>,
) -> impl FnMut(&mut [f64]) + 'a {
    let mut scratch = Scratch::default();
    move |values| kernel.evaluate(&mut scratch, &arguments, values)
}

fn box_kernel<'a>(kernel: std::sync::Arc<dyn BoxKernel>, batch: &'a Batch) -> impl FnMut(&mut [f64]) + 'a {
    let mut scratch = Scratch::default();
    let mut decorations = Vec::new();
    move |ends| {
        let (lo, hi) = ends.split_at_mut(ends.len() / 2);
        decorations.resize(lo.len(), Decoration::Trivial);
        kernel.evaluate(&mut scratch, batch.boxes(), Enclosures { lo, hi, decoration: &mut decorations });
    }
}

fn sweep<'a>(sweep: Sweep, points: [&'a [f64]; 3]) -> impl FnMut(&mut [f64]) + 'a {
    move |values| sweep(black_box(points), values)
}

fn box_sweep<'a>(sweep: BoxSweep, boxes: iso_expr::engine::Boxes<'a>) -> impl FnMut(&mut [f64]) + 'a {
    move |ends| {
        let (lo, hi) = ends.split_at_mut(ends.len() / 2);
        sweep(black_box(boxes), lo, hi);
    }
}
