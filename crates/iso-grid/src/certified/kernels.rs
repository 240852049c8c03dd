//! The kernels that proofs are made of.

use std::hash::BuildHasher;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{
    BatchKernel, BoxKernel, CompileError, Decorated, Decoration, Extreme, Interval, Program, Scratch,
};
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::{Kernel, Surface};

/// How many boxes are enclosed by one call at most.
pub(super) const BATCH: usize = 8;

/// About how much longer an operation takes at points in kernels that are made for few runs, where it is interpreted.
const MUCH_LESS: u64 = 4;

/// How many operations the programs of all places may have together.
const ROOM: u64 = 1 << 23;

/// After so many operations by kernels made for few runs, for each of its own operations, a formula would better have been compiled at
/// once: that takes about a quarter of a millisecond for each. Measured: to wait four times as long takes half as long again for a gyroid in a ball,
/// and to wait a quarter as long a tenth more for a union of a hundred balls.
const OFTEN: u64 = 1 << 17;

/// An axis-parallel box.
pub(super) type Bounds = [Interval; 3];

/// The box with these corners.
pub(super) fn bounds_between(lo: DVec3, hi: DVec3) -> Bounds {
    [0, 1, 2].map(|axis| Interval { lo: lo[axis], hi: hi[axis] })
}

/// F at points and over boxes, F with its gradient over boxes, and [what rounding does to F](Program::with_rounding) there:
/// everywhere, or those of a [shorter](Program::shortened) function that has its signs on a box. What is concluded from several values is
/// to be concluded from those of one function, for only their signs are the same.
pub(super) struct Kernels {
    formula: Arc<Formula>,
    /// Where they hold.
    domain: Bounds,
}

/// F, or what it comes to in some places: a function with the same signs there.
pub(super) struct Formula {
    /// Compiled before, or not to be compiled as long as it is seldom asked for.
    surface: Arc<Surface>,
    /// The same as native code, if it was asked for often.
    compiled: OnceLock<Arc<Surface>>,
    /// Before it is compiled.
    patience: Patience,
    /// Before each kernel is compiled that is not compiled ahead.
    patience_for: [Patience; Kernel::ALL.len()],
    has_branches: bool,
    /// What is left of it in places must have so many operations to have forms. These take long to make, and pay where rays of many places
    /// ask for the same ones.
    least_with_forms: usize,
    /// Whether its forms are asked for. That depends on the formula alone, so that all engines prove the same.
    has_forms: bool,
    /// How many operations each kernel takes, counted when first asked for.
    operations: [OnceLock<u64>; Kernel::ALL.len()],
    /// Those of which it is the least or the greatest everywhere, found when first asked for; `None` when it is no such thing.
    faces: OnceLock<Option<(Extreme, Vec<Arc<Formula>>)>>,
}

/// What F comes to in some places, shared wherever it is the same.
pub(super) struct Formulas {
    /// By the hashes of their programs.
    known: Mutex<FxHashMap<u64, Vec<Arc<Formula>>>>,
    /// How many operations may still be kept.
    room: AtomicU64,
}

/// None so far.
impl Default for Formulas {
    fn default() -> Self {
        Self { known: Mutex::default(), room: AtomicU64::new(ROOM) }
    }
}

impl Formulas {
    /// The one with this program, which is what is left of `outer`. It is kept while there is room.
    fn one_of(&self, program: Program, outer: &Formula) -> Arc<Formula> {
        let hash = FxBuildHasher.hash_one(&program);
        // Formulas are only ever put in whole.
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let alike = known.entry(hash).or_default();
        if let Some(formula) = alike.iter().find(|formula| *formula.surface.program() == program) {
            return Arc::clone(formula);
        }
        let operations = program.operations() as u64;
        let patience = Patience::limited(&program);
        let surface = outer.surface.reduced_to(program);
        let formula = Arc::new(Formula::new(surface, patience, outer.least_with_forms));
        if self.have_room() {
            self.room.update(Ordering::Relaxed, Ordering::Relaxed, |room| room.saturating_sub(operations));
            alike.push(Arc::clone(&formula));
        }
        formula
    }

