//! Operations that need not wait for each other, evaluated together: divisions and roots two by two, since processors divide both doubles of a
//! register in the time of one, and begin with the next only some cycles later; functions as many as one call takes.

use std::collections::HashMap;

use iso_expr::{Node, NodeId, Operation, Program};

use crate::{elementary, values};

/// How many nodes are evaluated while one division keeps others from beginning. Where there are more of them, processors do not
/// wait for divisions, and pairs only add instructions.
///
/// Measured on Zen 4, one call beside the next: in pairs, four divisions take 0.55 of the time among 18 nodes, 0.8 among 35 and 1.05 among 46,
/// two roots 0.5 among 9 and 14, 0.9 among 38 and 1.02 among 53.
const WHILE_DIVIDING: usize = 9;

/// The same for a root.
const WHILE_TAKING_A_ROOT: usize = 20;

/// The most nodes between two divisions or roots that are evaluated together, so that few values wait in registers for either.
const FARTHEST: usize = 64;

/// The same for functions: a call leaves nothing in registers anyway.
const FARTHEST_CALLS: usize = 1024;

/// All nodes of a program, operands before the nodes that use them.
pub(crate) struct Order {
    nodes: Vec<NodeId>,
    /// Where in these each step ends.
    ends: Vec<usize>,
}

impl Order {
    /// That of `program` where divisions and roots are evaluated in pairs, if that saves time.
    pub(crate) fn in_pairs(program: &Program) -> Self {
        let is_meant = |operation| matches!(operation, Operation::Divide | Operation::SquareRoot);
        if saves_time(program) {
            Self::of(program, (2, FARTHEST), is_meant)
        } else {
            Self::one_by_one(program)
        }
    }

    /// That of `program` where so many functions that there are [in lanes](elementary::function) are evaluated by one call.
    pub(crate) fn in_calls(program: &Program, most: usize) -> Self {
        if most > 1 {
            Self::of(program, (most, FARTHEST_CALLS), |operation| elementary::function(operation).is_some())
        } else {
            Self::one_by_one(program)
        }
    }

    /// What is evaluated next, step by step: a node, or several with the same operation.
    pub(crate) fn steps(&self) -> impl Iterator<Item = &[NodeId]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(start, end)| &self.nodes[*start..*end])
    }

    fn one_by_one(program: &Program) -> Self {
        let nodes: Vec<_> = program.iter().map(|(id, _)| id).collect();
        let ends = (1..=nodes.len()).collect();
        Self { nodes, ends }
    }

    /// The operations that are meant by so many together, if there are no more nodes than so many between. All else keeps its order, but for
    /// what several need, which comes before them.
    fn of(program: &Program, limits: (usize, usize), is_meant: impl Fn(Operation) -> bool) -> Self {
        let count = program.nodes().len();
        let groups = Groups::of(program, limits, is_meant);
        let mut order = Self { nodes: Vec::with_capacity(count), ends: Vec::with_capacity(count) };
        let mut is_done = vec![false; count];
        // What is to be done, each for the sake of the one before it.
        let mut wanted = Vec::new();
        for (id, _) in program.iter() {
            wanted.push(id);
            while let Some(&id) = wanted.last() {
                let together = groups.with(&id);
                let mut operands = together.iter().flat_map(|id| program.nodes()[id.index()].operands());
                if is_done[id.index()] {
                    wanted.pop();
                } else if let Some(operand) = operands.find(|operand| !is_done[operand.index()]) {
                    wanted.push(*operand);
                } else {
                    together.iter().for_each(|id| is_done[id.index()] = true);
                    order.nodes.extend(together);
                    order.ends.push(order.nodes.len());
                }
            }
        }
        order
    }
}

