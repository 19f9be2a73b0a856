//! Taking changes back, and bringing them back.

use crate::ui::calibrate::manual_states;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::document::undo::{Undoable, difference};
use crate::ui::plots::choices::PlotChoices;
use crate::ui::shell::message_list::{Messages, Tone};

/// Notices what was changed; call once a frame. What is dragged while a button is `held` is one change, however long one hesitates.
pub fn note_changes(document: &mut Document, calibration: &Calibration, plots: &PlotChoices, now_s: f64, held: bool) {
    if !document.recordings.is_empty() && !held {
        let now = Undoable::of(&calibration.choice, plots);
        document.undo.undoer.feed_state(now_s, &now);
    }
}

/// True when there is something to take back.
pub fn can_undo(document: &Document, calibration: &Calibration, plots: &PlotChoices) -> bool {
    document.undo.undoer.has_undo(&Undoable::of(&calibration.choice, plots))
}

/// True when something was taken back.
pub fn can_redo(document: &Document, calibration: &Calibration, plots: &PlotChoices) -> bool {
    document.undo.undoer.has_redo(&Undoable::of(&calibration.choice, plots))
}

/// Undoes the last change.
pub fn undo(document: &mut Document, calibration: &mut Calibration, plots: &mut PlotChoices, messages: &mut Messages) {
    let now = Undoable::of(&calibration.choice, plots);
    if let Some(before) = document.undo.undoer.undo(&now).cloned() {
        messages.say(Tone::Done, format!("Undone: {}.", difference(&now, &before)));
        put_back(document, calibration, plots, before);
    }
}

/// Brings back what was taken back.
pub fn redo(document: &mut Document, calibration: &mut Calibration, plots: &mut PlotChoices, messages: &mut Messages) {
    let now = Undoable::of(&calibration.choice, plots);
    if let Some(after) = document.undo.undoer.redo(&now).cloned() {
        messages.say(Tone::Done, format!("Redone: {}.", difference(&now, &after)));
        put_back(document, calibration, plots, after);
    }
}

fn put_back(
    document: &Document,
    calibration: &mut Calibration,
    plots: &mut PlotChoices,
    Undoable { choice, overlaid }: Undoable,
) {
    plots.overlaid = overlaid;
    if let (Some(rules), true) = (calibration.rules.as_mut(), calibration.choice.own != choice.own) {
        rules.draft = choice.own.as_deref().unwrap_or(&rules.before).clone();
        rules.untried = true;
    }
    let segments_differ = calibration.choice.segments != choice.segments;
    calibration.choice = choice;
    if segments_differ {
        manual_states::show_segments(document, calibration);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::document::prepared::Prepared;
    use crate::ui::session::Session;
    use estimator::segment::Method;
    use haptics::recording::Recording;
    use std::sync::Arc;

    fn session() -> Session {
        let mut session = Session::new();
        session.show(vec![Arc::new(Prepared::new(Recording::default()))]);
        session
    }

    /// Frames pass.
    fn wait(document: &mut Document, calibration: &Calibration, plots: &PlotChoices, from_s: f64) -> f64 {
        for frame in 0..60 {
            note_changes(document, calibration, plots, from_s + f64::from(frame) / 30.0, false);
        }
        from_s + 2.0
    }

    #[test]
    fn changes_are_taken_back_one_by_one_and_brought_back() {
        let mut session = session();
        let mut now = wait(&mut session.document, &session.calibration, &session.plots, 0.0);
        session.calibration.choice.method = Method::Hmm;
        now = wait(&mut session.document, &session.calibration, &session.plots, now);
        session.calibration.choice.only_s = Some((1.0, 2.0));
        wait(&mut session.document, &session.calibration, &session.plots, now);
        assert!(
            can_undo(&session.document, &session.calibration, &session.plots)
                && !can_redo(&session.document, &session.calibration, &session.plots)
        );
        undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        assert_eq!((session.calibration.choice.method, session.calibration.choice.only_s), (Method::Hmm, None));
        assert!(session.messages.banners.last().is_some_and(|b| b.text == "Undone: part of the recording."));
        undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        assert_eq!(session.calibration.choice.method, Method::Threshold);
        assert!(!can_undo(&session.document, &session.calibration, &session.plots));
        undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        redo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        redo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        assert_eq!(session.calibration.choice.only_s, Some((1.0, 2.0)));
        assert!(!can_redo(&session.document, &session.calibration, &session.plots));
    }

    #[test]
    fn a_drag_is_one_change() {
        let mut session = session();
        let mut now = wait(&mut session.document, &session.calibration, &session.plots, 0.0);
        for step in 0..100 {
            session.calibration.choice.only_s = Some((0.0, f64::from(step)));
            now += 0.02;
            note_changes(&mut session.document, &session.calibration, &session.plots, now, true);
        }
        wait(&mut session.document, &session.calibration, &session.plots, now);
        undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        assert_eq!(session.calibration.choice.only_s, None);
    }

    #[test]
    fn a_drag_in_which_one_hesitates_or_that_is_drawn_slowly_is_one_change() {
        let mut session = session();
        let mut now = wait(&mut session.document, &session.calibration, &session.plots, 0.0);
        for step in 0..4 {
            session.calibration.choice.only_s = Some((0.0, f64::from(step)));
            for _ in 0..5 {
                now += 0.4;
                note_changes(&mut session.document, &session.calibration, &session.plots, now, true);
            }
        }
        wait(&mut session.document, &session.calibration, &session.plots, now);
        undo(&mut session.document, &mut session.calibration, &mut session.plots, &mut session.messages);
        assert_eq!(session.calibration.choice.only_s, None);
        assert!(!can_undo(&session.document, &session.calibration, &session.plots));
    }

    #[test]
    fn other_recordings_begin_with_nothing_to_take_back() {
        let mut session = session();
        let now = wait(&mut session.document, &session.calibration, &session.plots, 0.0);
        session.calibration.choice.method = Method::Hmm;
        wait(&mut session.document, &session.calibration, &session.plots, now);
        let again = session.document.recordings.clone();
        session.show(again);
        wait(&mut session.document, &session.calibration, &session.plots, 10.0);
        assert!(!can_undo(&session.document, &session.calibration, &session.plots));
    }
}