    /// Whether more may be kept.
    pub(super) fn have_room(&self) -> bool {
        self.room.load(Ordering::Relaxed) > 0
    }
}

/// How many operations may still be asked for before something is compiled.
struct Patience(AtomicU64);

impl Patience {
    /// As long as something is not asked for often.
    fn limited(program: &Program) -> Self {
        Self(AtomicU64::new(OFTEN * program.operations().max(1) as u64))
    }

    /// It is never to be compiled.
    fn endless() -> Self {
        Self(AtomicU64::new(u64::MAX))
    }

    fn is_endless(&self) -> bool {
        self.0.load(Ordering::Relaxed) == u64::MAX
    }

    fn is_spent(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }

    /// Notes that so many operations were asked for; says once that it is enough.
    fn wear(&self, operations: u64) -> bool {
        let before = self.0.load(Ordering::Relaxed);
        if before == u64::MAX || before == 0 {
            return false;
        }
        // It does not matter if threads that come by at once forget each other's operations; one of them takes the last.
        let after = before.saturating_sub(operations);
        let is_first = self.0.compare_exchange(before, after, Ordering::Relaxed, Ordering::Relaxed).is_ok();
        after == 0 && is_first
    }
}

impl Formula {
    fn new(surface: Surface, patience: Patience, least_with_forms: usize) -> Self {
        let program = surface.program();
        let has_branches = program.has_branches();
        Self {
            least_with_forms,
            has_forms: program.operations() >= least_with_forms && Kernel::Forms.pays(program),
            patience_for: Kernel::ALL.map(|_| Patience::limited(surface.program())),
            surface: Arc::new(surface),
            compiled: OnceLock::new(),
            patience,
            has_branches,
            operations: Default::default(),
            faces: OnceLock::new(),
        }
    }

    /// What is to be called: both say the same, bit for bit.
    fn surface(&self) -> &Surface {
        self.compiled.get().unwrap_or(&self.surface)
    }

    /// Notes that so many operations of a kernel were asked for.
    fn wear(&self, kernel: Kernel, operations: u64) {
        if self.patience.wear(operations) {
            let surface = self.surface.compiled_for_many_runs();
            if Kernel::of_proofs(self.has_forms).all(|kernel| surface.compile(kernel).is_ok()) {
                self.compiled.get_or_init(|| Arc::new(surface));
                Kernel::ALL.into_iter().for_each(|kernel| self.compile_if_often(kernel));
            }
        }
        if !kernel.is_compiled_ahead(self.has_forms) && self.patience_for[kernel as usize].wear(operations) {
            self.compile_if_often(kernel);
        }
    }

    /// Compiles a kernel that was asked for often, if those are that are compiled ahead.
    fn compile_if_often(&self, kernel: Kernel) {
        let is_native = self.compiled.get().is_some() || self.patience.is_endless();
        if is_native && self.patience_for[kernel as usize].is_spent() {
            // Where it cannot be compiled it stays as it is.
            let _ = self.surface().compile(kernel);
        }
    }
}

/// F over a box, and its derivatives along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    pub(super) value: Decorated,
    pub(super) gradient: [Decorated; 3],
}

/// What holds for every function.
pub(super) const NOTHING_KNOWN: Decorated =
    Decorated { interval: Interval::ENTIRE, decoration: Decoration::Trivial };

impl Kernels {
    /// Kernels that hold everywhere: native code, unless they are [left to places](Kernel::are_left_to_places).
    ///
    /// # Errors
    /// When the engine cannot compile one.
    pub(super) fn of(surface: &Surface) -> Result<Self, CompileError> {
        let program = surface.program();
        let least_with_forms = match program.operations() {
            operations if operations > Kernel::WITH_FORMS => usize::MAX,
            operations if Kernel::are_left_to_places(program) => operations / 2,
            _ => 0,
        };
        let formula = if Kernel::are_left_to_places(program) {
            Formula::new(surface.made_for_few_runs(), Patience::limited(program), least_with_forms)
        } else {
            let has_forms = Kernel::Forms.pays(program);
            Kernel::of_proofs(has_forms).try_for_each(|kernel| surface.compile(kernel))?;
            Formula::new(surface.clone(), Patience::endless(), least_with_forms)
        };
        Ok(Self { formula: Arc::new(formula), domain: [Interval::ENTIRE; 3] })
    }

