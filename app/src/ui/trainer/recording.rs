//! Recording while training: every tick, in memory.

use super::Trainer;
use haptics::recording::Recording;
use haptics::servo::Privileges;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::timing::Timing;
use std::sync::Arc;

/// Longest recording, s.
const LONGEST_S: f64 = 600.0;
/// Most ticks of a recording, about 300 MB of them: ten minutes at a kilohertz, five at four.
const MOST_TICKS: usize = 1_200_000;

impl Trainer {
    /// Begins to keep every tick.
    pub fn start_recording(&mut self) {
        self.recorded = Some(Vec::new());
    }

    /// True while every tick is kept.
    pub fn is_recording(&self) -> bool {
        self.recorded.is_some()
    }

    /// Length of the running recording, s.
    pub fn recorded_s(&self) -> f64 {
        let ends = self.recorded.as_ref().and_then(|ticks| Some(ticks.last()?.time_s - ticks.first()?.time_s));
        ends.unwrap_or(0.0)
    }

    /// Ends the recording and gives it, seen through good sensors; `None` when it is too short for anything.
    pub fn stop_recording(&mut self) -> Option<Recording> {
        let mut ticks = self.recorded.take().filter(|ticks| ticks.len() > 1)?;
        let start_s = ticks[0].time_s;
        for tick in &mut ticks {
            tick.time_s -= start_s;
        }
        let (snapshot, world) = self.scene()?;
        let (world, servo) = (Arc::clone(world), servo_facts(&snapshot.timing, self.privileges()));
        self.recordings_made += 1;
        let name = format!("{} {}", world.name, self.recordings_made);
        let seed = self.recordings_made as u64;
        let mut recording = to_recording(&name, &world, &ticks, 1, &SensorModel::TYPICAL, seed);
        recording.meta.other.insert("servo".to_owned(), servo);
        Some(recording)
    }

    /// Ends a recording that has become too long.
    pub(super) fn end_overlong_recording(&mut self) {
        if self.recorded_s() > LONGEST_S || self.recorded.as_ref().is_some_and(|ticks| ticks.len() > MOST_TICKS) {
            self.stop_recording();
        }
    }
}

/// How the servo kept its time, for the sidecar of a recording.
fn servo_facts(timing: &Timing, privileges: Option<Privileges>) -> serde_json::Value {
    serde_json::json!({ "why": timing.rate.sentence(), "timing": timing, "privileges": privileges })
}
