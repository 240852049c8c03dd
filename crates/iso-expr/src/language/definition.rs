//! How definitions use each other.

use super::ast::{Definition, DefinitionId, Term, Tree};
use super::error::{FormulaError, FormulaErrorKind};
use super::function::Function;

/// Notes for each definition whether it is constant.
///
/// # Errors
/// When one leads back to itself, the names on the way.
pub(super) fn mark_constants(definitions: &mut [Definition]) -> Result<(), FormulaError> {
    let mut walk = Walk { states: vec![State::New; definitions.len()], path: Vec::new() };
    for start in 0..definitions.len() {
        walk.visit(start, definitions)?;
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    /// On the path from where the walk started.
    Open,
    Done,
}

/// A walk in depth through the definitions, each of which is done after those that it uses.
struct Walk {
    states: Vec<State>,
    /// The definitions on the way, each with those that it uses and that are still to be visited.
    path: Vec<(usize, Vec<DefinitionId>)>,
}

impl Walk {
    fn visit(&mut self, start: usize, definitions: &mut [Definition]) -> Result<(), FormulaError> {
        self.enter(start, definitions);
        while let Some((place, uses)) = self.path.last_mut() {
            let place = *place;
            let Some(used) = uses.pop() else {
                definitions[place].is_constant = is_constant(&definitions[place].body, definitions);
                self.states[place] = State::Done;
                self.path.pop();
                continue;
            };
            match self.states[used.index()] {
                State::Open => return Err(self.recursion(used.index(), definitions)),
                State::New => self.enter(used.index(), definitions),
                State::Done => {}
            }
        }
        Ok(())
    }

    fn enter(&mut self, place: usize, definitions: &[Definition]) {
        if self.states[place] == State::New {
            self.states[place] = State::Open;
            self.path.push((place, definitions[place].body.terms().iter().filter_map(used).collect()));
        }
    }

    fn recursion(&self, again: usize, definitions: &[Definition]) -> FormulaError {
        let cycle = self.path.iter().map(|(place, _)| *place).skip_while(|place| *place != again);
        let names = cycle.chain([again]).map(|place| definitions[place].name.clone()).collect();
        FormulaError::new(FormulaErrorKind::Recursion { cycle: names }, definitions[again].span.clone())
            .with_help("a definition may use others, but none that uses it")
    }
}

fn is_constant(body: &Tree, definitions: &[Definition]) -> bool {
    let names_axis = body.terms().iter().any(|term| matches!(term, Term::Variable(_)));
    !names_axis && body.terms().iter().filter_map(used).all(|used| definitions[used.index()].is_constant)
}

/// The definition that a term names.
fn used(term: &Term) -> Option<DefinitionId> {
    match term {
        Term::Value(id) | Term::Call(Function::Defined(id), _) => Some(*id),
        _ => None,
    }
}
