//! The structure of a formula, one term a line.

use std::fmt::{self, Display, Formatter};

use super::ast::{Ast, TermId, Tree};
use super::domain::Domain;
use super::print::{Names, write_leaf};

/// Terms deeper than this are left out, so that the outline of a long sum does not grow with the square of its length.
const DEEPEST: usize = 64;

/// Shows a formula as an indented tree, made by [`Ast::outline`].
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    ast: &'a Ast,
}

impl Ast {
    /// The structure of the formula as an indented tree: first each definition, then the formula.
    pub fn outline(&self) -> Outline<'_> {
        Outline { ast: self }
    }
}

impl Display for Outline<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let definitions = &self.ast.definitions;
        for definition in definitions {
            write!(f, "{}", definition.name)?;
            if !definition.parameters.is_empty() {
                write!(f, "({})", definition.parameters.join(", "))?;
            }
            writeln!(f, " :=")?;
            let names = Names { definitions, parameters: &definition.parameters };
            write_tree(f, &definition.body, names, &[true])?;
        }
        let names = Names { definitions, parameters: &[] };
        match &self.ast.right {
            None => write_tree(f, &self.ast.left, names, &[])?,
            Some(right) => {
                writeln!(f, "=")?;
                write_tree(f, &self.ast.left, names, &[false])?;
                write_tree(f, right, names, &[true])?;
            }
        }
        if let Some(Domain { condition, .. }) = &self.ast.domain {
            writeln!(f, "where")?;
            write_tree(f, condition, names, &[true])?;
        }
        Ok(())
    }
}

/// Writes a tree below what `branch` leads to: for each level whether its last term has been reached.
fn write_tree(f: &mut Formatter<'_>, tree: &Tree, names: Names<'_>, branch: &[bool]) -> fmt::Result {
    let mut branch = branch.to_vec();
    let last = branch.pop();
    let mut waiting: Vec<(TermId, usize, Option<bool>)> = vec![(tree.root(), branch.len(), last)];
    while let Some((id, depth, last)) = waiting.pop() {
        branch.truncate(depth);
        write_indentation(f, &branch, last)?;
        if depth > DEEPEST {
            writeln!(f, "…")?;
            continue;
        }
        write_leaf(f, tree.term(id), names)?;
        writeln!(f)?;
        branch.extend(last);
        let operands = tree.term(id).operands().rev().enumerate();
        waiting.extend(operands.map(|(place, operand)| (operand, branch.len(), Some(place == 0))));
    }
    Ok(())
}

fn write_indentation(f: &mut Formatter<'_>, branch: &[bool], last: Option<bool>) -> fmt::Result {
    for done in branch {
        f.write_str(if *done { "   " } else { "│  " })?;
    }
    match last {
        None => Ok(()),
        Some(true) => f.write_str("└─ "),
        Some(false) => f.write_str("├─ "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_shows_who_is_an_operand_of_whom() {
        let ast = Ast::parse("f(u) := -u; a := 2; max(f(x), a, 3) = y^2 where x < a").unwrap();
        let expected = "\
f(u) :=
└─ negate
   └─ u
a :=
└─ 2
=
├─ max
│  ├─ f
│  │  └─ x
│  ├─ a
│  └─ 3
└─ ^
   ├─ y
   └─ 2
where
└─ <
   ├─ x
   └─ a
";
        assert_eq!(ast.outline().to_string(), expected);
    }

    #[test]
    fn a_long_sum_is_cut() {
        let ast = Ast::parse(&format!("x{}", "+x".repeat(10_000))).unwrap();
        let outline = ast.outline().to_string();
        assert!(outline.contains('…') && outline.lines().count() < 4 * DEEPEST, "{outline}");
    }
}
