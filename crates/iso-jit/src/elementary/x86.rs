//! The functions, compiled for processors with certain features.

use std::arch::x86_64::{__m128d, __m512d, __m512i, _mm512_permutex2var_pd};
use std::mem::transmute;

use iso_expr::Operation;

use super::{
    Approximation, Bounds, Column, ENTRIES, InPlace, InPlaceOfBoth, Table, WIDTH, cube_root, exponential,
    logarithm, scalar, sine,
};

/// The versions of a function that this processor runs, the fastest first.
fn run_here<F>(avx512: Option<F>, avx2: Option<F>) -> impl Iterator<Item = F> {
    let has_avx512 = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
    let has_avx2 = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    avx512.filter(|_| has_avx512).into_iter().chain(avx2.filter(|_| has_avx2))
}

/// The versions of [`function`](super::function).
pub(super) fn versions(operation: Operation) -> impl Iterator<Item = InPlace> {
    run_here(avx512::function(operation), avx2::function(operation))
}

/// The versions of [`sines_and_cosines`](super::sines_and_cosines).
pub(super) fn of_both() -> impl Iterator<Item = InPlace> {
    run_here(Some(avx512::sines_and_cosines as InPlace), Some(avx2::sines_and_cosines))
}

/// The versions of [`both_of_eight`](super::both_of_eight).
pub(super) fn of_both_of_eight() -> impl Iterator<Item = InPlaceOfBoth> {
    run_here(Some(avx512::both_of_eight as InPlaceOfBoth), Some(avx2::both_of_eight))
}

/// A module for processors with certain features, and the way in which they look up tables.
macro_rules! compiled_for {
    ($module:ident, $features:literal, $look_up:ident) => {
        mod $module {
            use super::*;

            pub(super) fn function(operation: Operation) -> Option<InPlace> {
                match operation {
                    Operation::CubeRoot => Some(cbrt),
                    Operation::Exp => Some(exp),
                    Operation::Ln => Some(ln),
                    Operation::Sin => Some(sin),
                    Operation::Cos => Some(cos),
                    _ => None,
                }
            }

            #[target_feature(enable = $features)]
            extern "C" fn cbrt(places: &mut [f64; WIDTH]) {
                tabled(places, &cube_root::ROOTS, cube_root::index, cube_root::cbrt, Operation::CubeRoot);
            }

            #[target_feature(enable = $features)]
            extern "C" fn exp(places: &mut [f64; WIDTH]) {
                tabled(places, &exponential::POWERS, exponential::index, exponential::exp, Operation::Exp);
            }

            #[target_feature(enable = $features)]
            extern "C" fn ln(places: &mut [f64; WIDTH]) {
                tabled(places, &logarithm::LOGARITHMS, logarithm::index, logarithm::ln, Operation::Ln);
            }

            /// The function of one operation, approximated from an argument and its entry.
            #[target_feature(enable = $features)]
            #[inline]
            fn tabled<const COLUMNS: usize>(
                places: &mut [f64; WIDTH],
                table: &Table<COLUMNS>,
                index: impl Fn(f64) -> u64,
                approximate: impl Fn(f64, [f64; COLUMNS]) -> Approximation,
                operation: Operation,
            ) {
                let look_up = |column: &Column, indices: &[u64; WIDTH]| $look_up(column, indices);
                round(places, table, index, look_up, |_, x, entry| approximate(x, entry), [operation; 2]);
            }

            #[target_feature(enable = $features)]
            extern "C" fn sin(places: &mut [f64; WIDTH]) {
                waves(places, |_| 0, [Operation::Sin; 2]);
            }

            #[target_feature(enable = $features)]
            extern "C" fn cos(places: &mut [f64; WIDTH]) {
                waves(places, |_| 1, [Operation::Cos; 2]);
            }

            #[target_feature(enable = $features)]
            pub(super) extern "C" fn sines_and_cosines(places: &mut [f64; WIDTH]) {
                let quarters = |lane| u64::from(lane >= WIDTH / 2);
                waves(places, quarters, [Operation::Sin, Operation::Cos]);
            }

            /// Sines so many quarters of a turn further.
            #[target_feature(enable = $features)]
            #[inline]
            fn waves(places: &mut [f64; WIDTH], quarters: impl Fn(usize) -> u64, operations: [Operation; 2]) {
                let look_up = |column: &Column, indices: &[u64; WIDTH]| $look_up(column, indices);
                let approximate = |lane, x, entry| sine::sin(x, entry, quarters(lane));
                round(places, &sine::WAVE, sine::index, look_up, approximate, operations);
            }

            #[target_feature(enable = $features)]
            pub(super) extern "C" fn both_of_eight([sines, cosines]: &mut [[f64; WIDTH]; 2]) {
                let arguments = in_pairs(sines);
                let look_up = |column: &Column, indices: &[u64; WIDTH]| $look_up(column, indices);
                let entries = sine::WAVE.entries(&arguments, sine::index, look_up);
                let (mut of_sines, mut of_cosines) = ([[0.0; WIDTH]; 2], [[0.0; WIDTH]; 2]);
                for (lane, argument) in arguments.iter().enumerate() {
                    let [sine, cosine] =
                        sine::sin_and_cos(*argument, std::array::from_fn(|column| entries[column][lane]));
                    sine.bound(lane, &mut of_sines);
                    cosine.bound(lane, &mut of_cosines);
                }
                *cosines = arguments;
                decide(sines, &of_sines, [Operation::Sin; 2]);
                decide(cosines, &of_cosines, [Operation::Cos; 2]);
            }
        }
    };
}

