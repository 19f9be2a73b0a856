//! The history of the person who practises, in the window.

use crate::history::attempt::Attempt;
use crate::history::keeper::{Answer, History};
use crate::history::store::Query;
use crate::ui::shell::message_list::{Messages, Tone};
use crate::ui::train::learning::{AHEAD, Learned, Learning, POINTS};
use estimator::training::progress::{self, LearningCurve, Try};
use std::path::PathBuf;

impl Learned {
    /// Of attempts under the same conditions, the oldest first.
    pub fn new(attempts: Vec<Attempt>) -> Self {
        let tries: Vec<(usize, Try)> =
            attempts.iter().enumerate().filter_map(|(k, attempt)| Some((k + 1, attempt.as_try()?))).collect();
        let plain: Vec<Try> = tries.iter().map(|(_, t)| *t).collect();
        let number = |k: usize| tries[k].0;
        let session = |s: progress::Session| (number(s.first), number(s.end - 1), s.mean, s.half_width);
        let sessions = progress::sessions(&plain).into_iter().map(session).collect();
        let values: Vec<f64> = plain.iter().map(|t| t.value).collect();
        let curve = LearningCurve::fit(&values);
        let last = values.len() as f64 * (1.0 + AHEAD);
        let at = |k: usize| 1.0 + (last - 1.0) * k as f64 / (POINTS - 1) as f64;
        let points = curve.iter().flat_map(|curve| (0..POINTS).map(|k| curve.at(at(k)))).collect();
        let proficient_at = progress::proficient_at(&plain).map(number);
        Self { attempts, tries, sessions, curve, points, proficient_at }
    }
}

/// Keeps attempts in this database from now on, and shows what is there.
pub fn open_history(learning: &mut Learning, messages: &mut Messages, ctx: &egui::Context, database: PathBuf) {
    let ctx = ctx.clone();
    match History::start(database, move || ctx.request_repaint()) {
        Ok(history) => {
            history.read_trainees();
            learning.keep_in(history);
        }
        Err(problem) => messages.fail(problem),
    }
}

/// Keeps an attempt; false where nothing is kept.
pub fn keep_attempt(learning: &Learning, attempt: Attempt) -> bool {
    let history = learning.history.as_ref();
    history.is_some_and(|history| {
        history.add(attempt);
        true
    })
}

/// Writes the attempts of who practises as a table.
pub fn export_history(learning: &Learning, to: PathBuf) {
    let query = Query { trainee: learning.trainee.clone(), lesson: None };
    if let Some(history) = &learning.history {
        history.export(to, query);
    }
}

/// Takes what the history has answered.
pub(crate) fn follow_history(learning: &mut Learning, messages: &mut Messages) {
    let Some(history) = &learning.history else { return };
    for answer in history.poll() {
        match answer {
            Answer::Kept(attempt) => attempt_kept(learning, *attempt),
            Answer::Trainees(names) => trainees_known(learning, names),
            Answer::Attempts(query, attempts) if query.trainee == learning.trainee => {
                learning.take(attempts);
            }
            Answer::Attempts(..) => {}
            Answer::Exported(path) => messages.say_saved(&path),
            Answer::TakenIn(1) => {
                messages.say(Tone::Done, "An attempt of earlier was taken into the history.".to_owned());
            }
            Answer::TakenIn(count) => {
                messages.say(Tone::Done, format!("{count} attempts of earlier were taken into the history."));
            }
            Answer::Problem(problem) => messages.fail(problem),
        }
    }
}

fn attempt_kept(learning: &mut Learning, attempt: Attempt) {
    if !learning.trainees.contains(&attempt.trainee) {
        learning.trainees.push(attempt.trainee.clone());
    }
    if learning.trainee.as_ref() == Some(&attempt.trainee) {
        // The newest, whatever the clock says. What the history was asked for before has been answered before, without it; what
        // it is asked for afterwards takes the place of these.
        let mut attempts = std::mem::take(&mut learning.attempts);
        attempts.push(attempt);
        learning.take(attempts);
    }
}

/// Takes over the known trainees. A single one is chosen at once.
fn trainees_known(learning: &mut Learning, names: Vec<String>) {
    learning.trainees = names;
    if let ([only], None) = (learning.trainees.as_slice(), &learning.trainee) {
        let only = only.clone();
        learning.choose(&only);
    }
}
