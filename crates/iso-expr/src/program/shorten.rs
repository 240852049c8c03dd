//! Shortening: what a program comes to on a box where some of its branches are decided.

use super::needed::Needed;
use super::simplify::folded;
use super::{Node, NodeId, Program};
use crate::interval::extension::{add, maximum, minimum, multiply, subtract};
use crate::{Constant, Decorated, Decoration, Interval, Operation};

/// A program is rebuilt when it keeps no more than this part of its nodes, or loses its last branch.
const WORTHWHILE: f64 = 0.6;

/// What matters of a node's value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Demand {
    /// It is not asked for.
    Nothing,
    /// Whether it is less than this number, equal or greater.
    Side(f64),
    /// The value itself.
    Value,
}

impl Demand {
    /// What matters when both do.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, demand) | (demand, Self::Nothing) => demand,
            _ if self == other => self,
            _ => Self::Value,
        }
    }

    /// What matters of the negative.
    fn negated(self) -> Self {
        match self {
            Self::Side(of) => Self::Side(-of),
            demand => demand,
        }
    }
}

/// What an operation comes to on a box.
#[derive(Clone, Copy, Debug)]
enum Decision {
    /// The operand of this number.
    Operand(usize),
    /// The first operand with the other sign.
    Negated,
    /// A number.
    Constant(f64),
}

/// What a box makes of a program, node by node.
struct Findings {
    enclosures: Vec<Decorated>,
    demands: Vec<Demand>,
    decisions: Vec<Option<Decision>>,
}

impl Program {
    /// A program whose output is negative, zero or positive, in doubles and as a real function, wherever that of this one is on the
    /// box `domain`, and undefined wherever it is, with what the box decides left out: the branches of minima, maxima and choices that
    /// are never taken, or that do not matter to the sign; absolute values of what keeps its sign, steps without a step inside.
    /// `None` when that would neither be much shorter nor lose the last branch.
    ///
    /// Where the two functions are zero they have the same derivatives, for what is left out of a minimum is either greater than what is left or
    /// positive.
    ///
    /// What is left out is defined and bounded all over the box, so that it could not have made anything undefined. This is
    /// the 'shortened tape' of Keeter (Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces, 2020), with
    /// enclosures rounded outwards, so that it holds for doubles and for real numbers alike, and goes beyond it: there all values are kept.
    ///
    /// # Panics
    /// When the program has another number of outputs than one.
    pub fn shortened(&self, domain: [Interval; 3]) -> Option<Self> {
        assert_eq!(self.outputs.len(), 1, "the sign of one output is kept");
        let (findings, asked) = self.findings(domain);
        let kept = asked.ids().filter(|id| !findings.is_passed(*id)).count();
        let is_open =
            |id: NodeId| findings.decisions[id.index()].is_none() && self.nodes[id.index()].may_be_decided();
        let loses_branches = || self.has_branches() && !asked.ids().any(is_open);
        let is_worthwhile = kept as f64 <= WORTHWHILE * self.nodes.len() as f64 || loses_branches();
        is_worthwhile.then(|| self.rebuilt((&findings, &asked), kept))
    }

    /// Whether it holds an operation that a box may decide.
    pub fn has_branches(&self) -> bool {
        self.nodes.iter().any(Node::may_be_decided)
    }

    /// Whether its only output is certainly a number at all points with finite coordinates.
    ///
    /// # Panics
    /// When the program has another number of outputs than one.
    pub fn is_defined_everywhere(&self) -> bool {
        assert_eq!(self.outputs.len(), 1, "it is said of one output");
        self.enclosures([Interval::ENTIRE; 3])[self.outputs[0].index()].decoration >= Decoration::Defined
    }

    /// What a box decides: enclosures from the arguments on, and decisions from the output back to what is asked for.
    fn findings(&self, domain: [Interval; 3]) -> (Findings, Needed) {
        let mut findings = Findings {
            enclosures: self.enclosures(domain),
            demands: vec![Demand::Nothing; self.nodes.len()],
            decisions: vec![None; self.nodes.len()],
        };
        let mut asked = Needed::none(self);
        findings.demands[self.outputs[0].index()] = Demand::Side(0.0);
        asked.insert(self.outputs[0]);
        asked.spread(|asked, id| {
            if let Node::Apply(operation, operands) = self.node(id) {
                findings.decide((self, asked), id, operation, &operands);
            }
        });
        (findings, asked)
    }

