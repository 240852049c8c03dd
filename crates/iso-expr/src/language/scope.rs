//! What the names of a formula mean.

use std::collections::HashMap;

use super::ast::{Definition, DefinitionId, NamedConstant, Term};
use super::error::{FormulaError, FormulaErrorKind};
use super::function::{ArgumentCount, Function, prelude};
use super::item::{Head, Item};
use crate::{Axis, Operation};

/// Constants that stand for themselves wherever they are written, and are no names.
const SYMBOLS: [&str; 2] = ["π", "τ"];

/// Words that no definition may take.
const KEYWORDS: [&str; 4] = ["and", "or", "not", "where"];

/// The names that the formula defines, beside those of the language.
pub(super) struct Scope<'t> {
    heads: &'t [Head<'t>],
    places: HashMap<&'t str, DefinitionId>,
    is_prelude: bool,
}

/// What a name stands for.
pub(super) enum Meaning {
    Value(Term),
    Function(Function),
}

/// The parameters of the function whose body is being read.
pub(super) type Parameters<'t> = HashMap<&'t str, u32>;

impl<'t> Scope<'t> {
    /// The scope of a formula with these definitions.
    pub(super) fn of_formula(heads: &'t [Head<'t>]) -> Result<Self, FormulaError> {
        let scope = Self { heads, places: places(heads)?, is_prelude: false };
        for head in heads {
            Self::check_free(head)?;
        }
        Ok(scope)
    }

    /// The scope of the prelude itself.
    pub(super) fn of_prelude(heads: &'t [Head<'t>]) -> Result<Self, FormulaError> {
        Ok(Self { heads, places: places(heads)?, is_prelude: true })
    }

    /// What `name` means where `parameters` hide what else has their names.
    pub(super) fn meaning(&self, name: &str, parameters: &Parameters<'_>) -> Option<Meaning> {
        if let Some(&place) = parameters.get(name) {
            return Some(Meaning::Value(Term::Parameter(place)));
        }
        if let Some(&id) = self.places.get(name) {
            return Some(match self.heads[id.index()].parameters.is_empty() {
                true => Meaning::Value(Term::Value(id)),
                false => Meaning::Function(self.own(id)),
            });
        }
        let axis = Axis::ALL.into_iter().find(|axis| axis.name() == name).map(Term::Variable);
        let value = axis.or_else(|| constant(name).map(Term::Constant)).map(Meaning::Value);
        value.or_else(|| self.language_function(name).map(Meaning::Function))
    }

    /// How many arguments `function` takes.
    pub(super) fn argument_count(&self, function: Function) -> ArgumentCount {
        match function {
            Function::Operation(operation) => ArgumentCount::Exactly(operation.arity()),
            Function::Fold(operation) => ArgumentCount::AtLeast(operation.arity()),
            Function::Prelude(id) if !self.is_prelude => {
                ArgumentCount::Exactly(prelude()[id.index()].parameters.len())
            }
            Function::Prelude(id) | Function::Defined(id) => {
                ArgumentCount::Exactly(self.heads[id.index()].parameters.len())
            }
        }
    }

    /// A call of `function` as it should be written, such as `clamp(v, low, high)`, where its arguments have names.
    pub(super) fn pattern(&self, name: &str, function: Function) -> String {
        let parameters = match function {
            Function::Operation(Operation::Select) => "condition, a, b".to_owned(),
            Function::Operation(Operation::Atan2) => "y, x".to_owned(),
            Function::Operation(operation) => ["a", "b", "c"][..operation.arity()].join(", "),
            Function::Fold(_) => "a, b, …".to_owned(),
            Function::Prelude(id) => prelude()[id.index()].parameters.join(", "),
            Function::Defined(id) => {
                self.heads[id.index()].parameters.iter().map(|item| item.text).collect::<Vec<_>>().join(", ")
            }
        };
        format!("{name}({parameters})")
    }

    /// Every name that stands for a value.
    pub(super) fn values(&self) -> Vec<&str> {
        let axes = Axis::ALL.into_iter().map(Axis::name);
        let constants = NamedConstant::ALL.into_iter().map(NamedConstant::name);
        let mut names: Vec<&str> = axes.chain(constants).collect();
        names.extend(self.heads.iter().filter(|head| head.parameters.is_empty()).map(|head| head.name.text));
        names
    }

    /// Every name that stands for a function.
    pub(super) fn functions(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Function::operation_names().collect();
        names.extend(self.derived().iter().map(|definition| definition.name.as_str()));
        names.extend(self.heads.iter().filter(|head| !head.parameters.is_empty()).map(|head| head.name.text));
        names
    }

    fn own(&self, id: DefinitionId) -> Function {
        if self.is_prelude { Function::Prelude(id) } else { Function::Defined(id) }
    }

    fn language_function(&self, name: &str) -> Option<Function> {
        let derived = || self.derived().iter().position(|definition| definition.name == name);
        Function::operation(name)
            .or_else(|| derived().map(|place| Function::Prelude(DefinitionId(place as u32))))
    }

    /// The functions of the prelude, which are not there yet while it is read itself.
    fn derived(&self) -> &'static [Definition] {
        if self.is_prelude { &[] } else { prelude() }
    }

    /// That a definition takes no name of the language. A function's parameters may be called x, y or z.
    fn check_free(head: &Head<'_>) -> Result<(), FormulaError> {
        let name = meaning_in_language(head.name.text).map(|meaning| (&head.name, meaning));
        let parameter = || head.parameters.iter().find_map(|item| Some((item, meaning_of_word(item.text)?)));
        name.or_else(parameter).map_or(Ok(()), |(item, meaning)| Err(reserved(item, meaning)))
    }
}

