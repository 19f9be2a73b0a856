//! The time cursor: seeking, playing, and the view that follows.

use crate::ui::document::state::Document;

impl Document {
    /// Puts the cursor to the beginning of a span and shows the span with its surroundings.
    pub fn look_at(&mut self, from_s: f64, to_s: f64) {
        let Some((first, last)) = self.prepared().map(|p| p.span()) else { return };
        let width = (4.0 * (to_s - from_s)).max(0.02 * (last - first)).min(last - first);
        let start = (0.5 * (from_s + to_s - width)).clamp(first, (last - width).max(first));
        self.view_s = (start, start + width);
        self.playing = false;
        self.seek(from_s);
    }

    /// Moves the cursor, within the recording.
    pub fn seek(&mut self, time: f64) {
        if let Some(prepared) = self.prepared() {
            let (first, last) = prepared.span();
            self.cursor_s = time.clamp(first, last);
            let (from, to) = self.view_s;
            if self.cursor_s < from || self.cursor_s > to {
                // The view follows a cursor that leaves it.
                let width = to - from;
                let start = (self.cursor_s - 0.1 * width).clamp(first, (last - width).max(first));
                self.view_s = (start, start + width);
            }
        }
    }

    /// Starts or stops the playback; at the end it starts over.
    pub fn toggle_play(&mut self) {
        if let Some(prepared) = self.prepared() {
            let (first, last) = prepared.span();
            if !self.playing && self.cursor_s >= last - 1e-9 {
                self.seek(first);
            }
            self.playing = !self.playing;
        }
    }

    /// Runs the cursor on by a frame.
    pub fn advance(&mut self, frame_s: f64) {
        let Some(prepared) = self.prepared().filter(|_| self.playing) else { return };
        let (first, last) = prepared.span();
        // A clockless log is played in ten seconds.
        let rate = if prepared.clockless() { (last - first) / 10.0 } else { 1.0 };
        let next = self.cursor_s + frame_s * rate * self.speed;
        self.playing = next < last;
        self.seek(next);
    }
}

#[cfg(test)]
mod tests {

    use crate::ui::document::prepared::Prepared;
    use crate::ui::session::Session;
    use haptics::recording::Recording;
    use std::sync::Arc;

    fn clockless(n: usize) -> Session {
        let mut session = Session::new();
        let channel = haptics::recording::Channel { name: "x_m".into(), unit: "m".into(), values: vec![0.0; n] };
        let recording = Recording { channels: vec![channel], ..Recording::default() };
        session.show(vec![Arc::new(Prepared::new(recording))]);
        session
    }

    #[test]
    fn the_cursor_stays_inside_and_the_view_follows() {
        let mut session = clockless(1_001);
        session.document.view_s = (0.0, 100.0);
        session.document.seek(500.0);
        assert!(session.document.view_s.0 <= 500.0 && session.document.view_s.1 >= 500.0);
        assert!((session.document.view_s.1 - session.document.view_s.0 - 100.0).abs() < 1e-9);
        session.document.seek(1e9);
        assert_eq!(session.document.cursor_s, 1_000.0);
    }

    #[test]
    fn a_span_is_shown_with_its_surroundings() {
        let mut session = clockless(1_001);
        session.document.look_at(500.0, 510.0);
        assert_eq!((session.document.view_s, session.document.cursor_s), ((485.0, 525.0), 500.0));
        session.document.look_at(0.0, 1_000.0);
        assert_eq!(session.document.view_s, (0.0, 1_000.0));
        session.document.look_at(1_000.0, 1_000.0);
        assert_eq!((session.document.view_s, session.document.cursor_s), ((980.0, 1_000.0), 1_000.0));
    }

    #[test]
    fn playback_ends_and_starts_over() {
        let mut session = clockless(1_001);
        session.document.toggle_play();
        session.document.advance(20.0);
        assert!(!session.document.playing && session.document.cursor_s == 1_000.0);
        session.document.toggle_play();
        assert!(session.document.playing && session.document.cursor_s == 0.0);
    }
}
