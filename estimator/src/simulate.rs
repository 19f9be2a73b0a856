//! The measured motion through a world: what forces would have been felt?

use crate::estimate::EstimateError;
use crate::identify::{block, crank, mechanism};
use crate::segment::task_of;
use crate::signal::task::{TipSeries, is_two_fingered, task_signals};
use crate::wanted;
use haptics::Vec2;
use haptics::law::Coordinate;
use haptics::recording::{Channel, Recording, Task};
use haptics::world::{Input, Mechanism, Source, State, World, step};

/// Longest step of the simulation, s: that of the usual servo.
const STEP_S: f64 = 1e-3;
/// The wish to end is looked at so often, samples.
const LOOKS: usize = 500;

/// Predicted forces at the recording's sample times.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Sample times, s (sample numbers for a clockless log).
    pub time_s: Vec<f64>,
    /// Predicted channels, named like the measured ones (`fx1_N`, `f_N`, …).
    pub predicted: Vec<Channel>,
    /// RMS of measured minus predicted by channel, where it was measured, in the channel's unit.
    pub residual_rms: Vec<(String, f64)>,
}

impl Simulation {
    /// The prediction as a recording of its own, with the measured channels beside it as `measured_<name>`.
    pub fn to_recording(&self, recording: &Recording) -> Recording {
        let mut channels = self.predicted.clone();
        for channel in &self.predicted {
            if let Some(measured) = recording.channel(&channel.name) {
                channels.push(Channel {
                    name: format!("measured_{}", channel.name),
                    unit: channel.unit.clone(),
                    values: measured.to_vec(),
                });
            }
        }
        Recording {
            name: format!("simulation of {}", recording.name),
            time_s: Some(self.time_s.clone()),
            channels,
            meta: recording.meta.clone(),
            ..Recording::default()
        }
    }
}

/// Runs the measured motion of `recording` through `world`.
///
/// Where the give of the pads was measured the world is stepped: the fingers go where they went and the world answers. Fingers
/// that do not give cannot drive a world by their positions; there the laws say what the measured motion needs (along a crank's
/// circle, or while a block is in the air), and the operator's own pull and grip, which no world can know, stay as measured.
pub fn simulate(world: &World, recording: &Recording) -> Result<Simulation, EstimateError> {
    let task =
        task_of(recording, None).or_else(|error| world.mechanism.as_ref().map(|_| Task::Mechanism).ok_or(error))?;
    let mismatch = |what: &str| {
        Err(EstimateError::Other(format!(
            "{} is a recording of the task {}, and this world has {what}; fit the recording to make a world for it",
            recording.name,
            task.name()
        )))
    };
    match task {
        Task::Mechanism => match &world.mechanism {
            Some(model) => simulate_mechanism(model, recording),
            None => mismatch("no mechanism"),
        },
        Task::Crank => match &world.crank {
            Some(_) if is_two_fingered(recording) && pads_are_measured(world) => {
                play(world, recording).map(|forces| assemble_tips(recording, &forces))
            }
            Some(crank) => crank::needed_forces(crank, recording)
                .map(|predicted| assemble(recording, predicted, |name| recording.channel(name).map(<[f64]>::to_vec))),
            None => mismatch("no crank"),
        },
        Task::Needle if world.membrane.is_none() => mismatch("no membrane"),
        Task::Switch if world.switch.is_none() => mismatch("no switch"),
        Task::Needle | Task::Switch => play(world, recording).map(|forces| assemble_tips(recording, &forces)),
        _ if world.blocks.is_empty() => mismatch("no blocks"),
        _ if pads_are_measured(world) => play(world, recording).map(|forces| assemble_tips(recording, &forces)),
        _ => block::needed_forces(world, recording)
            .map(|predicted| assemble(recording, predicted, |name| recording.channel(name).map(<[f64]>::to_vec))),
    }
}

/// Whether the world's pads come from a measurement: assumed ones would turn micrometres into newtons.
fn pads_are_measured(world: &World) -> bool {
    world.provenance.is_empty()
        || world
            .provenance
            .iter()
            .any(|p| p.object == "pad" && p.name == "stiffness_N_m" && p.source == Source::Measured)
}

