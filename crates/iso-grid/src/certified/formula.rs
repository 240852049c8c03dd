//! F, and what it comes to in places: functions whose kernels are compiled when they were asked for often.

use std::hash::BuildHasher;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use iso_expr::{BoxKernel, CompileError, Composition, Program};
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::{Kernel, Surface};

/// How many operations the programs of all places may have together.
const ROOM: u64 = 1 << 23;

/// After so many operations by kernels made for few runs, for each of its own operations, a formula would better have been compiled at
/// once: that takes about a quarter of a millisecond for each. Measured: to wait four times as long takes half as long again for a gyroid in a ball,
/// and to wait a quarter as long a tenth more for a union of a hundred balls.
const OFTEN: u64 = 1 << 17;

/// About how many times as long an operation takes at points, or of forms, in kernels that are made for few runs, where it is interpreted.
pub(super) const INTERPRETED: u64 = 4;

/// F, or what it comes to in some places: a function with the same signs there.
pub(super) struct Formula {
    /// Compiled before, or not to be compiled as long as it is seldom asked for.
    surface: Arc<Surface>,
    /// The same as native code, if it was asked for often.
    compiled: OnceLock<Surface>,
    patience: AllPatience,
    /// Whether it is F as it is everywhere.
    is_whole: bool,
    has_branches: bool,
    is_cut: bool,
    /// Whether it is certainly a number everywhere, found when first asked for.
    is_defined_everywhere: OnceLock<bool>,
    /// What is left of it in places must have so many operations to have forms. These take long to make, and pay where rays of many places
    /// ask for the same ones.
    least_with_forms: usize,
    /// Whether its forms are asked for. That depends on the formula alone, so that all engines prove the same.
    has_forms: bool,
    /// Whether its second derivatives are asked for.
    has_hessian: bool,
    /// How many operations each kernel takes, counted when first asked for.
    operations: [OnceLock<u64>; Kernel::ALL.len()],
    /// How it is made of others everywhere, found when first asked for; `None` when it has no kinks.
    composition: OnceLock<Option<Composition<Arc<Formula>>>>,
}

/// How many operations may still be asked for. Threads write it by turns; it stands apart from what all of them read, so that each keeps that in
/// its cache. Processors fetch lines of 64 bytes by twos.
#[repr(align(128))]
struct AllPatience {
    /// Before the formula is compiled.
    whole: Patience,
    /// Before each kernel is compiled that is not compiled ahead.
    of_kernels: [Patience; Kernel::ALL.len()],
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
    pub(super) fn one_of(&self, program: &Program, outer: &Formula) -> Arc<Formula> {
        let patience = Patience::limited(program.operations());
        self.one_with(program, outer, patience)
    }

