//! The forces that a motion of blocks needs, for a replay.

use crate::identify::block::signals::MAIN;
use crate::segment::{Interval, Method, segment_signals_by};
use crate::simulate::prediction::{NeededForces, PredictedPart, resting_level, rms};
use foundation::estimate::EstimateError;
use foundation::signal::task::{smooth, task_signals};
use foundation::tasks::SystemState;
use foundation::tasks::definition::Definition;
use haptics::Vec2;
use haptics::recording::{Channel, Recording, Task};
use haptics::world::World;

/// The forces that the measured motion of carried blocks needs, channels named as measured.
///
/// The net force in the air is m (g + a), shared by both fingers. Grip and leaning are the operator's own and stay as
/// measured, and so does everything while a block rests. Free fingers feel nothing but the resting values of their
/// sensors.
pub(super) fn needed_forces(world: &World, recording: &Recording) -> Result<NeededForces, EstimateError> {
    let signals = task_signals(recording)?;
    let task = Definition::of(recording, Task::BlockStack)?;
    let segmentation = segment_signals_by(Method::Threshold, &signals, &task, None)?;
    let rate = |pick: fn(&Vec2) -> f64| {
        let values: Vec<f64> = signals.velocity.iter().map(pick).collect();
        smooth(&signals.time_s, &values).slope
    };
    let (ax, ay) = (rate(|v| v.x), rate(|v| v.y));
    let free: Vec<usize> = segmentation
        .states
        .iter()
        .filter(|i| i.state == SystemState::FreeMotion)
        .flat_map(|i| i.first..i.end)
        .collect();
    let names = ["fx1_N", "fy1_N", "fx2_N", "fy2_N"];
    let levels = names.map(|name| recording.channel(name).map_or(0.0, |measured| resting_level(measured, &free)));
    let bias_n = Vec2::new(levels[0] + levels[2], levels[1] + levels[3]);
    let mut correction = vec![Vec2::zeros(); signals.len()];
    let mut is_carried = vec![false; signals.len()];
    for (index, block) in world.blocks.iter().enumerate() {
        let names = task.showing(MAIN, MAIN, index + 1);
        let carried = |i: &&Interval| i.subtask.as_ref().is_some_and(|name| names.contains(name));
        for interval in segmentation.states.iter().filter(carried) {
            for i in interval.first..interval.end {
                let needed = (Vec2::new(ax[i], ay[i]) - world.gravity_vector()) * block.mass_kg;
                correction[i] = 0.5 * (needed + bias_n - signals.net_force_n[i]);
                is_carried[i] = true;
            }
        }
    }
    let mut is_free = vec![false; signals.len()];
    for i in &free {
        is_free[*i] = true;
    }
    let channels = names.iter().zip(levels).enumerate().filter_map(|(at, (name, level))| {
        let measured = recording.channel(name)?.iter().zip(&correction).zip(&is_free);
        let values = measured.map(|((force, c), free)| if *free { level } else { force + c[at % 2] }).collect();
        Some(Channel { name: (*name).to_owned(), unit: "N".to_owned(), values })
    });
    let channels = channels.collect();
    let part = PredictedPart {
        what: "net force on carried blocks".to_owned(),
        rms_n: rms(correction.iter().zip(&is_carried).filter(|(_, c)| **c).flat_map(|(c, _)| [2.0 * c.x, 2.0 * c.y])),
        samples: is_carried.iter().filter(|c| **c).count(),
        left_open: None,
    };
    Ok(NeededForces {
        channels,
        is_predicted: is_carried.iter().zip(&is_free).map(|(carried, free)| *carried || *free).collect(),
        part,
        inputs: vec![
            "grip and leaning of the fingers are the operator's own: they are as measured while something is held".to_owned(),
            "while a held block rests nothing is predicted, because how much of it the ground carries is the operator's own: all forces are as \
             measured there"
                .to_owned(),
        ],
        bias_n: names.iter().zip(levels).filter(|(_, l)| *l != 0.0).map(|(n, l)| ((*n).to_owned(), l)).collect(),
    })
}
