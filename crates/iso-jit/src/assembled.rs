//! Kernels over boxes that are assembled from [pieces](crate::pieces), operation by operation, instead of being compiled: for programs
//! that run too few times to be worth compiling, or are too large for it.

use std::sync::Arc;

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{
    BatchKernel, BoxKernel, CompileError, Decorated, Decoration, Engine, Interpreter, Interval, Node, NodeId,
    Operation, PointKernel, Program, Scratch,
};

use crate::boxes::PAIR;
use crate::domain::Domain;
use crate::enclosures;
use crate::engine::NAME;
use crate::pieces::{Apply, KNOWN, Kind, LO, MINUS_HI, Piece, Pieces, SIZE};

/// The most nodes of a program: for more, places would not fit into 32 bits.
const LARGEST: usize = u32::MAX as usize / SIZE;

/// The engine for kernels that are not worth compiling. Those over points are interpreted.
#[derive(Clone)]
pub(crate) struct Assembler {
    pub(crate) pieces: Arc<Pieces>,
}

impl Engine for Assembler {
    fn name(&self) -> &'static str {
        NAME
    }

    fn point(&self, program: &Program) -> Result<Arc<dyn PointKernel>, CompileError> {
        Interpreter.point(program)
    }

    fn batch(&self, program: &Program) -> Result<Arc<dyn BatchKernel>, CompileError> {
        Interpreter.batch(program)
    }

    fn boxes(&self, program: &Program) -> Result<Arc<dyn BoxKernel>, CompileError> {
        match Assembled::new(&self.pieces, program) {
            Ok(kernel) => Ok(Arc::new(kernel)),
            Err(_) => Interpreter.boxes(program),
        }
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        Arc::new(self.clone())
    }
}

/// Where the enclosures of a value stand, in doubles from the beginning: first the constants, then the arguments, then the results of all
/// steps in their order.
#[derive(Clone, Copy, Debug)]
struct Place(u32);

impl Place {
    fn start(self) -> usize {
        self.0 as usize
    }
}

/// One operation.
struct Step {
    apply: Apply,
    operation: Operation,
    operands: [Place; 3],
}

/// A kernel over batches of boxes.
pub(crate) struct Assembled {
    steps: Vec<Step>,
    /// The enclosures of all constants.
    constants: Vec<f64>,
    /// The axis of each argument.
    arguments: Vec<usize>,
    outputs: Vec<(Place, Kind)>,
    /// Keeps the functions of all steps.
    _pieces: Arc<Pieces>,
}

impl Assembled {
    /// Assembles `program`. What no output needs is computed as well.
    ///
    /// # Errors
    /// When a piece cannot be compiled, or the program has more nodes than anybody's memory holds.
    pub(crate) fn new(pieces: &Arc<Pieces>, program: &Program) -> Result<Self, CompileError> {
        let (given, allowed) = (program.nodes().len(), LARGEST);
        if given > allowed {
            return Err(CompileError::TooLarge { engine: NAME, given, allowed });
        }
        let ranges = program.enclosures([Interval { lo: -Domain::NEAR, hi: Domain::NEAR }; 3]);
        let piece = |(id, node): (NodeId, &Node)| match node {
            Node::Apply(operation, operands) => {
                Some(Piece::new(*operation, operands.map(|id| ranges[id.index()]), ranges[id.index()]))
            }
            _ => None,
        };
        let wanted: Vec<Piece> = program.iter().filter_map(piece).collect();
        let mut functions = pieces.functions(&wanted)?.into_iter();
        let nodes = || program.nodes().iter().zip(&ranges);
        let is_constant = |(node, _): &(&Node, &Decorated)| matches!(node, Node::Constant(_));
        let mut constants = Vec::with_capacity(SIZE * nodes().filter(is_constant).count());
        nodes().filter(is_constant).for_each(|(_, range)| constants.extend(in_memory(*range)));
        let argument = |(node, _): (&Node, _)| match node {
            Node::Variable(argument) => Some(argument.index()),
            _ => None,
        };
        let arguments: Vec<usize> = nodes().filter_map(argument).collect();
        let steps = Vec::with_capacity(program.operations());
        let mut kernel =
            Self { steps, constants, arguments, outputs: Vec::new(), _pieces: Arc::clone(pieces) };
        // The next place of a constant, an argument and a result.
        let mut free = [0, kernel.constants.len(), kernel.first_result()];
        let mut next = |kind: usize| {
            let place = Place(free[kind] as u32);
            free[kind] += SIZE;
            place
        };
        let mut places: Vec<Place> = Vec::with_capacity(program.nodes().len());
        for node in program.nodes() {
            places.push(match node {
                Node::Constant(_) => next(0),
                Node::Variable(_) => next(1),
                Node::Apply(operation, operands) => {
                    let apply = functions.next().expect("a function for each operation");
                    let operands = operands.map(|operand| places[operand.index()]);
                    kernel.steps.push(Step { apply, operation: *operation, operands });
                    next(2)
                }
            });
        }
        let output = |id: &NodeId| (places[id.index()], Kind::of(ranges[id.index()]));
        kernel.outputs = program.outputs().iter().map(output).collect();
        Ok(kernel)
    }

