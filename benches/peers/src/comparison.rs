//! One surface at one size, rendered by all programs in turns.

use std::error::Error;

use fidget::jit::JitFunction;
use fidget::vm::VmFunction;
use iso_benches::results::Results;
use iso_benches::samples::{Samples, rounded};
use iso_render::StatusCounts;

use crate::arguments::{Arguments, Body};
use crate::depths::DepthError;
use crate::fidget_engines::Fidget;
use crate::iso::{Answer, Iso, Width};
use crate::povray::PovRay;
use crate::renderer::Renderer;
use crate::view::SquareView;

/// What one program took, and how far it was off.
pub struct Measured {
    /// The program's name.
    pub name: &'static str,
    /// Seconds a picture, one for each turn.
    pub seconds: Samples,
    /// Against this project's answer.
    pub error: DepthError,
}

/// One surface at one size.
pub struct Comparison {
    /// The surface's name.
    pub surface: String,
    /// The picture.
    pub view: SquareView,
    /// This project first.
    pub measured: Vec<Measured>,
    /// This project's pixels by status.
    pub counts: StatusCounts,
}

impl Comparison {
    /// What [`Comparison::write`] writes about times.
    pub const TIME_COLUMNS: [&'static str; 6] = ["surface", "size", "threads", "program", "turn", "seconds"];
    /// What [`Comparison::write`] writes about errors.
    pub const ERROR_COLUMNS: [&'static str; 11] = [
        "surface",
        "size",
        "program",
        "largest_depth_error",
        "mean_depth_error",
        "pixel_width",
        "mismatched_pixels",
        "hit",
        "touch",
        "miss",
        "undecided",
    ];

    /// Renders once to warm up, then measures in turns. What cannot be rendered by a program is said and left out.
    ///
    /// # Errors
    /// When this project cannot render the surface, or a program fails while it renders.
    pub fn run(body: &Body, size: u32, arguments: &Arguments) -> Result<Self, Box<dyn Error>> {
        let view = SquareView { radius: body.radius, size };
        let Answer { depths, decided, counts } = iso(body, view, arguments, Width::Narrow)?.answer()?;
        let mut measured = Vec::new();
        let mut renderers: Vec<(Box<dyn Renderer>, Samples)> = Vec::new();
        for renderer in renderers_of(body, view, arguments) {
            match renderer {
                Ok(renderer) => renderers.push((renderer, Samples::default())),
                Err(error) => eprintln!("{}: {error}", body.name),
            }
        }
        for turn in 0..=arguments.turns {
            for (renderer, seconds) in &mut renderers {
                let is_slow = renderer.name() == PovRay::NAME;
                let turns = if is_slow { arguments.povray_turns } else { arguments.turns };
                let warms_up = turn == 0 && !is_slow;
                if warms_up || (1..=turns).contains(&turn) {
                    let taken = renderer.render()?;
                    if !warms_up {
                        seconds.push(taken);
                    }
                }
            }
        }
        for (renderer, seconds) in renderers {
            let error = renderer.depths()?.error_against(&depths, &decided);
            measured.push(Measured { name: renderer.name(), seconds, error });
        }
        Ok(Self { surface: body.name.clone(), view, measured, counts })
    }

    /// The program of this name.
    pub fn program(&self, name: &str) -> Option<&Measured> {
        self.measured.iter().find(|measured| measured.name == name)
    }

    /// The one of fidget's engines with the lower median.
    pub fn better_fidget(&self) -> Option<&Measured> {
        let engines = [VM, JIT].into_iter().filter_map(|name| self.program(name));
        engines.min_by(|a, b| a.seconds.spread().median.total_cmp(&b.seconds.spread().median))
    }

    /// Adds all measurements to the files of results.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn write(&self, times: &mut Results, errors: &mut Results) -> Result<(), Box<dyn Error>> {
        let (surface, size) = (&self.surface, self.view.size.to_string());
        let threads = rayon::current_num_threads().to_string();
        for Measured { name, seconds, error } in &self.measured {
            for (turn, seconds) in seconds.values().iter().enumerate() {
                let (turn, seconds) = (turn.to_string(), rounded(*seconds, 6));
                times.row([surface.as_str(), &size, &threads, name, &turn, &seconds])?;
            }
            let [largest, mean, pixel] =
                [error.largest, error.mean, self.view.pixel()].map(|length| format!("{length:.3e}"));
            let counts = [self.counts.hit, self.counts.touch, self.counts.miss, self.counts.undecided];
            let fields = [surface.clone(), size.clone(), (*name).to_owned(), largest, mean, pixel];
            let counts =
                std::iter::once(error.mismatches.to_string()).chain(counts.map(|count| count.to_string()));
            errors.row(fields.into_iter().chain(counts))?;
        }
        Ok(())
    }
}

/// The name of fidget's interpreter.
pub const VM: &str = "fidget VM";
/// The name of fidget's compiler.
pub const JIT: &str = "fidget JIT";

/// This project, ready to render.
fn iso(body: &Body, view: SquareView, arguments: &Arguments, width: Width) -> Result<Iso, Box<dyn Error>> {
    Iso::new(&body.program, view, (arguments.method, width), arguments.engine)
}

/// All programs, ready to render; an error for each that cannot.
fn renderers_of(
    body: &Body,
    view: SquareView,
    arguments: &Arguments,
) -> Vec<Result<Box<dyn Renderer>, Box<dyn Error>>> {
    let program = &body.program;
    let of_width = |width: &Width| iso(body, view, arguments, *width).map(|iso| Box::new(iso) as _);
    let mut renderers: Vec<Result<Box<dyn Renderer>, Box<dyn Error>>> =
        arguments.widths.iter().map(of_width).collect();
    if !arguments.without_fidget {
        renderers.extend([
            Fidget::<VmFunction>::new(VM, program, view).map(|renderer| Box::new(renderer) as _),
            Fidget::<JitFunction>::new(JIT, program, view).map(|renderer| Box::new(renderer) as _),
        ]);
    }
    if arguments.povray_turns > 0 && PovRay::is_installed() {
        let expected = |view| iso(body, view, arguments, Width::Narrow)?.answer();
        let povray = PovRay::tuned(program, view, arguments.threads, expected);
        renderers.push(povray.map(|renderer| Box::new(renderer) as _));
    }
    renderers
}
