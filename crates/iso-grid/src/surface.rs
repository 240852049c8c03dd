//! The surface F − C = 0 as kernels, compiled when first needed.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use iso_expr::{BatchKernel, BoxKernel, CompileError, Composition, Engine, Program};
use rustc_hash::FxHashMap;

use crate::certified::Cells;
use crate::{Kernel, Region, Stop};

/// The kernels of F − C and of its gradient. Each is compiled when it is first asked for, and F − C is differentiated when
/// the first that takes its gradient is.
///
/// The surface also keeps which cells of a region are proven to hold nothing of it, so that the certified method proves each
/// of them once, however many pictures of that region are drawn, and the kernels of the functions that F − C is made of by minima and
/// maxima. Copies share all of this.
#[derive(Clone)]
pub struct Surface {
    engine: Arc<dyn Engine>,
    /// The engine for kernels that are run often, where that is another one.
    many: Option<Arc<dyn Engine>>,
    value: Program,
    programs: Arc<Programs>,
    kernels: Arc<Compiled>,
    cells: Arc<Mutex<Option<CellsOfRegion>>>,
    /// The one with the same signs, `None` when it is this one.
    by_signs: Arc<OnceLock<Option<Surface>>>,
    /// The same with kernels that are made for many runs, where these are not.
    for_many_runs: Arc<OnceLock<Surface>>,
    /// The functions that F − C is made of.
    faces: Arc<OnceLock<FxHashMap<Program, Surface>>>,
    stop: Stop,
}

/// The programs that are made of F − C, when first needed.
#[derive(Default)]
struct Programs {
    gradient: OnceLock<Program>,
    slope: OnceLock<Program>,
    rounding: OnceLock<Program>,
    hessian: OnceLock<Program>,
    forms: OnceLock<Program>,
    parallel_forms: OnceLock<Program>,
}

/// The kernels by number, compiled when first needed.
#[derive(Default)]
struct Compiled {
    over_points: [OnceLock<Result<Arc<dyn BatchKernel>, CompileError>>; Kernel::ALL.len()],
    over_boxes: [OnceLock<Result<Arc<dyn BoxKernel>, CompileError>>; Kernel::ALL.len()],
    /// Those over boxes that are not compiled ahead.
    for_few_runs: [OnceLock<Arc<dyn BoxKernel>>; Kernel::ALL.len()],
}

/// A function of more operations is not followed through kinks inside it: that takes each side of all of them. Measured: for a body of 600
/// operations with smooth seams a fifth more time.
const LONGEST_CHOICE: usize = 64;

/// What is known of the cells of a region.
type CellsOfRegion = (Region, Arc<Cells>);

impl Surface {
    /// The surface where the one output of `value` is zero.
    ///
    /// # Panics
    /// When the program has another number of outputs.
    pub fn new(engine: Arc<dyn Engine>, value: Program) -> Self {
        assert_eq!(value.outputs().len(), 1, "a surface is where one function is zero");
        Self {
            engine,
            many: None,
            value,
            programs: Arc::default(),
            kernels: Arc::default(),
            cells: Arc::default(),
            by_signs: Arc::default(),
            for_many_runs: Arc::default(),
            faces: Arc::default(),
            stop: Stop::default(),
        }
    }

    /// The same surface, on which all work ends when `stop` is requested.
    pub fn stopped_by(self, stop: Stop) -> Self {
        let (by_signs, for_many_runs, faces) = Default::default();
        Self { stop, by_signs, for_many_runs, faces, ..self }
    }

    /// What ends work on this surface.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }

    /// The same surface for methods that ask of F − C no more than its sign and where it is zero: that of
    /// [another function](Program::with_same_signs) with the same signs if that is easier to follow, else this one.
    pub fn by_signs(&self) -> &Self {
        let find = || {
            let value = self.value.with_same_signs();
            (value != self.value).then(|| self.another(Arc::clone(&self.engine), value))
        };
        self.by_signs.get_or_init(find).as_ref().unwrap_or(self)
    }

    /// What is known of the cells of `region`. That of the last region asked for is kept.
    pub(crate) fn cells(&self, region: &Region) -> Arc<Cells> {
        // Cells are only ever put in whole.
        let mut kept = self.cells.lock().unwrap_or_else(PoisonError::into_inner);
        match &*kept {
            Some((of, cells)) if of == region => Arc::clone(cells),
            _ => {
                let cells = Arc::new(Cells::new(region));
                *kept = Some((*region, Arc::clone(&cells)));
                cells
            }
        }
    }

    /// A surface that is this one in some places, where F − C comes to `value`. Its kernels are made for few runs.
    pub(crate) fn reduced_to(&self, value: Program) -> Self {
        let many = Some(Arc::clone(self.engine_for_many_runs()));
        Self { many, ..self.another(self.engine.for_few_runs(), value) }
    }

    /// The same surface with kernels that are made for few runs.
    pub(crate) fn made_for_few_runs(&self) -> Self {
        Self { programs: Arc::clone(&self.programs), ..self.reduced_to(self.value.clone()) }
    }

