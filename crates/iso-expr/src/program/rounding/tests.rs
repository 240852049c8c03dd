use crate::engine::{Boxes, Enclosures};
use crate::program::tests::twofold::{ARITHMETIC, Twofold, exact};
use crate::random::Random;
use crate::{
    Ast, Axis, BoxKernel, Decorated, Decoration, Engine, Interpreter, Interval, Operation, Program, Scratch,
};

/// What a kernel of so many outputs says over a box.
pub(in crate::program) fn enclose(
    kernel: &dyn BoxKernel,
    count: usize,
    sides: [Interval; 3],
) -> Vec<Decorated> {
    let (lo, hi) = (sides.map(|side| [side.lo]), sides.map(|side| [side.hi]));
    let (mut low, mut high, mut decoration) =
        (vec![0.0; count], vec![0.0; count], vec![Decoration::Trivial; count]);
    kernel.evaluate(
        &mut Scratch::default(),
        Boxes { lo: lo.each_ref().map(|end| &end[..]), hi: hi.each_ref().map(|end| &end[..]) },
        Enclosures { lo: &mut low, hi: &mut high, decoration: &mut decoration },
    );
    let found = |place: usize| Decorated {
        interval: Interval { lo: low[place], hi: high[place] },
        decoration: decoration[place],
    };
    (0..count).map(found).collect()
}

fn program(formula: &str) -> Program {
    Ast::parse(formula).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
}

/// The bound over a box; `None` where there is none.
fn bound(program: &Program, sides: [Interval; 3]) -> Option<f64> {
    let kernel = Interpreter.boxes(&program.with_rounding()).unwrap();
    let outputs = enclose(&*kernel, 5, sides);
    let is_known = outputs[0].decoration == Decoration::Common
        && outputs.iter().all(|output| output.decoration >= Decoration::Defined);
    let bound = outputs[1].interval.hi * Program::ROUNDING_UNIT * Program::ROUNDING_SLACK;
    (is_known && bound.is_finite()).then_some(bound)
}

/// How large a part of the bound the rounding at some points is, at most.
fn check(program: &Program, sides: [Interval; 3], random: &mut Random) -> Option<f64> {
    let bound = bound(program, sides)?;
    let mut largest: f64 = 0.0;
    for _ in 0..30 {
        let point = sides.map(|side| random.between(side.lo, side.hi));
        let Twofold(exact, rest) = exact(program, point)[0];
        if exact.is_nan() {
            continue; // Products of doubles near the largest are too large for two.
        }
        let error = ((program.evaluate(point)[0] - exact) - rest).abs();
        assert!(error <= bound, "off by {error}, not {bound}, at {point:?} of\n{program}");
        if bound > 0.0 {
            largest = largest.max(error / bound);
        }
    }
    Some(largest)
}

fn sides(random: &mut Random, width: f64) -> [Interval; 3] {
    [(); 3].map(|()| {
        let lo = random.between(-3.0, 3.0);
        Interval { lo, hi: lo + width }
    })
}

#[test]
fn no_rounding_is_larger_than_the_bound() {
    let mut random = Random::new(7);
    let mut compared = 0;
    for round in 0..4000 {
        let program = random.program_of(1 + round % 25, &ARITHMETIC);
        let program = if program.outputs().len() == 1 { program } else { continue };
        let sides = sides(&mut random, [0.0, 1e-3, 0.1][round % 3]);
        compared += usize::from(check(&program, sides, &mut random).is_some());
    }
    assert!(compared > 1000, "only {compared} programs were compared");
}

#[test]
fn the_bound_of_one_operation_is_nearly_reached() {
    let mut random = Random::new(8);
    for operation in [Operation::Add, Operation::Subtract, Operation::Multiply, Operation::Divide] {
        let mut program = Program::new();
        let [x, y, _] = Axis::ALL.map(|axis| program.variable(axis));
        let output = program.apply(operation, &[x, y]);
        program.set_outputs(vec![output]);
        let shares = (0..40).filter_map(|_| {
            let sides = sides(&mut random, 1e-3);
            check(&program, sides, &mut random)
        });
        let largest = shares.fold(0.0, f64::max);
        assert!(largest > 0.6, "{operation:?} reaches {largest} of its bound");
    }
}

#[test]
fn every_operation_that_rounds_counts_with_its_size() {
    let mut random = Random::new(9);
    for operation in Operation::all().filter(|operation| *operation != Operation::IntegerPower) {
        let mut program = Program::new();
        let operands = Axis::ALL.map(|axis| program.variable(axis));
        let output = program.apply(operation, &operands[..operation.arity()]);
        program.set_outputs(vec![output]);
        for _ in 0..50 {
            let point = [(); 3].map(|()| random.between(0.1, 0.9));
            let value = program.evaluate(point)[0];
            let Some(bound) = bound(&program, point.map(Interval::point)) else { continue };
            // Only what picks an operand or gives an integer may be free of rounding.
            let is_exact = value == value.round() || point.contains(&value) || point.contains(&-value);
            let counts = bound >= Program::ROUNDING_UNIT * value.abs();
            assert!(
                counts || is_exact && bound == 0.0,
                "{operation:?} at {point:?} is off by {bound} at most"
            );
        }
    }
}

