//! Checks of a diagnosis on held-out recordings.

use super::jobs::no_change;
use super::session::{Session, change};
use crate::ui::checked::{CHECK, Checked, On, check_now};

/// Checks the answer in the background.
pub fn check(session: &mut Session, ctx: &egui::Context, on: On) {
    let Some(answer) = session.diagnosing.answer.clone() else { return };
    session.diagnosing.check_field.clear();
    let (recordings, choice) = (session.document.recordings.clone(), session.calibration.choice.clone());
    session.jobs.start(ctx, CHECK, "Checking on other recordings", move |ticket| {
        match check_now(&recordings, &choice, &answer, &on, &|share| ticket.goes_on(share)) {
            Some(checked) => change(|session, _| take_checked(session, checked)),
            None => no_change(),
        }
    });
}

/// A check has ended: what is newer takes the place of what was there of the same name.
pub(crate) fn take_checked(session: &mut Session, checked: Vec<Checked>) {
    let all = &mut session.diagnosing.checked;
    all.retain(|old| checked.iter().all(|new| new.name != old.name));
    all.extend(checked);
}