fn simulate_mechanism(model: &Mechanism, recording: &Recording) -> Result<Simulation, EstimateError> {
    let angular = recording.channel("q_rad").is_some() || recording.channel("tau_Nm").is_some();
    let linear = recording.channel("q_m").is_some();
    if (angular && model.coordinate == Coordinate::Linear) || (linear && model.coordinate == Coordinate::Angular) {
        return Err(EstimateError::Other(format!(
            "the world's mechanism moves along a {} and {} along a {}; choose the world that was fitted to it",
            if angular { "line" } else { "circle" },
            recording.name,
            if angular { "circle" } else { "line" }
        )));
    }
    let (name, unit) = if angular { ("tau_Nm", "Nm") } else { ("f_N", "N") };
    let values = mechanism::predict(model, recording)?;
    let measured = match recording.channel(name) {
        Some(measured) => Some(measured.to_vec()),
        None => mechanism::measured(model, recording)?,
    };
    let channel = Channel { name: name.to_owned(), unit: unit.to_owned(), values };
    Ok(assemble(recording, vec![channel], |_| measured.clone()))
}

fn assemble_tips(recording: &Recording, forces: &[Vec<Vec2>; 2]) -> Simulation {
    let channel = |name: &str, finger: usize, pick: fn(&Vec2) -> f64| Channel {
        name: name.to_owned(),
        unit: "N".to_owned(),
        values: forces[finger].iter().map(pick).collect(),
    };
    let predicted = vec![
        channel("fx1_N", 0, |f| f.x),
        channel("fy1_N", 0, |f| f.y),
        channel("fx2_N", 1, |f| f.x),
        channel("fy2_N", 1, |f| f.y),
    ];
    assemble(recording, predicted, |name| recording.channel(name).map(<[f64]>::to_vec))
}

fn assemble(recording: &Recording, predicted: Vec<Channel>, measured: impl Fn(&str) -> Option<Vec<f64>>) -> Simulation {
    let residual_rms = predicted
        .iter()
        .filter_map(|channel| {
            let measured = measured(&channel.name)?;
            let n = measured.len().min(channel.values.len()).max(1) as f64;
            let square: f64 = measured.iter().zip(&channel.values).map(|(m, p)| (m - p).powi(2)).sum();
            Some((channel.name.clone(), (square / n).sqrt()))
        })
        .collect();
    Simulation { time_s: crate::signal::task::times(recording), predicted, residual_rms }
}

/// Moves the world's fingers as they were measured; the force of each tip on the environment at every sample, N.
fn play(world: &World, recording: &Recording) -> Result<[Vec<Vec2>; 2], EstimateError> {
    let mut forces = [Vec::with_capacity(recording.len()), Vec::with_capacity(recording.len())];
    walk(world, recording, |_, state| {
        for (finger, series) in forces.iter_mut().enumerate() {
            series.push(state.tip_force_n[finger]);
        }
    })?;
    Ok(forces)
}

/// Moves the recorded fingers through `world`, from where its things stand at first, and shows the state at every sample: its time, s,
/// and the world's state then.
///
/// # Errors
/// Without two fingers.
pub fn walk(world: &World, recording: &Recording, see: impl FnMut(f64, &State)) -> Result<(), EstimateError> {
    let signals = task_signals(recording)?;
    walk_tips(world, &signals.time_s, &signals.tips, see);
    wanted::look()
}

/// [`walk`] for fingers whose motion is known already: where both are at each time, s. Samples that one of the lists lacks are not walked,
/// nor is the rest when nobody wants it any more ([`wanted`]).
pub fn walk_tips(world: &World, time_s: &[f64], tips: &[TipSeries; 2], mut see: impl FnMut(f64, &State)) {
    let n = tips.iter().map(|tip| tip.position.len()).fold(time_s.len(), usize::min);
    if n == 0 {
        return;
    }
    let tip = |finger: usize, i: usize| tips[finger].position[i];
    let mut state = State::new(world, [tip(0, 0), tip(1, 0)]);
    see(time_s[0], &state);
    for i in 1..n {
        if i % LOOKS == 0 && !wanted::still() {
            return;
        }
        let gap_s = time_s[i] - time_s[i - 1];
        let parts = (gap_s / STEP_S).ceil().max(1.0) as usize;
        let tip_velocity = [0, 1].map(|finger| velocity(&tips[finger], i));
        for part in 1..=parts {
            let share = part as f64 / parts as f64;
            let between = |finger: usize| tip(finger, i - 1) + (tip(finger, i) - tip(finger, i - 1)) * share;
            let input = Input { tip_in_world: [between(0), between(1)], tip_velocity };
            step(world, &mut state, &input, gap_s / parts as f64);
        }
        see(time_s[i], &state);
    }
}

fn velocity(tip: &TipSeries, i: usize) -> Vec2 {
    tip.velocity.as_ref().and_then(|v| v.get(i)).copied().unwrap_or_default()
}
