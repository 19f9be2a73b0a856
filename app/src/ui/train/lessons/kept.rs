//! Storage of completed attempts in the trainee's history.

use crate::history::attempt::{Attempt, Conditions};
use crate::ui::train::lessons::state::Debrief;
use crate::ui::train::state::Training;
use crate::ui::train::trainees;
use jiff::{SignedDuration, Timestamp};

/// Stores a graded attempt under the trainee's name; does nothing without a name.
pub(crate) fn keep_graded(training: &mut Training, debrief: &Debrief) {
    training.learning.experts.insert(debrief.grade.lesson.clone(), 100.0);
    let Some(trainee) = training.learning.trainee.clone() else { return };
    let line = training.trainer.delay();
    let conditions = Conditions { delay_ms: 1e3 * line.round_trip_s, predicted: line.predicted && !line.is_none() };
    let attempt = attempt_of(debrief, trainee, conditions, Timestamp::now());
    let before = training.learning.attempts.iter().rev().find(|earlier| earlier.is_like(&attempt));
    let proficient = attempt.meets_criterion && before.is_some_and(|earlier| earlier.meets_criterion);
    trainees::keep_attempt(&training.learning, Attempt { proficient, ..attempt });
}

/// Attempt that has ended now.
fn attempt_of(debrief: &Debrief, trainee: String, conditions: Conditions, ended: Timestamp) -> Attempt {
    let grade = &debrief.grade;
    let duration_s = grade.measures.hand.duration_s;
    Attempt {
        trainee,
        lesson: grade.lesson.clone(),
        conditions,
        began: ended.checked_sub(SignedDuration::from_secs_f64(duration_s)).unwrap_or(ended),
        duration_s,
        completed: grade.completed,
        score: grade.score,
        meets_criterion: grade.meets_criterion,
        proficient: false,
        measures: serde_json::to_value(&grade.measures).unwrap_or_default(),
        measures_version: grade.measures.version,
        grade_version: grade.version,
        recording: Some(debrief.path.clone()),
    }
}
