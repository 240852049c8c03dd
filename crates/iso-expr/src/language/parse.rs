//! Statements: definitions, and the formula that uses them.

use super::ast::{Ast, Definition, Tree};
use super::cursor::Cursor;
use super::definition::mark_constants;
use super::domain::Domain;
use super::error::{FormulaError, FormulaErrorKind};
use super::expression::{Place, read_expression};
use super::fault;
use super::item::{Head, Item, Kind, items};
use super::limits;
use super::scope::{Parameters, Scope, parameters};

/// The text in `bytes`.
///
/// # Errors
/// When they are not UTF-8.
pub fn decode(bytes: &[u8]) -> Result<&str, FormulaError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let offset = error.valid_up_to();
        let end = error.error_len().map_or(bytes.len(), |length| offset + length);
        FormulaError::new(FormulaErrorKind::NotUtf8 { byte: bytes[offset], offset }, offset..end)
            .with_help("save the formula as UTF-8, or write it in ASCII: `x^2`, `pi`, `sqrt(x)`")
    })
}

impl Ast {
    /// Reads a formula: an equation, or an expression that a level is later taken from, and its definitions.
    ///
    /// # Errors
    /// When the text breaks the rules of the language or its limits; see [`FormulaErrorKind`].
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        let allowed = limits::LARGEST_TEXT;
        if text.len() > allowed {
            return Err(FormulaError::new(FormulaErrorKind::TooLong { allowed }, allowed..allowed));
        }
        let (items, heads) = items(text);
        let scope = Scope::of_formula(&heads)?;
        let mut statements = Statements::new(items, &heads, &scope);
        statements.read()?;
        statements.cursor.check_depth()?;
        let mut definitions = statements.definitions;
        mark_constants(&mut definitions)?;
        match statements.formula {
            Some((left, right)) => Ok(Self { definitions, left, right, domain: statements.domain }),
            None if definitions.is_empty() => Err(FormulaError::new(FormulaErrorKind::Empty, 0..0)
                .with_help("write an equation such as `x^2 + y^2 + z^2 = 1`")),
            None => Err(FormulaError::new(FormulaErrorKind::MissingFormula, text.len()..text.len())
                .with_help("end with an equation or an expression in x, y and z")),
        }
    }
}

/// The definitions of the prelude, which is part of the program and not of its input.
pub(super) fn parse_prelude(text: &str) -> Vec<Definition> {
    const WELL_FORMED: &str = "the prelude is well formed";
    let (items, heads) = items(text);
    let scope = Scope::of_prelude(&heads).expect(WELL_FORMED);
    let mut statements = Statements::new(items, &heads, &scope);
    statements.read().expect(WELL_FORMED);
    statements.definitions
}

/// The statements of a text, as far as they are read.
struct Statements<'t> {
    cursor: Cursor<'t>,
    heads: std::slice::Iter<'t, Head<'t>>,
    scope: &'t Scope<'t>,
    definitions: Vec<Definition>,
    formula: Option<(Tree, Option<Tree>)>,
    domain: Option<Domain>,
}

impl<'t> Statements<'t> {
    fn new(items: Vec<Item<'t>>, heads: &'t [Head<'t>], scope: &'t Scope<'t>) -> Self {
        let cursor = Cursor::new(items);
        Self { cursor, heads: heads.iter(), scope, definitions: Vec::new(), formula: None, domain: None }
    }

    fn read(&mut self) -> Result<(), FormulaError> {
        loop {
            let item = self.cursor.peek();
            match item.kind {
                Kind::EOI => return Ok(()),
                Kind::semicolon | Kind::newline => self.cursor.advance(),
                Kind::value_head | Kind::function_head => self.read_definition()?,
                _ => self.read_formula(item)?,
            }
        }
    }

    fn read_definition(&mut self) -> Result<(), FormulaError> {
        let head = self.heads.next().expect("there is a head for every definition");
        self.cursor.advance();
        let body = read_expression(&mut self.cursor, self.scope, &parameters(head)?, Place::Definition)?;
        self.definitions.push(Definition {
            name: head.name.text.to_owned(),
            parameters: head.parameters.iter().map(|item| item.text.to_owned()).collect(),
            body,
            is_constant: false,
            span: head.name.span(),
        });
        Ok(())
    }

    fn read_formula(&mut self, first: Item<'t>) -> Result<(), FormulaError> {
        let left = self.read_side()?;
        let right = match self.cursor.peek().kind {
            Kind::equal | Kind::double_equal => {
                self.cursor.advance();
                Some(self.read_side()?)
            }
            _ => None,
        };
        let domain = self.read_domain()?;
        let end = self.cursor.peek();
        if matches!(end.kind, Kind::equal | Kind::double_equal) {
            return Err(FormulaError::new(FormulaErrorKind::TwoEquations, end.span())
                .with_help("keep one equality sign; in a condition, `==` stands inside `if(…)`"));
        }
        match &self.formula {
            None => (self.formula, self.domain) = (Some((left, right)), domain),
            Some((_, other)) => {
                let both = other.is_some() && right.is_some();
                return Err(fault::second_formula(first.start..end.start, both));
            }
        }
        Ok(())
    }

    /// Reads `where` and its condition, if they follow.
    fn read_domain(&mut self) -> Result<Option<Domain>, FormulaError> {
        let cut = self.cursor.peek();
        if cut.kind != Kind::cut {
            return Ok(None);
        }
        self.cursor.advance();
        if matches!(self.cursor.next_on_lines().kind, Kind::semicolon | Kind::EOI) {
            return Err(fault::no_domain(cut.span()));
        }
        let condition = read_expression(&mut self.cursor, self.scope, &Parameters::new(), Place::Definition)?;
        let domain = Domain::new(condition);
        domain.map(Some).ok_or_else(|| fault::no_domain(cut.start..self.cursor.peek().start))
    }

    fn read_side(&mut self) -> Result<Tree, FormulaError> {
        read_expression(&mut self.cursor, self.scope, &Parameters::new(), Place::Formula)
    }
}
