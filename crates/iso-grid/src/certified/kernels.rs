//! The kernels that proofs are made of.

use std::sync::Arc;

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{BoxKernel, Decorated, Decoration, Interval, Scratch};

/// How many boxes are enclosed by one call at most.
pub(super) const BATCH: usize = 8;

/// An axis-parallel box.
pub(super) type Bounds = [Interval; 3];

/// F over boxes, F with its gradient over boxes, and [what rounding does to F](iso_expr::Program::with_rounding) there.
pub(super) struct Kernels {
    pub(super) values: Arc<dyn BoxKernel>,
    pub(super) gradients: Arc<dyn BoxKernel>,
    pub(super) rounding: Arc<dyn BoxKernel>,
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
    /// Encloses F over each of the boxes; what stands behind their number means nothing.
    pub(super) fn values(&self, scratch: &mut Scratch, boxes: &[Bounds]) -> [Decorated; BATCH] {
        let outputs = Outputs::<BATCH>::of(&*self.values, scratch, boxes);
        std::array::from_fn(|place| outputs.at(place))
    }

    /// Encloses F and its gradient over each of the boxes; what stands behind their number means nothing.
    pub(super) fn jets(&self, scratch: &mut Scratch, boxes: &[Bounds]) -> [Jet; BATCH] {
        let outputs = Outputs::<{ 4 * BATCH }>::of(&*self.gradients, scratch, boxes);
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
