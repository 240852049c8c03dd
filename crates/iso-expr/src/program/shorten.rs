//! Shortening: what a program comes to on a box where some of its branches are decided.

use super::simplify::folded;
use super::{Node, NodeId, Program};
use crate::{Constant, Decorated, Decoration, Interval, Operation};

/// A program is rebuilt when it keeps no more than this part of its nodes, or loses its last branch.
const WORTHWHILE: f64 = 0.6;

/// What a program that is shortened still computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kept {
    /// The same doubles, signs of zeros included.
    Doubles,
    /// The same real functions.
    RealFunctions,
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

impl Program {
    /// A program that computes, at every point of the box `domain`, the same doubles as this one, and means the same real
    /// function there, with what the box decides left out: the branches of minima, maxima and choices that are never taken,
    /// absolute values of what keeps its sign, steps without a step inside. `None` when that would neither be
    /// much shorter nor lose the last branch.
    ///
    /// What is left out is defined and bounded all over the box, so that it could not have made anything undefined. This is
    /// the 'shortened tape' of Keeter (Massively Parallel Rendering of Complex Closed-Form Implicit Surfaces, 2020), with
    /// enclosures rounded outwards, so that it holds for doubles and for real numbers alike.
    pub fn shortened(&self, domain: [Interval; 3]) -> Option<Self> {
        self.shortened_keeping(domain, Kept::Doubles)
    }

    /// The same for a program that is evaluated over boxes alone, where zeros have no sign: what is zero all over the box is left
    /// out of sums, and what it is multiplied with is left out with it.
    pub fn shortened_over_boxes(&self, domain: [Interval; 3]) -> Option<Self> {
        self.shortened_keeping(domain, Kept::RealFunctions)
    }

    fn shortened_keeping(&self, domain: [Interval; 3], kept: Kept) -> Option<Self> {
        let decisions = self.decisions(domain, kept);
        let needed = self.needed_after(&decisions);
        let kept = needed.iter().filter(|needed| **needed).count();
        let is_open = |(node, (decision, needed)): (&Node, (&Option<Decision>, &bool))| {
            *needed && decision.is_none() && node.may_be_decided()
        };
        let has_branches = || self.nodes.iter().zip(decisions.iter().zip(&needed)).any(is_open);
        let loses_branches = || self.has_branches() && !has_branches();
        let is_worthwhile = kept as f64 <= WORTHWHILE * self.nodes.len() as f64 || loses_branches();
        is_worthwhile.then(|| self.rebuilt(&decisions, &needed, kept))
    }

    /// Whether it holds an operation that a box may decide.
    pub fn has_branches(&self) -> bool {
        self.nodes.iter().any(Node::may_be_decided)
    }

    /// What the box decides, node by node.
    fn decisions(&self, domain: [Interval; 3], kept: Kept) -> Vec<Option<Decision>> {
        let mut enclosures: Vec<Decorated> = Vec::with_capacity(self.nodes.len());
        let decide = |node: &Node| {
            let (enclosure, decision) = match *node {
                Node::Variable(argument) => {
                    let Interval { lo, hi } = domain[argument.index()];
                    (Decorated::argument(lo, hi), None)
                }
                Node::Constant(constant) => (Decorated::constant(constant.enclosure()), None),
                Node::Apply(operation, operands) => {
                    let operands = operands.map(|operand| enclosures[operand.index()]);
                    let enclosure = operation.extension().of(operands);
                    let decision = decision(operation, operands, enclosure);
                    (enclosure, decision.or_else(|| kept.decision(operation, operands, enclosure)))
                }
            };
            enclosures.push(enclosure);
            decision
        };
        self.nodes.iter().map(decide).collect()
    }

    /// For each node whether an output is computed from it when the rest is left out.
    fn needed_after(&self, decisions: &[Option<Decision>]) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        // A node that comes to one of its operands only passes the need on.
        let mut asked = vec![false; self.nodes.len()];
        for output in &self.outputs {
            asked[output.index()] = true;
        }
        for (id, node) in self.iter().rev() {
            if !asked[id.index()] {
                continue;
            }
            let operands = node.operands();
            needed[id.index()] = !matches!(decisions[id.index()], Some(Decision::Operand(_)));
            let asks = match decisions[id.index()] {
                Some(Decision::Operand(number)) => &operands[number..=number],
                Some(Decision::Negated) => &operands[..1],
                Some(Decision::Constant(_)) => &[],
                None => operands,
            };
            for operand in asks {
                asked[operand.index()] = true;
            }
        }
        needed
    }

    /// The program with the decided operations replaced, as far as it is needed, and constants folded. Nodes are not compared
    /// with each other and no rules are applied, for this is done for places by the thousand, and takes longer than they run.
    fn rebuilt(&self, decisions: &[Option<Decision>], needed: &[bool], count: usize) -> Self {
        let mut program = Self { nodes: Vec::with_capacity(count), ..Self::new() };
        let mut places = vec![NodeId(0); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            let decision = decisions[index];
            if let (Some(Decision::Operand(number)), Node::Apply(_, operands)) = (decision, node) {
                places[index] = places[operands[number].index()];
            } else if needed[index] {
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
                places[index] = NodeId(program.nodes.len() as u32);
                program.nodes.push(folded.map_or(node, Node::Constant));
            }
        }
        program.outputs = self.outputs.iter().map(|output| places[output.index()]).collect();
        program.pruned()
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

/// What `operation` comes to where its operands and its result are enclosed like this.
///
/// Doubles lie in the enclosures as real numbers do, as the operations before are correctly rounded. What is left out must be
/// [`Common`](Decoration::Common): defined all over the box, in doubles too, for nothing on its way overflows.
fn decision(operation: Operation, operands: [Decorated; 3], result: Decorated) -> Option<Decision> {
    use Operation as O;
    let [a, b, _] = operands;
    let is_common = |enclosure: Decorated| enclosure.decoration == Decoration::Common;
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

impl Kept {
    /// What `operation` comes to besides.
    fn decision(
        self,
        operation: Operation,
        [a, b, _]: [Decorated; 3],
        result: Decorated,
    ) -> Option<Decision> {
        let is_zero = |enclosure: Decorated| {
            enclosure.decoration == Decoration::Common && enclosure.interval == Interval::point(0.0)
        };
        match operation {
            _ if self == Self::Doubles => None,
            Operation::Add if is_zero(a) => Some(Decision::Operand(1)),
            Operation::Add | Operation::Subtract if is_zero(b) => Some(Decision::Operand(0)),
            _ if is_zero(result) => Some(Decision::Constant(0.0)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
