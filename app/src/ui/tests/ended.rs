//! A fit that nobody waits for any more ends soon, and leaves nothing half done for the next one.

use super::{cart, performed};
use crate::ui::train::trainer::world_choice::WorldChoice;
use estimator::cancellation;
use estimator::pipeline::{self, Prepared};
use estimator::segment::Method;
use haptics::recording::Recording;
use std::cell::Cell;
use std::rc::Rc;

/// Fits; nobody waits any more from the look after so many on. What was fitted, and how often it looked.
fn fitted(recording: &Recording, shared: &Prepared, method: Method, wanted_for: usize) -> (Option<String>, usize) {
    let looks = Rc::new(Cell::new(0));
    let counted = Rc::clone(&looks);
    let still = move || {
        counted.set(counted.get() + 1);
        counted.get() <= wanted_for
    };
    let options = pipeline::Options { method, ..pipeline::Options::default() };
    let fit = || pipeline::analyse_prepared(std::slice::from_ref(recording), shared, &options);
    let done = cancellation::while_wanted(still, fit);
    (done.map(|found| format!("{:?}", found.expect("a fit").fit)), looks.get())
}

#[test]
fn an_ended_fit_does_little_more_and_the_next_one_is_as_if_it_had_not_been() {
    let recordings = [performed(WorldChoice::Crank), performed(WorldChoice::Needle), cart()];
    for recording in &recordings {
        for method in [Method::Threshold, Method::Hmm] {
            let (whole, looks) = fitted(recording, &Prepared::default(), method, usize::MAX);
            assert!(whole.is_some() && looks > 10, "{} looks {looks} times", recording.name);
            for part in 0..6 {
                let (shared, wanted_for) = (Prepared::default(), looks * part / 6);
                let (nothing, looked) = fitted(recording, &shared, method, wanted_for);
                assert_eq!(nothing, None);
                // The loops around the one that ended look once more each.
                let more = looked - wanted_for;
                assert!(more < 10 + looks / 10, "{}: {more} of {looks} after {wanted_for}", recording.name);
                let (next, _) = fitted(recording, &shared, method, usize::MAX);
                assert!(next == whole, "{}: something was kept after {wanted_for} of {looks}", recording.name);
            }
        }
    }
}
