//! What holds of any program at any points: native code gives the interpreter's values, bit for bit.

use iso_expr::random::Random;
use iso_expr::{Engine, Interpreter, Program, Scratch};
use iso_jit::Jit;

/// The bits, any NaN counting as one.
pub(crate) fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| if value.is_nan() { f64::NAN } else { *value }.to_bits()).collect()
}

/// Native code gives the interpreter's values: the point kernel at each of `points`, the batch kernel at all of them at once.
pub(crate) fn values_agree(jit: &Jit, program: &Program, points: &[[f64; 3]]) {
    let interpreter = Interpreter;
    let mut scratch = Scratch::default();
    let outputs = program.outputs().len();

    let (native, reference) = (jit.point(program).unwrap(), interpreter.point(program).unwrap());
    let mut expected = Vec::new();
    for point @ [x, y, z] in points {
        let (mut value, mut right) = (vec![0.0; outputs], vec![0.0; outputs]);
        native.evaluate(&mut scratch, *x, *y, *z, &mut value);
        reference.evaluate(&mut scratch, *x, *y, *z, &mut right);
        assert_eq!(bits(&value), bits(&right), "{value:?} is not {right:?} at {point:?} in\n{program}");
        expected.push(right);
    }

    let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<_>>());
    let mut values = vec![0.0; outputs * points.len()];
    jit.batch(program).unwrap().evaluate(&mut scratch, &[&x, &y, &z], &mut values);
    for (place, right) in expected.iter().enumerate() {
        let value: Vec<_> = (0..outputs).map(|output| values[output * points.len() + place]).collect();
        let point = points[place];
        assert_eq!(
            bits(&value),
            bits(right),
            "{value:?} is not {right:?} at {point:?} in a batch of\n{program}"
        );
    }
}

/// Points with coordinates of every kind: ordinary, huge, tiny, subnormal, infinite, NaN, zeros.
pub(crate) fn points(random: &mut Random, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| [random.double(), random.double(), random.double()]).collect()
}
