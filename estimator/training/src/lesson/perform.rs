//! The scripted operator does a lesson, in simulated time, as fast as the processor can.

use super::format::Lesson;
use foundation::estimate::EstimateError;
use haptics::device::{Device, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap, TickRecord};
use haptics::teleop::{self, Delay, Ends};
use haptics::world::{State, World};

/// Ticks a second: the usual servo's.
const RATE_HZ: f64 = 1000.0;

/// A performance.
pub struct Performance {
    /// The world it was done in.
    pub world: World,
    /// Every tick, as the servo made it.
    pub ticks: Vec<TickRecord>,
    /// Start times of the steps of the demonstration, s.
    pub steps_s: Vec<f64>,
}

/// Does a lesson once. The same seed gives the same performance, to the bit.
///
/// # Errors
/// The lesson's world cannot be made.
pub fn perform(lesson: &Lesson, variant: usize, skill: Skill, seed: u64) -> Result<Performance, EstimateError> {
    perform_over(lesson, variant, skill, seed, &Delay::default())
}

/// The same over a slow line: there the operator moves and waits for the picture.
///
/// # Errors
/// The lesson's world cannot be made, or there is no such line.
pub fn perform_over(
    lesson: &Lesson,
    variant: usize,
    skill: Skill,
    seed: u64,
    line: &Delay,
) -> Result<Performance, EstimateError> {
    let world = lesson.world(variant)?;
    let state = State::resting(&world);
    let operator = ScriptedOperator::doing(&world, &state, &lesson.acts(), skill, seed);
    let steps_s = operator.acts_begin_s().to_vec();
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut view = None;
    let device: Box<dyn Device> = if line.is_none() {
        Box::new(operator)
    } else {
        let guess = teleop::guess(&world, seed);
        let period_s = 1.0 / RATE_HZ;
        let ends = Ends { world: &world, state: &state, guess: Some(&guess), limits, period_s, seed };
        let connected = teleop::connect(Box::new(operator.waiting()), &ends, line);
        let (device, source) = connected.map_err(|error| EstimateError::Other(error.to_string()))?;
        view = Some(source);
        device
    };
    let mut servo = Loop::new(Swap::at(world.clone(), state), device, limits);
    let most = (lesson.at_most_s * RATE_HZ) as usize;
    let mut ticks = Vec::new();
    while ticks.len() < most && !servo.finished() {
        ticks.push(servo.tick(1.0 / RATE_HZ));
        if let Some(view) = &mut view {
            view.newest();
        }
    }
    servo.make_safe();
    Ok(Performance { world, ticks, steps_s })
}

impl Performance {
    /// The recording of it, as the trainer would have made it: every tick, without errors of sensors.
    pub fn recording(&self, name: &str) -> Recording {
        to_recording(name, &self.world, &self.ticks, 1, &SensorModel::IDEAL, 0)
    }
}
