//! Copies of programs, node by node: what every pass is made of.

use super::{Node, NodeId, Program};

impl Program {
    /// A copy of this program without the nodes that no output needs.
    pub fn pruned(&self) -> Self {
        self.pruned_to(&self.outputs)
    }

    /// A copy without the nodes that none of these values needs, which are its outputs.
    pub(super) fn pruned_to(&self, outputs: &[NodeId]) -> Self {
        let needed = self.needed_for(outputs);
        let mut pruned = Self::new();
        pruned.nodes.reserve(needed.iter().filter(|is_needed| **is_needed).count());
        let mut places = Vec::with_capacity(needed.len());
        for (node, needed) in self.nodes.iter().zip(needed) {
            // What is not needed is never looked up, so that any place will do for it.
            places.push(NodeId(pruned.nodes.len() as u32));
            if needed {
                pruned.nodes.push(node.with_operands(|operand| places[operand.index()]));
            }
        }
        pruned.outputs = outputs.iter().map(|output| places[output.index()]).collect();
        pruned
    }

    /// Adds the nodes of `other` as `build` makes them: it is given each node, its operands already replaced by what was
    /// built for them. Returns what was built for the outputs.
    pub(super) fn import_with(
        &mut self,
        other: &Self,
        mut build: impl FnMut(&mut Self, Node) -> NodeId,
    ) -> Vec<NodeId> {
        let mut places: Vec<NodeId> = Vec::with_capacity(other.nodes.len());
        self.places.reserve(other.nodes.len());
        for node in &other.nodes {
            let node = node.with_operands(|operand| places[operand.index()]);
            places.push(build(self, node));
        }
        other.outputs.iter().map(|output| places[output.index()]).collect()
    }

    /// For each node up to the last of these values whether one of them is computed from it.
    fn needed_for(&self, values: &[NodeId]) -> Vec<bool> {
        let count = values.iter().map(|value| value.index() + 1).max().unwrap_or(0);
        let mut needed = vec![false; count];
        for value in values {
            needed[value.index()] = true;
        }
        for (place, node) in self.nodes[..count].iter().enumerate().rev() {
            if needed[place] {
                for operand in node.operands() {
                    needed[operand.index()] = true;
                }
            }
        }
        needed
    }
}
