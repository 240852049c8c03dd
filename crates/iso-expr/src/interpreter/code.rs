//! Programs as instructions over a small number of slots.

use crate::{Axis, Constant, Node, NodeId, Operation, Program};

/// The place of a value while a program runs: first the arguments, then the constants, then the registers.
pub(super) type Slot = u32;

/// One operation: where its operands are, and where its result goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instruction {
    pub(super) operation: Operation,
    /// A register, counted from the first register; never one of the operands.
    pub(super) target: u32,
    /// Only as many as the operation's arity count; the rest repeat the first one.
    pub(super) operands: [Slot; 3],
}

/// A program, its values assigned to slots.
#[derive(Debug)]
pub(super) struct Code {
    /// How many arguments there are: x, y and z, if not more.
    pub(super) arguments: usize,
    pub(super) instructions: Vec<Instruction>,
    pub(super) constants: Vec<Constant>,
    /// How many registers there are.
    pub(super) registers: usize,
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
        let mut code =
            Self { arguments, instructions: Vec::new(), constants, registers: 0, outputs: Vec::new() };
        code.assign_slots(program);
        code
    }

    /// The slot of the first register.
    pub(super) fn first_register(&self) -> usize {
        self.arguments + self.constants.len()
    }

    /// Walks the nodes in order, gives each operation the register that was freed last, and frees registers after the
    /// last instruction that reads them.
    fn assign_slots(&mut self, program: &Program) {
        let last_reader = last_readers(program);
        let first_register = self.first_register();
        let mut slots: Vec<Slot> = Vec::with_capacity(program.nodes().len());
        let mut free: Vec<u32> = Vec::new();
        let mut constants = self.arguments..;
        for (id, node) in program.iter() {
            let slot = match node {
                Node::Variable(argument) => argument.index(),
                Node::Constant(_) => constants.next().expect("the range has no end"),
                Node::Apply(operation, operands) => {
                    // Taken before the operands' registers are freed, so that no loop reads what it writes.
                    let target = free.pop().unwrap_or_else(|| {
                        self.registers += 1;
                        self.registers as u32 - 1
                    });
                    let operands = operands.map(|operand| slots[operand.index()]);
                    self.instructions.push(Instruction { operation: *operation, target, operands });
                    first_register + target as usize
                }
            };
            slots.push(slot as Slot);
            for (place, operand) in node.operands().iter().enumerate() {
                let is_repeated = node.operands()[..place].contains(operand);
                if last_reader[operand.index()] == Some(id) && !is_repeated {
                    let register = (slots[operand.index()] as usize).checked_sub(first_register);
                    free.extend(register.map(|register| register as u32));
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
