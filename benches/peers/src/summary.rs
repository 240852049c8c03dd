//! The table of one size.

use iso_benches::samples::{Spread, rounded};
use iso_benches::surfaces::SUBJECTS;

use crate::comparison::{Comparison, JIT, Measured, VM};
use crate::iso::Width;
use crate::povray::PovRay;

/// How many of the first surfaces the geometric mean is taken over.
const USUAL: usize = 8;

/// What is compared: a peer and this project.
const RATIOS: [&str; 3] = ["the better fidget / iso", "the better fidget / iso, 1e-12", "POV-Ray / iso"];

/// Prints rows as they come, and remembers the ratios for the last lines.
#[derive(Default)]
pub struct Summary {
    usual: Vec<[Option<f64>; RATIOS.len()]>,
}

impl Summary {
    /// Prints what the columns are.
    pub fn print_heading(&self, size: u32) {
        println!(
            "\n{size}x{size}, depth and normals. Milliseconds and ratios: median [quartiles]. Depth errors: mean / \
             largest in pixel widths, and silhouette pixels that differ.\n"
        );
        println!(
            "{:<11}{:>24}{:>24}{:>24}{:>24}{:>10}{:>26}{:>26}{:>15}{:>26}{:>26}{:>26}{:>26}  hit / touch / undecided",
            "surface",
            Width::Pixels.name(),
            Width::Narrow.name(),
            VM,
            JIT,
            "POV-Ray",
            "best fidget / iso",
            "best fidget / 1e-12",
            "POV-Ray / iso",
            "iso off by",
            "fidget VM off by",
            "fidget JIT off by",
            "POV-Ray off by"
        );
    }

    /// Prints one surface.
    pub fn add(&mut self, comparison: &Comparison) {
        let [iso, narrow] = [Width::Pixels, Width::Narrow].map(|width| comparison.program(width.name()));
        let [vm, jit, povray] = [VM, JIT, PovRay::NAME].map(|name| comparison.program(name));
        let [fidget, fidget_to_narrow] = [iso, narrow].map(|iso| ratio(comparison.better_fidget(), iso));
        let pov = ratio(povray, iso);
        let median = |spread: Option<Spread>| spread.map(|spread| spread.median);
        if SUBJECTS[..USUAL].iter().any(|subject| subject.name == comparison.surface) {
            self.usual.push([fidget, fidget_to_narrow, pov].map(median));
        }
        let [iso_time, narrow_time, vm_time, jit_time] = [iso, narrow, vm, jit].map(milliseconds);
        let pov_time = povray.map(|measured| rounded(1e3 * measured.seconds.spread().median, 3));
        let pixel = comparison.view.pixel();
        let [iso_error, vm_error, jit_error, pov_error] =
            [iso, vm, jit, povray].map(|measured| error(measured, pixel));
        let [fidget, fidget_to_narrow] =
            [fidget, fidget_to_narrow].map(|spread| spread.map_or_else(absent, |spread| spread.to_string()));
        let counts = comparison.counts;
        println!(
            "{:<11}{iso_time:>24}{narrow_time:>24}{vm_time:>24}{jit_time:>24}{:>10}{fidget:>26}{fidget_to_narrow:>26}{:>15}\
             {iso_error:>26}{vm_error:>26}{jit_error:>26}{pov_error:>26}  {} / {} / {}",
            comparison.surface,
            pov_time.unwrap_or_else(absent),
            pov.map_or_else(absent, |spread| rounded(spread.median, 3)),
            counts.hit,
            counts.touch,
            counts.undecided
        );
    }

    /// Prints the geometric means over the usual surfaces, and the least ratios.
    pub fn print_end(&self) {
        for (place, compared) in RATIOS.into_iter().enumerate() {
            let ratios: Vec<f64> = self.usual.iter().filter_map(|ratios| ratios[place]).collect();
            if !ratios.is_empty() {
                let logarithms: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
                let mean = (logarithms / ratios.len() as f64).exp();
                let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
                println!(
                    "{compared}: geometric mean over {} of the usual surfaces {}, least {}",
                    ratios.len(),
                    rounded(mean, 3),
                    rounded(least, 3)
                );
            }
        }
    }
}

fn absent() -> String {
    "-".to_owned()
}

fn ratio(a: Option<&Measured>, b: Option<&Measured>) -> Option<Spread> {
    Some(a?.seconds.over(&b?.seconds).spread())
}

fn milliseconds(measured: Option<&Measured>) -> String {
    let milliseconds = |measured: &Measured| {
        let Spread { lower, median, upper } = measured.seconds.spread();
        Spread { lower: 1e3 * lower, median: 1e3 * median, upper: 1e3 * upper }.to_string()
    };
    measured.map_or_else(absent, milliseconds)
}

fn error(measured: Option<&Measured>, pixel: f64) -> String {
    measured.map_or_else(absent, |measured| {
        let [mean, largest] =
            [measured.error.mean, measured.error.largest].map(|length| format!("{:.2e}", length / pixel));
        format!("{mean} / {largest}, {}", measured.error.mismatches)
    })
}
