//! The table of one size.

use iso_benches::samples::{Spread, rounded};
use iso_benches::surfaces::SUBJECTS;

use crate::comparison::{Comparison, JIT, Measured, VM};
use crate::iso::Iso;
use crate::povray::PovRay;

/// How many of the first surfaces the geometric mean is taken over.
const USUAL: usize = 8;

/// Prints rows as they come, and remembers the ratios for the last line.
#[derive(Default)]
pub struct Summary {
    usual: Vec<[Option<f64>; 2]>,
}

impl Summary {
    /// Prints what the columns are.
    pub fn print_heading(&self, size: u32) {
        println!(
            "\n{size}x{size}, depth and normals. Milliseconds and ratios: median [quartiles]. Depth errors: mean / \
             largest in pixel widths, and silhouette pixels that differ.\n"
        );
        println!(
            "{:<11}{:>24}{:>24}{:>24}{:>10}{:>26}{:>15}{:>26}{:>26}{:>26}  hit / touch / undecided",
            "surface",
            "iso",
            VM,
            JIT,
            "POV-Ray",
            "best fidget / iso",
            "POV-Ray / iso",
            "fidget VM off by",
            "fidget JIT off by",
            "POV-Ray off by"
        );
    }

    /// Prints one surface.
    pub fn add(&mut self, comparison: &Comparison) {
        let [iso, vm, jit, povray] = [Iso::NAME, VM, JIT, PovRay::NAME].map(|name| comparison.program(name));
        let fidget = ratio(comparison.better_fidget(), iso);
        let pov = ratio(povray, iso);
        let median = |spread: Option<Spread>| spread.map(|spread| spread.median);
        if SUBJECTS[..USUAL].iter().any(|subject| subject.name == comparison.surface) {
            self.usual.push([median(fidget), median(pov)]);
        }
        let [iso_time, vm_time, jit_time] = [iso, vm, jit].map(milliseconds);
        let pov_time = povray.map(|measured| rounded(1e3 * measured.seconds.spread().median, 3));
        let pixel = comparison.view.pixel();
        let [vm_error, jit_error, pov_error] = [vm, jit, povray].map(|measured| error(measured, pixel));
        let counts = comparison.counts;
        println!(
            "{:<11}{iso_time:>24}{vm_time:>24}{jit_time:>24}{:>10}{:>26}{:>15}{vm_error:>26}{jit_error:>26}\
             {pov_error:>26}  {} / {} / {}",
            comparison.surface,
            pov_time.unwrap_or_else(absent),
            fidget.map_or_else(absent, |spread| spread.to_string()),
            pov.map_or_else(absent, |spread| rounded(spread.median, 3)),
            counts.hit,
            counts.touch,
            counts.undecided
        );
    }

    /// Prints the geometric means over the usual surfaces, and the least ratios.
    pub fn print_end(&self) {
        for (place, peer) in ["the better fidget", "POV-Ray"].into_iter().enumerate() {
            let ratios: Vec<f64> = self.usual.iter().filter_map(|ratios| ratios[place]).collect();
            if !ratios.is_empty() {
                let logarithms: f64 = ratios.iter().map(|ratio| ratio.ln()).sum();
                let mean = (logarithms / ratios.len() as f64).exp();
                let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
                println!(
                    "{peer} / iso: geometric mean over {} of the usual surfaces {}, least {}",
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
