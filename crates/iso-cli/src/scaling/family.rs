//! Formulas of any size.

use clap::ValueEnum;
use glam::DVec3;
use iso_expr::{Ast, Program};
use iso_grid::Region;

use crate::evaluation::spread;

/// Formulas that are made of as many like parts as wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Family {
    /// Metaballs: a sum of reciprocals of squared distances; few values are needed at a time
    Blobs,
    /// A union of balls: the least of their functions; in derivatives and enclosures many values are needed at a time
    Balls,
}

/// A formula of a family.
pub(crate) struct Formula {
    pub(crate) family: Family,
    /// The simplified program of F − C.
    pub(crate) program: Program,
}

/// Operations of each part but the first: three differences, three squares, two sums, what is made of the distance, and
/// what joins the parts.
const OPERATIONS_OF_A_PART: usize = 10;

impl Family {
    /// Where its surfaces are.
    pub(crate) fn region() -> Region {
        Region::new(DVec3::splat(-1.25), DVec3::splat(1.25)).expect("the box has room")
    }

    /// The formula of about so many operations: a plane where a part has more.
    pub(crate) fn formula(self, operations: usize) -> Formula {
        let parts = operations / OPERATIONS_OF_A_PART;
        let text = if parts == 0 { "x + y + z = 0.1".to_owned() } else { self.text(parts) };
        let formula =
            Ast::parse(&text).expect("the text is a formula").lower(&[]).expect("it has no parameters");
        Formula { family: self, program: formula.program().simplified() }
    }

    fn text(self, parts: usize) -> String {
        let inner = Region::new(DVec3::splat(-1.0), DVec3::splat(1.0)).expect("the box has room");
        let squared = |DVec3 { x, y, z }: DVec3| format!("((x-({x:.4}))^2+(y-({y:.4}))^2+(z-({z:.4}))^2)");
        let squares: Vec<String> = spread(&inner).take(parts).map(squared).collect();
        // Blobs far away add up to about 0.03 each; balls fill about a fifth of the box.
        let parts = parts as f64;
        match (self, &squares[..]) {
            (Self::Blobs, _) => format!("0.04/{}={}", squares.join("+0.04/"), 2.0 + 0.03 * parts),
            (Self::Balls, [square]) => format!("{square}=0.5"),
            (Self::Balls, _) => format!("min({})={:.6}", squares.join(","), (0.7 / parts.cbrt()).powi(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_have_about_as_many_operations_as_asked_for() {
        for family in [Family::Blobs, Family::Balls] {
            assert_eq!(family.formula(3).program.operations(), 3);
            for wanted in [10, 100, 1000, 10_000] {
                let operations = family.formula(wanted).program.operations();
                assert!(
                    (wanted / 2..=3 * wanted / 2).contains(&operations),
                    "{family:?}: {operations} of {wanted}"
                );
            }
        }
    }
}
