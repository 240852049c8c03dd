//! Divisions and roots that need not wait for each other, two by two: processors divide both doubles of a register in the time of
//! one, and begin with the next only some cycles later.

use std::collections::HashMap;

use iso_expr::{Node, NodeId, Operation, Program};

use crate::values;

/// How many nodes are evaluated while one division keeps others from beginning. Where there are more of them, processors do not
/// wait for divisions, and pairs only add instructions.
///
/// Measured on Zen 4, one call beside the next: in pairs, four divisions take 0.55 of the time among 18 nodes, 0.8 among 35 and 1.05 among 46,
/// two roots 0.5 among 9 and 14, 0.9 among 38 and 1.02 among 53.
const WHILE_DIVIDING: usize = 9;

/// The same for a root.
const WHILE_TAKING_A_ROOT: usize = 20;

/// The most nodes between two that are evaluated together, so that few values wait in registers for either.
const FARTHEST: usize = 64;

/// What is evaluated next: a node, and perhaps another with the same operation.
pub(crate) type Step = (NodeId, Option<NodeId>);

/// All nodes of `program`, operands before the nodes that use them, divisions and roots in pairs where that saves time. All else
/// keeps its order, but for what a pair needs, which comes before the pair.
pub(crate) fn steps(program: &Program) -> Vec<Step> {
    let count = program.nodes().len();
    let partners = if saves_time(program) { partners(program) } else { vec![None; count] };
    let mut steps = Vec::with_capacity(count);
    let mut is_done = vec![false; count];
    // What is to be done, each for the sake of the one before it.
    let mut wanted = Vec::new();
    for (id, _) in program.iter() {
        wanted.push(id);
        while let Some(&id) = wanted.last() {
            let partner = partners[id.index()];
            let both = || [Some(id), partner].into_iter().flatten();
            let mut operands = both().flat_map(|id| program.nodes()[id.index()].operands());
            if is_done[id.index()] {
                wanted.pop();
            } else if let Some(operand) = operands.find(|operand| !is_done[operand.index()]) {
                wanted.push(*operand);
            } else {
                both().for_each(|id| is_done[id.index()] = true);
                steps.push((id, partner));
            }
        }
    }
    steps
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

/// The other one of each node's pair.
///
/// Both are as deep, where depth counts divisions and roots from an argument to a node. So neither needs the other, nor do pairs
/// need each other in a circle, for what needs a pair is deeper.
fn partners(program: &Program) -> Vec<Option<NodeId>> {
    let mut depths = vec![0; program.nodes().len()];
    let mut partners = vec![None; program.nodes().len()];
    // The last node without a partner, by operation and depth.
    let mut single: HashMap<(Operation, usize), NodeId> = HashMap::new();
    for (id, node) in program.iter() {
        let mut depth = node.operands().iter().map(|operand| depths[operand.index()]).max().unwrap_or(0);
        if let Node::Apply(operation @ (Operation::Divide | Operation::SquareRoot), _) = *node {
            depth += 1;
            let other = single.remove(&(operation, depth));
            match other.filter(|other| id.index() - other.index() <= FARTHEST) {
                Some(other) => {
                    partners[id.index()] = Some(other);
                    partners[other.index()] = Some(id);
                }
                None => {
                    single.insert((operation, depth), id);
                }
            }
        }
        depths[id.index()] = depth;
    }
    partners
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
        steps(program).iter().filter(|(_, other)| other.is_some()).count()
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
            let steps = steps(&program);
            let divisions = steps.iter().filter(|(id, other)| other.is_some() && is_division(*id));
            assert_eq!(divisions.count(), expected, "{roots} roots between");
        }
    }

    #[test]
    fn every_node_is_evaluated_once_and_after_its_operands() {
        let mut random = Random::new(1);
        let operations = [Operation::Divide, Operation::SquareRoot, Operation::Add, Operation::Multiply];
        let mut found = 0;
        for round in 0..300 {
            let program = random.program_of(1 + round, &operations);
            let mut is_done = vec![false; program.nodes().len()];
            for (id, other) in steps(&program) {
                let together: Vec<_> = [Some(id), other].into_iter().flatten().collect();
                for id in &together {
                    let mut operands = program.nodes()[id.index()].operands().iter();
                    assert!(operands.all(|operand| is_done[operand.index()]), "{program}");
                }
                for id in together {
                    assert!(!std::mem::replace(&mut is_done[id.index()], true), "{program}");
                }
                if let Some(other) = other {
                    let [a, b] = [id, other].map(|id| match program.node(id) {
                        Node::Apply(operation, _) => operation,
                        leaf => panic!("{leaf:?} is no operation"),
                    });
                    assert_eq!(a, b);
                    found += 1;
                }
            }
            assert!(is_done.iter().all(|is_done| *is_done), "{program}");
        }
        assert!(found > 1000, "{found} pairs");
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
