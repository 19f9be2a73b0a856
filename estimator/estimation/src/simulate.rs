//! Simulation of the forces that would have been felt: the measured motion through a world.

mod block_forces;
mod crank_forces;
mod gap;
mod prediction;

pub use prediction::{LeftOpen, PredictedPart, Simulation};

use crate::identify::mechanism;
use crate::identify::needle::sheet::{HELD, OBJECT};
use crate::segment::task_of;
use foundation::cancellation;
use foundation::estimate::EstimateError;
use foundation::signal::gaps::{gap_above_s, gaps};
use foundation::signal::task::{TipSeries, is_two_fingered, times, tip_series};
use haptics::Vec2;
use haptics::law::Coordinate;
use haptics::law::object::MembraneHistory;
use haptics::recording::{Channel, Recording, Task};
use haptics::world::{Input, Mechanism, Source, State, World, step};
use prediction::rms;

/// Longest step of the simulation, s: that of the usual servo.
const STEP_S: f64 = 1e-3;
/// Most parts of a way between two samples: a reading that leaps would ask for work by its metres.
/// Derived: a metre of way.
const MOST_PARTS: f64 = 1.0 / STEP_M;
/// Longest time between two samples that is stepped, s. Over more, nothing is known of the fingers' motion, and a clock with a wrong
/// unit would ask for work by its seconds.
/// Derived: a hand's strokes last about a second.
const LONGEST_STEPPED_S: f64 = 1.0;
/// Longest way between two updates of a sheet's memory, m.
const STEP_M: f64 = 5e-5;
/// The wish to end is looked at so often, samples.
const LOOKS: usize = 500;

/// Runs the measured motion of `recording` through `world`.
///
/// With a measured give of the pads the world is stepped: the fingers follow their recorded motion and the world
/// answers. Fingers that do not yield cannot drive a world by their positions. For them the laws predict the forces of
/// the measured motion (along a crank's circle, or while a block is in the air). The operator's own pull and grip,
/// which no world can know, stay as measured ([`Simulation::inputs`] says so). A free hand feels nothing but the
/// resting values of the sensors.
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
            Some(_) if is_two_fingered(recording) && pads_are_measured(world) => stepped(world, recording),
            Some(crank) => crank_forces::needed_forces(crank, recording).map(|needed| needed.beside(recording)),
            None => mismatch("no crank"),
        },
        Task::Needle if world.membrane.is_none() => mismatch("no membrane"),
        Task::Switch if world.switch.is_none() => mismatch("no switch"),
        Task::Needle if !is_two_fingered(recording) => poke(world, recording),
        Task::Needle | Task::Switch => stepped(world, recording),
        _ if world.blocks.is_empty() => mismatch("no blocks"),
        _ if pads_are_measured(world) => stepped(world, recording),
        _ => block_forces::needed_forces(world, recording).map(|needed| needed.beside(recording)),
    }
}

/// The world's own answer to where the fingers go.
fn stepped(world: &World, recording: &Recording) -> Result<Simulation, EstimateError> {
    let mut found = assemble_tips(recording, &play(world, recording)?);
    found.inputs.push(
        "no measured force enters the prediction: the measured motion of the fingers drives the world, and its pads answer".to_owned(),
    );
    let gaps = gaps(&times(recording));
    if !gaps.is_empty() {
        found.inputs.push(format!(
            "{} gap(s) in the time are not simulated: what both fingers held goes on where they are found again",
            gaps.len()
        ));
    }
    Ok(found)
}

/// Force of the sheet along a single tool, which is the needle. One place of the sheet, as in the fit of such a
/// recording.
fn poke(world: &World, recording: &Recording) -> Result<Simulation, EstimateError> {
    let TipSeries { position, velocity, .. } = tip_series(recording, "")?;
    let (Some(sheet), Some(velocity)) = (&world.membrane, velocity) else {
        return Err(EstimateError::Clockless {
            what: "the sheet's drag on a needle".to_owned(),
            recording: recording.name.clone(),
        });
    };
    // Its sensor feels its weight all the time, with a bias that nothing tells from it.
    let held = world.provenance.iter().find(|p| p.object == OBJECT && p.name == HELD);
    let held_n = held.map_or(0.0, |p| p.value);
    let mut history = MembraneHistory::default();
    let mut values = Vec::with_capacity(position.len());
    for i in 0..position.len() {
        // The memory of a place is moved in steps as fine as the servo's way.
        let from = position[i.saturating_sub(1)];
        let parts = ((position[i] - from).norm() / STEP_M).ceil().clamp(1.0, MOST_PARTS) as usize;
        let mut out_n = 0.0;
        for part in 1..=parts {
            let at = from + (position[i] - from) * (part as f64 / parts as f64);
            let insertion_m = sheet.center_m.y - at.y;
            out_n = if (at.x - sheet.center_m.x).abs() < sheet.half_width_m {
                sheet.law.force_n(insertion_m, -velocity[i].y, &mut history)
            } else {
                0.0
            };
        }
        values.push(held_n - out_n);
    }
    let along = Channel { name: "fy_N".to_owned(), unit: "N".to_owned(), values };
    let mut found = assemble(recording, vec![along], |name| recording.channel(name).map(<[f64]>::to_vec));
    found.inputs.push(
        "the force across the needle is the operator's own where its hole gives way: it is not predicted for a single tool".to_owned(),
    );
    if held_n != 0.0 {
        found.inputs.push(format!(
            "{held_n:.3} N of the force along the needle hold the tool, as in the recording that the world is of"
        ));
    }
    Ok(found)
}

