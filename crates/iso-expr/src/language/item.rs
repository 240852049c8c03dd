//! Text cut into items by the grammar.

use std::ops::Range;

use pest::Parser;
use pest_derive::Parser;

#[derive(Parser)]
#[grammar = "language/grammar.pest"]
struct Grammar;

/// The kinds of items, named in `grammar.pest`.
pub(super) use Rule as Kind;

/// A piece of the text that has a meaning of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<'t> {
    pub(super) kind: Kind,
    pub(super) text: &'t str,
    pub(super) start: usize,
}

impl Item<'_> {
    pub(super) fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// The item in an error message.
    pub(super) fn shown(&self) -> String {
        match self.kind {
            Kind::EOI => "the end".to_owned(),
            Kind::newline => "the end of the line".to_owned(),
            _ => format!("`{}`", shortened(self.text)),
        }
    }
}

/// What stands to the left of `:=`.
#[derive(Debug)]
pub(super) struct Head<'t> {
    pub(super) name: Item<'t>,
    /// The parameters of a function; none for a value.
    pub(super) parameters: Vec<Item<'t>>,
}

/// The items of `text`, with an end item after the last one, and the heads of all definitions in their order.
pub(super) fn items(text: &str) -> (Vec<Item<'_>>, Vec<Head<'_>>) {
    let mut items = Vec::new();
    let mut heads = Vec::new();
    let mut formula = Grammar::parse(Rule::formula, text).expect("the grammar gives every text a meaning");
    for pair in formula.next().into_iter().flat_map(|formula| formula.into_inner()) {
        let item = item(&pair);
        items.push(item);
        if matches!(item.kind, Kind::function_head | Kind::value_head) {
            let mut names = pair.into_inner().map(|pair| self::item(&pair));
            let name = names.next().expect("a head starts with a name");
            heads.push(Head { name, parameters: names.collect() });
        }
    }
    (items, heads)
}

/// Whether `text` is a name that a definition could have, unless the language has a meaning for it.
pub(super) fn is_name(text: &str) -> bool {
    let (items, _) = items(text);
    matches!(items[..], [item, Item { kind: Kind::EOI, .. }] if item.kind == Kind::name && item.text == text)
}

fn item<'t>(pair: &pest::iterators::Pair<'t, Rule>) -> Item<'t> {
    Item { kind: pair.as_rule(), text: pair.as_str(), start: pair.as_span().start() }
}

/// Text for an error message, cut when long.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
