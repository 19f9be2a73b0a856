//! Early end of unwanted work: long computations look from time to time for a waiting caller, and end early without
//! one.
//!
//! The wish belongs to the thread that works ([`while_wanted`]); without one, everything is wanted. It does not go along as an argument,
//! because the loops that take the time lie deep below functions that have nothing else to do with it. What an ended loop leaves is no
//! result: the stage around it asks [`check`] before it keeps anything for later or hands it on.

use crate::estimate::EstimateError;
use std::cell::RefCell;
use std::rc::Rc;

type Wish = Rc<dyn Fn() -> bool>;

thread_local! {
    static WISH: RefCell<Option<Wish>> = const { RefCell::new(None) };
}

/// Restores the earlier wish, also when the work panics.
struct Before(Option<Wish>);

impl Drop for Before {
    fn drop(&mut self) {
        let before = self.0.take();
        WISH.with(|wish| *wish.borrow_mut() = before);
    }
}

/// Does `work` as long as `wanted` says so; `None` when it no longer did so at the end. Of several around each other the innermost counts.
pub fn while_wanted<T>(wanted: impl Fn() -> bool + 'static, work: impl FnOnce() -> T) -> Option<T> {
    let wish: Wish = Rc::new(wanted);
    let _before = Before(WISH.with(|now| now.borrow_mut().replace(Rc::clone(&wish))));
    let done = work();
    wish().then_some(done)
}

/// False when nobody waits for what this thread does: a loop ends, and its caller asks [`check`].
pub fn is_wanted() -> bool {
    // The wish is called outside of the borrow: it may look itself.
    let wish = WISH.with(|wish| wish.borrow().clone());
    wish.is_none_or(|wanted| wanted())
}

/// An error if the result of this thread is not wanted any more.
///
/// # Errors
/// [`EstimateError::Ended`] then.
pub fn check() -> Result<(), EstimateError> {
    if is_wanted() { Ok(()) } else { Err(EstimateError::Ended) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    #[test]
    fn nobody_said_anything_so_all_is_wanted() {
        assert!(is_wanted() && check().is_ok());
    }

    #[test]
    fn work_ends_where_it_looks_and_brings_nothing() {
        let left = Rc::new(Cell::new(3));
        let count = Rc::clone(&left);
        let mut rounds = 0;
        let result = while_wanted(
            move || count.replace(count.get().max(1) - 1) > 1,
            || {
                while check().is_ok() {
                    rounds += 1;
                }
            },
        );
        assert_eq!((result, rounds, left.get()), (None, 2, 0));
        assert!(is_wanted(), "only that work was not wanted");
    }

    #[test]
    fn the_wish_is_this_threads_alone_and_a_panic_takes_it_along() {
        let inside = while_wanted(|| false, || (is_wanted(), std::thread::spawn(is_wanted).join().expect("no panic")));
        assert_eq!(inside, None);
        let caught = catch_unwind(AssertUnwindSafe(|| while_wanted(|| false, || panic!("a bug"))));
        assert!(caught.is_err() && is_wanted());
        // The innermost counts, and the outer one is there again.
        let (inner, outer) =
            while_wanted(|| true, || (while_wanted(|| false, is_wanted), is_wanted())).expect("wanted");
        assert_eq!((inner, outer), (None, true));
    }
}
