//! The plan of a picture: what it takes and what is left out, decided before any work.

use iso_expr::{Axis, CompileError, Program};
use iso_grid::{GridError, Kernel, Method, Region, RootFinder, Surface, Tracer};

use crate::{Layers, Projection, Smoothing};

/// What a picture is to be.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The simplified program of F − C.
    pub program: &'a Program,
    /// How rays are followed.
    pub method: Method,
    /// Whether the formula has parameters.
    pub has_parameters: bool,
    /// How space is projected onto the picture; `None` for rays that are no picture's.
    pub projection: Option<Projection>,
    /// Whether the box is given, so that none needs to be fitted.
    pub box_is_given: bool,
    /// What is kept of the picture.
    pub layers: Layers,
    /// How edges are smoothed.
    pub smoothing: Smoothing,
}

/// What a picture takes, and why. [`render`](crate::render()) and all around it ask the plan what to do.
#[derive(Clone, Debug)]
pub struct Plan {
    method: Method,
    layers: Layers,
    arguments: [Decision<Axis>; 3],
    constants: [Decision<Given>; 4],
    kernels: [Decision<Kernel>; Kernel::ALL.len()],
    /// Whether the method compiles none of them ahead.
    is_left_to_places: bool,
    passes: [Decision<Pass>; 6],
    buffers: [Decision<Buffer>; 7],
}

/// Whether something is part of the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision<T> {
    /// What was decided upon.
    pub subject: T,
    /// Whether the picture takes it.
    pub taken: bool,
    /// Why, in a few words.
    pub reason: &'static str,
}

/// What is known before the first ray, so that kernels might be made for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// The level C.
    Level,
    /// The formula's parameters.
    Parameters,
    /// The direction of the rays.
    Direction,
    /// The place of the camera.
    Position,
}

impl Given {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Level => "level",
            Self::Parameters => "parameters",
            Self::Direction => "direction",
            Self::Position => "position",
        }
    }
}

/// A stage of the work on a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// A box is fitted around the surface.
    Fit,
    /// The cells of a grid are classified, all of them before the first ray.
    Classify,
    /// Rays are followed to the surface.
    Trace,
    /// Normals are found where rays meet the surface.
    Normals,
    /// Colours are found.
    Shade,
    /// Pixels are averaged.
    Smooth,
}

impl Pass {
    /// The pass's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Classify => "classify",
            Self::Trace => "trace",
            Self::Normals => "normals",
            Self::Shade => "shade",
            Self::Smooth => "smooth",
        }
    }
}

/// Something that is kept for each pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffer {
    /// [`Layers::color`].
    Color,
    /// [`Layers::coverage`].
    Coverage,
    /// [`Layers::depth`].
    Depth,
    /// [`Layers::normals`].
    Normals,
    /// [`Layers::points`].
    Points,
    /// [`Layers::statuses`].
    Statuses,
    /// [`Layers::outcomes`].
    Outcomes,
}

impl Buffer {
    /// The buffer's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Coverage => "coverage",
            Self::Depth => "depth",
            Self::Normals => "normals",
            Self::Points => "points",
            Self::Statuses => "statuses",
            Self::Outcomes => "outcomes",
        }
    }
}

impl Plan {
    /// Decides what a picture takes.
    pub fn new(wanted: &Wanted<'_>) -> Self {
        let followed = is_certified(&wanted.method).then(|| wanted.program.with_same_signs());
        let wanted = &Wanted { program: followed.as_ref().unwrap_or(wanted.program), ..*wanted };
        Self {
            method: wanted.method,
            layers: wanted.layers,
            arguments: Axis::ALL.map(|axis| decide(axis, wanted.argument(axis))),
            constants: [Given::Level, Given::Parameters, Given::Direction, Given::Position]
                .map(|given| decide(given, wanted.constant(given))),
            kernels: Kernel::ALL.map(|kernel| decide(kernel, wanted.kernel(kernel))),
            is_left_to_places: wanted.is_left_to_places(),
            passes: [Pass::Fit, Pass::Classify, Pass::Trace, Pass::Normals, Pass::Shade, Pass::Smooth]
                .map(|pass| decide(pass, wanted.pass(pass))),
            buffers: [
                Buffer::Color,
                Buffer::Coverage,
                Buffer::Depth,
                Buffer::Normals,
                Buffer::Points,
                Buffer::Statuses,
                Buffer::Outcomes,
            ]
            .map(|buffer| decide(buffer, wanted.buffer(buffer))),
        }
    }

    /// How rays are followed.
    pub fn method(&self) -> Method {
        self.method
    }

    /// What is kept of the picture.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// The arguments that F takes.
    pub fn arguments(&self) -> &[Decision<Axis>] {
        &self.arguments
    }

    /// What of all that is known before the first ray the kernels are made for.
    pub fn constants(&self) -> &[Decision<Given>] {
        &self.constants
    }

