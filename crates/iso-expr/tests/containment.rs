//! Enclosures of random programs.

#[path = "properties/containment.rs"]
mod containment;

use containment::{enclose, enclosures_hold_values};
use iso_expr::random::Random;
use iso_expr::{Decorated, Scratch};

#[test]
fn enclosures_hold_the_values_at_points_of_their_boxes() {
    let mut random = Random::new(6);
    let mut scratch = Scratch::default();
    let mut checked = 0;
    for _ in 0..2000 {
        let operations = random.below(20);
        let program = random.program(operations).pruned();
        for program in [&program, &program.simplified(), &program.with_gradient()] {
            checked += enclosures_hold_values(&mut random, &mut scratch, program);
        }
    }
    assert!(checked > 20_000, "only {checked} values were finite");
}

#[test]
fn enclosures_do_not_depend_on_their_neighbours() {
    let mut random = Random::new(7);
    let mut scratch = Scratch::default();
    let bits = |enclosures: &[Decorated]| -> Vec<_> {
        let ends = |enclosure: &Decorated| [enclosure.interval.lo.to_bits(), enclosure.interval.hi.to_bits()];
        enclosures.iter().map(|enclosure| (ends(enclosure), enclosure.decoration)).collect()
    };
    for _ in 0..200 {
        let program = random.program(15).with_gradient();
        let boxes: Vec<_> = (0..9).map(|_| [(); 3].map(|()| random.argument().interval)).collect();
        let together = enclose(&program, &mut scratch, &boxes);
        for (sides, enclosures) in boxes.iter().zip(together) {
            let alone = enclose(&program, &mut scratch, &[*sides]);
            assert_eq!(bits(&enclosures), bits(&alone[0]), "over {sides:?} of\n{program}");
        }
    }
}