/// Whether divisions and roots are what processors wait for. Functions that are called take longer than any of them.
fn saves_time(program: &Program) -> bool {
    let mut waited_for = 0;
    for node in program.nodes() {
        match node {
            Node::Apply(Operation::Divide, _) => waited_for += WHILE_DIVIDING,
            Node::Apply(Operation::SquareRoot, _) => waited_for += WHILE_TAKING_A_ROOT,
            Node::Apply(operation, _) if !values::is_written_out(*operation) => return false,
            _ => {}
        }
    }
    waited_for > program.nodes().len()
}

/// Nodes that are evaluated together.
struct Groups {
    groups: Vec<Vec<NodeId>>,
    /// The number of each node's group, if it has one.
    of_nodes: Vec<Option<usize>>,
}

impl Groups {
    /// All of a group are as deep, where depth counts the operations that are meant from an argument to a node. So none needs another, nor do
    /// groups need each other in a circle, for what needs a group is deeper.
    fn of(program: &Program, (most, farthest): (usize, usize), is_meant: impl Fn(Operation) -> bool) -> Self {
        let count = program.nodes().len();
        let mut depths = vec![0; count];
        let mut found = Self { groups: Vec::new(), of_nodes: vec![None; count] };
        // The number of the last group, by operation and depth.
        let mut last: HashMap<(Operation, usize), usize> = HashMap::new();
        for (id, node) in program.iter() {
            let mut depth = node.operands().iter().map(|operand| depths[operand.index()]).max().unwrap_or(0);
            if let Node::Apply(operation, _) = *node
                && is_meant(operation)
            {
                depth += 1;
                let number = last.entry((operation, depth)).or_insert(usize::MAX);
                let start = id.index().saturating_sub(farthest);
                let is_open = |group: &&mut Vec<NodeId>| group.len() < most && group[0].index() >= start;
                match found.groups.get_mut(*number).filter(is_open) {
                    Some(group) => group.push(id),
                    None => {
                        *number = found.groups.len();
                        found.groups.push(vec![id]);
                    }
                }
                found.of_nodes[id.index()] = Some(*number);
            }
            depths[id.index()] = depth;
        }
        found
    }