    /// The kernels, and which of them are taken.
    pub fn kernels(&self) -> &[Decision<Kernel>] {
        &self.kernels
    }

    /// The passes that run, in their order.
    pub fn passes(&self) -> &[Decision<Pass>] {
        &self.passes
    }

    /// The buffers that exist.
    pub fn buffers(&self) -> &[Decision<Buffer>] {
        &self.buffers
    }

    /// Whether a pass runs.
    pub fn runs(&self, pass: Pass) -> bool {
        self.passes.iter().any(|decision| decision.subject == pass && decision.taken)
    }

    /// Whether a kernel takes the gradient, so that F is differentiated.
    pub fn takes_gradient(&self) -> bool {
        let gradients = [Kernel::Gradients, Kernel::GradientEnclosures];
        self.kernels.iter().any(|decision| decision.taken && gradients.contains(&decision.subject))
    }

    /// The kernels that are compiled ahead of their use.
    pub fn compiled_ahead(&self) -> impl Iterator<Item = Kernel> {
        let taken = self.kernels.iter().filter(|kernel| kernel.taken).map(|kernel| kernel.subject);
        let has_forms = taken.clone().any(|kernel| matches!(kernel, Kernel::Forms | Kernel::ParallelForms));
        let fits = self.runs(Pass::Fit);
        taken.filter(move |&kernel| match kernel {
            Kernel::ValueEnclosures if fits => true,
            _ => !self.is_left_to_places && kernel.is_compiled_ahead(has_forms),
        })
    }

    /// Compiles these kernels, so that the time it takes is known.
    ///
    /// # Errors
    /// When the engine cannot compile one.
    pub fn compile(&self, surface: &Surface) -> Result<(), CompileError> {
        self.compiled_ahead().try_for_each(|kernel| self.surface_of(kernel, surface).compile(kernel))
    }

    /// The surface by whose kernels the method follows rays and normals are found: the one that is given, or another one with
    /// [the same signs](Surface::by_signs).
    pub fn followed<'a>(&self, surface: &'a Surface) -> &'a Surface {
        if is_certified(&self.method) { surface.by_signs() } else { surface }
    }

    /// The surface whose kernel is taken: the one that is [followed](Self::followed), but boxes are fitted by signs whatever the method is.
    pub fn surface_of<'a>(&self, kernel: Kernel, surface: &'a Surface) -> &'a Surface {
        if kernel == Kernel::ValueEnclosures { surface.by_signs() } else { self.followed(surface) }
    }

    /// Prepares the method for a surface in a region.
    ///
    /// # Errors
    /// Those of [`Method::prepare`].
    pub fn tracer(&self, surface: &Surface, region: Region) -> Result<Box<dyn Tracer>, GridError> {
        self.method.prepare(surface, region)
    }
}

fn is_certified(method: &Method) -> bool {
    matches!(method, Method::Certified { .. })
}

