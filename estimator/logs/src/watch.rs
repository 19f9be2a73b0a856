//! Watching and ending a long read.

use super::preview::Preview;
use std::sync::atomic::{AtomicBool, Ordering};

/// Watch of a caller over a long read: it learns the progress and can end it.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Told the share that is done, 0 … 1, never less than before; from any thread, about once a megabyte.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Set by anybody to end the read; it then answers [`LogError::Cancelled`](super::LogError::Cancelled).
    pub cancelled: &'a AtomicBool,
    /// Preview that is shown the rows read so far, if there is one.
    pub preview: Option<&'a Preview>,
}

/// Never set.
static NEVER: AtomicBool = AtomicBool::new(false);

impl Watch<'_> {
    /// No watcher: the read is neither shown nor ended.
    pub fn none() -> Watch<'static> {
        Watch { progress: &|_| {}, cancelled: &NEVER, preview: None }
    }

    /// True after the caller has ended it.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl std::fmt::Debug for Watch<'_> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.debug_struct("Watch").field("cancelled", &self.is_cancelled()).finish_non_exhaustive()
    }
}
