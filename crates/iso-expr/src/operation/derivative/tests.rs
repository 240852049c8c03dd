use crate::random::Random;
use crate::{Axis, NodeId, Operation, Program};

/// ∂F/∂axis by central differences of fourth order, at two distances. None where they do not agree, as near a kink, a
/// jump, a pole or the edge of the domain.
fn difference_quotient(program: &Program, point: [f64; 3], axis: Axis) -> Option<f64> {
    let value = |shift: f64| {
        let mut shifted = point;
        shifted[axis as usize] += shift;
        program.evaluate(shifted)[0]
    };
    let quotient = |h: f64| (8.0 * (value(h) - value(-h)) - (value(2.0 * h) - value(-2.0 * h))) / (12.0 * h);
    let (coarse, fine) = (quotient(1.0 / 1024.0), quotient(1.0 / 2048.0));
    ((coarse - fine).abs() <= 1e-8 * (1.0 + fine.abs())).then_some(fine)
}

/// Compares derivatives with difference quotients at random points; gives the share of points where there were any.
fn check(program: &Program, random: &mut Random) -> f64 {
    let gradient = program.with_gradient();
    let (points, mut compared) = (300, 0);
    for _ in 0..points {
        let point = [(); 3].map(|()| random.between(-3.0, 3.0));
        let given = gradient.evaluate(point);
        assert_eq!(given[0].to_bits(), program.evaluate(point)[0].to_bits());
        for axis in Axis::ALL {
            let Some(expected) = difference_quotient(program, point, axis) else { continue };
            let given = given[1 + axis as usize];
            let agrees = (given - expected).abs() <= 1e-7 * (1.0 + expected.abs());
            assert!(agrees, "{given} instead of {expected} at {point:?} along {axis:?} of\n{gradient}");
            compared += 1;
        }
    }
    f64::from(compared) / f64::from(3 * points)
}

/// `operation` with its only output on `operands`; an integer power with each of some exponents.
fn applications(operation: Operation, operands: impl Fn(&mut Program) -> [NodeId; 3]) -> Vec<Program> {
    let exponents: &[u32] = if operation == Operation::IntegerPower { &[2, 3, 4, 7] } else { &[1] };
    let apply = |exponent: &u32| {
        let mut program = Program::new();
        let operands = operands(&mut program);
        let output = match operation {
            Operation::IntegerPower => program.integer_power(operands[0], *exponent),
            _ => program.apply(operation, &operands[..operation.arity()]),
        };
        program.set_outputs(vec![output]);
        program
    };
    exponents.iter().map(apply).collect()
}

#[test]
fn derivatives_of_every_operation_agree_with_difference_quotients() {
    let mut random = Random::new(1);
    for operation in Operation::all() {
        for program in applications(operation, |program| Axis::ALL.map(|axis| program.variable(axis))) {
            let share = check(&program, &mut random);
            assert!(share > 0.2, "{operation:?} was compared at {share} of the points");
        }
    }
}

#[test]
fn derivatives_of_every_operation_on_functions_agree_with_difference_quotients() {
    let functions = |program: &mut Program| {
        let [x, y, z] = Axis::ALL.map(|axis| program.variable(axis));
        let [quarter, three] = [0.25, 3.0].map(|value| program.literal(value));
        let xy = program.apply(Operation::Multiply, &[x, y]);
        let scaled = program.apply(Operation::Multiply, &[quarter, xy]);
        let sine = program.apply(Operation::Sin, &[z]);
        let first = program.apply(Operation::Add, &[scaled, sine]);
        let second = program.apply(Operation::Subtract, &[y, scaled]);
        let third = program.apply(Operation::Divide, &[x, three]);
        [first, second, third]
    };
    let mut random = Random::new(2);
    for operation in Operation::all() {
        for program in applications(operation, functions) {
            let share = check(&program, &mut random);
            assert!(share > 0.1, "{operation:?} was compared at {share} of the points");
        }
    }
}

