//! A place among the items of a text.

use std::ops::Range;

use super::error::{FormulaError, FormulaErrorKind};
use super::item::{Item, Kind};
use super::limits;

/// The items still to be read, and what is noted of those already read.
pub(super) struct Cursor<'t> {
    items: Vec<Item<'t>>,
    next: usize,
    /// How deep the text nests, and where it first goes beyond the limit.
    deepest: (usize, Range<usize>),
}

impl<'t> Cursor<'t> {
    /// `items` must end with an end item.
    pub(super) fn new(items: Vec<Item<'t>>) -> Self {
        Self { items, next: 0, deepest: (0, 0..0) }
    }

    pub(super) fn peek(&self) -> Item<'t> {
        self.items[self.next]
    }

    /// The item after [`Cursor::peek`].
    pub(super) fn second(&self) -> Item<'t> {
        self.items[(self.next + 1).min(self.items.len() - 1)]
    }

    /// The first item from here on that is not the end of a line.
    pub(super) fn next_on_lines(&self) -> Item<'t> {
        let rest = &self.items[self.next..];
        rest.iter().find(|item| item.kind != Kind::newline).copied().unwrap_or(self.peek())
    }

    /// The item before [`Cursor::peek`].
    pub(super) fn previous(&self) -> Option<Item<'t>> {
        self.next.checked_sub(1).map(|place| self.items[place])
    }

    /// Whether the name here begins a statement, and `=` follows it or its arguments.
    pub(super) fn is_at_left_side(&self) -> bool {
        let begins = self.previous().is_none_or(|item| matches!(item.kind, Kind::semicolon | Kind::newline));
        let mut depth = 0_usize;
        let after = self.items[self.next + 1..].iter().find(|item| {
            match item.kind {
                Kind::open => depth += 1,
                Kind::close => depth = depth.saturating_sub(1),
                _ => return depth == 0,
            }
            false
        });
        begins && after.is_some_and(|item| item.kind == Kind::equal)
    }

    /// Whether a parenthesis that is open here is closed later in the statement.
    pub(super) fn is_closed_later(&self) -> bool {
        let mut depth = 0_usize;
        for item in &self.items[self.next..] {
            match item.kind {
                Kind::open => depth += 1,
                Kind::close if depth == 0 => return true,
                Kind::close => depth -= 1,
                Kind::semicolon => return false,
                _ => {}
            }
        }
        false
    }

    /// The last item before [`Cursor::peek`] that is not the end of a line.
    pub(super) fn previous_on_lines(&self) -> Option<Item<'t>> {
        self.items[..self.next].iter().rev().find(|item| item.kind != Kind::newline).copied()
    }

    /// Steps over an item; the end stays.
    pub(super) fn advance(&mut self) {
        self.next = (self.next + 1).min(self.items.len() - 1);
    }

    /// Steps to the first item from here on that is not the end of a line.
    pub(super) fn skip_lines(&mut self) {
        while self.peek().kind == Kind::newline {
            self.advance();
        }
    }

    /// Notes that `item` opens a level of nesting.
    pub(super) fn note_depth(&mut self, depth: usize, item: &Item<'_>) {
        if depth == limits::DEEPEST_NESTING + 1 && self.deepest.0 < depth {
            self.deepest.1 = item.span();
        }
        self.deepest.0 = self.deepest.0.max(depth);
    }

    /// That the text nested no deeper than is allowed.
    pub(super) fn check_depth(&self) -> Result<(), FormulaError> {
        let (given, ref span) = self.deepest;
        let allowed = limits::DEEPEST_NESTING;
        if given > allowed {
            let kind = FormulaErrorKind::TooDeep { given, allowed };
            return Err(
                FormulaError::new(kind, span.clone()).with_help("name the inner parts: `a := …; f(a)`")
            );
        }
        Ok(())
    }
}
