//! The zero of a force sensor that jumps between two phases of free motion: a tare, or a knock.
//!
//! The force of the world may jump as well, as at the release of a load, but the level of free motion is the same afterwards. A load
//! that is held in both phases changes this level slowly. A jump of the zero is one step of just the size by which the level moves.

use crate::segment::Segmentation;
use crate::segment::threshold::percentile;
use foundation::tasks::SystemState;
use foundation::words::amount;
use haptics::recording::{Recording, TARE_STEP};

/// Least number of samples of a free phase.
/// Choice: not varied.
const LEAST_SAMPLES: usize = 50;
/// Change of a level over the noise of one sample.
/// Choice: a slow sensor noise as large as the white one stays below.
const CLEAR: f64 = 6.0;
/// Normal standard deviation over the median absolute deviation.
/// Derived: 1/Φ⁻¹(3/4).
const NORMAL_OVER_MEDIAN: f64 = 1.4826;
/// Largest difference between a jump and the change of the level, as a share of it.
/// Choice: not varied.
const ALIKE: f64 = 0.2;

/// Channels of the tips' forces.
const CHANNELS: [&str; 7] = ["fx1_N", "fy1_N", "fx2_N", "fy2_N", "fx_N", "fy_N", "fz_N"];

/// A zero that jumped.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroJump {
    /// Index of the recording.
    pub recording: usize,
    /// The force channel.
    pub channel: String,
    /// Level afterwards less that before, N.
    pub size_n: f64,
    /// First sample afterwards.
    pub row: usize,
}

/// A free phase of a channel.
#[derive(Clone, Copy)]
struct Level {
    first: usize,
    end: usize,
    median_n: f64,
    noise_n: f64,
}

/// The zeros of the tips' forces that jump between one free phase and the next.
pub fn find(recordings: &[Recording], segmentations: &[Option<Segmentation>]) -> Vec<ZeroJump> {
    let mut found = Vec::new();
    for (k, (recording, segmentation)) in recordings.iter().zip(segmentations).enumerate() {
        let Some(segmentation) = segmentation else { continue };
        for name in CHANNELS {
            let Some(force) = recording.channel(name) else { continue };
            let levels = levels(force, segmentation);
            for pair in levels.windows(2) {
                let size_n = pair[1].median_n - pair[0].median_n;
                if size_n.abs() <= CLEAR * pair[0].noise_n.max(pair[1].noise_n) {
                    continue;
                }
                let row = jump(force, pair, size_n);
                found.extend(row.map(|row| ZeroJump { recording: k, channel: name.to_owned(), size_n, row }));
            }
        }
    }
    found
}

fn levels(force: &[f64], segmentation: &Segmentation) -> Vec<Level> {
    let free = segmentation.states.iter().filter(|s| s.state == SystemState::FreeMotion);
    let long = free.filter(|s| s.end.min(force.len()) >= s.first + LEAST_SAMPLES);
    long.map(|s| {
        let (first, end) = (s.first, s.end.min(force.len()));
        // Near its ends a finger may touch already.
        let margin = (end - first) / 5;
        let inner = &force[first + margin..end - margin];
        let median_n = percentile(&mut inner.to_vec(), 0.5);
        let mut off: Vec<f64> = inner.iter().map(|f| (f - median_n).abs()).collect();
        Level { first, end, median_n, noise_n: NORMAL_OVER_MEDIAN * percentile(&mut off, 0.5) }
    })
    .collect()
}

/// Row of the only step of this size between the middles of two phases.
fn jump(force: &[f64], pair: &[Level], size_n: f64) -> Option<usize> {
    let middle = |level: &Level| usize::midpoint(level.first, level.end);
    let off_n = |i: &usize| (force[*i] - force[i - 1] - size_n).abs();
    let mut alike = (middle(&pair[0]) + 1..=middle(&pair[1])).filter(|i| off_n(i) < ALIKE * size_n.abs());
    alike.next().filter(|_| alike.next().is_none())
}

/// The recordings without the jumps whose sidecars allow it; `None` if there are none.
pub fn taken_out(recordings: &[Recording], jumps: &[ZeroJump]) -> Option<Vec<Recording>> {
    let wanted = || jumps.iter().filter(|jump| recordings[jump.recording].meta.repairs(TARE_STEP));
    wanted().next()?;
    let mut others = recordings.to_vec();
    for jump in wanted() {
        if let Some(channel) = others[jump.recording].channels.iter_mut().find(|c| c.name == jump.channel) {
            channel.values[jump.row..].iter_mut().for_each(|value| *value -= jump.size_n);
        }
    }
    Some(others)
}

/// A sentence about a jump.
pub fn said(jump: &ZeroJump, recordings: &[Recording]) -> String {
    let recording = &recordings[jump.recording];
    let at = match &recording.time_s {
        Some(times) => format!("{:.2} s", times[jump.row]),
        None => format!("row {}", jump.row + 1),
    };
    let (channel, size) = (&jump.channel, amount(jump.size_n, "N"));
    let what = fate(recording, TARE_STEP, "step");
    format!(
        "{}: the zero of {channel} jumps by {size} at {at}, as after a tare or a knock of its sensor; {what}",
        recording.name
    )
}

/// The fate of a defect, for a sentence. `kind`: of its repair.
pub fn fate(recording: &Recording, kind: &str, defect: &str) -> String {
    if recording.meta.repairs(kind) {
        return format!("the fit takes the {defect} out (\"as_recorded\": [\"{kind}\"] in the sidecar leaves it in)");
    }
    format!("the {defect} is left in, as the sidecar says")
}
