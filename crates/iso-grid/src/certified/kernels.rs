//! The kernels that proofs are made of.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{
    BatchKernel, BoxKernel, CompileError, Composition, Decorated, Decoration, Interval, Program, Scratch,
};

use super::formula::{Formula, Formulas, INTERPRETED, compiled};
use crate::{Kernel, Surface};

/// How many boxes are enclosed by one call at most.
pub(super) const BATCH: usize = 8;

/// Of so few functions it is first asked whether any of them has a sign on a box.
const FEW: usize = 4;

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
    /// Those of the functions that F is made of wherever these hold, found when first asked for.
    composition: OnceLock<Option<Composition<Arc<Self>>>>,
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
    fn on(domain: Bounds, formula: Arc<Formula>) -> Self {
        Self { formula, domain, composition: OnceLock::new() }
    }

    /// Kernels that hold everywhere: native code, unless they are [left to places](Kernel::are_left_to_places).
    ///
    /// # Errors
    /// When the engine cannot compile one.
    pub(super) fn of(surface: &Surface) -> Result<Self, CompileError> {
        let formula = Formula::everywhere(surface)?;
        Ok(Self::on([Interval::ENTIRE; 3], Arc::new(formula)))
    }

    /// Shorter ones that hold on `domain`, as far as these do; `None` where there are none. They are made for few runs, and compiled when they are
    /// asked for often.
    pub(super) fn shortened(&self, formulas: &Formulas, domain: Bounds) -> Option<Self> {
        let domain = [0, 1, 2].map(|axis| domain[axis].intersection(self.domain[axis]));
        if self.leave_all_open(formulas, domain) {
            return None;
        }
        let program = self.program().shortened(domain)?;
        Some(Self::on(domain, formulas.one_of(&program, &self.formula)))
    }

    /// Whether F is the least or the greatest of a few smooth functions none of which has a sign on a box, so that nothing is decided there. Their
    /// kernels tell that in a fraction of the time that it takes to look at each node of F.
    fn leave_all_open(&self, formulas: &Formulas, domain: Bounds) -> bool {
        let composition = self.formula.is_whole().then(|| self.composition(formulas)).flatten();
        let Some(Composition::Extreme(_, faces)) = composition else { return false };
        let mut scratch = Scratch::default();
        let mut has_no_sign = |face: &Arc<Self>| {
            let [Decorated { interval: Interval { lo, hi }, .. }, ..] =
                face.enclosures(&mut scratch, &[domain]);
            lo < 0.0 && 0.0 < hi
        };
        faces.len() <= FEW && faces.iter().all(|face| !face.may_be_shortened() && has_no_sign(face))
    }

    /// Kernels of the functions that F is made of wherever these hold, if it has kinks there.
    pub(super) fn composition(&self, formulas: &Formulas) -> Option<&Composition<Arc<Self>>> {
        let find = || {
            let composition = self.formula.composition(formulas)?;
            Some(composition.of_each(|formula| Arc::new(Self::on(self.domain, Arc::clone(formula)))))
        };
        self.composition.get_or_init(find).as_ref()
    }

    /// Kernels of the same function that hold on a box, or along some rays in it that ask for nothing beyond.
    pub(super) fn within(&self, domain: Bounds) -> Self {
        Self::on(domain, Arc::clone(&self.formula))
    }

    /// Whether these are others of the same function. Threads may find out the same.
    pub(super) fn are_alike(&self, others: &Self) -> bool {
        Arc::ptr_eq(&self.formula, &others.formula) || self.program() == others.program()
    }

    /// Whether these are others of the same function on the same box.
    pub(super) fn are(&self, others: &Self) -> bool {
        self.domain == others.domain && self.are_alike(others)
    }

    /// The same number for all kernels of one function, as far as it is known to be one.
    pub(super) fn identity(&self) -> usize {
        Arc::as_ptr(&self.formula).addr()
    }

    /// Whether there is anything that a box may decide.
    pub(super) fn may_be_shortened(&self) -> bool {
        self.formula.has_branches()
    }

    /// Whether F is a function [within](Composition::Within) a margin.
    pub(super) fn are_cut(&self) -> bool {
        self.formula.is_cut()
    }

    /// Whether the function is certainly a number everywhere.
    pub(super) fn are_defined_everywhere(&self) -> bool {
        self.formula.is_defined_everywhere()
    }

    /// How many operations a kernel takes.
    pub(super) fn operations(&self, kernel: Kernel) -> u64 {
        self.formula.operations(kernel)
    }

    /// Notes that a kernel is asked for so many points or boxes, and says how many operations that takes.
    pub(super) fn charge(&self, kernel: Kernel, count: usize) -> u64 {
        let operations = count as u64 * self.operations(kernel);
        self.formula.wear(kernel, operations);
        operations
    }

    pub(super) fn program(&self) -> &Program {
        self.formula.program()
    }

    /// One of the kernels over points.
    pub(super) fn over_points(&self, kernel: Kernel) -> &dyn BatchKernel {
        &**compiled(self.formula.surface().over_points(kernel))
    }

    /// F and its gradient at points, made for few runs, if that takes less time than those of `others` as native code, or that is not at
    /// hand.
    pub(super) fn gradients_at_points(&self, others: &Self) -> Option<Arc<dyn BatchKernel>> {
        let [these, those] = [self, others].map(|kernels| kernels.operations(Kernel::Gradients));
        let pays = INTERPRETED * these <= those || Kernel::are_left_to_places(others.program());
        pays.then(|| Arc::clone(compiled(self.formula.seldom().over_points(Kernel::Gradients))))
    }

    /// F over boxes.
    pub(super) fn values(&self) -> &dyn BoxKernel {
        &**compiled(self.formula.surface().over_boxes(Kernel::ValueEnclosures))
    }

    /// F with its gradient over boxes.
    pub(super) fn gradients(&self) -> &dyn BoxKernel {
        self.formula.over_boxes(Kernel::GradientEnclosures)
    }

    /// Whether a kernel over boxes pays for the function.
    pub(super) fn may_ask(&self, kernel: Kernel) -> bool {
        self.formula.may_ask(kernel)
    }

    /// One of the kernels over boxes; `None` where it does not pay.
    pub(super) fn over_boxes(&self, kernel: Kernel) -> Option<&dyn BoxKernel> {
        self.may_ask(kernel).then(|| self.formula.over_boxes(kernel))
    }

    /// Whether affine forms of F and its derivatives are asked for.
    pub(super) fn have_forms(&self) -> bool {
        self.formula.has_forms()
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
