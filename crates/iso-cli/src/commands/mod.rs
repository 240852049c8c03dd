//! What the commands do, one module each.

pub(crate) mod bench;
pub(crate) mod completions;
pub(crate) mod engines;
pub(crate) mod eval;
pub(crate) mod explain;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod stress;
pub(crate) mod trace;
