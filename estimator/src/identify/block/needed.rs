//! The forces that a motion of blocks needs, for a replay.

use super::MAIN;
use crate::estimate::EstimateError;
use crate::segment::definition::Definition;
use crate::segment::{Interval, Method, segment_signals_by};
use crate::signal::task::{smooth, task_signals};
use haptics::Vec2;
use haptics::recording::{Channel, Recording, Task};
use haptics::world::World;

/// The forces that the measured motion of carried blocks needs, channels named as measured.
///
/// In the air the net force is m (g + a), shared by both fingers; grip and leaning are the operator's own and stay as measured,
/// as does everything while a block rests.
pub fn needed_forces(world: &World, recording: &Recording) -> Result<Vec<Channel>, EstimateError> {
    let signals = task_signals(recording)?;
    let task = Definition::of(recording, Task::BlockStack)?;
    let segmentation = segment_signals_by(Method::Threshold, &signals, &task, None)?;
    let rate = |pick: fn(&Vec2) -> f64| {
        let values: Vec<f64> = signals.velocity.iter().map(pick).collect();
        smooth(&signals.time_s, &values).slope
    };
    let (ax, ay) = (rate(|v| v.x), rate(|v| v.y));
    let mut correction = vec![Vec2::zeros(); signals.len()];
    for (index, block) in world.blocks.iter().enumerate() {
        let names = task.showing(MAIN, MAIN, index + 1);
        let carried = |i: &&Interval| i.subtask.as_ref().is_some_and(|name| names.contains(name));
        for interval in segmentation.states.iter().filter(carried) {
            for i in interval.first..interval.end {
                let needed = (Vec2::new(ax[i], ay[i]) - world.gravity_vector()) * block.mass_kg;
                correction[i] = 0.5 * (needed - signals.net_force_n[i]);
            }
        }
    }
    let mut channels = Vec::new();
    for (name, axis) in [("fx1_N", 0), ("fy1_N", 1), ("fx2_N", 0), ("fy2_N", 1)] {
        let Some(measured) = recording.channel(name) else { continue };
        let values = measured.iter().zip(&correction).map(|(force, c)| force + c[axis]).collect();
        channels.push(Channel { name: name.to_owned(), unit: "N".to_owned(), values });
    }
    Ok(channels)
}
