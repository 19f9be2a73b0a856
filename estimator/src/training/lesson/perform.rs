//! The scripted operator does a lesson, in simulated time, as fast as the processor can.

use super::Lesson;
use crate::estimate::EstimateError;
use haptics::device::{Device as _, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap, TickRecord};
use haptics::world::{State, World};

/// Ticks a second: the usual servo's.
const RATE_HZ: f64 = 1000.0;

/// A performance.
pub struct Performance {
    /// The world it was done in.
    pub world: World,
    /// Every tick, as the servo made it.
    pub ticks: Vec<TickRecord>,
    /// When each step of the demonstration began, s.
    pub steps_s: Vec<f64>,
}

/// Does a lesson once. The same seed gives the same performance, to the bit.
///
/// # Errors
/// When the lesson's world cannot be made.
pub fn perform(lesson: &Lesson, variant: usize, skill: Skill, seed: u64) -> Result<Performance, EstimateError> {
    let world = lesson.world(variant)?;
    let state = State::resting(&world);
    let operator = ScriptedOperator::doing(&world, &state, &lesson.acts(), skill, seed);
    let steps_s = operator.acts_begin_s().to_vec();
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits);
    let most = (lesson.at_most_s * RATE_HZ) as usize;
    let mut ticks = Vec::new();
    while ticks.len() < most && !servo.finished() {
        ticks.push(servo.tick(1.0 / RATE_HZ));
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