    /// Where the results begin.
    fn first_result(&self) -> usize {
        self.constants.len() + SIZE * self.arguments.len()
    }

    /// How many doubles a run takes.
    fn length(&self) -> usize {
        self.first_result() + SIZE * self.steps.len()
    }

    /// Puts two boxes in the places of the arguments; says whether they are inside the domain.
    fn put_boxes(&self, values: &mut [f64], boxes: Boxes<'_>, lanes: [usize; PAIR]) -> bool {
        let (places, _) = values[self.constants.len()..].as_chunks_mut::<SIZE>();
        let mut are_inside = true;
        for (axis, parts) in self.arguments.iter().zip(&mut *places) {
            let (lo, hi) = (boxes.lo[*axis], boxes.hi[*axis]);
            for (lane, number) in lanes.into_iter().enumerate() {
                let (lo, hi) = (lo[number], hi[number]);
                are_inside &= Domain::holds(Domain::NEAR, lo, hi);
                // The same enclosure as below, without saying that it is common: pieces that take it know.
                (parts[LO + lane], parts[MINUS_HI + lane]) = (lo + 0.0, 0.0 - hi);
            }
        }
        if !are_inside {
            for (axis, parts) in self.arguments.iter().zip(places) {
                for (lane, number) in lanes.into_iter().enumerate() {
                    put(parts, lane, Decorated::argument(boxes.lo[*axis][number], boxes.hi[*axis][number]));
                }
            }
        }
        are_inside
    }

    /// Computes all values over two boxes inside the domain, where constants and arguments stand in their places.
    fn run(&self, values: &mut [f64]) {
        assert_eq!(values.len(), self.length(), "room for every value");
        let start = values.as_mut_ptr();
        let mut result = self.first_result();
        for Step { apply, operands: [a, b, c], .. } in &self.steps {
            // SAFETY: all places are inside the values, and the pieces live as long as the kernel. A result stands behind the operands, so that a
            // piece reads nothing that it writes.
            unsafe {
                let [a, b, c] = [a, b, c].map(|place| start.cast_const().add(place.start()));
                apply(start.add(result), a, b, c);
            }
            result += SIZE;
        }
    }

    /// The same over any boxes, empty, unbounded and huge ones included, for which the pieces were not chosen.
    fn run_anywhere(&self, values: &mut [f64]) {
        let results = (self.first_result()..).step_by(SIZE);
        for (Step { operation, operands, .. }, result) in self.steps.iter().zip(results) {
            for lane in 0..PAIR {
                let operands = operands.map(|place| decorated(&values[place.start()..], lane));
                put(&mut values[result..], lane, operation.extension().of(operands));
            }
        }
    }
}

/// The enclosure over the box in a lane.
fn decorated(parts: &[f64], lane: usize) -> Decorated {
    let interval = Interval { lo: parts[LO + lane], hi: -parts[MINUS_HI + lane] };
    Decorated { interval, decoration: enclosures::decoration_of(parts[KNOWN + lane].to_bits()) }
}

/// Puts the enclosure over the box in a lane.
fn put(parts: &mut [f64], lane: usize, Decorated { interval, decoration }: Decorated) {
    parts[LO + lane] = interval.lo;
    parts[MINUS_HI + lane] = -interval.hi;
    parts[KNOWN + lane] = f64::from_bits(enclosures::known(decoration));
}

/// The same enclosure over both boxes.
fn in_memory(enclosure: Decorated) -> [f64; SIZE] {
    let mut parts = [0.0; SIZE];
    (0..PAIR).for_each(|lane| put(&mut parts, lane, enclosure));
    parts
}

impl BoxKernel for Assembled {
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>) {
        let Enclosures { lo, hi, decoration } = enclosures;
        let count = boxes.lo[0].len();
        assert_eq!(
            [lo.len(), hi.len(), decoration.len()],
            [self.outputs.len() * count; 3],
            "room for every output over every box"
        );
        let values = scratch.values(self.length());
        values[..self.constants.len()].copy_from_slice(&self.constants);
        for first in (0..count).step_by(PAIR) {
            // The last box of an odd number stands in both lanes.
            let lanes = [first, (first + 1).min(count - 1)];
            let are_inside = self.put_boxes(values, boxes, lanes);
            if are_inside {
                self.run(values);
            } else {
                self.run_anywhere(values);
            }
            for (output, (place, kind)) in self.outputs.iter().enumerate() {
                let parts = &values[place.start()..][..SIZE];
                let is_common = are_inside && kind.is_common;
                for (lane, number) in lanes.into_iter().enumerate() {
                    let place = output * count + number;
                    (lo[place], hi[place]) = (parts[LO + lane], -parts[MINUS_HI + lane]);
                    decoration[place] =
                        if is_common { Decoration::Common } else { decorated(parts, lane).decoration };
                }
            }
        }
    }
}
