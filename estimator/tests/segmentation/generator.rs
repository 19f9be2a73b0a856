//! Recordings of the scripted operator stacking random blocks, with the stepped world's own labels.
//!
//! The labels come from the contacts of the simulated bodies; the methods under test only see noisy positions, velocities and
//! forces of the tips. Neither knows of the other.

use haptics::device::{Device, Mistake, ScriptedOperator, Skill};
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap, TickRecord};
use haptics::world::{Block, State, World, presets};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

/// Ticks a second of the simulation.
pub const RATE_HZ: f64 = 4000.0;

/// Two blocks of random weight, size and friction, block 1 on block 2.
pub fn stacking(seed: u64) -> World {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x5e61_0e27);
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    let mut world = presets::stacking();
    let floor_m = world.floor.as_ref().map_or(0.0, |f| f.height_m);
    let (height_1, height_2) = (draw(0.011, 0.018), draw(0.010, 0.016));
    let lower = Block::upright("block-2", draw(0.025, 0.065), draw(0.019, 0.027), height_2, -0.014, floor_m);
    let upper = Block::upright("block-1", draw(0.025, 0.065), draw(0.013, 0.019), height_1, -0.014, floor_m + height_2);
    world.pad.stiffness_n_m = draw(1800.0, 4000.0);
    world.pad.shear_stiffness_n_m = draw(1000.0, 2500.0);
    world.blocks = vec![upper, lower];
    for block in &mut world.blocks {
        block.finger_friction = draw(0.7, 1.2);
    }
    world
}

/// A crank of random size and friction.
pub fn crank(seed: u64) -> World {
    let mut rng = StdRng::seed_from_u64(seed ^ 0xc4a2_77b1);
    let mut world = presets::crank();
    if let Some(crank) = &mut world.crank {
        crank.radius_m = rng.random_range(0.016..0.025);
        crank.finger_friction = rng.random_range(0.8..1.2);
    }
    world
}

/// Every tick of the operator's performance.
pub fn perform(world: &World, skill: Skill, mistakes: &[Mistake], seed: u64) -> Vec<TickRecord> {
    const LONGEST_S: f64 = 90.0;
    let state = State::resting(world);
    let operator = ScriptedOperator::with_mistakes(world, &state, skill, mistakes, seed);
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits);
    let mut ticks = Vec::new();
    while !servo.finished() && (ticks.len() as f64) < LONGEST_S * RATE_HZ {
        ticks.push(servo.tick(1.0 / RATE_HZ));
    }
    servo.make_safe();
    ticks
}

/// The ticks as a log of a rate that divides [`RATE_HZ`], through sensors `noise` times as noisy as typical ones.
pub fn log(world: &World, ticks: &[TickRecord], rate_hz: f64, noise: f64, seed: u64) -> Recording {
    let typical = SensorModel::TYPICAL;
    let sensor = SensorModel {
        position_noise_m: noise * typical.position_noise_m,
        velocity_noise_m_s: noise * typical.velocity_noise_m_s,
        force_noise_n: noise * typical.force_noise_n,
        ..typical
    };
    let every = (RATE_HZ / rate_hz).round() as usize;
    let mut recording = to_recording("scripted", world, ticks, every, &sensor, seed ^ 0xab5e);
    recording.meta.task = Some(if world.crank.is_some() { Task::Crank } else { Task::BlockStack });
    recording
}
