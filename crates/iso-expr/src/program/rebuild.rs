//! Copies of programs, node by node: what every pass is made of.

use super::needed::Needed;
use super::{Node, NodeId, Program};

impl Program {
    /// A copy of this program without the nodes that no output needs.
    pub fn pruned(&self) -> Self {
        self.pruned_to(&self.outputs)
    }

    /// A copy without the nodes that none of these values needs, which are its outputs.
    pub(super) fn pruned_to(&self, outputs: &[NodeId]) -> Self {
        let needed = Needed::for_values(self, outputs);
        let nodes = Vec::with_capacity(needed.count());
        let mut pruned = Self { nodes, is_draft: self.is_draft, ..Self::new() };
        let mut places = vec![NodeId(0); self.nodes.len()];
        for id in needed.ids() {
            places[id.index()] = NodeId(pruned.nodes.len() as u32);
            pruned.nodes.push(self.node(id).with_operands(|operand| places[operand.index()]));
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
        self.nodes.reserve(other.nodes.len());
        self.places.reserve(other.nodes.len());
        for node in &other.nodes {
            let node = node.with_operands(|operand| places[operand.index()]);
            places.push(build(self, node));
        }
        other.outputs.iter().map(|output| places[output.index()]).collect()
    }
}