    /// The nodes that are evaluated together with one, that one included.
    fn with<'a>(&'a self, id: &'a NodeId) -> &'a [NodeId] {
        match self.of_nodes[id.index()] {
            Some(number) => &self.groups[number],
            None => std::slice::from_ref(id),
        }
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;
    use iso_expr::{Ast, Axis};

    use super::*;

    fn program(formula: &str) -> Program {
        let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
        program.with_powers_expanded()
    }

    /// How many pairs there are.
    fn pairs(program: &Program) -> usize {
        Order::in_pairs(program).steps().filter(|step| step.len() == 2).count()
    }

    #[test]
    fn divisions_and_roots_are_paired_where_they_do_not_wait_for_each_other() {
        for (formula, expected) in [
            (
                "3.5 - 1/((x - 0.9)^2 + y^2 + z^2) - 1/((x + 0.9)^2 + y^2 + z^2) - 1/(x^2 + (y - 0.8)^2 + z^2) \
                 - 1/(x^2 + y^2 + (z - 0.8)^2)",
                2,
            ),
            ("1/(1 + 1/x)", 0),
            ("1/(1 + 1/x) + 1/(1 + 1/y)", 2),
            ("1/(1 + 1/x) + 1/y", 1),
            ("1/x + 1/y + 1/z", 1),
            ("sqrt(x) + sqrt(y)", 1),
            ("sqrt(x) + 1/y", 0),
            ("sqrt(1/x) + sqrt(1/y) + z", 2),
            // An operand of one is not an operand of the other alone.
            ("x/(y + 2) + y/(y + 2)", 1),
        ] {
            assert_eq!(pairs(&program(formula)), expected, "{formula}");
        }
    }

    #[test]
    fn nothing_is_paired_where_it_is_not_waited_for() {
        assert_eq!(pairs(&program("1/x + 1/y + sin(z)")), 0);
        assert_eq!(pairs(&program("1/x + 1/y + (x^2 + 2)*(y^3 + 3)*(z^4 + 4)*(x - y)*(y - z)")), 0);
    }

    #[test]
    fn what_stands_far_apart_is_not_paired() {
        for (roots, expected) in [(8, 1), (24, 0)] {
            let between = (1..=roots).map(|place| format!(" + sqrt(x - {place})")).collect::<String>();
            let program = program(&format!("1/(x + 1){between} + 1/(y + 1)"));
            let is_division = |id: NodeId| matches!(program.node(id), Node::Apply(Operation::Divide, _));
            let order = Order::in_pairs(&program);
            let divisions = order.steps().filter(|step| step.len() == 2 && is_division(step[0]));
            assert_eq!(divisions.count(), expected, "{roots} roots between");
        }
    }

    #[test]
    fn functions_are_called_together_where_they_do_not_wait_for_each_other() {
        let exponentials = |formula: &str| -> Vec<usize> {
            let program = program(formula);
            let is_exponential = |id: NodeId| matches!(program.node(id), Node::Apply(Operation::Exp, _));
            let order = Order::in_calls(&program, 4);
            order.steps().filter(|step| is_exponential(step[0])).map(<[NodeId]>::len).collect()
        };
        if elementary::function(Operation::Exp).is_some() {
            assert_eq!(exponentials("exp(x) + exp(y) + exp(z)"), [3]);
            assert_eq!(exponentials("exp(exp(exp(x)))"), [1, 1, 1]);
            assert_eq!(exponentials("exp(x) + exp(y) + exp(z) + exp(2x) + exp(2y) + exp(2z)"), [4, 2]);
            // What lies between is deeper.
            assert_eq!(exponentials("exp(x) + ln(2 + exp(y)) + exp(z + ln(y))"), [2, 1]);
        }
    }

    #[test]
    fn every_node_is_evaluated_once_and_after_its_operands() {
        let mut random = Random::new(1);
        let operations = [
            Operation::Divide,
            Operation::SquareRoot,
            Operation::Add,
            Operation::Multiply,
            Operation::Exp,
            Operation::Ln,
        ];
        let mut found = [0; 5];
        for round in 0..300 {
            let kinds = if round % 2 == 0 { &operations[..4] } else { &operations };
            let program = random.program_of(1 + round, kinds);
            for order in [Order::in_pairs(&program), Order::in_calls(&program, 4)] {
                let mut is_done = vec![false; program.nodes().len()];
                for step in order.steps() {
                    for id in step {
                        let mut operands = program.nodes()[id.index()].operands().iter();
                        assert!(operands.all(|operand| is_done[operand.index()]), "{program}");
                    }
                    let operation = |id: &NodeId| match program.node(*id) {
                        Node::Apply(operation, _) => Some(operation),
                        _ => None,
                    };
                    let first = operation(&step[0]);
                    assert!(
                        step.iter().all(|id| operation(id) == first) && (first.is_some() || step.len() == 1)
                    );
                    for id in step {
                        assert!(!std::mem::replace(&mut is_done[id.index()], true), "{program}");
                    }
                    found[step.len()] += 1;
                }
                assert!(is_done.iter().all(|is_done| *is_done), "{program}");
            }
        }
        assert!(found[2] > 1000, "{found:?}");
        assert!(found[4] > 300 || elementary::function(Operation::Exp).is_none(), "{found:?}");
    }

    #[test]
    fn deep_programs_take_no_stack_and_little_time() {
        let mut program = Program::new();
        let [x, y, mut sum] = Axis::ALL.map(|axis| program.variable(axis));
        for _ in 0..25_000 {
            let quotients = [x, y].map(|dividend| program.apply(Operation::Divide, &[dividend, sum]));
            let root = program.apply(Operation::SquareRoot, &[quotients[0]]);
            sum = program.apply(Operation::Add, &[quotients[1], root]);
        }
        program.set_outputs(vec![sum]);
        assert_eq!(pairs(&program), 25_000);
    }
}