    /// Shorter ones that hold on `domain`, a part of where these do; `None` where there are none. They are made for few
    /// runs, and compiled when they are asked for often.
    pub(super) fn shortened(&self, formulas: &Formulas, domain: Bounds) -> Option<Self> {
        let program = self.program().shortened(domain)?;
        Some(Self { formula: formulas.one_of(program, &self.formula), domain })
    }

    /// Kernels of those of which F is the least or the greatest wherever these hold, if it is a minimum or a maximum there.
    pub(super) fn faces(&self, formulas: &Formulas) -> Option<(Extreme, Vec<Self>)> {
        let faces = self.formula.faces.get_or_init(|| {
            let (extreme, programs) = self.program().extreme_of()?;
            let faces = programs.into_iter().map(|program| formulas.one_of(program, &self.formula));
            Some((extreme, faces.collect()))
        });
        let (extreme, faces) = faces.as_ref()?;
        let kernels = |face: &Arc<Formula>| Self { formula: Arc::clone(face), domain: self.domain };
        Some((*extreme, faces.iter().map(kernels).collect()))
    }

    /// Whether these are others of the same function on the same box. Threads may find out the same.
    pub(super) fn are(&self, others: &Self) -> bool {
        let is_same = || Arc::ptr_eq(&self.formula, &others.formula) || self.program() == others.program();
        self.domain == others.domain && is_same()
    }

    /// Whether there is anything that a box may decide.
    pub(super) fn may_be_shortened(&self) -> bool {
        self.formula.has_branches
    }

    /// How many operations a kernel takes.
    pub(super) fn operations(&self, kernel: Kernel) -> u64 {
        let Formula { operations, surface, .. } = &*self.formula;
        *operations[kernel as usize].get_or_init(|| surface.program_of(kernel).operations() as u64)
    }

    /// Notes that a kernel is asked for so many points or boxes, and says how many operations that takes.
    pub(super) fn charge(&self, kernel: Kernel, count: usize) -> u64 {
        let operations = count as u64 * self.operations(kernel);
        self.formula.wear(kernel, operations);
        operations
    }

    pub(super) fn program(&self) -> &Program {
        self.formula.surface.program()
    }

    /// One of the kernels over points.
    pub(super) fn over_points(&self, kernel: Kernel) -> &dyn BatchKernel {
        &**compiled(self.formula.surface().over_points(kernel))
    }

    /// F and its gradient at points, made for few runs, if that takes less time than those of `others` as native code, or that is not at
    /// hand.
    pub(super) fn gradients_at_points(&self, others: &Self) -> Option<Arc<dyn BatchKernel>> {
        let [these, those] = [self, others].map(|kernels| kernels.operations(Kernel::Gradients));
        let pays = MUCH_LESS * these <= those || Kernel::are_left_to_places(others.program());
        pays.then(|| Arc::clone(compiled(self.formula.surface.gradients())))
    }

    /// F over boxes.
    pub(super) fn values(&self) -> &dyn BoxKernel {
        &**compiled(self.formula.surface().value_enclosures())
    }

    /// F with its gradient over boxes.
    pub(super) fn gradients(&self) -> &dyn BoxKernel {
        self.made_for(Kernel::GradientEnclosures)
    }

    /// One of the kernels over boxes; `None` where it does not pay.
    pub(super) fn over_boxes(&self, kernel: Kernel) -> Option<&dyn BoxKernel> {
        kernel.pays(self.program()).then(|| self.made_for(kernel))
    }