/// Whether something is taken, and why.
type Verdict = (bool, &'static str);

fn decide<T>(subject: T, (taken, reason): Verdict) -> Decision<T> {
    Decision { subject, taken, reason }
}

impl Wanted<'_> {
    fn is_parallel(&self) -> bool {
        matches!(self.projection, Some(Projection::Orthographic { .. }))
    }

    fn argument(&self, axis: Axis) -> Verdict {
        match (self.program.takes(axis), self.method) {
            (true, _) => (true, "F depends on it"),
            (false, Method::Grid(_)) => {
                (false, "F does not depend on it: the cells along it are classified as one")
            }
            (false, _) => (false, "F does not depend on it"),
        }
    }

    fn constant(&self, given: Given) -> Verdict {
        match (given, self.projection) {
            (Given::Level, _) => (true, "the kernels compute F − C"),
            (Given::Parameters, _) if self.has_parameters => {
                (true, "their values are folded while simplifying")
            }
            (Given::Parameters, _) => (false, "the formula has none"),
            (Given::Direction, _) if !self.is_parallel() => (false, "each ray has its own"),
            (Given::Direction, _) if self.kernel(Kernel::ParallelForms).0 => (
                true,
                "F is differentiated along it, once instead of three times; a number that kernels take, so another view compiles nothing",
            ),
            (Given::Direction, _) => {
                (false, "all rays share one; kernels take points, so another view compiles nothing")
            }
            (Given::Position, _) => (false, "kernels take points, so another view compiles nothing"),
        }
    }

    fn is_certified(&self) -> bool {
        is_certified(&self.method)
    }

    fn is_left_to_places(&self) -> bool {
        self.is_certified() && Kernel::are_left_to_places(self.program)
    }

    fn kernel(&self, kernel: Kernel) -> Verdict {
        match self.kernel_of_whole(kernel) {
            (true, _) if self.is_left_to_places() => match kernel {
                Kernel::ValueEnclosures if !self.box_is_given => (true, "a box is fitted around the surface"),
                _ if self.program.is_cut() => (
                    true,
                    "asked for where F is cut; those of the whole function within are compiled when first asked for",
                ),
                _ => (
                    true,
                    "asked for where boxes leave less of F; compiled for each place when asked for often",
                ),
            },
            verdict => verdict,
        }
    }

    fn kernel_of_whole(&self, kernel: Kernel) -> Verdict {
        let certified = self.is_certified();
        match kernel {
            Kernel::Values if certified => (true, "roots are narrowed down at points before they are proven"),
            Kernel::Values => (true, "rays are sampled, and roots found between samples"),
            Kernel::Gradients
                if self.method.roots().is_some_and(|roots| roots.finder == RootFinder::Newton) =>
            {
                (true, "roots are found by the slope of F along the ray")
            }
            Kernel::Gradients => self.normals(),
            Kernel::Slopes if certified && self.projection.is_some() => {
                (true, "rays side by side are followed to their roots")
            }
            Kernel::Slopes if certified => (false, "each ray is searched for its own"),
            Kernel::Slopes => (false, "the method samples"),
            Kernel::ValueEnclosures if certified => (true, "stretches of rays and cells are proven empty"),
            Kernel::ValueEnclosures if !self.box_is_given => (true, "a box is fitted around the surface"),
            Kernel::ValueEnclosures => (false, "the method samples, and the box is given"),
            Kernel::GradientEnclosures if certified && Kernel::Forms.pays(self.program) => (
                true,
                "roots are proven to be simple where forms say too little; compiled when asked for often",
            ),
            Kernel::GradientEnclosures if certified => (true, "roots are proven to be simple"),
            Kernel::GradientEnclosures => (false, "the method samples"),
            Kernel::RoundingBounds if certified => {
                (true, "roots found at points are proven by the rounding of F; compiled when asked for often")
            }
            Kernel::RoundingBounds => (false, "the method samples"),
            Kernel::HessianEnclosures if certified && !kernel.pays(self.program) => {
                (false, "F is too large to be differentiated twice")
            }
            Kernel::HessianEnclosures if certified => (
                true,
                "where F bends one way, rays that graze the surface are decided together; compiled when asked for often",
            ),
            Kernel::HessianEnclosures => (false, "the method samples"),
            Kernel::Forms | Kernel::ParallelForms if !certified => (false, "the method samples"),
            Kernel::Forms | Kernel::ParallelForms if !kernel.pays(self.program) => (
                false,
                "F is too large, has jumps or functions without forms, or is the logarithm of a sum of many exponentials",
            ),
            Kernel::Forms if self.is_parallel() => (false, "all rays have one direction"),
            Kernel::ParallelForms if !self.is_parallel() => (false, "each ray has its own direction"),
            Kernel::Forms | Kernel::ParallelForms => {
                (true, "slopes of F over beams are narrowed by what they have in common")
            }
        }
    }

    fn pass(&self, pass: Pass) -> Verdict {
        match (pass, self.method) {
            (Pass::Fit, _) if self.box_is_given => (false, "the box is given"),
            (Pass::Fit, _) => (true, "no box is given"),
            (Pass::Classify, Method::Grid(_) | Method::Octree(_)) => {
                (true, "whether a cell holds the surface depends on its neighbours")
            }
            (Pass::Classify, Method::Certified { .. }) => {
                (false, "a cell is proven empty when the first ray comes by")
            }
            (Pass::Classify, Method::Direct { .. }) => (false, "the method has no grid"),
            (Pass::Trace, _) => (true, "every layer needs it"),
            (Pass::Normals, _) => self.normals(),
            (Pass::Shade, _) if self.layers.color => (true, "a shaded picture is wanted"),
            (Pass::Shade, _) => (false, "no shaded picture is wanted"),
            (Pass::Smooth, _) if self.smoothing == Smoothing::NONE => (false, "each pixel is drawn once"),
            (Pass::Smooth, _) => (true, "several pixels are drawn for each of the picture"),
        }
    }

    fn normals(&self) -> Verdict {
        match self.layers {
            Layers { color: true, .. } => (true, "shading needs normals"),
            Layers { normals: true, .. } => (true, "normals are wanted"),
            _ => (false, "neither a shaded picture nor normals are wanted"),
        }
    }

    fn buffer(&self, buffer: Buffer) -> Verdict {
        let Layers { color, coverage, depth, normals, points, statuses, outcomes } = self.layers;
        let wanted = match buffer {
            Buffer::Color => color,
            Buffer::Coverage => coverage,
            Buffer::Depth => depth,
            Buffer::Normals => normals,
            Buffer::Points => points,
            Buffer::Statuses => statuses,
            Buffer::Outcomes => outcomes,
        };
        (wanted, if wanted { "an output needs it" } else { "no output needs it" })
    }
}
