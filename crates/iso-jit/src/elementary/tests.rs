//! Against the scalar functions, which are correctly rounded.

use std::f64::consts::{LN_2, PI};

use iso_expr::Operation;
use iso_expr::random::Random;

use super::{Approximation, ENTRIES, Table, WIDTH, cube_root, exponential, logarithm, scalar, sine, x86};

type Approximate = fn(f64) -> Approximation;

const FUNCTIONS: [(Operation, Approximate); 5] = [
    (Operation::CubeRoot, |x| cube_root::cbrt(x, entry(&cube_root::ROOTS, cube_root::index(x)))),
    (Operation::Exp, |x| exponential::exp(x, entry(&exponential::POWERS, exponential::index(x)))),
    (Operation::Ln, |x| logarithm::ln(x, entry(&logarithm::LOGARITHMS, logarithm::index(x)))),
    (Operation::Sin, |x| sine::sin(x, entry(&sine::WAVE, sine::index(x)), 0)),
    (Operation::Cos, |x| sine::sin(x, entry(&sine::WAVE, sine::index(x)), 1)),
];

/// The entry with this index.
fn entry<const COLUMNS: usize>(table: &Table<COLUMNS>, index: u64) -> [f64; COLUMNS] {
    table.columns.map(|column| column[index as usize % ENTRIES])
}

/// Where exponentials begin to underflow, to be subnormal, to be approximated, not to be, and to overflow.
const BORDERS: [f64; 6] = [-746.0, -745.13, -708.4, -690.0, 690.0, 709.78];

/// An argument of any kind: spread over an interval or over magnitudes, next to a multiple of half the tables' steps,
/// next to a border or to one, short, or special.
fn argument(random: &mut Random) -> f64 {
    let uniform = |random: &mut Random| random.below(1 << 53) as f64 / (1u64 << 53) as f64;
    match random.below(10) {
        0 => random.double(),
        1 => 60_000.0 * (uniform(random) - 0.5),
        2 => 2f64.powi(-(random.below(100) as i32)) * uniform(random),
        3 => {
            let step = [PI / 64.0, LN_2 / 32.0][random.below(2)];
            step * (random.below(4_000) as f64 - 2_000.0) + 1e-9 * uniform(random)
        }
        4 => f64::from_bits(uniform(random).to_bits() & !0 << random.below(52)),
        5 => BORDERS[random.below(BORDERS.len())] + 0.1 * (uniform(random) - 0.5),
        6 => 1.0 + 2f64.powi(-(random.below(60) as i32)) * (uniform(random) - 0.5),
        7 => f64::from_bits(uniform(random).to_bits() + ((random.below(1000) as u64) << 52)),
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
fn sines_beside_cosines_are_those_of_eight_calls() {
    let mut random = Random::new(3);
    let [sin, cos] = [Operation::Sin, Operation::Cos].map(scalar);
    for _ in 0..250_000 {
        let arguments: [f64; WIDTH] = std::array::from_fn(|_| argument(&mut random));
        let expected: [f64; WIDTH] = std::array::from_fn(|lane| [sin, cos][lane / 4](arguments[lane]));
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
