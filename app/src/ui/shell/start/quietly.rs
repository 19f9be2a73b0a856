//! A panic of the window library while it starts, caught without a word on standard error: a sentence follows.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};
use std::sync::Once;

/// Progress of the start.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    NotBegun,
    Opening,
    Open,
}

thread_local! {
    /// Progress on this thread; a window lives on the thread that opens it.
    static START: Cell<Start> = const { Cell::new(Start::NotBegun) };
}
static HOOK: Once = Once::new();

/// The window stands: from now on, a panic is a bug of this program and is reported as one.
pub fn opened() {
    START.set(Start::Open);
}

/// True once the window stood.
pub fn is_open() -> bool {
    START.get() == Start::Open
}

/// Runs `open`; `None` if it panicked before the window stood.
pub fn opening<T>(open: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if START.get() != Start::Opening {
                before(panic);
            }
        }));
    });
    START.set(Start::Opening);
    // Nothing that it left half-made is used again: the program ends, or another one takes its place.
    match catch_unwind(AssertUnwindSafe(open)) {
        Ok(done) => Some(done),
        Err(panic) if is_open() => resume_unwind(panic),
        Err(_) => {
            START.set(Start::NotBegun);
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_caught_before_the_window_stands_and_passed_on_after() {
        assert_eq!(opening(|| 3), Some(3));
        let empty: Vec<u8> = Vec::new();
        assert_eq!(opening(|| empty[empty.len()]), None);
        let after = || {
            opening(|| {
                opened();
                empty[empty.len()]
            })
        };
        assert!(catch_unwind(AssertUnwindSafe(after)).is_err());
        assert!(is_open());
    }
}
