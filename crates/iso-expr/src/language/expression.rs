//! Expressions: items in a row, resolved into a tree by precedence.
//!
//! This is the shunting-yard algorithm (E. W. Dijkstra, "Algol 60 translation", Mathematisch Centrum, 1961): operands go to
//! one stack, operators and opening brackets wait on another until something that binds less tightly follows. Nothing
//! recurses, and each item is looked at once.
//!
//! A bar opens an absolute value where an operand is expected, closes one where an operand has just ended inside it, and
//! elsewhere opens a factor: `||x| - 1|` and `2|x|` are what they seem, and `|x|y|` is |x|·y followed by a bar too many.

use super::ast::{Infix, NamedConstant, Precedence, Prefix, Term, TermId, Tree};
use super::cursor::Cursor;
use super::error::{FormulaError, FormulaErrorKind};
use super::fault;
use super::function::Function;
use super::item::{Item, Kind};
use super::number::{number, superscript};
use super::scope::{Meaning, Parameters, Scope};
use crate::Operation;

/// Where an expression stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In the formula itself, where an equality sign parts two sides.
    Formula,
    /// In the body of a definition, where `==` compares.
    Definition,
}

/// Something that waits for its operand to be complete.
#[derive(Clone, Copy)]
enum Pending {
    Prefix(Prefix),
    Root,
    Infix(Infix),
    /// Everything inside the bracket that was opened here.
    Bracket,
}

/// What has been opened and not yet closed.
#[derive(Clone, Copy)]
struct Bracket<'t> {
    kind: BracketKind<'t>,
    open: Item<'t>,
}

#[derive(Clone, Copy)]
enum BracketKind<'t> {
    Parenthesis,
    Bar,
    /// The arguments of a call; those read already stand from `first` on among the operands.
    Call {
        function: Function,
        name: Item<'t>,
        first: usize,
    },
}

impl Pending {
    /// How tightly it holds its left operand, if it is an operator.
    fn precedence(&self) -> Option<Precedence> {
        match self {
            Self::Prefix(prefix) => Some(prefix.precedence()),
            Self::Root => Some(Precedence::Sign),
            Self::Infix(infix) => Some(infix.precedence()),
            Self::Bracket => None,
        }
    }
}

/// Reads one expression, up to the end of its statement or, in a formula, to an equality sign outside of all brackets.
///
/// # Errors
/// Whatever is wrong with the expression; only its nesting is left to [`Cursor::check_depth`].
pub(super) fn read_expression<'t>(
    cursor: &mut Cursor<'t>,
    scope: &Scope<'_>,
    parameters: &Parameters<'_>,
    place: Place,
) -> Result<Tree, FormulaError> {
    let mut reader = Reader {
        cursor,
        scope,
        parameters,
        place,
        tree: Tree::default(),
        operands: Vec::new(),
        pending: Vec::new(),
        brackets: Vec::new(),
        depth: 0,
    };
    loop {
        reader.read_operand()?;
        if !reader.read_operator()? {
            reader.settle_all();
            return Ok(reader.tree);
        }
    }
}

struct Reader<'r, 't> {
    cursor: &'r mut Cursor<'t>,
    scope: &'r Scope<'r>,
    parameters: &'r Parameters<'r>,
    place: Place,
    tree: Tree,
    operands: Vec<TermId>,
    pending: Vec<Pending>,
    brackets: Vec<Bracket<'t>>,
    /// How many brackets are open and how many root signs are pending: both are calls or parentheses when printed.
    depth: usize,
}

