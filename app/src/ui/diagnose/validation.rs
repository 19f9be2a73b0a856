//! Checks of a diagnosis on held-out recordings.

use crate::ui::background::jobs::Jobs;
use crate::ui::background::jobs::no_change;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::checked::{CHECK, Checked, On, check_now};
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};

/// Checks the answer in the background.
pub fn check(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    on: On,
) {
    let Some(answer) = diagnosing.answer.clone() else { return };
    diagnosing.check_field.clear();
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    jobs.start(ctx, CHECK, "Checking on other recordings", move |ticket| {
        match check_now(&recordings, &choice, &answer, &on, &|share| ticket.goes_on(share)) {
            Some(checked) => change(|session, _| take_checked(&mut session.diagnosing, checked)),
            None => no_change(),
        }
    });
}

/// A check has ended: what is newer takes the place of what was there of the same name.
pub(crate) fn take_checked(diagnosing: &mut Diagnosing, checked: Vec<Checked>) {
    let all = &mut diagnosing.checked;
    all.retain(|old| checked.iter().all(|new| new.name != old.name));
    all.extend(checked);
}
