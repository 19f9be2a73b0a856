//! Pause of the world, because the window lost the focus or the device stopped responding. Its clock stops, so no time
//! counts, and the force on the fingers drops to zero. On resume the force rises slowly.

use crate::ui::train::trainer::hand::{HandDevice, Steering};
use crate::ui::train::trainer::live::{Operator, Trainer};
use std::time::Instant;

/// Sidecar key under which a recording states its pauses: number and total duration.
pub const PAUSED: &str = "paused";
/// Silence after which a device counts as lost, s; sample age below which it is back, s.
const LOST_S: f64 = 0.5;
const BACK_S: f64 = 0.1;

/// Reason for the pause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Another window has the keyboard and the mouse.
    Focus,
    /// The device does not respond.
    Device,
}

/// State of the pause in the trainer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hold {
    since: Option<(Cause, Instant)>,
    /// Number of pauses in the running recording, and their total duration, s.
    times: u32,
    seconds: f64,
    listening: Listening,
}

/// Responsiveness of the device: it has answered, and still does.
#[derive(Clone, Copy, Debug, Default)]
struct Listening {
    /// Monitoring time, s, and age of the newest sample, s.
    for_s: f64,
    age_s: f64,
    answered: bool,
}

impl Listening {
    /// Advances by a frame. Returns true if a device that has answered before is silent for too long.
    fn hear(&mut self, age_s: f64, frame_s: f64) -> bool {
        self.for_s += frame_s;
        self.age_s = age_s;
        // Without any answer the sample age equals the monitoring time.
        self.answered |= self.for_s > BACK_S && age_s < 0.5 * self.for_s;
        self.answered && age_s > LOST_S
    }
}

impl Hold {
    /// Resets the counters for another recording.
    pub(super) fn count_anew(&mut self) {
        (self.times, self.seconds) = (0, 0.0);
    }
}

impl Trainer {
    /// Reason for the pause; `None` while the world runs.
    pub fn held(&self) -> Option<Cause> {
        self.hold.since.map(|(cause, _)| cause)
    }

    /// Message about the pause, and advice.
    pub fn held_words(&self) -> Option<(&'static str, &'static str)> {
        const GO_ON: &str = "Click here or press Space to go on.";
        Some(match self.held()? {
            Cause::Focus => ("Paused: the window lost the focus.", GO_ON),
            Cause::Device if self.device_is_back() => ("Paused: the device was gone. It is back.", GO_ON),
            Cause::Device => ("Paused: the device does not answer.", "Check its cable and power; then go on here."),
        })
    }

    /// Pauses because the window has lost the focus: the hand has left the task.
    pub fn lose_focus(&mut self) {
        if self.is_a_persons() {
            self.stand_still(Cause::Focus);
        }
    }

    /// Resumes. A pinch held by a button is kept until the key or a button opens it.
    pub fn go_on(&mut self) {
        let Some((cause, since)) = self.hold.since else { return };
        if cause == Cause::Device && !self.device_is_back() {
            return;
        }
        self.hold.seconds += since.elapsed().as_secs_f64();
        self.hold.since = None;
        self.pinch.latched |= self.pinch.button;
        if let Some(engine) = &mut self.engine {
            engine.hold(false);
        }
        self.state_pauses();
    }

    /// True if a person moves the fingers now.
    fn is_a_persons(&self) -> bool {
        self.engine.is_some() && self.operator == Operator::You && self.hand != HandDevice::Replay
    }

    fn stand_still(&mut self, cause: Cause) {
        if self.hold.since.is_some() {
            return;
        }
        self.hold.since = Some((cause, Instant::now()));
        self.hold.times += 1;
        if let Some(engine) = &mut self.engine {
            engine.hold(true);
        }
        self.state_pauses();
    }

    /// Stores the pauses in the recording, as an explanation for jumps of the hand.
    fn state_pauses(&mut self) {
        let (times, seconds) = (self.hold.times, (10.0 * self.hold.seconds).round() / 10.0);
        self.state_at_end(PAUSED, serde_json::json!({ "times": times, "seconds": seconds }));
    }

    fn device_is_back(&self) -> bool {
        self.hold.listening.age_s < BACK_S
    }

    /// Runs once per frame: pauses the world if a force-feedback device stops responding.
    pub(super) fn listen(&mut self, frame_s: f64) {
        let age_s = self.newest.as_ref().map_or(0.0, |snapshot| snapshot.timing.sample_age_s);
        let is_lost = self.hold.listening.hear(age_s, frame_s);
        let own = self.spec.as_ref().is_some_and(|spec| spec.force_feedback) && matches!(self.steering, Steering::None);
        if own && is_lost && self.is_a_persons() {
            self.stand_still(Cause::Device);
        }
    }

    /// Clears the pause when the engine ends or starts.
    pub(super) fn hold_nothing(&mut self) {
        self.hold = Hold { times: self.hold.times, seconds: self.hold.seconds, ..Hold::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of frames in which the device counts as lost, given the age of its newest sample in each frame.
    fn lost(ages_s: impl Iterator<Item = f64>) -> usize {
        let mut listening = Listening::default();
        ages_s.filter(|age_s| listening.hear(*age_s, 1.0 / 60.0)).count()
    }

    #[test]
    fn a_device_that_falls_silent_is_lost_and_one_that_was_never_there_is_not() {
        let steady = || (0..60).map(|_| 0.0);
        let silent = || (1..60).map(|k| f64::from(k) / 60.0);
        assert_eq!(lost(steady()), 0);
        assert_eq!(lost(silent()), 0, "nothing has answered yet: the page of devices says that");
        assert_eq!(lost(steady().chain(silent())), 29, "half a second after the last sample");
        let slow = (0..240).map(|k| f64::from(k % 12) / 60.0);
        assert_eq!(lost(slow), 0, "five answers a second are few, but no silence");
    }
}
