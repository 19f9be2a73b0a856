//! Starting over in Train, by one key.

use super::guided;
use super::session::Session;
use crate::ui::guiding;
use crate::ui::lessons::practising;
use crate::ui::lessons::state;
use crate::ui::message_list::Tone;

/// Puts everything in Train back where it started, by one key. What is being done begins anew: an experiment, a try at a lesson; an
/// attempt that counts is removed, which is said.
pub fn start_over(session: &mut Session) {
    if session.experiments.guided.as_ref().is_some_and(|g| matches!(g.phase, guided::Phase::Going(_))) {
        guiding::begin_experiment(&mut session.experiments, &mut session.training.trainer, &mut session.messages);
        session.messages.say(Tone::Done, "The experiment begins anew; what was recorded of it is removed.".to_owned());
        return;
    }
    let Some(phase) = session.training.lessons.open.as_ref().map(|open| open.phase.clone()) else {
        let choice = session.training.trainer.choice;
        if let Err(problem) = session.training.trainer.choose(choice) {
            session.messages.fail(problem);
        }
        return;
    };
    match phase {
        state::Phase::Watching => practising::watch_lesson(session),
        state::Phase::Practising => practising::practise_lesson(session),
        state::Phase::Testing | state::Phase::Asking => {
            practising::test_lesson(session);
            session.messages.say(Tone::Done, "The attempt begins anew; what was recorded of it is removed.".to_owned());
        }
        state::Phase::Brief | state::Phase::Debrief(_) => practising::back_to_brief(session),
        // The recording is being read.
        state::Phase::Grading => {}
    }
}
