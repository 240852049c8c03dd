//! What is computed of a surface, and when that is worth compiling.

use iso_expr::Program;

/// Formulas of more operations are not differentiated twice.
const DIFFERENTIATED_TWICE: usize = 100;

/// Formulas of more operations that have branches are hardly ever asked for as a whole, but for what is left of them in places.
const AS_A_WHOLE: usize = 100;

/// One of a surface's kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// F − C at points.
    Values,
    /// F − C and its three derivatives at points.
    Gradients,
    /// F − C and its [slope](Program::with_slope) along a direction at points.
    Slopes,
    /// F − C over boxes.
    ValueEnclosures,
    /// F − C and its three derivatives over boxes.
    GradientEnclosures,
    /// F − C, [what rounding does to it](Program::with_rounding) and its three derivatives over boxes.
    RoundingBounds,
    /// F − C with its [first and second derivatives](Program::with_hessian) over boxes.
    HessianEnclosures,
    /// The [affine forms](Program::with_forms) of F − C and its three derivatives.
    Forms,
    /// The [affine forms](Program::with_forms) of F − C and its slope along parallel rays.
    ParallelForms,
}

impl Kernel {
    /// Formulas of more operations have no forms, which take some forty times as many, and a fraction of a second to be compiled.
    pub(crate) const WITH_FORMS: usize = 600;

    /// All kernels.
    pub const ALL: [Self; 9] = [
        Self::Values,
        Self::Gradients,
        Self::Slopes,
        Self::ValueEnclosures,
        Self::GradientEnclosures,
        Self::RoundingBounds,
        Self::HessianEnclosures,
        Self::Forms,
        Self::ParallelForms,
    ];

    /// Whether there is such a kernel and it is likely to pay for itself: large formulas are not differentiated twice, for that
    /// may take nine times as many operations, and have no forms, nor have those that jump.
    pub fn pays(self, value: &Program) -> bool {
        match self {
            Self::HessianEnclosures => value.operations() <= DIFFERENTIATED_TWICE,
            Self::Forms | Self::ParallelForms => value.operations() <= Self::WITH_FORMS && value.has_forms(),
            _ => true,
        }
    }

    /// Whether the method that proves what it says compiles no kernel of a formula ahead, for less of it is left nearly everywhere: in places, or
    /// since it is [cut](Program::is_cut) and hardly asked for at its edge.
    pub fn are_left_to_places(value: &Program) -> bool {
        value.is_cut() || Self::are_for_places(value)
    }

    /// Whether most of a formula is left out nearly everywhere, place by place.
    pub(crate) fn are_for_places(value: &Program) -> bool {
        value.operations() > AS_A_WHOLE && value.has_branches()
    }

    /// Whether it runs over boxes, and not over points or forms.
    pub(crate) fn runs_over_boxes(self) -> bool {
        match self {
            Self::ValueEnclosures
            | Self::GradientEnclosures
            | Self::RoundingBounds
            | Self::HessianEnclosures => true,
            Self::Values | Self::Gradients | Self::Slopes | Self::Forms | Self::ParallelForms => false,
        }
    }

    /// Whether it gives affine forms.
    pub(crate) fn makes_forms(self) -> bool {
        matches!(self, Self::Forms | Self::ParallelForms)
    }

    /// Whether it is compiled ahead of its use. What is asked for seldom is made for few runs until it was asked for often: for many
    /// pictures that is never. Where there are forms, enclosures of the gradient are asked for only where those say too little.
    pub fn is_compiled_ahead(self, has_forms: bool) -> bool {
        match self {
            Self::GradientEnclosures => !has_forms,
            Self::RoundingBounds | Self::HessianEnclosures => false,
            _ => true,
        }
    }

    /// Those that the method that proves what it says compiles ahead, whatever the rays. Slopes are for rays side by side, and forms depend
    /// on how those spread.
    pub(crate) fn of_proofs(has_forms: bool) -> impl Iterator<Item = Self> {
        let all = [Self::Values, Self::ValueEnclosures, Self::GradientEnclosures];
        all.into_iter().filter(move |kernel| kernel.is_compiled_ahead(has_forms))
    }

    /// The kernel's name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Values => "values",
            Self::Gradients => "gradients",
            Self::Slopes => "slopes",
            Self::ValueEnclosures => "value enclosures",
            Self::GradientEnclosures => "gradient enclosures",
            Self::RoundingBounds => "rounding bounds",
            Self::HessianEnclosures => "hessian enclosures",
            Self::Forms => "forms",
            Self::ParallelForms => "parallel forms",
        }
    }
}
