//! Against the scalar functions, which are correctly rounded.

use iso_expr::Operation;
use iso_expr::random::Random;

use super::{Approximation, WIDTH, scalar, sine, x86};

type Approximate = fn(f64) -> Approximation;

const FUNCTIONS: [(Operation, Approximate); 2] = [(Operation::Sin, sine::sin), (Operation::Cos, sine::cos)];

/// An argument of any kind: spread over an interval or over magnitudes, next to a multiple of half the table's steps,
/// short, or special.
fn argument(random: &mut Random) -> f64 {
    let uniform = |random: &mut Random| random.below(1 << 53) as f64 / (1u64 << 53) as f64;
    match random.below(7) {
        0 => random.double(),
        1 => 60_000.0 * (uniform(random) - 0.5),
        2 => 2f64.powi(-(random.below(100) as i32)) * uniform(random),
        3 => {
            let multiple = std::f64::consts::PI / 256.0 * (random.below(4_000) as f64 - 2_000.0);
            multiple + 1e-9 * uniform(random)
        }
        4 => f64::from_bits(uniform(random).to_bits() & !0 << random.below(52)),
        _ => 20.0 * (uniform(random) - 0.5),
    }
}

/// The bits, any NaN counting as one.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

#[test]
fn eight_values_are_those_of_eight_calls() {
    let mut random = Random::new(1);
    for (operation, _) in FUNCTIONS {
        let function = scalar(operation);
        for _ in 0..250_000 {
            let arguments: [f64; WIDTH] = std::array::from_fn(|_| argument(&mut random));
            let expected = arguments.map(|a| bits(function(a)));
            for version in x86::versions(operation) {
                let mut values = arguments;
                // SAFETY: this processor runs the version.
                unsafe { version(&mut values) };
                assert_eq!(values.map(bits), expected, "{operation:?} of {arguments:?}");
            }
        }
    }
}

#[test]
fn both_functions_of_four_are_those_of_eight_calls() {
    let mut random = Random::new(3);
    let [sin, cos] = [Operation::Sin, Operation::Cos].map(scalar);
    for _ in 0..250_000 {
        let arguments: [f64; WIDTH] = std::array::from_fn(|_| argument(&mut random));
        let expected: [f64; WIDTH] =
            std::array::from_fn(
                |lane| if lane < 4 { sin(arguments[lane]) } else { cos(arguments[lane - 4]) },
            );
        for version in x86::of_both() {
            let mut values = arguments;
            // SAFETY: this processor runs the version.
            unsafe { version(&mut values) };
            assert_eq!(values.map(bits), expected.map(bits), "{arguments:?}");
        }
    }
}

#[test]
fn both_functions_of_eight_are_those_of_sixteen_calls() {
    let mut random = Random::new(4);
    let [sin, cos] = [Operation::Sin, Operation::Cos].map(scalar);
    for _ in 0..250_000 {
        let arguments: [f64; WIDTH] = std::array::from_fn(|_| argument(&mut random));
        let expected = [arguments.map(|a| bits(sin(a))), arguments.map(|a| bits(cos(a)))];
        for version in x86::of_both_of_eight() {
            let mut values = [arguments, [0.0; WIDTH]];
            // SAFETY: this processor runs the version.
            unsafe { version(&mut values) };
            assert_eq!(values.map(|values| values.map(bits)), expected, "{arguments:?}");
        }
    }
}

/// What is decided would be decided rightly with a quarter of the bounds too, so these are no close call; and most is decided.
#[test]
fn bounds_have_room_and_are_tight() {
    let mut random = Random::new(2);
    for (operation, approximate) in FUNCTIONS {
        let function = scalar(operation);
        let (mut covered, mut decided) = (0, 0);
        for _ in 0..2_000_000 {
            let a = argument(&mut random);
            let Approximation { hi, lo, error } = approximate(a);
            let [least, most] = [lo - error / 4.0, lo + error / 4.0].map(|lo| hi + lo);
            assert!(least != most || least == function(a), "{operation:?} of {a:e}: {hi:e} + {lo:e}");
            // Of tiny values and of those beyond the range less is known.
            if error < f64::INFINITY && hi.abs() > 1e-9 {
                covered += 1;
                decided += i32::from(hi + (lo - error) == hi + (lo + error));
            }
        }
        assert!(covered > 1_000_000, "{operation:?} covers {covered}");
        assert!(
            f64::from(decided) > 0.98 * f64::from(covered),
            "{operation:?}: {decided} of {covered} decided"
        );
    }
}
