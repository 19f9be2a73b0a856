//! The forces that a motion of a crank's handle needs, for a replay.

use crate::identify::crank::geometry::Geometry;
use crate::identify::crank::path_coordinate::motions;
use crate::identify::crank::signals::{Held, Smooth, grasped, smooth};
use crate::segment::segment;
use crate::segment::threshold::percentile;
use crate::simulate::prediction::{NeededForces, PredictedPart, resting_level, rms};
use foundation::estimate::EstimateError;
use foundation::signal::task::is_two_fingered;
use foundation::tasks::SystemState;
use haptics::Vec2;
use haptics::law::drive_forces;
use haptics::recording::{Channel, Recording, Task};
use haptics::world::Crank;
use std::borrow::Cow;
use std::sync::Arc;

/// Largest distance of the tool from its circle, as a share of the radius, at which the handle counts as held in a
/// recording without forces; it turns if it is faster than this share of its usual speed.
const NEAR_CIRCLE: f64 = 0.03;
const TURNS: f64 = 0.1;

/// The forces that the measured motion of a crank needs, channels named as measured.
///
/// The world's laws predict the force along the circle; the pull along the arm and the grip are the operator's own and
/// stay as measured. A free hand feels nothing but the resting value of the sensor.
pub(super) fn needed_forces(crank: &Crank, recording: &Recording) -> Result<NeededForces, EstimateError> {
    let names = names(recording);
    let is_felt = names.iter().any(|name| recording.channel(name).is_some_and(|f| f.iter().any(|v| *v != f[0])));
    let recording = if is_felt { Cow::Borrowed(recording) } else { Cow::Owned(without_forces(recording, &names)) };
    let recording = recording.as_ref();
    let segmentation = segment(recording, Some(Task::Crank), None)?;
    let smooth = Arc::new(smooth(recording)?);
    let held = Held::new(&Arc::new(grasped(&smooth, &segmentation)));
    let geometry = Geometry {
        center_m: crank.center_m,
        radius_m: crank.radius_m,
        give_m_per_n: Vec2::zeros(),
        give_errors: Vec2::zeros(),
        errors_m: [0.0; 3],
        resampled: None,
        stiffness: None,
        rms_m: 0.0,
    };
    let states =
        if is_felt { segmentation.per_sample(held.time_s.len()) } else { by_path(crank, &smooth, held.position()) };
    let (motions, tangential) = motions(recording, &held, &geometry);
    let needed = drive_forces(&crank.effects, &motions);
    let turns = |i: &usize| states[*i] == SystemState::Turning;
    let missing = |i: usize| needed[i] - tangential[i];
    let mut correction = vec![Vec2::zeros(); motions.len()];
    for i in (0..motions.len()).filter(turns) {
        let outward = (held.position()[i] - crank.center_m).normalize();
        correction[i] = Vec2::new(-outward.y, outward.x) * missing(i);
    }
    let free: Vec<usize> = (0..states.len()).filter(|i| states[*i] == SystemState::FreeMotion).collect();
    let share = 2.0 / names.len() as f64;
    let (mut channels, mut bias_n) = (Vec::new(), Vec::new());
    for (at, name) in names.iter().enumerate() {
        let Some(measured) = recording.channel(name) else { continue };
        let level = resting_level(measured, &free);
        if level != 0.0 {
            bias_n.push((name.clone(), level));
        }
        let value = |i: usize| match states[i] {
            SystemState::FreeMotion => level,
            _ => measured[i] + correction[i][at % 2] * share,
        };
        let values = (0..measured.len()).map(value).collect();
        channels.push(Channel { name: name.clone(), unit: "N".to_owned(), values });
    }
    let part = PredictedPart {
        what: "net force along the crank's circle while it turns".to_owned(),
        rms_n: if is_felt { rms((0..motions.len()).filter(turns).map(missing)) } else { None },
        samples: (0..motions.len()).filter(turns).count(),
        left_open: None,
    };
    let is_predicted = states.iter().map(|s| matches!(s, SystemState::Turning | SystemState::FreeMotion)).collect();
    Ok(NeededForces { channels, is_predicted, part, inputs: inputs(is_felt), bias_n })
}

/// Channels of force.
fn names(recording: &Recording) -> Vec<String> {
    let fingers: &[&str] = if is_two_fingered(recording) { &["1", "2"] } else { &[""] };
    fingers.iter().flat_map(|finger| ["x", "y"].map(|axis| format!("f{axis}{finger}_N"))).collect()
}

/// The recording with forces of zero: all that is left is the motion.
fn without_forces(recording: &Recording, names: &[String]) -> Recording {
    let mut copy = recording.clone();
    copy.channels.retain(|c| !names.contains(&c.name));
    copy.channels.extend(names.iter().map(|name| Channel {
        name: name.clone(),
        unit: "N".to_owned(),
        values: vec![0.0; recording.len()],
    }));
    copy
}

/// States from the path alone: on the crank's circle or off it.
fn by_path(crank: &Crank, smooth: &Smooth, position: &[Vec2]) -> Vec<SystemState> {
    let off = |p: &Vec2| ((p - crank.center_m).norm() - crank.radius_m).abs();
    let is_on: Vec<bool> = position.iter().map(|p| off(p) < NEAR_CIRCLE * crank.radius_m).collect();
    let speeds: Vec<f64> = smooth.velocity.iter().map(Vec2::norm).collect();
    let mut held: Vec<f64> = speeds.iter().zip(&is_on).filter(|(_, on)| **on).map(|(v, _)| *v).collect();
    let least = TURNS * percentile(&mut held, 0.95);
    let state = |(on, speed): (&bool, &f64)| match (on, *speed > least) {
        (false, _) => SystemState::FreeMotion,
        (true, true) => SystemState::Turning,
        (true, false) => SystemState::Holding,
    };
    is_on.iter().zip(&speeds).map(state).collect()
}

/// Inputs that are not predicted.
fn inputs(is_felt: bool) -> Vec<String> {
    if !is_felt {
        return vec![
            "no force was recorded: that the handle is held is told from its path, and the pull along the arm is taken as zero, so that \
             friction by that pull is missing from the prediction"
                .to_owned(),
        ];
    }
    vec![
        "the pull along the crank's arm and the grip are the operator's own: no law predicts them, and they are as measured while the \
         handle is held"
            .to_owned(),
        "along the circle the laws take the place of the measured force as the fit's filter sees it: the noise of the sensors above the \
         filter is as measured in the prediction, too, so that what is left can be less than that noise"
            .to_owned(),
        "while the handle is held still nothing is predicted, because friction holds any force within its limit: all forces are as \
         measured there"
            .to_owned(),
    ]
}

#[cfg(test)]
mod tests;
