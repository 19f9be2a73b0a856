//! Taking changes back, and bringing them back.

use super::session::Session;
use crate::ui::message_list::Tone;
use crate::ui::undo::{Undoable, difference};

impl Session {
    /// Notices what was changed; call once a frame. What is dragged while a button is `held` is one change, however long one hesitates.
    pub fn note_changes(&mut self, now_s: f64, held: bool) {
        if !self.document.recordings.is_empty() && !held {
            let now = Undoable::of(&self.calibration.choice, &self.plots);
            self.document.undo.undoer.feed_state(now_s, &now);
        }
    }

    /// True when there is something to take back.
    pub fn can_undo(&self) -> bool {
        self.document.undo.undoer.has_undo(&Undoable::of(&self.calibration.choice, &self.plots))
    }

    /// True when something was taken back.
    pub fn can_redo(&self) -> bool {
        self.document.undo.undoer.has_redo(&Undoable::of(&self.calibration.choice, &self.plots))
    }

    /// Takes the last change back.
    pub fn undo(&mut self) {
        let now = Undoable::of(&self.calibration.choice, &self.plots);
        if let Some(before) = self.document.undo.undoer.undo(&now).cloned() {
            self.messages.say(Tone::Done, format!("Undone: {}.", difference(&now, &before)));
            self.put_back(before);
        }
    }

    /// Brings back what was taken back.
    pub fn redo(&mut self) {
        let now = Undoable::of(&self.calibration.choice, &self.plots);
        if let Some(after) = self.document.undo.undoer.redo(&now).cloned() {
            self.messages.say(Tone::Done, format!("Redone: {}.", difference(&now, &after)));
            self.put_back(after);
        }
    }

    fn put_back(&mut self, Undoable { choice, overlaid }: Undoable) {
        self.plots.overlaid = overlaid;
        if let (Some(rules), true) = (self.calibration.rules.as_mut(), self.calibration.choice.own != choice.own) {
            rules.draft = choice.own.as_deref().unwrap_or(&rules.before).clone();
            rules.untried = true;
        }
        let segments_differ = self.calibration.choice.segments != choice.segments;
        self.calibration.choice = choice;
        if segments_differ {
            self.show_segments();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::prepare::Prepared;
    use estimator::segment::Method;
    use haptics::recording::Recording;
    use std::sync::Arc;

    fn session() -> Session {
        let mut session = Session::new();
        session.show(vec![Arc::new(Prepared::new(Recording::default()))]);
        session
    }

    /// Frames pass.
    fn wait(session: &mut Session, from_s: f64) -> f64 {
        for frame in 0..60 {
            session.note_changes(from_s + f64::from(frame) / 30.0, false);
        }
        from_s + 2.0
    }

    #[test]
    fn changes_are_taken_back_one_by_one_and_brought_back() {
        let mut session = session();
        let mut now = wait(&mut session, 0.0);
        session.calibration.choice.method = Method::Hmm;
        now = wait(&mut session, now);
        session.calibration.choice.only_s = Some((1.0, 2.0));
        wait(&mut session, now);
        assert!(session.can_undo() && !session.can_redo());
        session.undo();
        assert_eq!((session.calibration.choice.method, session.calibration.choice.only_s), (Method::Hmm, None));
        assert!(session.messages.banners.last().is_some_and(|b| b.text == "Undone: part of the recording."));
        session.undo();
        assert_eq!(session.calibration.choice.method, Method::Threshold);
        assert!(!session.can_undo());
        session.undo();
        session.redo();
        session.redo();
        assert_eq!(session.calibration.choice.only_s, Some((1.0, 2.0)));
        assert!(!session.can_redo());
    }

    #[test]
    fn a_drag_is_one_change() {
        let mut session = session();
        let mut now = wait(&mut session, 0.0);
        for step in 0..100 {
            session.calibration.choice.only_s = Some((0.0, f64::from(step)));
            now += 0.02;
            session.note_changes(now, true);
        }
        wait(&mut session, now);
        session.undo();
        assert_eq!(session.calibration.choice.only_s, None);
    }

    #[test]
    fn a_drag_in_which_one_hesitates_or_that_is_drawn_slowly_is_one_change() {
        let mut session = session();
        let mut now = wait(&mut session, 0.0);
        for step in 0..4 {
            session.calibration.choice.only_s = Some((0.0, f64::from(step)));
            for _ in 0..5 {
                now += 0.4;
                session.note_changes(now, true);
            }
        }
        wait(&mut session, now);
        session.undo();
        assert_eq!(session.calibration.choice.only_s, None);
        assert!(!session.can_undo());
    }

    #[test]
    fn other_recordings_begin_with_nothing_to_take_back() {
        let mut session = session();
        let now = wait(&mut session, 0.0);
        session.calibration.choice.method = Method::Hmm;
        wait(&mut session, now);
        let again = session.document.recordings.clone();
        session.show(again);
        wait(&mut session, 10.0);
        assert!(!session.can_undo());
    }
}
