use super::*;

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
fn substitution_leaves_no_node_that_nothing_needs() {
    let on_a_line = polynomial().substituted(|program| {
        let t = program.variable(Axis::X);
        let three = program.literal(3.0);
        let z = program.variable(Axis::Z);
        let x = program.apply(Operation::Add, &[t, three]);
        [x, t, z]
    });
    assert_eq!(on_a_line.to_string(), "v1 = x + 3\nv2 = v1 ^ 3\nv3 = v2 * x\nF = v3\n");
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
