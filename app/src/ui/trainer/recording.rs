//! Recording while training: starting it, following it, ending it. The ticks go to the disk past the window.

use crate::recorder::{FILE_BYTES, Order, Recorder, ServoFacts, Status, Stopping, folder};
use crate::ui::trainer::engine::Engine;
use crate::ui::trainer::live::{Sensors, Trainer};
use haptics::servo::recorder::SensorModel;
use std::sync::Arc;

impl Trainer {
    /// Begins to write every tick to a file. Errors are one sentence; those of the disk come later, from
    /// [`Self::take_ended_recording`].
    pub fn start_recording(&mut self) -> Result<(), String> {
        if self.is_recording() {
            return Ok(());
        }
        let tap = self.engine.as_ref().map(Engine::tap).cloned();
        let (Some(tap), Some((_, world))) = (tap, self.scene()) else {
            return Err("There is nothing to record yet: open the trainer first.".to_owned());
        };
        let world = Arc::clone(world);
        let folder = self.recordings_folder.clone().or_else(folder::of_user).ok_or(
            "The system names no folder for recordings; set HOME or XDG_DATA_HOME, then start the program again.",
        )?;
        let sensors = match self.sensors {
            Sensors::Usual => SensorModel::TYPICAL,
            Sensors::Ideal => SensorModel::IDEAL,
        };
        self.hold.count_anew();
        self.recordings_made += 1;
        let stated = self.stated.clone();
        let (device, servo, seed) = (self.spec.clone(), self.servo_facts(), self.recordings_made as u64);
        self.recorder = Some(Recorder::start(
            &tap,
            Order { folder, world, device, sensors, seed, servo, file_bytes: FILE_BYTES, stated },
        )?);
        Ok(())
    }

    /// States something at the end of the running recording.
    pub fn state_at_end(&mut self, key: &str, value: serde_json::Value) {
        if let Some(recorder) = &self.recorder {
            recorder.state(key, value);
        }
    }

    /// True while every tick is kept.
    pub fn is_recording(&self) -> bool {
        self.recorder.is_some()
    }

    /// How far the running recording is.
    pub fn recording_status(&self) -> Option<Status> {
        self.recorder.as_ref().map(Recorder::status)
    }

    /// Ends the recording; its file gets its end in the background.
    pub fn stop_recording(&mut self) -> Option<Stopping> {
        let facts = self.servo_facts();
        let recorder = self.recorder.take()?;
        recorder.tell(facts);
        Some(recorder.stop())
    }

    /// Ends the recording and removes its file.
    pub fn discard_recording(&mut self) {
        if let Some(recorder) = self.recorder.take() {
            recorder.discard();
        }
    }

    /// A recording that ended without being asked to: with its world or its servo, or because of the disk. It is told once.
    pub fn take_ended_recording(&mut self) -> Option<Stopping> {
        self.ended.pop()
    }

    /// Ends the recording because what is recorded ends.
    pub(super) fn end_recording(&mut self) {
        let ended = self.stop_recording();
        self.ended.extend(ended);
    }

    /// Once a frame: tells the recording how the servo keeps its time, and sees when it has ended by itself.
    pub(super) fn follow_recording(&mut self) {
        let facts = self.servo_facts();
        match &self.recorder {
            Some(recorder) if recorder.has_ended() => self.end_recording(),
            Some(recorder) => recorder.tell(facts),
            None => {}
        }
    }

    fn servo_facts(&self) -> ServoFacts {
        let timing = self.newest.as_ref().map(|snapshot| snapshot.timing).unwrap_or_default();
        ServoFacts { timing, privileges: self.privileges() }
    }
}