impl<'t> Reader<'_, 't> {
    /// Reads signs and opening brackets, up to the number or name where an operand starts.
    fn read_operand(&mut self) -> Result<(), FormulaError> {
        loop {
            let item = self.cursor.peek();
            match item.kind {
                Kind::newline | Kind::plus => {}
                Kind::minus => self.pending.push(Pending::Prefix(Prefix::Negate)),
                Kind::not => self.open_negation(&item)?,
                Kind::root => {
                    self.pending.push(Pending::Root);
                    self.deepen(&item);
                }
                Kind::open => self.open(BracketKind::Parenthesis, item),
                Kind::bar => self.open(BracketKind::Bar, item),
                // Elsewhere it is a function.
                Kind::cut if self.cursor.second().kind == Kind::open => {
                    return Err(fault::unknown_name(
                        &item,
                        &self.cursor.second(),
                        false,
                        self.scope,
                        self.parameters,
                    ));
                }
                Kind::name => {
                    if self.read_name(&item)? {
                        return Ok(());
                    }
                }
                Kind::number => return self.read_leaf(Term::Number(number(&item)?)),
                Kind::pi => return self.read_leaf(Term::Constant(NamedConstant::Pi)),
                Kind::tau => return self.read_leaf(Term::Constant(NamedConstant::Tau)),
                _ => return Err(self.missing_operand(&item)),
            }
            self.cursor.advance();
        }
    }

    fn read_leaf(&mut self, term: Term) -> Result<(), FormulaError> {
        self.cursor.advance();
        self.push(term);
        Ok(())
    }

    /// Reads a name; whether it was an operand and not the start of a call.
    fn read_name(&mut self, item: &Item<'t>) -> Result<bool, FormulaError> {
        let next = self.cursor.second();
        let is_called = next.kind == Kind::open;
        match self.scope.meaning(item.text, self.parameters) {
            Some(Meaning::Value(term)) => self.read_leaf(term).map(|()| true),
            Some(Meaning::Function(function)) if is_called => {
                self.cursor.advance();
                self.open(BracketKind::Call { function, name: *item, first: self.operands.len() }, next);
                Ok(false)
            }
            Some(Meaning::Function(function)) => {
                let takes_one = self.scope.argument_count(function).allows(1);
                let pattern = (!takes_one).then(|| self.scope.pattern(item.text, function));
                Err(fault::missing_arguments(item, &next, pattern))
            }
            None => {
                let is_left_side = self.cursor.is_at_left_side();
                Err(fault::unknown_name(item, &next, is_left_side, self.scope, self.parameters))
            }
        }
    }

    /// That a sign of a condition stands where a condition may.
    fn check_condition(&self, item: &Item<'_>) -> Result<(), FormulaError> {
        if self.brackets.is_empty() && self.place == Place::Formula {
            let error = FormulaError::new(FormulaErrorKind::Condition, item.span());
            return Err(
                error.with_help("write `=` between two sides; conditions belong into `if(condition, a, b)`, or behind `where`")
            );
        }
        Ok(())
    }

    /// `not` may stand where whatever it negates reaches as far as it would at the start.
    fn open_negation(&mut self, item: &Item<'_>) -> Result<(), FormulaError> {
        self.check_condition(item)?;
        let holder = self.pending.last().and_then(Pending::precedence);
        if holder.is_some_and(|holder| holder > Precedence::Not) {
            let error = FormulaError::new(FormulaErrorKind::MisplacedNot, item.span());
            return Err(error.with_help("write `(not …)`"));
        }
        self.pending.push(Pending::Prefix(Prefix::Not));
        Ok(())
    }

    /// Reads what follows an operand, up to the operator after which the next one is due; `false` at the end.
    fn read_operator(&mut self) -> Result<bool, FormulaError> {
        loop {
            let item = self.cursor.peek();
            let inside = !self.brackets.is_empty();
            match item.kind {
                Kind::newline if inside || self.goes_on() => self.cursor.skip_lines(),
                Kind::newline | Kind::semicolon | Kind::EOI if !inside => return Ok(false),
                Kind::equal | Kind::double_equal | Kind::cut if !inside && self.place == Place::Formula => {
                    return Ok(false);
                }
                Kind::superscript => self.read_superscript(&item)?,
                Kind::close => self.close_parenthesis(&item)?,
                Kind::bar if self.innermost_is_bar() => self.close_bar(),
                Kind::comma => {
                    self.part_arguments(&item)?;
                    return Ok(true);
                }
                Kind::name | Kind::pi | Kind::tau | Kind::open | Kind::bar | Kind::root => {
                    self.push_infix(Infix::Multiply, &item)?;
                    return Ok(true);
                }
                _ => {
                    let infix = self.infix(&item)?;
                    self.push_infix(infix, &item)?;
                    self.cursor.advance();
                    return Ok(true);
                }
            }
        }
    }

    /// Whether a line that ends here goes on in the next one, since that begins with an operator or with `where`, whose left side is here.
    /// A sign after a definition begins the formula.
    fn goes_on(&self) -> bool {
        match self.cursor.next_on_lines().kind {
            Kind::plus | Kind::minus | Kind::equal | Kind::cut => self.place == Place::Formula,
            kind => infix_of(kind).is_some(),
        }
    }

    /// The operator that `item` is, if it may stand here.
    fn infix(&self, item: &Item<'t>) -> Result<Infix, FormulaError> {
        let infix = infix_of(item.kind).ok_or_else(|| self.missing_operator(item))?;
        if infix.precedence() <= Precedence::Comparison {
            self.check_condition(item)?;
        }
        Ok(infix)
    }

    /// Settles what binds at least as tightly, then lets the operator wait for its right operand.
    fn push_infix(&mut self, infix: Infix, item: &Item<'_>) -> Result<(), FormulaError> {
        let precedence = infix.precedence();
        while let Some(holder) = self.pending.last().and_then(Pending::precedence) {
            if holder < precedence || holder == Precedence::Power && precedence == Precedence::Power {
                break;
            }
            if holder == Precedence::Comparison && precedence == Precedence::Comparison {
                let error = FormulaError::new(FormulaErrorKind::ChainedComparison, item.span());
                return Err(error.with_help("join two comparisons: `a < b and b < c`"));
            }
            self.settle();
        }
        self.pending.push(Pending::Infix(infix));
        Ok(())
    }

    /// `x²`: the operand just read, to a power.
    fn read_superscript(&mut self, item: &Item<'_>) -> Result<(), FormulaError> {
        let base = self.operands.pop().expect("an operand has just been read");
        let exponent = superscript(item)?;
        let mut power = self.tree.push(Term::Number(exponent.abs()));
        if item.text.starts_with('⁻') {
            power = self.tree.push(Term::Prefix(Prefix::Negate, power));
        }
        self.push(Term::Infix(Infix::Power, base, power));
        self.cursor.advance();
        let next = self.cursor.peek();
        if matches!(next.kind, Kind::superscript | Kind::power) {
            let error = FormulaError::new(FormulaErrorKind::StackedPowers, next.span());
            return Err(error.with_help("write `(x^a)^b` or `x^(a^b)`"));
        }
        Ok(())
    }

    fn open(&mut self, kind: BracketKind<'t>, open: Item<'t>) {
        self.pending.push(Pending::Bracket);
        self.brackets.push(Bracket { kind, open });
        self.deepen(&open);
    }

    fn deepen(&mut self, item: &Item<'_>) {
        self.depth += 1;
        self.cursor.note_depth(self.depth, item);
    }

    fn innermost_is_bar(&self) -> bool {
        matches!(self.brackets.last(), Some(Bracket { kind: BracketKind::Bar, .. }))
    }

    /// Settles every operator inside the innermost bracket.
    fn settle_bracket(&mut self) {
        while !matches!(self.pending.last(), None | Some(Pending::Bracket)) {
            self.settle();
        }
    }

    /// Takes the innermost bracket away, its operators settled.
    fn close(&mut self) -> Option<Bracket<'t>> {
        let bracket = self.brackets.pop()?;
        self.settle_bracket();
        self.pending.pop();
        self.depth -= 1;
        Some(bracket)
    }

    fn close_bar(&mut self) {
        self.close();
        let operand = self.operands.pop().expect("an operand has just been read");
        self.push(Term::Call(Function::Operation(Operation::Absolute), vec![operand]));
        self.cursor.advance();
    }

    fn close_parenthesis(&mut self, item: &Item<'t>) -> Result<(), FormulaError> {
        let Some(bracket) = self.close() else {
            return Err(FormulaError::new(FormulaErrorKind::UnopenedParenthesis, item.span()));
        };
        match bracket.kind {
            BracketKind::Parenthesis => {}
            BracketKind::Bar => return Err(fault::unclosed(&bracket.open)),
            BracketKind::Call { function, name, first } => {
                let arguments = self.operands.split_off(first);
                if !self.scope.argument_count(function).allows(arguments.len()) {
                    return Err(self.argument_count(function, &name, arguments.len(), item));
                }
                self.push(Term::Call(function, arguments));
            }
        }
        self.cursor.advance();
        Ok(())
    }

    fn part_arguments(&mut self, item: &Item<'t>) -> Result<(), FormulaError> {
        match self.brackets.last() {
            Some(Bracket { kind: BracketKind::Call { .. }, .. }) => {}
            Some(Bracket { kind: BracketKind::Bar, open }) => return Err(fault::unclosed(open)),
            _ => {
                let before = self.cursor.previous().map(|item| item.kind);
                let is_between = before == Some(Kind::number) && self.cursor.second().kind == Kind::number;
                return Err(fault::stray_comma(item, is_between));
            }
        }
        self.settle_bracket();
        self.cursor.advance();
        Ok(())
    }

    /// Gives the topmost operator its operands.
    fn settle(&mut self) {
        const COMPLETE: &str = "an operator is settled when its operands are complete";
        let last = self.operands.pop().expect(COMPLETE);
        let term = match self.pending.pop().expect(COMPLETE) {
            Pending::Prefix(prefix) => Term::Prefix(prefix, last),
            Pending::Infix(infix) => Term::Infix(infix, self.operands.pop().expect(COMPLETE), last),
            Pending::Root => {
                self.depth -= 1;
                Term::Call(Function::Operation(Operation::SquareRoot), vec![last])
            }
            Pending::Bracket => unreachable!("brackets are taken away by what closes them"),
        };
        self.push(term);
    }

    fn settle_all(&mut self) {
        while !self.pending.is_empty() {
            self.settle();
        }
    }

    fn push(&mut self, term: Term) {
        let id = self.tree.push(term);
        self.operands.push(id);
    }

    fn missing_operand(&self, item: &Item<'t>) -> FormulaError {
        let previous = self.cursor.previous_on_lines();
        let is_first = previous.is_some_and(|previous| previous.kind == Kind::open);
        match (item.kind, self.brackets.last()) {
            (Kind::stray, _) => fault::stray(item),
            (kind, Some(bracket)) if ends_statement(kind) => fault::unclosed(&bracket.open),
            (Kind::close, None) => FormulaError::new(FormulaErrorKind::UnopenedParenthesis, item.span()),
            (Kind::close, Some(Bracket { kind: BracketKind::Bar, open })) => fault::unclosed(open),
            (Kind::close, Some(Bracket { kind: BracketKind::Call { function, name, .. }, .. }))
                if is_first =>
            {
                self.argument_count(*function, name, 0, item)
            }
            _ => fault::missing_operand(item, previous, self.cursor.previous()),
        }
    }

    fn missing_operator(&self, item: &Item<'t>) -> FormulaError {
        match (item.kind, self.brackets.last()) {
            (Kind::stray, _) => fault::stray(item),
            (Kind::equal, Some(Bracket { kind: BracketKind::Parenthesis, open }))
                if !self.cursor.is_closed_later() =>
            {
                fault::unclosed(open)
            }
            (Kind::equal, innermost) => fault::equation_inside(item, innermost.is_some()),
            (kind, Some(bracket)) if ends_statement(kind) => fault::unclosed(&bracket.open),
            (kind, None) if ends_statement(kind) => fault::misplaced_definition(item),
            _ => fault::missing_operator(item),
        }
    }

    fn argument_count(
        &self,
        function: Function,
        name: &Item<'_>,
        given: usize,
        close: &Item<'_>,
    ) -> FormulaError {
        let span = name.start..close.span().end;
        let expected = self.scope.argument_count(function);
        fault::argument_count(name.text, given, expected, span, self.scope.pattern(name.text, function))
    }
}

/// Whether an item cannot stand inside brackets, so that one of those still open must lack its end.
fn ends_statement(kind: Kind) -> bool {
    matches!(kind, Kind::EOI | Kind::semicolon | Kind::function_head | Kind::value_head | Kind::define)
}

fn infix_of(kind: Kind) -> Option<Infix> {
    Some(match kind {
        Kind::or => Infix::Or,
        Kind::and => Infix::And,
        Kind::less => Infix::Less,
        Kind::less_or_equal => Infix::LessOrEqual,
        Kind::greater => Infix::Greater,
        Kind::greater_or_equal => Infix::GreaterOrEqual,
        Kind::double_equal => Infix::Equal,
        Kind::not_equal => Infix::NotEqual,
        Kind::plus => Infix::Add,
        Kind::minus => Infix::Subtract,
        Kind::times => Infix::Multiply,
        Kind::over => Infix::Divide,
        Kind::power => Infix::Power,
        _ => return None,
    })
}
