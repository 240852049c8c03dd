//! What holds of any program over any boxes: native code, compiled or assembled, gives the interpreter's enclosures, ends bit for
//! bit and decorations.

use iso_expr::engine::{Boxes, Enclosures};
use iso_expr::random::Random;
use iso_expr::{BoxKernel, Decorated, Decoration, Engine, Interpreter, Program, Scratch};
use iso_jit::Jit;

/// The enclosures of so many outputs over all boxes, as bits, any NaN counting as one. Zeros at the ends of every other box have the sign that
/// no enclosure gives them: kernels take any.
fn enclosures(
    kernel: &dyn BoxKernel,
    outputs: usize,
    boxes: &[[Decorated; 3]],
) -> Vec<(u64, u64, Decoration)> {
    let ends = |end: fn(&Decorated) -> f64| {
        let turned = |(number, end): (usize, f64)| if end == 0.0 && number % 2 == 0 { -end } else { end };
        let along = |axis: usize| boxes.iter().map(move |ranges| end(&ranges[axis])).enumerate();
        [0, 1, 2].map(|axis| along(axis).map(turned).collect::<Vec<_>>())
    };
    let (lo, hi) = (ends(|range| range.interval.lo), ends(|range| range.interval.hi));
    let count = outputs * boxes.len();
    let (mut output_lo, mut output_hi) = (vec![7.0; count], vec![7.0; count]);
    let mut decoration = vec![Decoration::Defined; count];
    kernel.evaluate(
        &mut Scratch::default(),
        Boxes { lo: lo.each_ref().map(|ends| &ends[..]), hi: hi.each_ref().map(|ends| &ends[..]) },
        Enclosures { lo: &mut output_lo, hi: &mut output_hi, decoration: &mut decoration },
    );
    let bits = |value: f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
    let ends = output_lo.into_iter().zip(output_hi).map(|(lo, hi)| (bits(lo), bits(hi)));
    ends.zip(decoration).map(|((lo, hi), decoration)| (lo, hi, decoration)).collect()
}

/// Native code gives the interpreter's enclosures over `boxes`, and over those of them that are bounded and of moderate size, for
/// which the code is made; any other box in a batch leaves all of it to other code, and so does one of which too much was assumed,
/// wherefore those are also given a few at a time.
pub(crate) fn enclosures_agree(jit: &Jit, program: &Program, boxes: &[[Decorated; 3]]) {
    let is_moderate = |side: &Decorated| side.interval.magnitude() <= 65_536.0;
    let moderate: Vec<_> = boxes.iter().copied().filter(|sides| sides.iter().all(is_moderate)).collect();
    let interpreted = Interpreter.boxes(program).unwrap();
    for kernel in [jit.boxes(program).unwrap(), jit.for_few_runs().boxes(program).unwrap()] {
        for batch in [boxes, &moderate].into_iter().chain(moderate.chunks(1)).chain(moderate.chunks(3)) {
            all_agree(&*kernel, &*interpreted, program, batch);
        }
    }
}

fn all_agree(
    native: &dyn BoxKernel,
    interpreted: &dyn BoxKernel,
    program: &Program,
    boxes: &[[Decorated; 3]],
) {
    let [native, expected] =
        [native, interpreted].map(|kernel| enclosures(kernel, program.outputs().len(), boxes));
    for (place, (native, expected)) in native.iter().zip(&expected).enumerate() {
        let show = |(lo, hi, decoration): &(u64, u64, Decoration)| {
            format!("[{:e}, {:e}] {decoration:?}", f64::from_bits(*lo), f64::from_bits(*hi))
        };
        let ranges = boxes[place % boxes.len()];
        assert_eq!(
            native,
            expected,
            "{} is not {} over {ranges:?} in\n{program}",
            show(native),
            show(expected)
        );
    }
}

/// Boxes with sides of every kind.
pub(crate) fn boxes(random: &mut Random, count: usize) -> Vec<[Decorated; 3]> {
    (0..count).map(|_| [random.argument(), random.argument(), random.argument()]).collect()
}
