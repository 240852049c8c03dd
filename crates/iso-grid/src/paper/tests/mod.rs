//! The paper's methods as a whole: what they find, and what they are documented to get wrong.

mod closed_forms;
mod limits;