/// True if the world's pads come from a measurement: assumed ones would turn micrometres into newtons.
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
    let mechanism::Prediction { force: values, is_told } = mechanism::predict(model, recording)?;
    let measured = match recording.channel(name) {
        Some(measured) => Some(measured.to_vec()),
        None => mechanism::measured(model, recording)?,
    };
    let rms_where = |told: bool| {
        let all = measured.iter().flat_map(|measured| measured.iter().zip(&values).zip(&is_told));
        rms(all.filter(|(_, is)| **is == told).map(|((m, p), _)| m - p))
    };
    let samples = is_told.iter().filter(|told| **told).count();
    let open = is_told.len() - samples;
    let left_open = LeftOpen { what: STANDING.to_owned(), rms_n: rms_where(false), samples: open };
    let part = (open > 0).then(|| PredictedPart {
        what: MOVING.to_owned(),
        rms_n: rms_where(true),
        samples,
        left_open: Some(left_open),
    });
    let channel = Channel { name: name.to_owned(), unit: unit.to_owned(), values };
    let mut found = assemble(recording, vec![channel], |_| measured.clone());
    found.part = part;
    found.inputs.push(
        "no measured force enters the prediction: it is that of the laws along the measured motion, filtered, with the noise of its acceleration in it"
            .to_owned(),
    );
    Ok(found)
}

/// The part of a mechanism's force that its laws predict, and the rest.
const MOVING: &str = "the force while it moves";
const STANDING: &str = "where it stands or turns, and within the filter's reach of that, dry friction holds whatever it is loaded with, up to its size";

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
    Simulation { time_s: times(recording), predicted, residual_rms, part: None, inputs: Vec::new(), bias_n: Vec::new() }
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

/// Moves the recorded fingers through `world`, from the first positions of its objects, and shows the state at every
/// sample: its time, s, and the world's state then.
///
/// # Errors
/// Without two fingers.
pub fn walk(world: &World, recording: &Recording, see: impl FnMut(f64, &State)) -> Result<(), EstimateError> {
    // The forces are the unknowns: the motion alone drives the world.
    let tips = [tip_series(recording, "1")?, tip_series(recording, "2")?];
    if tips.iter().any(|tip| tip.velocity.is_none()) {
        return Err(EstimateError::Clockless {
            what: "the motion of a world".to_owned(),
            recording: recording.name.clone(),
        });
    }
    walk_tips(world, &times(recording), &tips, see);
    cancellation::check()
}

/// [`walk`] for fingers whose motion is known already: the positions of both at each time, s. Samples that one of the
/// lists lacks are not walked, nor is the rest when it is not wanted any more ([`wanted`]). Over a gap in the time
/// nothing is stepped: objects held by both fingers reappear with them, everything else stays in place.
pub fn walk_tips(world: &World, time_s: &[f64], tips: &[TipSeries; 2], mut see: impl FnMut(f64, &State)) {
    let n = tips.iter().map(|tip| tip.position.len()).fold(time_s.len(), usize::min);
    if n == 0 {
        return;
    }
    let tip = |finger: usize, i: usize| tips[finger].position[i];
    let gap_above_s = gap_above_s(&time_s[..n]).unwrap_or(f64::INFINITY).min(LONGEST_STEPPED_S);
    let mut state = State::new(world, [tip(0, 0), tip(1, 0)]);
    see(time_s[0], &state);
    for i in 1..n {
        if i % LOOKS == 0 && !cancellation::is_wanted() {
            return;
        }
        let gap_s = time_s[i] - time_s[i - 1];
        let tip_velocity = [0, 1].map(|finger| velocity(&tips[finger], i));
        if gap_s > gap_above_s {
            let input = Input { tip_in_world: [tip(0, i), tip(1, i)], tip_velocity };
            gap::bridge(world, &mut state, &input, gap_s - STEP_S);
            step(world, &mut state, &input, STEP_S);
            see(time_s[i], &state);
            continue;
        }
        let parts = (gap_s / STEP_S).ceil().max(1.0) as usize;
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
