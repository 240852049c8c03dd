//! The nodes of a program that some of its values need.

use super::{Node, NodeId, Program};

/// How many neighbouring nodes have their bits in one block.
const BLOCK: usize = u64::BITS as usize;

/// Some nodes of a program, as a set of bits: of a large program few are often needed, and the others are passed by 64 at a time.
pub(super) struct Needed {
    blocks: Vec<u64>,
}

impl Needed {
    /// These values and all that they are computed from.
    pub(super) fn for_values(program: &Program, values: &[NodeId]) -> Self {
        let mut needed = Self::none(program);
        values.iter().for_each(|value| needed.insert(*value));
        needed.spread(|needed, id| {
            if let Node::Apply(_, operands) = program.node(id) {
                operands.into_iter().for_each(|operand| needed.insert(operand));
            }
        });
        needed
    }

    /// No node of a program so far.
    pub(super) fn none(program: &Program) -> Self {
        Self { blocks: vec![0; program.nodes.len().div_ceil(BLOCK)] }
    }

    pub(super) fn insert(&mut self, id: NodeId) {
        self.blocks[id.index() / BLOCK] |= 1 << (id.index() % BLOCK);
    }

    /// Asks each node that is needed for those that it needs itself, from the last to the first. They stand before it.
    pub(super) fn spread(&mut self, mut ask: impl FnMut(&mut Self, NodeId)) {
        for block in (0..self.blocks.len()).rev() {
            let mut open = u64::MAX;
            while let Some(place) = (self.blocks[block] & open).checked_ilog2() {
                open = (1 << place) - 1;
                ask(self, NodeId((block * BLOCK) as u32 + place));
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.blocks.iter().map(|block| block.count_ones() as usize).sum()
    }

    /// Those that are needed, in order.
    pub(super) fn ids(&self) -> impl Iterator<Item = NodeId> {
        let of_block = |(number, block): (usize, &u64)| {
            let mut open = *block;
            std::iter::from_fn(move || {
                let place = open.trailing_zeros();
                open &= open.checked_sub(1)?;
                Some(NodeId((number * BLOCK) as u32 + place))
            })
        };
        self.blocks.iter().enumerate().flat_map(of_block)
    }
}
