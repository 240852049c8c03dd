use super::rules::{self, Rule};
use super::{Node, Simplifier};
use crate::program::reference::assert_same;
use crate::random::Random;
use crate::{Ast, Operation, Program};

/// Both programs compute the same doubles at `count` random points of every kind.
fn assert_equal_values(random: &mut Random, count: usize, program: &Program, other: &Program) {
    for _ in 0..count {
        let point = [(); 3].map(|()| random.double());
        for (given, expected) in other.evaluate(point).into_iter().zip(program.evaluate(point)) {
            assert_same(given, expected, || format!("at {point:?} of\n{program}which became\n{other}"));
        }
    }
}

#[test]
fn random_programs_keep_their_values() {
    let mut random = Random::new(1);
    for _ in 0..3000 {
        let operations = random.below(30);
        let program = random.program(operations);
        assert_equal_values(&mut random, 30, &program, &program.simplified());
    }
}

#[test]
fn programs_of_what_rules_look_for_keep_their_values() {
    use Operation::*;
    let mut random = Random::new(2);
    let arithmetic =
        [Add, Subtract, Multiply, Divide, Negate, Negate, IntegerPower, Absolute, Minimum, Select, Less];
    for _ in 0..10_000 {
        let operations = random.below(12);
        let program = random.program_of(operations, &arithmetic);
        assert_equal_values(&mut random, 20, &program, &program.simplified());
    }
}

#[test]
fn what_is_simplified_stays_as_it_is() {
    let mut random = Random::new(3);
    for _ in 0..3000 {
        let operations = random.below(40);
        let once = random.program(operations).simplified();
        let twice = once.simplified();
        assert_eq!(once.to_string(), twice.to_string());
    }
}

#[test]
fn gradients_keep_their_values() {
    let mut random = Random::new(4);
    for _ in 0..1000 {
        let operations = random.below(20);
        let program = random.program(operations).with_gradient();
        assert_equal_values(&mut random, 20, &program, &program.simplified());
    }
}

/// Arguments at which a wrong rule shows: ordinary, huge, tiny, subnormal, infinite, undefined, both zeros.
const ARGUMENTS: [f64; 28] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    2.0,
    3.0,
    -3.0,
    0.1,
    -0.7,
    2.5,
    -1e16,
    7.3e40,
    1e160,
    -1e300,
    f64::MAX,
    f64::MIN,
    1e-160,
    -1e-300,
    f64::MIN_POSITIVE,
    -1.5 * f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    3.5e-323,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn parse(formula: &str) -> Program {
    if formula.contains('<') {
        // A condition is no formula by itself.
        let mut program = parse_formula(&format!("if({formula}, 1, 0)"));
        let condition = program.node(program.outputs()[0]).operands()[0];
        program.set_outputs(vec![condition]);
        return program;
    }
    parse_formula(formula)
}

fn parse_formula(formula: &str) -> Program {
    let ast = Ast::parse(formula).unwrap_or_else(|error| panic!("{formula}: {error}"));
    ast.lower(&[]).unwrap_or_else(|error| panic!("{formula}: {error}")).program().clone()
}

/// What `rule` makes of the formula given with it, whose operands are simplified before.
fn applied(operation: Operation, rule: &Rule, given: &Program) -> Program {
    let Node::Apply(outermost, operands) = given.node(given.outputs()[0]) else {
        panic!("{} is a leaf", rule.given)
    };
    assert_eq!(outermost, operation, "the rule for {}", rule.given);
    let mut operands_alone = given.clone();
    operands_alone.set_outputs(operands.to_vec());
    let mut program = operands_alone.simplified();
    let operands = [0, 1, 2].map(|place| program.outputs()[place]);
    let result = (rule.apply)(&mut Simplifier { program: &mut program }, operands);
    program.set_outputs(vec![result.unwrap_or_else(|| panic!("the rule does not apply to {}", rule.given))]);
    program.pruned()
}

#[test]
fn every_rule_gives_what_it_says() {
    for operation in Operation::all() {
        for rule in rules::of(operation) {
            let given = parse(rule.given);
            let (applied, expected) = (applied(operation, rule, &given), parse(rule.simpler).simplified());
            assert_eq!(applied.to_string(), expected.to_string(), "from {}", rule.given);
            assert_eq!(given.simplified().to_string(), expected.to_string(), "from {}", rule.given);
        }
    }
}

#[test]
fn every_rule_keeps_every_bit() {
    for operation in Operation::all() {
        for rule in rules::of(operation) {
            let given = parse(rule.given);
            let simpler = applied(operation, rule, &given);
            for (x, y) in ARGUMENTS.iter().flat_map(|x| ARGUMENTS.map(|y| (*x, y))) {
                let point = [x, y, 1.0];
                let context = || format!("for {} at {point:?}", rule.given);
                assert_same(simpler.evaluate(point)[0], given.evaluate(point)[0], context);
            }
        }
    }
}

#[test]
fn what_is_not_exact_stays() {
    let kept = [
        "x + 0",
        "0 - x",
        "x - x",
        "0 * x",
        "x / x",
        "x / 3",
        "-(x - y)",
        "(-x) - y",
        "x + y - y",
        "0.5 * (0.5 * x)",
        "3 * (3 * x)",
        "(x^3)^2",
        "x^3 * x^3",
        "sqrt(x^2)",
        "sqrt(x)^2",
        "x^0.5",
        "if(x, y, y)",
        "exp(ln(x))",
        "1 / (1 / x)",
        "2^x * 2^y",
        "x * y / y",
        "max(x, y) + min(x, y)",
    ];
    for formula in kept {
        let (given, simplified) = (parse(formula), parse(formula).simplified());
        assert_eq!(given.operations(), simplified.operations(), "{formula} became\n{simplified}");
    }
}
