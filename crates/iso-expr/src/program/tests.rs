pub(super) mod twofold;

use super::*;
use crate::random::Random;
use crate::{Ast, Engine, Interpreter, Scratch};

fn polynomial() -> Program {
    let mut program = Program::new();
    let (x, y) = (program.variable(Axis::X), program.variable(Axis::Y));
    let cube = program.integer_power(x, 3);
    let product = program.apply(Operation::Multiply, &[cube, y]);
    program.set_outputs(vec![product]);
    program
}

#[test]
fn a_gradient_without_a_variable_is_the_literal_zero() {
    let gradient = polynomial().with_gradient();
    assert_eq!(gradient.outputs().len(), 4);
    assert_eq!(gradient.node(gradient.outputs()[3]), Node::Constant(Constant::exact(0.0)));
}

#[test]
fn a_pruned_program_has_no_node_that_nothing_needs() {
    let mut program = polynomial();
    let z = program.variable(Axis::Z);
    program.apply(Operation::Add, &[z, program.outputs()[0]]);
    assert_eq!(program.pruned().to_string(), "v1 = x ^ 3\nv2 = v1 * y\nF = v2\n");
}

#[test]
fn constants_of_a_derivative_fold_into_one() {
    let program =
        Ast::parse("3 * (5 * (y + (7x^3 + 1)))").unwrap().lower(&[]).unwrap().program().with_gradient();
    let gradient = program.simplified();
    let mut along_x = gradient.clone();
    along_x.set_outputs(vec![gradient.outputs()[1]]);
    assert_eq!(along_x.pruned().to_string(), "v1 = x ^ 2\nv2 = 315 * v1\nF = v2\n");
    assert_eq!(gradient.node(gradient.outputs()[2]), Node::Constant(Constant::exact(15.0)));
}

#[test]
fn a_listing_shows_every_kind_of_operation_as_formulas_do() {
    let formula = "if(x < pi, -y, log2(max(z, 1e-9)) / 3)";
    let program = Ast::parse(formula).unwrap().lower(&[]).unwrap().program().simplified();
    let expected =
        "v1 = x < pi\nv2 = -y\nv3 = max(z, 1e-9)\nv4 = log2(v3)\nv5 = v4 / 3\nv6 = if(v1, v2, v5)\nF = v6\n";
    assert_eq!(program.to_string(), expected);
}

#[test]
fn powers_of_one_base_share_their_squares() {
    let mut program = Program::new();
    let x = program.variable(Axis::X);
    let powers = [2, 4, 6, 7].map(|exponent| program.integer_power(x, exponent));
    program.set_outputs(powers.to_vec());
    let expected = "v1 = x * x\nv2 = v1 * v1\nv3 = v1 * v2\nv4 = x * v1\nv5 = v4 * v2\n\
                    F = v1\n∂F/∂x = v2\n∂F/∂y = v3\n∂F/∂z = v5\n";
    assert_eq!(program.with_powers_expanded().to_string(), expected);
}

#[test]
#[should_panic(expected = "the exponent is not an integer")]
fn an_integer_power_has_an_integer_exponent() {
    let mut program = Program::new();
    let x = program.variable(Axis::X);
    program.apply(Operation::IntegerPower, &[x, x]);
}

#[test]
fn the_gradient_of_a_polynomial_is_minimal() {
    let mut program = Program::new();
    let (x, y) = (program.variable(Axis::X), program.variable(Axis::Y));
    let (fourth, square, five) =
        (program.integer_power(x, 4), program.integer_power(y, 3), program.literal(5.0));
    let scaled = program.apply(Operation::Multiply, &[five, square]);
    let difference = program.apply(Operation::Subtract, &[fourth, scaled]);
    program.set_outputs(vec![difference]);
    let expected = "v1 = x ^ 4\nv2 = x ^ 3\nv3 = 4 * v2\nv4 = y ^ 3\nv5 = y ^ 2\nv6 = 5 * v4\nv7 = v1 - v6\n\
                    v8 = -15 * v5\nF = v7\n∂F/∂x = v3\n∂F/∂y = v8\n∂F/∂z = 0\n";
    assert_eq!(program.with_gradient().simplified().to_string(), expected);
}

#[test]
fn the_gradient_of_a_reciprocal_divides_no_more_often_than_that_does() {
    let gradient = |formula| Ast::parse(formula).unwrap().lower(&[]).unwrap().program().with_gradient();
    let divisions = |formula| {
        let program = gradient(formula).simplified();
        let divides = |node: &&Node| matches!(node, Node::Apply(Operation::Divide, _));
        program.nodes().iter().filter(divides).count()
    };
    assert_eq!(divisions("1/(x^2 + y^2 + z^2)"), 1);
    assert_eq!(divisions("3/(x^2 + y^2 + z^2)"), 2);
    assert_eq!(divisions("x/(y^2 + z^2)"), 2);
}

#[test]
fn second_derivatives_are_those_of_calculus() {
    let formula = Ast::parse("x^2 y + 3y z^2 + exp(x) - sin(y z)").unwrap().lower(&[]).unwrap();
    let hessian = formula.minus_level(0.0).with_gradient().with_hessian();
    let kernel = Interpreter.point(&hessian).unwrap();
    for [x, y, z] in [[0.3_f64, -1.2, 0.7], [-2.0, 0.0, 1.5], [1.0, 4.0, -0.25]] {
        let mut found = [f64::NAN; 10];
        kernel.evaluate(&mut Scratch::default(), x, y, z, &mut found);
        let (sine, cosine) = (y * z).sin_cos();
        let expected = [
            x * x * y + 3.0 * y * z * z + x.exp() - sine,
            2.0 * x * y + x.exp(),
            x * x + 3.0 * z * z - z * cosine,
            6.0 * y * z - y * cosine,
            2.0 * y + x.exp(),
            2.0 * x,
            0.0,
            z * z * sine,
            6.0 * z - cosine + y * z * sine,
            6.0 * y + y * y * sine,
        ];
        for (place, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            assert!((found - expected).abs() < 1e-13 * (1.0 + expected.abs()), "output {place}: {found}");
        }
    }
}

/// So that nothing is computed twice, in programs of more nodes than stand in one block of bits.
#[test]
fn derivatives_hold_equal_nodes_only_until_they_are_simplified() {
    let mut random = Random::new(0x6472_6166);
    let are_unequal = |program: &Program| {
        let mut known = std::collections::HashSet::new();
        program.nodes().iter().all(|node| known.insert(*node))
    };
    let mut drafts_with_equal_nodes = 0;
    for _ in 0..200 {
        let program = random.program(40).simplified();
        let gradient = program.with_gradient();
        let drafts =
            [gradient.simplified().with_hessian(), gradient, program.with_slope(), program.with_rounding()];
        for draft in &drafts {
            drafts_with_equal_nodes += usize::from(!are_unequal(draft));
            let simplified = draft.simplified();
            assert!(are_unequal(&simplified), "{simplified}");
            assert_eq!(simplified.pruned(), simplified, "what no output needs is left");
        }
    }
    assert!(drafts_with_equal_nodes > 0, "no draft tells");
}
