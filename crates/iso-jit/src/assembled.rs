//! Kernels over boxes that are assembled from [pieces](crate::pieces), operation by operation, instead of being compiled: for programs that run too
//! few times to be worth compiling, or are too large for it.

use std::sync::{Arc, OnceLock};

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::{
    BatchKernel, BoxKernel, CompileError, Decorated, Decoration, Engine, Interpreter, Interval, Node, NodeId,
    PointKernel, Program, Scratch,
};

use crate::domain::Domain;
use crate::enclosures;
use crate::engine::NAME;
use crate::pieces::{Apply, KNOWN, Kind, LO, MINUS_HI, Piece, Pieces, SIZE};

/// Boxes in one run.
const PAIR: usize = 2;

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
        match Assembled::new(&self.pieces, program.pruned()) {
            Ok(kernel) => Ok(Arc::new(kernel)),
            Err(_) => Interpreter.boxes(program),
        }
    }

    fn for_few_runs(&self) -> Arc<dyn Engine> {
        Arc::new(self.clone())
    }
}

/// Where the enclosures of a value stand, in doubles from the beginning.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// Among those that a run computes.
    Computed(u32),
    /// Among the constants.
    Constant(u32),
}

/// One operation.
struct Step {
    apply: Apply,
    /// Behind all that it reads.
    result: u32,
    operands: [Place; 3],
}

/// A kernel over batches of boxes.
pub(crate) struct Assembled {
    program: Program,
    steps: Vec<Step>,
    /// The enclosures of all constants.
    constants: Vec<f64>,
    /// The axis of each argument, and where its enclosures stand.
    arguments: Vec<(usize, usize)>,
    outputs: Vec<(Place, Kind)>,
    /// How many doubles a run computes.
    length: usize,
    /// For boxes that the pieces were not chosen for: empty, unbounded and huge ones.
    interpreted: OnceLock<Result<Arc<dyn BoxKernel>, CompileError>>,
    /// Keeps the functions of all steps.
    _pieces: Arc<Pieces>,
}

impl Assembled {
    /// Assembles `program`, every node of which some output needs.
    ///
    /// # Errors
    /// When a piece cannot be compiled.
    pub(crate) fn new(pieces: &Arc<Pieces>, program: Program) -> Result<Self, CompileError> {
        let Domain { ranges, .. } = Domain::near(&program);
        let wanted = program.iter().filter_map(|(id, node)| match node {
            Node::Apply(operation, operands) => {
                Some(Piece::new(*operation, operands.map(|id| ranges[id.index()]), ranges[id.index()]))
            }
            _ => None,
        });
        let mut functions = pieces.functions(wanted)?.into_iter();
        let (mut steps, mut constants, mut arguments, mut length) =
            (Vec::new(), Vec::new(), Vec::new(), 0u32);
        let mut places: Vec<Place> = Vec::with_capacity(program.nodes().len());
        for (node, range) in program.nodes().iter().zip(&ranges) {
            if let Node::Constant(_) = node {
                places.push(Place::Constant(constants.len() as u32));
                constants.extend(in_memory(*range));
                continue;
            }
            match node {
                Node::Variable(axis) => arguments.push((*axis as usize, length as usize)),
                Node::Apply(_, operands) => {
                    let apply = functions.next().expect("a function for each operation");
                    let operands = operands.map(|operand| places[operand.index()]);
                    steps.push(Step { apply, result: length, operands });
                }
                Node::Constant(_) => unreachable!("constants are put elsewhere"),
            }
            places.push(Place::Computed(length));
            length += SIZE as u32;
        }
        let output = |id: &NodeId| (places[id.index()], Kind::of(ranges[id.index()]));
        let outputs = program.outputs().iter().map(output).collect();
        let (interpreted, _pieces) = (OnceLock::new(), Arc::clone(pieces));
        let length = length as usize;
        Ok(Self { program, steps, constants, arguments, outputs, length, interpreted, _pieces })
    }

    /// Computes all values over two boxes, the arguments of which stand where they belong.
    fn run(&self, computed: &mut [f64]) {
        assert_eq!(computed.len(), self.length, "room for every value");
        let start = computed.as_mut_ptr();
        let constants = self.constants.as_ptr();
        for Step { apply, result, operands } in &self.steps {
            // SAFETY: places are inside what they are counted in, and the pieces live as long as the kernel. A result stands
            // behind the operands, so that a piece reads nothing that it writes.
            unsafe {
                let [a, b, c] = operands.map(|place| match place {
                    Place::Computed(place) => start.add(place as usize).cast_const(),
                    Place::Constant(place) => constants.add(place as usize),
                });
                apply(start.add(*result as usize), a, b, c);
            }
        }
    }

    /// The enclosure of a value over the box in a lane.
    fn enclosure(&self, computed: &[f64], (place, kind): (Place, Kind), lane: usize) -> Decorated {
        let parts = match place {
            Place::Computed(place) => &computed[place as usize..][..SIZE],
            Place::Constant(place) => &self.constants[place as usize..][..SIZE],
        };
        let decoration = match kind.is_common {
            true => Decoration::Common,
            false => enclosures::decoration_of(parts[KNOWN + lane].to_bits()),
        };
        let interval = Interval { lo: parts[LO + lane], hi: -parts[MINUS_HI + lane] };
        Decorated { interval, decoration }
    }
}

/// The same enclosure over both boxes, as it stands in memory.
fn in_memory(Decorated { interval, decoration }: Decorated) -> [f64; SIZE] {
    let mut parts = [0.0; SIZE];
    parts[LO..][..PAIR].fill(interval.lo);
    parts[MINUS_HI..][..PAIR].fill(-interval.hi);
    parts[KNOWN..][..PAIR].fill(f64::from_bits(enclosures::known(decoration)));
    parts
}

impl BoxKernel for Assembled {
    fn evaluate(&self, scratch: &mut Scratch, boxes: Boxes<'_>, enclosures: Enclosures<'_>) {
        if !Domain::holds_all(Domain::NEAR, boxes) {
            let interpreted = self.interpreted.get_or_init(|| Interpreter.boxes(&self.program));
            let interpreted = interpreted.as_ref().expect("the interpreter takes any program");
            return interpreted.evaluate(scratch, boxes, enclosures);
        }
        let Enclosures { lo, hi, decoration } = enclosures;
        let count = boxes.lo[0].len();
        assert_eq!(
            [lo.len(), hi.len(), decoration.len()],
            [self.outputs.len() * count; 3],
            "room for every output over every box"
        );
        let computed = scratch.values(self.length);
        for first in (0..count).step_by(PAIR) {
            // The last box of an odd number stands in both lanes.
            let lanes = [first, (first + 1).min(count - 1)];
            for &(axis, place) in &self.arguments {
                for (lane, number) in lanes.into_iter().enumerate() {
                    // Zeros are made to point inwards.
                    computed[place + LO + lane] = boxes.lo[axis][number] + 0.0;
                    computed[place + MINUS_HI + lane] = 0.0 - boxes.hi[axis][number];
                }
            }
            self.run(computed);
            for (place, output) in self.outputs.iter().enumerate() {
                for (lane, number) in lanes.into_iter().enumerate() {
                    let enclosure = self.enclosure(computed, *output, lane);
                    let place = place * count + number;
                    (lo[place], hi[place]) = (enclosure.interval.lo, enclosure.interval.hi);
                    decoration[place] = enclosure.decoration;
                }
            }
        }
    }
}
