//! Starting over in Train, by one key.

use super::guided;
use super::session::Session;
use crate::ui::lessons::state;
use crate::ui::message_list::Tone;

impl Session {
    /// Puts everything in Train back where it started, by one key. What is being done begins anew: an experiment, a try at a lesson; an
    /// attempt that counts is removed, which is said.
    pub fn start_over(&mut self) {
        if self.experiments.guided.as_ref().is_some_and(|g| matches!(g.phase, guided::Phase::Going(_))) {
            self.begin_experiment();
            self.messages.say(Tone::Done, "The experiment begins anew; what was recorded of it is removed.".to_owned());
            return;
        }
        let Some(phase) = self.training.lessons.open.as_ref().map(|open| open.phase.clone()) else {
            let choice = self.training.trainer.choice;
            if let Err(problem) = self.training.trainer.choose(choice) {
                self.messages.fail(problem);
            }
            return;
        };
        match phase {
            state::Phase::Watching => self.watch_lesson(),
            state::Phase::Practising => self.practise_lesson(),
            state::Phase::Testing | state::Phase::Asking => {
                self.test_lesson();
                self.messages
                    .say(Tone::Done, "The attempt begins anew; what was recorded of it is removed.".to_owned());
            }
            state::Phase::Brief | state::Phase::Debrief(_) => self.back_to_brief(),
            // The recording is being read.
            state::Phase::Grading => {}
        }
    }
}