#[test]
fn derivatives_of_one_operand_twice_agree_with_difference_quotients() {
    let mut random = Random::new(3);
    for operation in Operation::all().filter(|operation| operation.arity() > 1) {
        for program in applications(operation, |program| [program.variable(Axis::X); 3]) {
            check(&program, &mut random);
        }
    }
}

/// Smooth minima of distances: their derivatives are means of those of the distances.
const SMOOTH_MINIMA: [&str; 5] = [
    "-ln(exp(-8x) + exp(-8*(y - z)))/8",
    "-ln(exp(-3*sqrt(x^2 + y^2 + 1)) + exp(-3*hypot(y, z)) + exp(-3*(x + 2)))/3",
    "-ln(exp(-5*(-ln(exp(-5x) + exp(-5y))/5)) + exp(-5z) + 2)/5",
    "-ln(exp(-2x) + exp(-2y) + exp(-2z) + exp(-x - y) + exp(-y - z) + 1)/2",
    "ln(exp(x + y) + (exp(y + x) + exp(z)))",
];

fn program(formula: &str) -> Program {
    crate::Ast::parse(formula).unwrap().lower(&[]).unwrap().program().clone()
}

#[test]
fn derivatives_of_smooth_minima_agree_with_difference_quotients() {
    let mut random = Random::new(4);
    for formula in SMOOTH_MINIMA {
        let share = check(&program(formula), &mut random);
        assert!(share > 0.3, "{formula} was compared at {share} of the points");
    }
}

#[test]
fn second_derivatives_of_smooth_minima_agree_with_difference_quotients() {
    let mut random = Random::new(5);
    for formula in SMOOTH_MINIMA {
        let gradient = program(formula).with_gradient();
        for partial in &gradient.outputs()[1..] {
            let mut slope = gradient.clone();
            slope.set_outputs(vec![*partial]);
            let share = check(&slope.pruned(), &mut random);
            assert!(share > 0.2, "{formula} was compared at {share} of the points");
        }
    }
}

/// Where one term is far above the others over all of a box, the derivative is all but that of its exponent, however wide the box is.
#[test]
fn derivatives_of_smooth_minima_are_certain_far_from_the_seam() {
    let domain = [(1.0, 2.0), (-2.0, -1.0), (-3.0, 3.0)];
    let domain = domain.map(|(lo, hi)| crate::Interval::new(lo, hi).unwrap());
    let mut slope = program("ln(exp(9x) + exp(9y))").with_gradient();
    slope.set_outputs(vec![slope.outputs()[1]]);
    let range = slope.pruned().pieces(domain).next().unwrap();
    // 1 − 1/(1 + e⁻¹⁸) = 1.52·10⁻⁸
    assert!(9.0 - range.lo < 1.4e-7 && range.contains(9.0 - 1e-8), "{range}");
}

/// The second derivative of ln(eᵘ + eᵛ) by u is a product of two shares.
#[test]
fn second_derivatives_of_smooth_maxima_stay_bounded_over_wide_boxes() {
    let mut slope = program("ln(exp(9x) + exp(9y))").with_gradient().simplified();
    slope.set_outputs(vec![slope.outputs()[1]]);
    let mut bend = slope.pruned().with_gradient();
    bend.set_outputs(vec![bend.outputs()[1]]);
    let range = bend.pruned().pieces([crate::Interval::new(-9.0, 9.0).unwrap(); 3]).next().unwrap();
    assert!(range.magnitude() <= 81.0 + 1e-9, "{range}");
}

#[test]
fn derivatives_of_smooth_minima_stay_bounded_over_wide_boxes() {
    let domain = [crate::Interval::new(-3.0, 3.0).unwrap(); 3];
    for formula in [SMOOTH_MINIMA[0], SMOOTH_MINIMA[2], SMOOTH_MINIMA[3]] {
        let gradient = program(formula).with_gradient();
        for partial in &gradient.outputs()[1..] {
            let mut slope = gradient.clone();
            slope.set_outputs(vec![*partial]);
            let range = slope.pruned().pieces(domain).next().unwrap();
            assert!(range.magnitude() <= 1.0 + 1e-12, "{formula}: {range}");
        }
    }
}
