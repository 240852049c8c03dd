//! The kernels that proofs are made of.

use std::sync::{Arc, OnceLock};

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BatchKernel, BoxKernel, CompileError, Decorated, Decoration, Interval, Program, Scratch};

use crate::{Kernel, Surface};

/// How many boxes are enclosed by one call at most.
pub(super) const BATCH: usize = 8;

/// About how much longer an interpreted operation takes than one in native code.
const INTERPRETING: u64 = 4;

/// An axis-parallel box.
pub(super) type Bounds = [Interval; 3];

/// F at points and over boxes, F with its gradient over boxes, and [what rounding does to F](Program::with_rounding) there:
/// everywhere, or on a box where F comes to something [shorter](Program::shortened).
pub(super) struct Kernels {
    surface: Arc<Surface>,
    has_branches: bool,
    /// Where they hold.
    domain: Bounds,
    /// How many operations each takes, counted when first asked for.
    operations: [OnceLock<u64>; 5],
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
    /// Kernels that hold everywhere.
    ///
    /// # Errors
    /// When the engine cannot compile one.
    pub(super) fn of(surface: &Surface) -> Result<Self, CompileError> {
        Kernel::OF_PROOFS.iter().try_for_each(|kernel| surface.compile(*kernel))?;
        Ok(Self::on([Interval::ENTIRE; 3], Arc::new(surface.clone())))
    }

    fn on(domain: Bounds, surface: Arc<Surface>) -> Self {
        let has_branches = surface.program().has_branches();
        Self { has_branches, surface, domain, operations: Default::default() }
    }

    /// Shorter ones that hold on `domain`, a part of where these do; `None` where there are none. They are interpreted, for
    /// compiling takes longer than they run.
    pub(super) fn shortened(&self, domain: Bounds) -> Option<Self> {
        Some(Self::on(domain, Arc::new(self.surface.shortened(domain)?)))
    }

    /// Whether there is anything that a box may decide.
    pub(super) fn may_be_shortened(&self) -> bool {
        self.has_branches
    }

    /// Whether these, which are interpreted, take less time than `others` as native code. Where `others` are interpreted too the
    /// answer is the same, so that both engines prove the same enclosures.
    pub(super) fn are_quicker_than(&self, others: &Self) -> bool {
        INTERPRETING * self.operations(Kernel::Values) <= others.operations(Kernel::Values)
    }

    /// How many operations a kernel takes.
    pub(super) fn operations(&self, kernel: Kernel) -> u64 {
        *self.operations[kernel as usize].get_or_init(|| self.surface.program_of(kernel).operations() as u64)
    }

    pub(super) fn program(&self) -> &Program {
        self.surface.program()
    }

    /// F at points.
    pub(super) fn points(&self) -> &dyn BatchKernel {
        &**compiled(self.surface.values())
    }

    /// F over boxes.
    pub(super) fn values(&self) -> &dyn BoxKernel {
        &**compiled(self.surface.value_enclosures())
    }

    /// F with its gradient over boxes.
    pub(super) fn gradients(&self) -> &dyn BoxKernel {
        &**compiled(self.surface.gradient_enclosures())
    }

    /// F, what rounding does to it, and its gradient over boxes.
    pub(super) fn rounding(&self) -> &dyn BoxKernel {
        &**compiled(self.surface.rounding_bounds())
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
