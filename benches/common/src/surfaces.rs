//! The surfaces that are measured: one formula each, from which every program's own form is made.

use iso_expr::{Ast, FormulaError, Program};

/// A surface, where to look for it, and its name.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Its name in tables and on the command line.
    pub name: &'static str,
    /// Its formula: an equation whose left side is less than its right side inside the body, or a bare expression that is
    /// negative there.
    pub formula: &'static str,
    /// The radius of a ball around the origin that holds the surface: half the picture's width.
    pub radius: f64,
}

impl Subject {
    /// The surface of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        SUBJECTS.iter().find(|subject| subject.name == name)
    }

    /// F, whose zeros are the surface, simplified.
    ///
    /// # Errors
    /// When the formula is wrong.
    pub fn program(&self) -> Result<Program, FormulaError> {
        Ok(Ast::parse(self.formula)?.lower(&[])?.minus_level(0.0).simplified())
    }
}

/// All surfaces. The first eight are the usual ones of this trade; of the others each is hard in another way.
pub const SUBJECTS: [Subject; 12] = [
    Subject { name: "paper", formula: "(x^2 + y^2 - 1)^2 + 4z^2 + 0.5x = 0.2", radius: 1.6 },
    Subject { name: "tanglecube", formula: "x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8", radius: 4.5 },
    Subject { name: "torus", formula: "(x^2 + y^2 + z^2 + 0.84)^2 = 4(x^2 + y^2)", radius: 1.6 },
    // Barth's sextic, whose golden ratio φ gives φ² and 1 + 2φ, and a ball.
    Subject {
        name: "barth",
        formula: "max(4(2.618033988749895x^2 - y^2)(2.618033988749895y^2 - z^2)(2.618033988749895z^2 - x^2) \
                  - 4.23606797749979(x^2 + y^2 + z^2 - 1)^2, x^2 + y^2 + z^2 - 3)",
        radius: 1.8,
    },
    Subject {
        name: "gyroid",
        formula: "max(sin(x)cos(y) + sin(y)cos(z) + sin(z)cos(x), x^2 + y^2 + z^2 - 49)",
        radius: 7.2,
    },
    Subject {
        name: "metaballs",
        formula: "3.5 - 1/((x - 0.9)^2 + y^2 + z^2) - 1/((x + 0.9)^2 + y^2 + z^2) - 1/(x^2 + (y - 0.8)^2 + z^2) \
                  - 1/(x^2 + y^2 + (z - 0.8)^2)",
        radius: 2.2,
    },
    Subject { name: "heart", formula: "(x^2 + 2.25y^2 + z^2 - 1)^3 - x^2 z^3 - 0.1125y^2 z^3", radius: 1.6 },
    Subject {
        name: "blobs",
        formula: "0.5 - exp(-4((x - 0.6)^2 + y^2 + z^2)) - exp(-3((x + 0.5)^2 + (y - 0.3)^2 + z^2)) \
                  - exp(-5(x^2 + (y + 0.5)^2 + (z - 0.4)^2)) - exp(-4(x^2 + y^2 + (z + 0.7)^2))",
        radius: 1.8,
    },
    // Passes through itself.
    Subject {
        name: "klein",
        formula: "(x^2 + y^2 + z^2 + 2y - 1)((x^2 + y^2 + z^2 - 2y - 1)^2 - 8z^2) \
                  + 16x*z*(x^2 + y^2 + z^2 - 2y - 1)",
        radius: 4.2,
    },
    // Of degree 12, with holes.
    Subject {
        name: "decocube",
        formula: "((x^2 + y^2 - 0.64)^2 + (z^2 - 1)^2)((y^2 + z^2 - 0.64)^2 + (x^2 - 1)^2) \
                  ((z^2 + x^2 - 0.64)^2 + (y^2 - 1)^2) = 0.02",
        radius: 2.0,
    },
    // A machined part: planes, cylinders and a ball, with sharp edges.
    Subject {
        name: "part",
        formula: "max(abs(x) - 1, abs(y) - 1, abs(z) - 1, x^2 + y^2 + z^2 - 1.9, 0.3 - x^2 - y^2, 0.3 - y^2 - z^2, \
                  0.3 - z^2 - x^2)",
        radius: 1.6,
    },
    // Chmutov's octic: many small pieces.
    Subject {
        name: "chmutov",
        formula: "128(x^8 + y^8 + z^8) - 256(x^6 + y^6 + z^6) + 160(x^4 + y^4 + z^4) - 32(x^2 + y^2 + z^2) + 3",
        radius: 1.85,
    },
];