    /// The same surface with kernels that are made for many runs.
    pub(crate) fn made_for_many_runs(&self) -> &Self {
        self.for_many_runs.get_or_init(|| {
            let engine = Arc::clone(self.engine_for_many_runs());
            Self { programs: Arc::clone(&self.programs), ..self.another(engine, self.value.clone()) }
        })
    }

    /// That one, if these kernels of it were compiled by now.
    pub(crate) fn compiled_for_many_runs(&self, mut kernels: impl Iterator<Item = Kernel>) -> Option<&Self> {
        self.for_many_runs.get().filter(|surface| kernels.all(|kernel| surface.is_compiled(kernel)))
    }

    /// How F − C is made of other functions everywhere, if it has kinks.
    pub(crate) fn composition(&self) -> Option<Composition<Program>> {
        self.value.composition(LONGEST_CHOICE)
    }

    /// The surface of one of these, by its program. Its kernels are made for few runs, and kept.
    pub(crate) fn face(&self, program: &Program) -> Option<&Self> {
        let find = || {
            let composition = self.composition();
            let faces = composition.iter().flat_map(Composition::functions);
            faces.map(|face| (face.clone(), self.reduced_to(face.clone()))).collect()
        };
        self.faces.get_or_init(find).get(program)
    }

    /// The surface of another function, on which work ends with that on this one.
    fn another(&self, engine: Arc<dyn Engine>, value: Program) -> Self {
        Self { many: self.many.clone(), stop: self.stop.clone(), ..Self::new(engine, value) }
    }

    fn engine_for_many_runs(&self) -> &Arc<dyn Engine> {
        self.many.as_ref().unwrap_or(&self.engine)
    }

    /// The program of F − C.
    pub fn program(&self) -> &Program {
        &self.value
    }

    /// The program that a kernel is compiled from: F − C, in some with its three derivatives and more.
    ///
    /// # Panics
    /// When forms are asked for and there are [none](Program::has_forms).
    pub fn program_of(&self, kernel: Kernel) -> &Program {
        match kernel {
            Kernel::Values | Kernel::ValueEnclosures => &self.value,
            Kernel::Gradients | Kernel::GradientEnclosures => {
                self.programs.gradient.get_or_init(|| self.value.with_gradient().simplified())
            }
            Kernel::Slopes => self.programs.slope.get_or_init(|| self.value.with_slope().simplified()),
            Kernel::RoundingBounds => {
                self.programs.rounding.get_or_init(|| self.value.with_rounding().simplified())
            }
            Kernel::HessianEnclosures => {
                let gradient = || self.program_of(Kernel::Gradients);
                self.programs.hessian.get_or_init(|| gradient().with_hessian().simplified())
            }
            Kernel::Forms => self.programs.forms.get_or_init(|| {
                let forms = self.program_of(Kernel::Gradients).with_forms();
                forms.expect("derivatives of what has forms have forms")
            }),
            Kernel::ParallelForms => self.programs.parallel_forms.get_or_init(|| {
                let forms = self.program_of(Kernel::Slopes).with_forms();
                forms.expect("derivatives of what has forms have forms")
            }),
        }
    }

    /// Compiles a kernel ahead of its use, so that the time it takes is known.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn compile(&self, kernel: Kernel) -> Result<(), CompileError> {
        if kernel.runs_over_boxes() {
            self.over_boxes(kernel).map(drop)
        } else {
            self.over_points(kernel).map(drop)
        }
    }

    /// Whether a kernel was compiled by now.
    pub fn is_compiled(&self, kernel: Kernel) -> bool {
        let Compiled { over_points, over_boxes, .. } = &*self.kernels;
        matches!(over_points[kernel as usize].get(), Some(Ok(_)))
            || matches!(over_boxes[kernel as usize].get(), Some(Ok(_)))
    }

    /// A kernel that runs over points, or over forms. Forms are made for few runs where that kernel is too large to be compiled.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    ///
    /// # Panics
    /// When forms are asked for and there are [none](Program::has_forms).
    pub fn over_points(&self, kernel: Kernel) -> Result<&Arc<dyn BatchKernel>, CompileError> {
        let compile = || {
            let program = self.program_of(kernel);
            let compiled = self.engine.batch(program);
            match kernel {
                Kernel::Forms | Kernel::ParallelForms => {
                    compiled.or_else(|_| self.engine.for_few_runs().batch(program))
                }
                _ => compiled,
            }
        };
        self.kernels.over_points[kernel as usize].get_or_init(compile).as_ref().map_err(Clone::clone)
    }

    /// A kernel that runs over boxes.
    ///
    /// # Errors
    /// When the engine cannot compile it.
    pub fn over_boxes(&self, kernel: Kernel) -> Result<&Arc<dyn BoxKernel>, CompileError> {
        let compile = || self.engine.boxes(self.program_of(kernel));
        self.kernels.over_boxes[kernel as usize].get_or_init(compile).as_ref().map_err(Clone::clone)
    }

    /// A kernel that runs over boxes, made for few runs.
    pub(crate) fn for_few_runs(&self, kernel: Kernel) -> &Arc<dyn BoxKernel> {
        self.kernels.for_few_runs[kernel as usize].get_or_init(|| {
            let kernel = self.engine.for_few_runs().boxes(self.program_of(kernel));
            kernel.expect("an engine for few runs takes any program")
        })
    }
}
