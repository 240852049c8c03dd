//! Enclosures are isotone, as tight as their ends allow, and decorated no better than their operands.

use super::*;

const CASES: usize = 10_000;

#[test]
fn a_part_of_a_box_has_a_part_of_the_enclosure() {
    for operation in Operation::all() {
        let mut random = Random::new(0xa11 + operation.index() as u64);
        for _ in 0..CASES {
            let operands = random_box(&mut random, operation);
            if has_empty(operation, operands) {
                continue;
            }
            let part = random_part(&mut random, operands);
            let (whole, small) = (extend(operation, operands), extend(operation, part));
            let message =
                || format!("{} = {small}, {} = {whole}", show(operation, part), show(operation, operands));
            assert!(small.interval.is_subset_of(whole.interval), "{}", message());
            // A part of an unbounded box may be bounded, so only the order of the weaker decorations is kept.
            let known = |enclosure: Decorated| enclosure.decoration.min(Decoration::Continuous);
            assert!(small.interval.is_empty() || known(small) >= known(whole), "{}", message());
        }
    }
}

/// Operations that take their extremes over every box at its corners, or where an operand is zero.
fn has_extremes_at_corners(operation: Operation) -> bool {
    use Operation::*;
    !matches!(operation, Sin | Cos | Tan | Modulo | Equal | Select)
}

#[test]
fn ends_are_those_of_the_enclosures_at_the_corners() {
    for operation in Operation::all().filter(|operation| has_extremes_at_corners(*operation)) {
        let mut random = Random::new(0xc04e4 + operation.index() as u64);
        let mut compared = 0;
        for _ in 0..CASES {
            let operands = random_box(&mut random, operation);
            let enclosure = extend(operation, operands);
            if enclosure.decoration < Decoration::Common {
                continue;
            }
            compared += 1;
            let corners =
                corners(operands[0]).into_iter().flat_map(|a| corners(operands[1]).map(|b| [a, b, b]));
            let hull = corners.fold(Interval::EMPTY, |hull, corner| {
                hull.hull(extend(operation, corner.map(Decorated::constant)).interval)
            });
            assert_eq!(enclosure.interval, hull, "{}", show(operation, operands));
        }
        assert!(compared > CASES / 20, "{operation:?}: only {compared} boxes");
    }
}

/// Both ends, and zero if it is inside.
fn corners(operand: Decorated) -> [Interval; 3] {
    let Interval { lo, hi } = operand.interval;
    [lo, hi, if operand.interval.contains_zero() { 0.0 } else { lo }].map(Interval::point)
}

#[test]
fn waves_reach_their_extremes_just_where_these_are_inside() {
    let mut random = Random::new(0x3a5e);
    for _ in 0..200_000 {
        let turns = random.between(-1e4, 1e4).floor();
        let (shift, operation) = random.choose(&[(0.0, Operation::Cos), (FRAC_PI_2, Operation::Sin)]);
        // Within 1e-11 of the extreme at (turns + shift/π)·π; the boxes end at least 1e-9 away from it.
        let extreme = turns * PI + shift;
        let (near, far) = (random.between(1e-9, 0.5), random.between(0.5, 2.5));
        let reached = if turns.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        let enclosure = |lo, hi| extend(operation, [Decorated::argument(lo, hi); 3]).interval;
        let beyond = Interval::point(reached);
        let held = enclosure(extreme - far, extreme + near);
        assert!(beyond.is_subset_of(held), "{operation:?} past {extreme}: {held}");
        let (below, above) =
            (enclosure(extreme - far, extreme - near), enclosure(extreme + near, extreme + far));
        let limit = core_math::cos(near) + 1e-9;
        for missed in [below, above] {
            let most = if reached > 0.0 { missed.hi } else { -missed.lo };
            assert!(most <= limit.min(1.0), "{operation:?} beside {extreme} by {near}: {missed}");
        }
    }
}

#[test]
fn nothing_is_known_of_what_is_made_from_the_unknown() {
    for operation in Operation::all() {
        let mut random = Random::new(0xdec0 + operation.index() as u64);
        for _ in 0..CASES / 10 {
            let operands = random_box(&mut random, operation);
            // The choice by a condition looks at one branch only, and the exponent of a power is a constant.
            let counts = match operation {
                Operation::Select | Operation::IntegerPower => 1,
                operation => operation.arity(),
            };
            for place in 0..counts {
                let mut weakened = operands;
                weakened[place].decoration = Decoration::Trivial;
                let enclosure = extend(operation, weakened);
                assert_eq!(enclosure.decoration, Decoration::Trivial, "{}", show(operation, weakened));
                assert_eq!(enclosure.interval, extend(operation, operands).interval);
            }
        }
    }
}

#[test]
fn made_intervals_have_zeros_that_point_inwards() {
    for operation in Operation::all() {
        let mut random = Random::new(0x2e40 + operation.index() as u64);
        for _ in 0..CASES {
            let operands = random_box(&mut random, operation);
            let Interval { lo, hi } = extend(operation, operands).interval;
            let points_inwards = (lo != 0.0 || lo.is_sign_positive()) && (hi != 0.0 || hi.is_sign_negative());
            assert!(points_inwards, "{} = [{lo:?}, {hi:?}]", show(operation, operands));
        }
    }
}

#[test]
fn zeros_that_point_outwards_do_no_harm() {
    let turn = |end: f64| if end == 0.0 { -end } else { end };
    for operation in Operation::all() {
        let mut random = Random::new(0x0127 + operation.index() as u64);
        for _ in 0..CASES {
            let operands = random_box(&mut random, operation);
            let turned = operands.map(|Decorated { interval: Interval { lo, hi }, decoration }| Decorated {
                interval: Interval { lo: turn(lo), hi: turn(hi) },
                decoration,
            });
            let (expected, found) = (extend(operation, operands), extend(operation, turned));
            let Interval { lo, hi } = expected.interval;
            let widest = Interval { lo: lo.next_down(), hi: hi.next_up() };
            let is_sound =
                expected.interval.is_subset_of(found.interval) && found.interval.is_subset_of(widest);
            assert!(is_sound, "{} = {expected}, found {found}", show(operation, operands));
            assert_eq!(expected.decoration, found.decoration, "{}", show(operation, operands));
        }
    }
}
