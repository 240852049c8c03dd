use crate::program::reference::assert_same;
use crate::random::Random;
use crate::{Operation, Program};

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

#[test]
fn no_two_rules_are_alike() {
    let mut rules: Vec<_> =
        Operation::all().flat_map(super::rules::of).map(|rule| (rule.given, rule.simpler)).collect();
    rules.sort_unstable();
    let count = rules.len();
    rules.dedup();
    assert_eq!(rules.len(), count);
}