    /// The enclosure of each node over the box `domain`, in the order of the nodes.
    ///
    /// # Panics
    /// When the program has other arguments than x, y and z.
    pub fn enclosures(&self, domain: [Interval; 3]) -> Vec<Decorated> {
        let mut enclosures: Vec<Decorated> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            enclosures.push(match *node {
                Node::Variable(argument) => {
                    let Interval { lo, hi } = domain[argument.index()];
                    Decorated::argument(lo, hi)
                }
                Node::Constant(constant) => Decorated::constant(constant.enclosure()),
                Node::Apply(operation, operands) => {
                    let of = |place: usize| enclosures[operands[place].index()];
                    // The commonest are not called by the table: hundreds of thousands of nodes are enclosed to shorten a large formula in all places.
                    match operation {
                        Operation::Add => add(of(0), of(1)),
                        Operation::Subtract => subtract(of(0), of(1)),
                        Operation::Multiply => multiply(of(0), of(1)),
                        Operation::Minimum => minimum(of(0), of(1)),
                        Operation::Maximum => maximum(of(0), of(1)),
                        _ => operation.extension().of([0, 1, 2].map(of)),
                    }
                }
            });
        }
        enclosures
    }

    /// The program with the decided operations replaced, as far as it is needed, and constants folded. Nodes are not compared
    /// with each other and no rules are applied, for this is done for places by the thousand, and takes longer than they run.
    fn rebuilt(&self, (findings, asked): (&Findings, &Needed), count: usize) -> Self {
        let mut program = Self { nodes: Vec::with_capacity(count), ..Self::new() };
        let mut places = vec![NodeId(0); self.nodes.len()];
        let mut is_folded = false;
        for id in asked.ids() {
            let (node, decision) = (self.node(id), findings.decisions[id.index()]);
            if let (Some(Decision::Operand(number)), Node::Apply(_, operands)) = (decision, node) {
                places[id.index()] = places[operands[number].index()];
                continue;
            }
            let node = node.with_operands(|operand| places[operand.index()]);
            let node = match (decision, node) {
                (Some(Decision::Constant(value)), _) => Node::Constant(Constant::exact(value)),
                (Some(Decision::Negated), Node::Apply(_, operands)) => {
                    Node::Apply(Operation::Negate, [operands[0]; 3])
                }
                _ => node,
            };
            let folded = match node {
                Node::Apply(operation, operands) => {
                    folded(&program, operation, &operands[..operation.arity()])
                }
                _ => None,
            };
            is_folded |= folded.is_some();
            places[id.index()] = NodeId(program.nodes.len() as u32);
            program.nodes.push(folded.map_or(node, Node::Constant));
        }
        program.outputs = self.outputs.iter().map(|output| places[output.index()]).collect();
        if is_folded { program.pruned() } else { program }
    }
}

impl Node {
    /// Whether [`decision`] may be something.
    fn may_be_decided(&self) -> bool {
        use Operation as O;
        let Self::Apply(operation, _) = self else { return false };
        let is_choice = matches!(operation, O::Minimum | O::Maximum | O::Absolute | O::Select);
        let is_step = matches!(operation, O::Sign | O::Floor | O::Ceil | O::Round | O::Truncate);
        is_choice || is_step || matches!(operation, O::Less | O::LessOrEqual | O::Equal)
    }
}

impl Findings {
    /// Whether a node is one of its operands.
    fn is_passed(&self, id: NodeId) -> bool {
        matches!(self.decisions[id.index()], Some(Decision::Operand(_)))
    }