#[test]
fn a_constant_that_is_no_double_counts_with_what_it_is_off() {
    let mut program = Program::new();
    let pi = program.constant(crate::Constant::PI);
    program.set_outputs(vec![pi]);
    let bound = bound(&program, [Interval::point(0.0); 3]).unwrap();
    // π − its double.
    assert!((1.2246467991473532e-16..1e-15).contains(&bound), "{bound}");
}

/// Exponentials over a wide box are of very different sizes, but what rounds them and sums of some of them changes the logarithm of their
/// sum by no more than a unit each.
#[test]
fn the_rounding_of_smooth_minima_does_not_grow_with_the_box() {
    let mut random = Random::new(10);
    for formula in ["-ln(exp(-60x) + exp(-60y))/60", "-ln(exp(-60x) + exp(-60y) + exp(-60z))/60"] {
        let program = program(formula);
        let of_box = bound(&program, [Interval { lo: 0.25, hi: 1.0 }; 3]).unwrap();
        // Each exponent is off by 60 units, which is 1 of the result; the rest is of size 1 or 1/60.
        assert!(of_box < 7.0 * Program::ROUNDING_UNIT, "{of_box} of {formula}");
        for _ in 0..200 {
            let point = [(); 3].map(|()| random.between(0.25, 1.0));
            let of_point = bound(&program, point.map(Interval::point)).unwrap();
            assert!(of_point <= of_box, "{of_point} at {point:?}");
        }
        // There all exponentials are next to the least number, and off by about as much as they are.
        let of_tiny = bound(&program, [Interval::point(12.4); 3]);
        assert!(of_tiny.is_none_or(|bound| bound > 1e-3), "{of_tiny:?} of {formula}");
    }
}

#[test]
fn a_constant_among_exponentials_counts_with_what_it_is_off() {
    // The difference is 0.9323846, but known to some thousandths only.
    let constant = "(1e13*pi - 31415926535897)";
    let width = Ast::parse(constant).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
    let width =
        enclose(&*Interpreter.boxes(&width).unwrap(), 1, [Interval::point(0.0); 3])[0].interval.width();
    assert!(width > 1e-3, "{width}");
    let bound = bound(&program(&format!("ln(exp(x) + {constant})")), [Interval::point(0.0); 3]).unwrap();
    assert!(bound >= width / 2.0, "{bound}");
}

/// Exponentials that are terms of a sum whose logarithm is taken, and are used elsewhere too, as often as it comes.
#[test]
fn derivatives_found_backwards_are_those_found_forwards() {
    let mut random = Random::new(11);
    let exponentials = ["exp(x)", "exp(y)", "exp(z)", "exp(x - 3)", "exp(y - 2)", "exp(z - 1)"];
    for terms in 2..=exponentials.len() {
        for _ in 0..100 {
            let mut combination = |count: usize| {
                let terms = (0..count).map(|_| {
                    let exponential = exponentials[random.below(exponentials.len())];
                    format!("{}*{exponential}", ["x", "y", "z", "x*y", "(x - z)", "2"][random.below(6)])
                });
                terms.collect::<Vec<_>>().join(" + ")
            };
            let sum = exponentials[..terms].join(" + ");
            let formula = format!("ln({sum})*({}) + ({})/({sum})", combination(3), combination(2));
            let program = program(&formula);
            let point = [(); 3].map(|()| random.between(-2.0, 2.0));
            let (forwards, backwards) = (program.with_gradient(), program.with_rounding());
            let (forwards, backwards) = (forwards.evaluate(point), backwards.evaluate(point));
            let size = forwards.iter().fold(1.0, |size: f64, value| size.max(value.abs()));
            for (forwards, backwards) in forwards[1..].iter().zip(&backwards[2..]) {
                assert!((forwards - backwards).abs() < 1e-11 * size, "{forwards}, {backwards}: {formula}");
            }
        }
    }
}

/// Each line takes the one before twice, and multiples of an exponential double with it.
#[test]
fn sums_shared_within_themselves_are_not_written_out() {
    let lines = (1..=60).map(|line| format!("s{line} := (s{} + z*exp(z)) + s{}; ", line - 1, line - 1));
    let formula =
        format!("s0 := exp(x) + exp(y); {}ln(exp(x) + exp(y) + exp(z))*s60", lines.collect::<String>());
    let program = program(&formula);
    for derived in [program.with_rounding(), program.with_gradient()] {
        assert!(derived.operations() < 3000, "{}", derived.operations());
    }
}
