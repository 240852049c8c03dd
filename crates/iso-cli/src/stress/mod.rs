//! The suite of hard cases, `testdata/stability`: what is true of them, and what the engines and methods make of them.

mod document;
mod engines;
mod measure;
mod page;
mod shapes;
mod suite;
mod terminal;
mod truth;

pub(crate) use document::write_document;
pub(crate) use measure::{Measured, measure};
pub(crate) use page::write_page;
pub(crate) use suite::{Case, cases};
pub(crate) use terminal::write_table;
