//! The measured formulas as kernels compiled by rustc, once for 128-bit lanes and once for AVX-512.
//!
//! All loops run over slices, whose elements LLVM puts side by side in as wide registers as the named features have.

use std::arch::is_x86_feature_detected;
use std::sync::Arc;

use iso_expr::engine::Boxes;
use iso_expr::{Interval, PointKernel, Scratch};

use crate::{formulas, operations};

include!("measured.rs");

/// A function of three intervals with several results.
type Enclose<const OUTPUTS: usize> = fn(Interval, Interval, Interval) -> [Interval; OUTPUTS];

include!(concat!(env!("OUT_DIR"), "/straight_line.rs"));

/// A kernel over batches: as the engines' kernels are, but a function alone.
pub type Sweep = fn([&[f64]; 3], &mut [f64]);

/// A kernel over batches of points and directions.
pub type SlopeSweep = fn([&[f64]; 6], &mut [f64]);

/// A kernel over boxes, writing lower and upper ends.
pub type BoxSweep = fn(Boxes<'_>, lo: &mut [f64], hi: &mut [f64]);

/// A function of a point as a kernel.
struct Point<F>(F);

impl<F: Fn(f64, f64, f64) -> f64 + Send + Sync> PointKernel for Point<F> {
    fn evaluate(&self, _: &mut Scratch, x: f64, y: f64, z: f64, values: &mut [f64]) {
        let [value] = values else { panic!("one output") };
        *value = (self.0)(x, y, z);
    }
}

/// What rustc makes of one formula.
pub struct Native {
    /// The formula's name.
    pub name: &'static str,
    /// F at a point.
    pub value: fn(f64, f64, f64) -> f64,
    /// The same behind the trait that the engines' kernels are called through.
    pub point: fn() -> Arc<dyn PointKernel>,
    /// F over a batch, in 128-bit lanes.
    pub values: Sweep,
    /// F and its slope along a direction over a batch, in 128-bit lanes.
    pub slopes: SlopeSweep,
    /// F and its gradient over a batch, in 128-bit lanes.
    pub gradients: Sweep,
    /// F over a batch, in 512-bit lanes; only to be called where [`has_avx512`].
    pub wide_values: Sweep,
    /// F and its slope along a direction over a batch, in 512-bit lanes; only to be called where [`has_avx512`].
    pub wide_slopes: SlopeSweep,
    /// F and its gradient over a batch, in 512-bit lanes; only to be called where [`has_avx512`].
    pub wide_gradients: Sweep,
    /// F over boxes, without decorations. `None` when Rust's intervals lack an operation.
    pub boxes: Option<BoxSweep>,
    /// F and its gradient over boxes, without decorations. `None` when Rust's intervals lack an operation.
    pub gradient_boxes: Option<BoxSweep>,
}

/// Whether this processor runs the kernels in 512-bit lanes.
pub fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

/// Loops over slices for processors with these features.
macro_rules! sweeps {
    ($features:literal, $value:path, $slope:path, $gradient:path) => {
        #[target_feature(enable = $features)]
        fn sweep_values(x: &[f64], y: &[f64], z: &[f64], values: &mut [f64]) {
            let count = x.len();
            let (y, z, values) = (&y[..count], &z[..count], &mut values[..count]);
            for point in 0..count {
                values[point] = $value(x[point], y[point], z[point]);
            }
        }

        #[target_feature(enable = $features)]
        fn sweep_slopes(
            [x, y, z]: [&[f64]; 3],
            [dx, dy, dz]: [&[f64]; 3],
            values: &mut [f64],
            slopes: &mut [f64],
        ) {
            let count = x.len();
            let (y, z, dx, dy, dz) = (&y[..count], &z[..count], &dx[..count], &dy[..count], &dz[..count]);
            let (values, slopes) = (&mut values[..count], &mut slopes[..count]);
            for point in 0..count {
                [values[point], slopes[point]] =
                    $slope(x[point], y[point], z[point], dx[point], dy[point], dz[point]);
            }
        }

        #[target_feature(enable = $features)]
        fn sweep_gradients(
            x: &[f64],
            y: &[f64],
            z: &[f64],
            values: &mut [f64],
            along_x: &mut [f64],
            along_y: &mut [f64],
            along_z: &mut [f64],
        ) {
            let count = x.len();
            let (y, z, values) = (&y[..count], &z[..count], &mut values[..count]);
            let (along_x, along_y, along_z) =
                (&mut along_x[..count], &mut along_y[..count], &mut along_z[..count]);
            for point in 0..count {
                [values[point], along_x[point], along_y[point], along_z[point]] =
                    $gradient(x[point], y[point], z[point]);
            }
        }

        pub(crate) fn values([x, y, z]: [&[f64]; 3], values: &mut [f64]) {
            // SAFETY: `Native` says which processors the function may be called on: those with the features.
            unsafe { sweep_values(x, y, z, values) }
        }

        pub(crate) fn slopes([x, y, z, dx, dy, dz]: [&[f64]; 6], values: &mut [f64]) {
            let (values, slopes) = values.split_at_mut(x.len());
            // SAFETY: `Native` says which processors the function may be called on: those with the features.
            unsafe { sweep_slopes([x, y, z], [dx, dy, dz], values, slopes) }
        }

        pub(crate) fn gradients([x, y, z]: [&[f64]; 3], values: &mut [f64]) {
            let count = x.len();
            let (values, rest) = values.split_at_mut(count);
            let (along_x, rest) = rest.split_at_mut(count);
            let (along_y, along_z) = rest.split_at_mut(count);
            // SAFETY: `Native` says which processors the function may be called on: those with the features.
            unsafe { sweep_gradients(x, y, z, values, along_x, along_y, along_z) }
        }
    };
}

macro_rules! natives {
    ($($name:ident, $slope:ident, $gradient:ident, $boxes:ident, $gradient_boxes:ident;)*) => {
        $(mod $name {
            use super::*;

            #[inline(never)]
            pub(super) fn value(x: f64, y: f64, z: f64) -> f64 {
                formulas::$name(x, y, z)
            }

            pub(super) mod narrow {
                use super::*;
                sweeps!("sse4.2", formulas::$name, $slope, $gradient);
            }

            pub(super) mod wide {
                use super::*;
                sweeps!("avx512f,avx512dq", formulas::$name, $slope, $gradient);
            }

            pub(super) fn boxes(boxes: Boxes<'_>, lo: &mut [f64], hi: &mut [f64]) {
                sweep_boxes($boxes.expect("only offered when there"), boxes, lo, hi);
            }

            pub(super) fn gradient_boxes(boxes: Boxes<'_>, lo: &mut [f64], hi: &mut [f64]) {
                sweep_boxes($gradient_boxes.expect("only offered when there"), boxes, lo, hi);
            }
        })*

        /// Every measured formula.
        pub const NATIVES: [Native; MEASURED.len()] = [$(Native {
            name: stringify!($name),
            value: $name::value,
            point: || Arc::new(Point(formulas::$name)),
            values: $name::narrow::values,
            slopes: $name::narrow::slopes,
            gradients: $name::narrow::gradients,
            wide_values: $name::wide::values,
            wide_slopes: $name::wide::slopes,
            wide_gradients: $name::wide::gradients,
            boxes: if $boxes.is_some() { Some($name::boxes) } else { None },
            gradient_boxes: if $gradient_boxes.is_some() { Some($name::gradient_boxes) } else { None },
        }),*];
    };
}

natives! {
    paper, paper_slope, paper_gradient, PAPER_BOX, PAPER_BOX_GRADIENT;
    tanglecube, tanglecube_slope, tanglecube_gradient, TANGLECUBE_BOX, TANGLECUBE_BOX_GRADIENT;
    heart, heart_slope, heart_gradient, HEART_BOX, HEART_BOX_GRADIENT;
    barth, barth_slope, barth_gradient, BARTH_BOX, BARTH_BOX_GRADIENT;
    gyroid, gyroid_slope, gyroid_gradient, GYROID_BOX, GYROID_BOX_GRADIENT;
    metaballs, metaballs_slope, metaballs_gradient, METABALLS_BOX, METABALLS_BOX_GRADIENT;
}

/// Applies a function of intervals to every box.
#[inline(always)]
fn sweep_boxes<const OUTPUTS: usize>(
    enclose: Enclose<OUTPUTS>,
    boxes: Boxes<'_>,
    lo: &mut [f64],
    hi: &mut [f64],
) {
    let count = boxes.lo[0].len();
    for place in 0..count {
        let [x, y, z] =
            [0, 1, 2].map(|axis| Interval { lo: boxes.lo[axis][place], hi: boxes.hi[axis][place] });
        for (output, enclosure) in enclose(x, y, z).into_iter().enumerate() {
            (lo[output * count + place], hi[output * count + place]) = (enclosure.lo, enclosure.hi);
        }
    }
}
