//! Programs as instructions over a small number of slots.

use crate::{Axis, Constant, Node, NodeId, Operation, Program};

/// The place of a value while a program runs: first the arguments, then the constants, then the registers.
pub(super) type Slot = u32;

/// One operation: where its operands are, and where its result goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instruction {
    pub(super) operation: Operation,
    /// A register; never one of the operands.
    pub(super) target: Slot,
    /// Only as many as the operation's arity count; the rest repeat the first one.
    pub(super) operands: [Slot; 3],
}

/// A program, its values assigned to slots.
#[derive(Debug)]
pub(super) struct Code {
    /// How many arguments there are: x, y and z, if not more.
    pub(super) arguments: usize,
    pub(super) instructions: Vec<Instruction>,
    constants: Vec<Constant>,
    /// How many slots there are.
    pub(super) slots: usize,
    pub(super) outputs: Vec<Slot>,
}

impl Code {
    /// Code for `program`, every node of which some output needs.
    pub(super) fn new(program: &Program) -> Self {
        let constants: Vec<Constant> = program
            .nodes()
            .iter()
            .filter_map(|node| if let Node::Constant(constant) = node { Some(*constant) } else { None })
            .collect();
        let arguments = program.arguments().max(Axis::ALL.len());
        let slots = arguments + constants.len();
        let mut code = Self { arguments, instructions: Vec::new(), constants, slots, outputs: Vec::new() };
        code.assign_slots(program);
        code
    }

    /// Each constant with its slot.
    pub(super) fn constants(&self) -> impl Iterator<Item = (Slot, Constant)> {
        (self.arguments as Slot..).zip(self.constants.iter().copied())
    }

    /// Walks the nodes in order, gives each operation the register that was freed last, and frees registers after the
    /// last instruction that reads them.
    fn assign_slots(&mut self, program: &Program) {
        let last_reader = last_readers(program);
        let first_register = self.slots as Slot;
        let mut slots: Vec<Slot> = Vec::with_capacity(program.nodes().len());
        let mut free: Vec<Slot> = Vec::new();
        let mut constants = self.arguments as Slot..;
        for (id, node) in program.iter() {
            let slot = match node {
                Node::Variable(argument) => argument.index() as Slot,
                Node::Constant(_) => constants.next().expect("the range has no end"),
                Node::Apply(operation, operands) => {
                    // Taken before the operands' registers are freed, so that no loop reads what it writes.
                    let target = free.pop().unwrap_or_else(|| {
                        self.slots += 1;
                        self.slots as Slot - 1
                    });
                    let operands = operands.map(|operand| slots[operand.index()]);
                    self.instructions.push(Instruction { operation: *operation, target, operands });
                    target
                }
            };
            slots.push(slot);
            for (place, operand) in node.operands().iter().enumerate() {
                let is_repeated = node.operands()[..place].contains(operand);
                let slot = slots[operand.index()];
                if last_reader[operand.index()] == Some(id) && !is_repeated && slot >= first_register {
                    free.push(slot);
                }
            }
        }
        self.outputs = program.outputs().iter().map(|output| slots[output.index()]).collect();
    }
}

/// The last node that reads each node; `None` for outputs, which are read at the end.
fn last_readers(program: &Program) -> Vec<Option<NodeId>> {
    let mut readers = vec![None; program.nodes().len()];
    for (id, node) in program.iter() {
        for operand in node.operands() {
            readers[operand.index()] = Some(id);
        }
    }
    for output in program.outputs() {
        readers[output.index()] = None;
    }
    readers
}
