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

/// The most nodes of a program: for more, places would not fit into half of 32 bits.
const LARGEST: usize = Place::CONSTANT as usize / SIZE;

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
        match Assembled::new(&self.pieces, &program.pruned()) {
            Ok(kernel) => Ok(Arc::new(kernel)),
            Err(_) => Interpreter.boxes(program),
        }
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        Arc::new(self.clone())
    }
}

/// Where the enclosures of a value stand: among those that a run computes, or among the constants.
#[derive(Clone, Copy, Debug)]
struct Place(u32);

impl Place {
    /// Marks constants.
    const CONSTANT: u32 = 1 << 31;

    /// So many doubles from the beginning.
    fn start(self) -> usize {
        (self.0 & !Self::CONSTANT) as usize
    }

    fn is_constant(self) -> bool {
        self.0 & Self::CONSTANT != 0
    }
}

/// One operation.
struct Step {
    apply: Apply,
    operation: Operation,
    /// Behind all that it reads.
    result: Place,
    operands: [Place; 3],
}

/// A kernel over batches of boxes.
pub(crate) struct Assembled {
    steps: Vec<Step>,
    /// The enclosures of all constants.
    constants: Vec<f64>,
    /// The axis of each argument, and where its enclosures stand.
    arguments: Vec<(usize, Place)>,
    outputs: Vec<(Place, Kind)>,
    /// How many doubles a run computes.
    length: usize,
    /// Keeps the functions of all steps.
    _pieces: Arc<Pieces>,
}

impl Assembled {
    /// Assembles `program`, every node of which some output needs.
    ///
    /// # Errors
    /// When a piece cannot be compiled, or the program has more nodes than anybody's memory holds.
    pub(crate) fn new(pieces: &Arc<Pieces>, program: &Program) -> Result<Self, CompileError> {
        let (given, allowed) = (program.nodes().len(), LARGEST);
        if given > allowed {
            return Err(CompileError::TooLarge { engine: NAME, given, allowed });
        }
        let Domain { ranges, .. } = Domain::near(program);
        let wanted = program.iter().filter_map(|(id, node)| match node {
            Node::Apply(operation, operands) => {
                Some(Piece::new(*operation, operands.map(|id| ranges[id.index()]), ranges[id.index()]))
            }
            _ => None,
        });
        let mut functions = pieces.functions(wanted)?.into_iter();
        let mut steps = Vec::with_capacity(program.operations());
        let (mut constants, mut arguments, mut computed) = (Vec::new(), Vec::new(), 0u32);
        let mut places: Vec<Place> = Vec::with_capacity(program.nodes().len());
        for (node, range) in program.nodes().iter().zip(&ranges) {
            let place = match node {
                Node::Constant(_) => Place(constants.len() as u32 | Place::CONSTANT),
                _ => Place(computed),
            };
            match node {
                Node::Constant(_) => constants.extend(in_memory(*range)),
                Node::Variable(argument) => arguments.push((argument.index(), place)),
                Node::Apply(operation, operands) => {
                    let apply = functions.next().expect("a function for each operation");
                    let operands = operands.map(|operand| places[operand.index()]);
                    steps.push(Step { apply, operation: *operation, result: place, operands });
                }
            }
            if !place.is_constant() {
                computed += SIZE as u32;
            }
            places.push(place);
        }
        let output = |id: &NodeId| (places[id.index()], Kind::of(ranges[id.index()]));
        let outputs = program.outputs().iter().map(output).collect();
        let length = computed as usize;
        Ok(Self { steps, constants, arguments, outputs, length, _pieces: Arc::clone(pieces) })
    }

    /// Computes all values over two boxes inside the domain, the arguments of which stand where they belong.
    fn run(&self, computed: &mut [f64]) {
        assert_eq!(computed.len(), self.length, "room for every value");
        let start = computed.as_mut_ptr();
        let constants = self.constants.as_ptr();
        for Step { apply, result, operands, .. } in &self.steps {
            // SAFETY: places are inside what they are counted in, of which no count overflowed, and the pieces live as long as the kernel. A result stands
            // behind the operands, so that a piece reads nothing that it writes.
            unsafe {
                let [a, b, c] = operands.map(|place| {
                    let first = if place.is_constant() { constants } else { start.cast_const() };
                    first.add(place.start())
                });
                apply(start.add(result.start()), a, b, c);
            }
        }
    }

    /// The same over any boxes, empty, unbounded and huge ones included, for which the pieces were not chosen.
    fn run_anywhere(&self, computed: &mut [f64]) {
        for Step { operation, result, operands, .. } in &self.steps {
            for lane in 0..PAIR {
                let operands = operands.map(|place| decorated(self.parts(computed, place), lane));
                let enclosure = operation.extension().of(operands);
                put(&mut computed[result.start()..][..SIZE], lane, enclosure);
            }
        }
    }

    /// The enclosures of a value.
    fn parts<'a>(&'a self, computed: &'a [f64], place: Place) -> &'a [f64] {
        let all = if place.is_constant() { &self.constants } else { computed };
        &all[place.start()..][..SIZE]
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
        let is_inside = Domain::holds_all(Domain::NEAR, boxes);
        let computed = scratch.values(self.length);
        for first in (0..count).step_by(PAIR) {
            // The last box of an odd number stands in both lanes.
            let lanes = [first, (first + 1).min(count - 1)];
            for &(axis, place) in &self.arguments {
                for (lane, number) in lanes.into_iter().enumerate() {
                    let argument = Decorated::argument(boxes.lo[axis][number], boxes.hi[axis][number]);
                    put(&mut computed[place.start()..][..SIZE], lane, argument);
                }
            }
            if is_inside {
                self.run(computed);
            } else {
                self.run_anywhere(computed);
            }
            for (output, (place, kind)) in self.outputs.iter().enumerate() {
                let parts = self.parts(computed, *place);
                let is_common = is_inside && kind.is_common;
                for (lane, number) in lanes.into_iter().enumerate() {
                    let enclosure = decorated(parts, lane);
                    let place = output * count + number;
                    (lo[place], hi[place]) = (enclosure.interval.lo, enclosure.interval.hi);
                    decoration[place] = if is_common { Decoration::Common } else { enclosure.decoration };
                }
            }
        }
    }
}
