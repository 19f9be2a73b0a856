//! Starting over in Train, by one key.

use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::diagnose::guidance;
use crate::ui::diagnose::guided_experiment;
use crate::ui::shell::message_list::{Messages, Tone};
use crate::ui::train::lessons::practising;
use crate::ui::train::lessons::state;
use crate::ui::train::state::Training;

/// Puts everything in Train back where it started, by one key. What is being done begins anew: an experiment, a try at a lesson; an
/// attempt that counts is removed, which is said.
pub fn start_over(experiments: &mut Experiments, training: &mut Training, messages: &mut Messages) {
    if experiments.guided.as_ref().is_some_and(|g| matches!(g.phase, guided_experiment::Phase::Going(_))) {
        guidance::begin_experiment(experiments, &mut training.trainer, messages);
        messages.say(Tone::Done, "The experiment begins anew; what was recorded of it is removed.".to_owned());
        return;
    }
    let Some(phase) = training.lessons.open.as_ref().map(|open| open.phase.clone()) else {
        let choice = training.trainer.choice;
        if let Err(problem) = training.trainer.choose(choice) {
            messages.fail(problem);
        }
        return;
    };
    match phase {
        state::Phase::Watching => practising::watch_lesson(training, messages),
        state::Phase::Practising => practising::practise_lesson(training, messages),
        state::Phase::Testing | state::Phase::Asking => {
            practising::test_lesson(training, messages);
            messages.say(Tone::Done, "The attempt begins anew; what was recorded of it is removed.".to_owned());
        }
        state::Phase::Brief | state::Phase::Debrief(_) => practising::back_to_brief(training, messages),
        // The recording is being read.
        state::Phase::Grading => {}
    }
}