/// What the language itself means by `name`, which no definition can take then.
pub(super) fn meaning_in_language(name: &str) -> Option<&'static str> {
    let is_axis = Axis::ALL.iter().any(|axis| axis.name() == name);
    if is_axis { Some("a coordinate") } else { meaning_of_word(name) }
}

/// The same of names that no parameter of a function can take either.
fn meaning_of_word(name: &str) -> Option<&'static str> {
    let is_derived = || prelude().iter().any(|definition| definition.name == name);
    if constant(name).is_some() || SYMBOLS.contains(&name) {
        Some("a constant of the language")
    } else if Function::operation(name).is_some() || is_derived() {
        Some("a function of the language")
    } else {
        KEYWORDS.contains(&name).then_some("a word of the language")
    }
}

fn constant(name: &str) -> Option<NamedConstant> {
    NamedConstant::ALL.into_iter().find(|constant| constant.name() == name)
}

fn reserved(item: &Item<'_>, meaning: &'static str) -> FormulaError {
    FormulaError::new(FormulaErrorKind::Reserved { name: item.text.to_owned(), meaning }, item.span())
        .with_help("choose another name")
}

/// The place of each name, when no two are equal.
fn places<'t>(heads: &'t [Head<'t>]) -> Result<HashMap<&'t str, DefinitionId>, FormulaError> {
    let mut places = HashMap::with_capacity(heads.len());
    for (place, head) in heads.iter().enumerate() {
        if places.insert(head.name.text, DefinitionId(place as u32)).is_some() {
            return Err(defined_twice(&head.name));
        }
        parameters(head)?;
    }
    Ok(places)
}

/// The place of each parameter of a function, when no two are equal.
pub(super) fn parameters<'t>(head: &Head<'t>) -> Result<Parameters<'t>, FormulaError> {
    let mut parameters = Parameters::with_capacity(head.parameters.len());
    for (place, item) in head.parameters.iter().enumerate() {
        if parameters.insert(item.text, place as u32).is_some() {
            return Err(defined_twice(item));
        }
    }
    Ok(parameters)
}

fn defined_twice(item: &Item<'_>) -> FormulaError {
    FormulaError::new(FormulaErrorKind::DefinedTwice { name: item.text.to_owned() }, item.span())
}
