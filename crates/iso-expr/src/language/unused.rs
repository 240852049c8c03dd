//! Definitions that a formula does without.

use super::ast::{Ast, DefinitionId, Term, Tree};
use super::domain::Domain;
use super::function::Function;

impl Ast {
    /// The names of the definitions that the formula does without, in their order: neither it nor anything that it uses names them.
    pub(super) fn unused(&self) -> Vec<String> {
        let mut are_used = vec![false; self.definitions.len()];
        let condition = self.domain.as_ref().map(|Domain { condition, .. }| condition);
        let mut trees: Vec<&Tree> = std::iter::once(&self.left).chain(&self.right).chain(condition).collect();
        while let Some(tree) = trees.pop() {
            for id in tree.terms().iter().filter_map(defined) {
                if !std::mem::replace(&mut are_used[id.index()], true) {
                    trees.push(&self.definitions[id.index()].body);
                }
            }
        }
        let unused = self.definitions.iter().zip(are_used).filter(|(_, is_used)| !is_used);
        unused.map(|(definition, _)| definition.name.clone()).collect()
    }
}

/// The definition that a term names.
fn defined(term: &Term) -> Option<DefinitionId> {
    match term {
        Term::Value(id) | Term::Call(Function::Defined(id), _) => Some(*id),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_used_by_the_formula_or_by_what_it_uses() {
        for (text, unused) in [
            ("a := 2; x + a*y", vec![]),
            ("a := 2; x + y", vec!["a"]),
            ("f(u) := u*b; b := a + 1; a := 2; f(x) = 1", vec![]),
            ("f(u) := u*b; b := a + 1; a := 2; x = b", vec!["f"]),
            ("c := 3; d := c; e2 := 1; x = 1", vec!["c", "d", "e2"]),
            ("a := 2; b := 3; x = b where y < a", vec![]),
            ("a := 2; b := 3; x = y where y < b", vec!["a"]),
        ] {
            assert_eq!(Ast::parse(text).unwrap().unused(), unused, "{text}");
        }
    }
}
