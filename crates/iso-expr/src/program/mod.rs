//! Programs: hash-consed, straight-line descriptions of what is to be evaluated.

mod composed;
mod composition;
mod cubes;
mod display;
mod exact;
mod forms;
mod gradient;
mod needed;
mod powers;
mod rebuild;
#[cfg(any(test, feature = "random"))]
pub(crate) mod reference;
mod rounding;
mod shorten;
mod simplify;
mod waves;

use std::hash::{Hash, Hasher};

use rustc_hash::FxHashMap;

pub use composition::{Composition, Extreme};

use crate::{Constant, Operation};

/// A coordinate axis, and the variable that runs along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// The variable `x`.
    X,
    /// The variable `y`.
    Y,
    /// The variable `z`.
    Z,
}

impl Axis {
    /// All axes, in the order of the arguments of F.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// The variable's name in formulas.
    pub const fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

/// An argument of a program, by number. Those of F are x, y and z, with the numbers 0, 1 and 2; [slopes](Program::with_slope) and
/// [forms](Program::with_forms) take more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Argument(u8);

impl Argument {
    /// The component along `axis` of the direction that [slopes](Program::with_slope) are taken along.
    const fn of_direction(axis: Axis) -> Self {
        Self(3 + axis as u8)
    }

    /// Its number.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl From<Axis> for Argument {
    fn from(axis: Axis) -> Self {
        Self(axis as u8)
    }
}

/// The place of a node in its [`Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(u32);

impl NodeId {
    /// The index into [`Program::nodes`].
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// One value of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// An argument.
    Variable(Argument),
    /// A constant.
    Constant(Constant),
    /// An operation on earlier nodes. Only the first [`Operation::arity`] operands count; the rest repeat the first one.
    Apply(Operation, [NodeId; 3]),
}

impl Node {
    pub(crate) const ONE: Self = Self::Constant(Constant::ONE);

    /// This node with each operand replaced.
    fn with_operands(self, mut replace: impl FnMut(NodeId) -> NodeId) -> Self {
        match self {
            Self::Apply(operation, operands) => Self::Apply(operation, operands.map(&mut replace)),
            leaf => leaf,
        }
    }

    /// The nodes that this one is computed from.
    pub fn operands(&self) -> &[NodeId] {
        match self {
            Self::Variable(_) | Self::Constant(_) => &[],
            Self::Apply(operation, operands) => &operands[..operation.arity()],
        }
    }
}

/// Nodes in an order in which each stands after its operands, and some of them named as outputs. No two nodes are equal but in derivatives that
/// were not [simplified](Self::simplified) yet.
///
/// The order of evaluation, and with it every rounding, is part of the program: engines compute just the operations that
/// stand here, so all of them agree bit for bit.
#[derive(Clone, Debug, Default)]
pub struct Program {
    nodes: Vec<Node>,
    /// Where each node is. Copies leave it empty until they are added to.
    places: FxHashMap<Node, NodeId>,
    outputs: Vec<NodeId>,
    /// Whether equal nodes may stand in it until it is simplified, as nothing is looked up while they are added.
    is_draft: bool,
}

/// Equal programs have the same nodes in the same order, and the same outputs.
impl PartialEq for Program {
    fn eq(&self, other: &Self) -> bool {
        self.nodes == other.nodes && self.outputs == other.outputs
    }
}

impl Eq for Program {}

/// As [`PartialEq`] has it.
impl Hash for Program {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.nodes.hash(state);
        self.outputs.hash(state);
    }
}

impl Program {
    /// A program without nodes or outputs.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same for derivatives of another one, which take about three times as many nodes until they are simplified.
    fn draft_from(other: &Self) -> Self {
        Self { nodes: Vec::with_capacity(3 * other.nodes.len()), is_draft: true, ..Self::new() }
    }

    /// All nodes, operands before the nodes that use them.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The node at `id`.
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// What the program computes, in order.
    pub fn outputs(&self) -> &[NodeId] {
        &self.outputs
    }

    /// Names what the program computes.
    pub fn set_outputs(&mut self, outputs: Vec<NodeId>) {
        assert!(outputs.iter().all(|id| id.index() < self.nodes.len()), "an output is not in this program");
        self.outputs = outputs;
    }