compiled_for!(avx512, "avx512f,avx512dq", permuted);
compiled_for!(avx2, "avx2,fma", indexed);

/// Approximates where that decides the rounding, else calls the operations. The approximation is made from the lane, the argument and
/// the entry that `index` names for it.
#[inline(always)]
fn round<const COLUMNS: usize>(
    places: &mut [f64; WIDTH],
    table: &Table<COLUMNS>,
    index: impl Fn(f64) -> u64,
    look_up: impl Fn(&Column, &[u64; WIDTH]) -> [f64; WIDTH],
    approximate: impl Fn(usize, f64, [f64; COLUMNS]) -> Approximation,
    operations: [Operation; 2],
) {
    let arguments = in_pairs(places);
    let entries = table.entries(&arguments, index, look_up);
    let mut bounds = [[0.0; WIDTH]; 2];
    for (lane, argument) in arguments.iter().enumerate() {
        let entry = std::array::from_fn(|column| entries[column][lane]);
        approximate(lane, *argument, entry).bound(lane, &mut bounds);
    }
    decide(places, &bounds, operations);
}

/// Replaces arguments by what the bounds in a lane are where they are the same, else by what the operations give, one for the lower
/// and one for the upper lanes.
#[inline(always)]
fn decide(places: &mut [f64; WIDTH], bounds: &Bounds, operations: [Operation; 2]) {
    let [least, most] = bounds;
    // Not searched, for this is one comparison of all lanes.
    if (0..WIDTH).fold(false, |is_open, lane| is_open | (least[lane] != most[lane])) {
        call(places, bounds, operations);
    } else {
        *places = *least;
    }
}

/// Apart, for otherwise all lanes would be taken out of their register before it is known whether that is needed.
#[cold]
#[inline(never)]
fn call(places: &mut [f64; WIDTH], [least, most]: &Bounds, operations: [Operation; 2]) {
    let functions = operations.map(scalar);
    for (lane, place) in places.iter_mut().enumerate() {
        // An unknown value is not even equal to itself.
        let is_open = least[lane] != most[lane];
        *place = if is_open { functions[lane * 2 / WIDTH](*place) } else { least[lane] };
    }
}

/// Looks all lanes up at once, in registers.
#[target_feature(enable = "avx512f,avx512dq")]
#[inline]
fn permuted(column: &Column, indices: &[u64; WIDTH]) -> [f64; WIDTH] {
    // SAFETY: these are the same bytes.
    let ([low, high], indices) =
        unsafe { (transmute::<Column, [__m512d; 2]>(*column), transmute::<[u64; WIDTH], __m512i>(*indices)) };
    // SAFETY: these are too. Only the lowest four bits of an index count.
    unsafe { transmute(_mm512_permutex2var_pd(low, indices, high)) }
}

/// Looks up lane by lane, in memory.
#[inline(always)]
fn indexed(column: &Column, indices: &[u64; WIDTH]) -> [f64; WIDTH] {
    std::array::from_fn(|lane| column[indices[lane] as usize % ENTRIES])
}

/// The arguments, loaded pair by pair, as kernels write them: the processor forwards no wider load from narrower stores, which
/// takes as long as the function itself. Volatile, for otherwise the compiler makes one load of them.
#[inline(always)]
fn in_pairs(places: &[f64; WIDTH]) -> [f64; WIDTH] {
    /// Where doubles may be.
    #[derive(Clone, Copy)]
    #[repr(C, packed(8))]
    struct Pair(__m128d);
    let pairs = places.as_ptr().cast::<Pair>();
    // SAFETY: eight doubles are four pairs of them.
    unsafe { transmute([0, 1, 2, 3].map(|pair| pairs.add(pair).read_volatile())) }
}
