//! The wish that work ends before it is done.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::GridError;

/// A flag that tells work on a surface to end soon, done or not. Its copies are one flag.
///
/// Work looks at it often and then returns in a moment, with results that mean nothing: whoever asked for them sees
/// [`Stop::is_requested`], and leaves them out.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks all work that looks at this flag to end.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether work is to end. Once it is, it stays so.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// An error when work is to end.
    pub(crate) fn check(&self) -> Result<(), GridError> {
        if self.is_requested() { Err(GridError::Stopped) } else { Ok(()) }
    }
}