    /// The nodes with their ids, in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (NodeId, &Node)> + ExactSizeIterator {
        self.nodes.iter().enumerate().map(|(index, node)| (NodeId(index as u32), node))
    }

    /// Whether the argument along `axis` occurs. A simplified program holds nothing that its outputs do not need.
    pub fn takes(&self, axis: Axis) -> bool {
        self.nodes.contains(&Node::Variable(axis.into()))
    }

    /// How many arguments there are, up to the last one that occurs.
    pub fn arguments(&self) -> usize {
        let number = |node: &Node| if let Node::Variable(argument) = node { argument.index() + 1 } else { 0 };
        self.nodes.iter().map(number).max().unwrap_or(0)
    }

    /// How many operations one evaluation takes.
    pub fn operations(&self) -> usize {
        self.nodes.iter().filter(|node| matches!(node, Node::Apply(..))).count()
    }

    /// The argument of F along `axis`.
    pub fn variable(&mut self, axis: Axis) -> NodeId {
        self.intern(Node::Variable(axis.into()))
    }

    /// A program whose output is negative, zero or positive, as a real function, wherever that of this one is, and undefined wherever it is, but
    /// easier to follow to its zeros: sums of two cubes become sums of what is cubed, and polynomials compositions of lower ones. Where the two
    /// are zero their gradients have the same direction, if both have any.
    pub fn with_same_signs(&self) -> Self {
        self.with_what_is_cut(|program| program.without_cubes().composed())
    }

    /// A constant.
    pub fn constant(&mut self, constant: Constant) -> NodeId {
        self.intern(Node::Constant(constant))
    }

    /// The double `value`, exactly.
    pub fn literal(&mut self, value: f64) -> NodeId {
        self.constant(Constant::exact(value))
    }

    /// An operation on nodes of this program. Nothing is simplified; an equal node is reused.
    ///
    /// # Panics
    /// When the number of operands is not the operation's arity, or the exponent of an integer power is not a constant
    /// integer from 2 to [`Operation::LARGEST_POWER`].
    pub fn apply(&mut self, operation: Operation, operands: &[NodeId]) -> NodeId {
        assert_eq!(operands.len(), operation.arity(), "{operation:?} takes {} operands", operation.arity());
        if operation == Operation::IntegerPower {
            assert!(
                self.exponent(operands[1]).is_some(),
                "the exponent is not an integer that powers may have"
            );
        }
        let operand = |place: usize| *operands.get(place).unwrap_or(&operands[0]);
        self.intern(Node::Apply(operation, [operand(0), operand(1), operand(2)]))
    }

    /// The sum of what there is of two nodes.
    pub(crate) fn sum(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.apply(Operation::Add, &[a, b])),
            (one, other) => one.or(other),
        }
    }

    /// `base` multiplied by itself, `exponent` factors in all.
    pub fn integer_power(&mut self, base: NodeId, exponent: u32) -> NodeId {
        let exponent = self.literal(f64::from(exponent));
        self.apply(Operation::IntegerPower, &[base, exponent])
    }

    /// The integer at `id`, if it is one that [`Operation::IntegerPower`] takes.
    pub(crate) fn exponent(&self, id: NodeId) -> Option<u32> {
        let Node::Constant(constant) = self.node(id) else { return None };
        let exponent = constant.value() as u32;
        let fits = (2..=Operation::LARGEST_POWER).contains(&exponent);
        (fits && constant.is_exact() && f64::from(exponent) == constant.value()).then_some(exponent)
    }

    fn intern(&mut self, node: Node) -> NodeId {
        if self.is_draft {
            return push(&mut self.nodes, node);
        }
        if self.places.len() < self.nodes.len() {
            self.places = self.iter().map(|(id, node)| (*node, id)).collect();
        }
        *self.places.entry(node).or_insert_with(|| push(&mut self.nodes, node))
    }
}

fn push(nodes: &mut Vec<Node>, node: Node) -> NodeId {
    let id = u32::try_from(nodes.len()).expect("formulas are limited to far fewer nodes");
    nodes.push(node);
    NodeId(id)
}

#[cfg(test)]
mod tests;
