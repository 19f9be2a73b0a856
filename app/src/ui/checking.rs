//! What a diagnosis is worth on recordings that took no part in it.

use super::jobs::{change, no_change};
use super::session::Session;
use crate::ui::checked::{CHECK, Checked, On, check_now};

impl Session {
    /// Checks the answer in the background.
    pub fn check(&mut self, ctx: &egui::Context, on: On) {
        let Some(answer) = self.diagnosing.answer.clone() else { return };
        self.diagnosing.check_field.clear();
        let (recordings, choice) = (self.document.recordings.clone(), self.calibration.choice.clone());
        self.jobs.start(ctx, CHECK, "Checking on other recordings", move |ticket| {
            match check_now(&recordings, &choice, &answer, &on, &|share| ticket.goes_on(share)) {
                Some(checked) => change(|session: &mut Self, _| session.checked(checked)),
                None => no_change(),
            }
        });
    }

    /// A check has ended: what is newer takes the place of what was there of the same name.
    pub(super) fn checked(&mut self, checked: Vec<Checked>) {
        let all = &mut self.diagnosing.checked;
        all.retain(|old| checked.iter().all(|new| new.name != old.name));
        all.extend(checked);
    }
}