    /// Decides a node, and notes what that asks of its operands.
    fn decide(
        &mut self,
        (program, needed): (&Program, &mut Needed),
        id: NodeId,
        operation: Operation,
        operands: &[NodeId; 3],
    ) {
        use Operation as O;
        let demand = self.demands[id.index()];
        if demand == Demand::Value && !program.nodes[id.index()].may_be_decided() {
            // Most nodes are such.
            for operand in &operands[..operation.arity()] {
                self.demands[operand.index()] = Demand::Value;
                needed.insert(*operand);
            }
            return;
        }
        let enclosures = operands.map(|operand| self.enclosures[operand.index()]);
        let decision =
            decision(operation, enclosures, self.enclosures[id.index()]).or_else(|| match demand {
                Demand::Side(of) => decision_by_side(operation, enclosures, of),
                _ => None,
            });
        self.decisions[id.index()] = decision;
        // Sums and differences of doubles have the signs that those of real numbers have.
        let exact = |number: usize| match program.node(operands[number]) {
            Node::Constant(constant) if constant.is_exact() => Some(constant.value()),
            _ => None,
        };
        let asked: &[(usize, Demand)] = match (decision, operation, demand) {
            (Some(Decision::Operand(number)), ..) => &[(number, demand)],
            (Some(Decision::Negated), ..) | (None, O::Negate, _) => &[(0, demand.negated())],
            (Some(Decision::Constant(_)), ..) => &[],
            (None, O::Minimum | O::Maximum, _) => &[(0, demand), (1, demand)],
            (None, O::Subtract, Demand::Side(0.0)) if let Some(of) = exact(1) => {
                &[(0, Demand::Side(of)), (1, Demand::Value)]
            }
            (None, O::Subtract, Demand::Side(0.0)) if let Some(of) = exact(0) => {
                &[(0, Demand::Value), (1, Demand::Side(of))]
            }
            (None, O::Add, Demand::Side(0.0)) if let Some(of) = exact(0) => {
                &[(0, Demand::Value), (1, Demand::Side(-of))]
            }
            (None, O::Add, Demand::Side(0.0)) if let Some(of) = exact(1) => {
                &[(0, Demand::Side(-of)), (1, Demand::Value)]
            }
            // The other summand is as much on a side as the sum, wherever that is a number.
            (None, O::Add, Demand::Side(_)) if is_zero(enclosures[1]) => &[(0, demand), (1, Demand::Value)],
            (None, O::Add, Demand::Side(_)) if is_zero(enclosures[0]) => &[(0, Demand::Value), (1, demand)],
            (None, ..) => &[(0, Demand::Value), (1, Demand::Value), (2, Demand::Value)][..operation.arity()],
        };
        for (number, demand) in asked {
            let asked = &mut self.demands[operands[*number].index()];
            *asked = asked.and(*demand);
            needed.insert(operands[*number]);
        }
    }
}

/// What `operation` comes to where its operands and its result are enclosed like this.
///
/// Doubles lie in the enclosures as real numbers do, as the operations before are correctly rounded. What is left out must be
/// [`Common`](Decoration::Common): defined all over the box, in doubles too, for nothing on its way overflows.
fn decision(operation: Operation, operands: [Decorated; 3], result: Decorated) -> Option<Decision> {
    use Operation as O;
    let [a, b, _] = operands;
    let lesser = |a: Decorated, b: Decorated| a.interval.hi < b.interval.lo;
    match operation {
        O::Minimum if lesser(a, b) && is_common(b) => Some(Decision::Operand(0)),
        O::Minimum if lesser(b, a) && is_common(a) => Some(Decision::Operand(1)),
        O::Maximum if lesser(a, b) && is_common(a) => Some(Decision::Operand(1)),
        O::Maximum if lesser(b, a) && is_common(b) => Some(Decision::Operand(0)),
        O::Absolute if a.interval.lo > 0.0 => Some(Decision::Operand(0)),
        O::Absolute if a.interval.hi < 0.0 => Some(Decision::Negated),
        O::Select if is_common(a) && !a.interval.contains_zero() => Some(Decision::Operand(1)),
        O::Select if is_common(a) && a.interval.is_point() => Some(Decision::Operand(2)),
        O::Less | O::LessOrEqual | O::Equal if is_common(result) && result.interval.is_point() => {
            Some(Decision::Constant(result.interval.lo))
        }
        // Zeros of steps keep the sign of what they came from.
        O::Sign | O::Floor | O::Ceil | O::Round | O::Truncate
            if is_common(result)
                && result.interval.is_point()
                && (result.interval.lo != 0.0 || a.interval.lo > 0.0) =>
        {
            Some(Decision::Constant(result.interval.lo))
        }
        _ => None,
    }
}

/// What `operation` comes to where it only matters on which side of a number the result lies: that of a minimum is the other
/// operand's where one is greater all over the box, and that of the one that is less all over it.
fn decision_by_side(operation: Operation, [a, b, _]: [Decorated; 3], of: f64) -> Option<Decision> {
    let above = [a, b].map(|operand| operand.interval.lo > of);
    let below = [a, b].map(|operand| operand.interval.hi < of);
    let (is_left_out, decides) = match operation {
        Operation::Minimum => (above, below),
        Operation::Maximum => (below, above),
        _ => return None,
    };
    if is_common(b) && (is_left_out[1] || decides[0]) {
        Some(Decision::Operand(0))
    } else if is_common(a) && (is_left_out[0] || decides[1]) {
        Some(Decision::Operand(1))
    } else {
        None
    }
}

/// Whether it is zero wherever it is a number, which may be nowhere.
fn is_zero(enclosure: Decorated) -> bool {
    enclosure.interval == Interval::point(0.0) || enclosure.interval.is_empty()
}

fn is_common(enclosure: Decorated) -> bool {
    enclosure.decoration == Decoration::Common
}

#[cfg(test)]
mod tests;