    fn one_with(&self, program: &Program, outer: &Formula, patience: Patience) -> Arc<Formula> {
        let hash = FxBuildHasher.hash_one(program);
        // Formulas are only ever put in whole.
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let alike = known.entry(hash).or_default();
        if let Some(formula) = alike.iter().find(|formula| formula.surface.program() == program) {
            return Arc::clone(formula);
        }
        let operations = program.operations() as u64;
        let surface =
            outer.face(program).cloned().unwrap_or_else(|| outer.surface.reduced_to(program.clone()));
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
    /// As long as something of so many operations is not asked for often.
    fn limited(operations: usize) -> Self {
        Self(AtomicU64::new(OFTEN * operations.max(1) as u64))
    }

    /// Until something is first asked for.
    fn none() -> Self {
        Self(AtomicU64::new(1))
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

    /// Notes that so many operations were asked for; says that it is enough, once or, where threads come by at once, seldom again.
    fn wear(&self, operations: u64) -> bool {
        let before = self.0.load(Ordering::Relaxed);
        if before == u64::MAX || before == 0 {
            return false;
        }
        // It does not matter if threads that come by at once forget each other's operations, and to keep them apart takes longer than a store;
        // one of them takes the last.
        let after = before.saturating_sub(operations);
        if after > 0 {
            self.0.store(after, Ordering::Relaxed);
            return false;
        }
        self.0.compare_exchange(before, 0, Ordering::Relaxed, Ordering::Relaxed).is_ok()
    }
}

impl Formula {
    /// F everywhere: native code, unless it is [left to places](Kernel::are_left_to_places).
    ///
    /// # Errors
    /// When the engine cannot compile a kernel.
    pub(super) fn everywhere(surface: &Surface) -> Result<Self, CompileError> {
        let program = surface.program();
        let is_left_to_places = Kernel::are_left_to_places(program);
        let least_with_forms = match program.operations() {
            operations if operations > Kernel::WITH_FORMS => usize::MAX,
            operations if Kernel::are_for_places(program) => operations / 2,
            _ => 0,
        };
        if is_left_to_places {
            let formula = Self::new(
                surface.made_for_few_runs(),
                Patience::limited(program.operations()),
                least_with_forms,
            );
            return Ok(Self { is_whole: true, ..formula });
        }
        Kernel::of_proofs(Kernel::Forms.pays(program)).try_for_each(|kernel| surface.compile(kernel))?;
        Ok(Self { is_whole: true, ..Self::new(surface.clone(), Patience::endless(), least_with_forms) })
    }

    fn new(surface: Surface, patience: Patience, least_with_forms: usize) -> Self {
        let program = surface.program();
        let operations = program.operations();
        let of_kernels = Kernel::ALL.map(|_| Patience::limited(operations));
        let (has_branches, is_cut) = (program.has_branches(), program.is_cut());
        let has_forms = operations >= least_with_forms && Kernel::Forms.pays(program);
        let compiled = OnceLock::new();
        // By an earlier picture.
        if let Some(surface) = surface.compiled_for_many_runs(Kernel::of_proofs(has_forms)) {
            compiled.get_or_init(|| surface.clone());
        }
        Self {
            least_with_forms,
            has_forms,
            has_hessian: Kernel::HessianEnclosures.pays(program),
            surface: Arc::new(surface),
            compiled,
            patience: AllPatience { whole: patience, of_kernels },
            is_whole: false,
            has_branches,
            is_cut,
            is_defined_everywhere: OnceLock::new(),
            operations: Default::default(),
            composition: OnceLock::new(),
        }
    }

    pub(super) fn program(&self) -> &Program {
        self.surface.program()
    }

    /// The surface of one of the functions that it is made of everywhere, if it is F.
    fn face(&self, program: &Program) -> Option<&Surface> {
        if self.is_whole { self.surface.face(program) } else { None }
    }

    /// Whether it is F as it is everywhere.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Whether there is anything that a box may decide.
    pub(super) fn has_branches(&self) -> bool {
        self.has_branches
    }

    /// Whether it is a function [within](Composition::Within) a margin.
    pub(super) fn is_cut(&self) -> bool {
        self.is_cut
    }

    /// Whether it is certainly a number everywhere.
    pub(super) fn is_defined_everywhere(&self) -> bool {
        *self.is_defined_everywhere.get_or_init(|| self.program().is_defined_everywhere())
    }

    /// Whether its forms are asked for.
    pub(super) fn has_forms(&self) -> bool {
        self.has_forms
    }

    /// Whether a kernel over boxes [pays](Kernel::pays).
    pub(super) fn may_ask(&self, kernel: Kernel) -> bool {
        kernel != Kernel::HessianEnclosures || self.has_hessian
    }

    /// How many operations a kernel takes.
    pub(super) fn operations(&self, kernel: Kernel) -> u64 {
        let operations = || self.surface.program_of(kernel).operations() as u64;
        *self.operations[kernel as usize].get_or_init(operations)
    }

    /// How it is made of others everywhere, if it has kinks.
    pub(super) fn composition(&self, formulas: &Formulas) -> Option<&Composition<Arc<Self>>> {
        let find = || {
            let one_of = |program: &Program| formulas.one_of(program, self);
            Some(match self.surface.composition()? {
                Composition::Within { ref function, ref margin }
                    if self.is_whole && !Kernel::are_left_to_places(function) =>
                {
                    // It is asked for wherever anything is to be seen.
                    let function = formulas.one_with(function, self, Patience::none());
                    Composition::Within { function, margin: one_of(margin) }
                }
                composition => composition.of_each(one_of),
            })
        };
        self.composition.get_or_init(find).as_ref()
    }

    /// A kernel over boxes: compiled, or made for few runs as long as it is seldom asked for. Both say the same, bit for bit.
    pub(super) fn over_boxes(&self, kernel: Kernel) -> &dyn BoxKernel {
        let surface = self.surface();
        let is_native = kernel.is_compiled_ahead(self.has_forms) || surface.is_compiled(kernel);
        &**if is_native { compiled(surface.over_boxes(kernel)) } else { self.surface.for_few_runs(kernel) }
    }

    /// F as it is called while it is seldom asked for.
    pub(super) fn seldom(&self) -> &Surface {
        &self.surface
    }

    /// What is to be called: both say the same, bit for bit.
    pub(super) fn surface(&self) -> &Surface {
        self.compiled.get().unwrap_or(&self.surface)
    }

    /// Notes that so many operations of a kernel were asked for.
    pub(super) fn wear(&self, kernel: Kernel, operations: u64) {
        // Counted so, a bear of 662 operations (Keeter's benchmark of 2020) takes a twelfth fewer instructions.
        let operations = operations * if kernel.makes_forms() { INTERPRETED } else { 1 };
        if self.patience.whole.wear(operations) {
            let surface = self.surface.made_for_many_runs();
            if Kernel::of_proofs(self.has_forms).all(|kernel| surface.compile(kernel).is_ok()) {
                self.compiled.get_or_init(|| surface.clone());
                Kernel::ALL.into_iter().for_each(|kernel| self.compile_if_often(kernel));
            }
        }
        if !kernel.is_compiled_ahead(self.has_forms)
            && self.patience.of_kernels[kernel as usize].wear(operations)
        {
            self.compile_if_often(kernel);
        }
    }

    /// Compiles a kernel that was asked for often, if those are that are compiled ahead.
    fn compile_if_often(&self, kernel: Kernel) {
        let is_native = self.compiled.get().is_some() || self.patience.whole.is_endless();
        if is_native && self.patience.of_kernels[kernel as usize].is_spent() {
            // Where it cannot be compiled it stays as it is.
            let _ = self.surface().compile(kernel);
        }
    }
}

/// A kernel that there must be.
pub(super) fn compiled<K>(kernel: Result<K, CompileError>) -> K {
    kernel.expect("native code was compiled before, and the interpreter takes any program")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::surface_of;

    /// As for a second picture, whether faces or places are looked at first.
    #[test]
    fn kernels_of_what_a_surface_is_made_of_are_kept() {
        let ball_and_half_space = || surface_of("max(x^2 + y^2 + z^2 - 1, x)");
        let face_of = |surface: &Surface| {
            let (whole, formulas) = (Formula::everywhere(surface).unwrap(), Formulas::default());
            let Some(Composition::Extreme(_, faces)) = whole.composition(&formulas) else {
                panic!("an intersection is made of two")
            };
            Arc::clone(&faces[0])
        };
        let is_native = |face: &Formula| face.compiled.get().is_some();
        let surface = ball_and_half_space();
        let first = face_of(&surface);
        assert!(!is_native(&first));
        first.wear(Kernel::Values, u64::MAX - 1);
        assert!(is_native(&first) && is_native(&face_of(&surface)));
        let whole = Formula::everywhere(&surface).unwrap();
        assert!(is_native(&Formulas::default().one_of(first.program(), &whole)));
        assert!(!is_native(&face_of(&ball_and_half_space())));
    }
}
