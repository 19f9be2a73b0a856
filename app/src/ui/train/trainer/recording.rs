//! Recording in the trainer: start, progress, end. The ticks go directly to the disk, not through the window.

use crate::recorder::{FILE_BYTES, Order, Recorder, ServoFacts, Status, Stopping, folder};
use crate::ui::train::trainer::engine::Engine;
use crate::ui::train::trainer::live::{Sensors, Trainer};
use haptics::servo::recorder::SensorModel;
use std::sync::Arc;

impl Trainer {
    /// Starts to write every tick to a file. Errors are one sentence; those of the disk come later, from
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

    /// Adds a sidecar entry at the end of the running recording.
    pub fn state_at_end(&mut self, key: &str, value: serde_json::Value) {
        if let Some(recorder) = &self.recorder {
            recorder.state(key, value);
        }
    }

    /// True while every tick is recorded.
    pub fn is_recording(&self) -> bool {
        self.recorder.is_some()
    }

    /// Progress of the running recording.
    pub fn recording_status(&self) -> Option<Status> {
        self.recorder.as_ref().map(Recorder::status)
    }

    /// Ends the recording; its file is finished in the background.
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

    /// Recording that ended by itself: with its world or its servo, or because of the disk. It is returned once.
    pub fn take_ended_recording(&mut self) -> Option<Stopping> {
        self.ended.pop()
    }

    /// Ends the recording because its world or servo ends.
    pub(super) fn end_recording(&mut self) {
        let ended = self.stop_recording();
        self.ended.extend(ended);
    }

    /// Runs once per frame: passes the servo's timing to the recording, and detects its end.
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