    /// A kernel over boxes: compiled, or made for few runs as long as it is seldom asked for. Both say the same, bit for bit.
    fn made_for(&self, kernel: Kernel) -> &dyn BoxKernel {
        let Formula { has_forms, surface: seldom, .. } = &*self.formula;
        let surface = self.formula.surface();
        let native = kernel.is_compiled_ahead(*has_forms) || surface.is_compiled(kernel);
        &**if native { compiled(surface.over_boxes(kernel)) } else { seldom.for_few_runs(kernel) }
    }

    /// The affine forms of F and its derivatives, by one of the kernels of forms, where that pays.
    pub(super) fn forms(&self, kernel: Kernel) -> Option<&dyn BatchKernel> {
        self.formula.has_forms.then(|| self.over_points(kernel))
    }

    /// The corners of the box on which they hold.
    pub(super) fn corners(&self) -> (DVec3, DVec3) {
        (self.domain.map(|side| side.lo).into(), self.domain.map(|side| side.hi).into())
    }

    /// Whether they hold on all of a box.
    pub(super) fn cover(&self, bounds: &Bounds) -> bool {
        self.domain.iter().zip(bounds).all(|(domain, side)| domain.lo <= side.lo && side.hi <= domain.hi)
    }

    /// Encloses F over each of the boxes; what stands behind their number means nothing.
    pub(super) fn enclosures(&self, scratch: &mut Scratch, boxes: &[Bounds]) -> [Decorated; BATCH] {
        let outputs = Outputs::<BATCH>::of(self.values(), scratch, boxes);
        std::array::from_fn(|place| outputs.at(place))
    }

    /// Encloses F and its gradient over each of the boxes; what stands behind their number means nothing.
    pub(super) fn jets(&self, scratch: &mut Scratch, boxes: &[Bounds]) -> [Jet; BATCH] {
        let outputs = Outputs::<{ 4 * BATCH }>::of(self.gradients(), scratch, boxes);
        let count = boxes.len();
        let mut jets = [Jet { value: NOTHING_KNOWN, gradient: [NOTHING_KNOWN; 3] }; BATCH];
        for (place, jet) in jets.iter_mut().enumerate().take(count) {
            let gradient = [1, 2, 3].map(|output| outputs.at(output * count + place));
            *jet = Jet { value: outputs.at(place), gradient };
        }
        jets
    }
}

fn compiled<K>(kernel: Result<K, CompileError>) -> K {
    kernel.expect("native code was compiled before, and the interpreter takes any program")
}

/// What a kernel wrote for a batch: output `k` of box `i` of `n` stands at `k·n + i`.
struct Outputs<const N: usize> {
    lo: [f64; N],
    hi: [f64; N],
    decoration: [Decoration; N],
}

impl<const N: usize> Outputs<N> {
    fn of(kernel: &dyn BoxKernel, scratch: &mut Scratch, boxes: &[Bounds]) -> Self {
        let count = boxes.len();
        let (mut lo, mut hi) = ([[0.0; BATCH]; 3], [[0.0; BATCH]; 3]);
        for (place, bounds) in boxes.iter().enumerate() {
            for (axis, side) in bounds.iter().enumerate() {
                (lo[axis][place], hi[axis][place]) = (side.lo, side.hi);
            }
        }
        let boxes = Boxes {
            lo: lo.each_ref().map(|ends| &ends[..count]),
            hi: hi.each_ref().map(|ends| &ends[..count]),
        };
        let mut outputs = Self { lo: [0.0; N], hi: [0.0; N], decoration: [Decoration::Trivial; N] };
        let used = count * (N / BATCH);
        let enclosures = Enclosures {
            lo: &mut outputs.lo[..used],
            hi: &mut outputs.hi[..used],
            decoration: &mut outputs.decoration[..used],
        };
        kernel.evaluate(scratch, boxes, enclosures);
        outputs
    }

    fn at(&self, place: usize) -> Decorated {
        let interval = Interval { lo: self.lo[place], hi: self.hi[place] };
        Decorated { interval, decoration: self.decoration[place] }
    }
}
