//! Two blocks stacked in the stepped world, one of which may leak, seen by sensors that may drift.

use haptics::Vec2;
use haptics::device::{Command, Device, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::world::{Input, State, step, true_label};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use tests::generate::{STEP_S, stacking_world};

/// What is wrong with object and sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fault {
    /// Mass that the first block loses, kg/s.
    pub leak_kg_s: f64,
    /// Drift of every force channel of each finger, N/s.
    pub drift_n_s: [Vec2; 2],
    /// Mass that the first block loses at once after so much time of its first carry, kg and s.
    pub loss: Option<(f64, f64)>,
}

impl Fault {
    /// A leak of 0.6 to 1.5 g/s.
    pub fn leak(seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed ^ 0x1eaf);
        Self { leak_kg_s: rng.random_range(0.6e-3..1.5e-3), ..Self::default() }
    }

    /// Drifts whose vertical sum is 4 to 8 mN/s, either way; along x each sensor has its own.
    pub fn drift(seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed ^ 0xd21f);
        let sum = rng.random_range(4e-3..8e-3) * if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let share = rng.random_range(0.0..1.0);
        let mut along = || rng.random_range(-3e-3..3e-3);
        let drift_n_s = [Vec2::new(along(), share * sum), Vec2::new(along(), (1.0 - share) * sum)];
        Self { drift_n_s, ..Self::default() }
    }
}

/// Someone who takes his time: carries of some seconds.
pub fn unhurried() -> Skill {
    Skill { pace: 2.5, ..Skill::default() }
}

/// The recording (1 kHz), and when the first carry ended, s.
pub fn perform(seed: u64, fault: &Fault) -> (Recording, f64) {
    const EVERY: usize = 5;
    let (mut world, _) = stacking_world(seed);
    let full_kg = world.blocks[0].mass_kg;
    let mut state = State::resting(&world);
    let mut operator = ScriptedOperator::new(&world, &state, unhurried(), seed);
    let mut rng = StdRng::seed_from_u64(seed ^ 0xb1a5);
    let bias_n = [(); 2].map(|()| Vec2::from_fn(|_, _| rng.random_range(-0.02..0.02)));
    let mut ticks: Vec<TickRecord> = Vec::new();
    let (mut count, mut lifted_s, mut carried_until_s) = (0_usize, None, 0.0);
    while !operator.finished() {
        let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, STEP_S);
        let input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
        step(&world, &mut state, &input, STEP_S);
        let label = true_label(&world, &state);
        if label == "hold-above-ground" {
            lifted_s.get_or_insert(state.time_s);
            // A short bounce on the ground is still the same carry.
            if carried_until_s == 0.0 || state.time_s - carried_until_s < 0.1 {
                carried_until_s = state.time_s;
            }
        }
        let lost = fault.loss.map_or(
            0.0,
            |(kg, after_s)| {
                if lifted_s.is_some_and(|t| state.time_s > t + after_s) { kg } else { 0.0 }
            },
        );
        world.blocks[0].mass_kg = (full_kg - lost - fault.leak_kg_s * state.time_s).max(0.004);
        if count.is_multiple_of(EVERY) {
            let force = |f: usize| state.tip_force_n[f] + bias_n[f] + fault.drift_n_s[f] * state.time_s;
            ticks.push(TickRecord {
                time_s: state.time_s,
                input,
                tip_force_n: [force(0), force(1)],
                label,
                ..TickRecord::default()
            });
        }
        count += 1;
    }
    (to_recording(&format!("seed {seed}"), &world, &ticks, 1, &SensorModel::TYPICAL, seed ^ 0x5eed), carried_until_s)
}

/// The recording up to a time, s.
pub fn until(recording: &Recording, end_s: f64) -> Recording {
    let n = recording.time_s.as_ref().map_or(0, |t| t.partition_point(|t| *t < end_s));
    let mut part = recording.clone();
    part.time_s = recording.time_s.as_ref().map(|t| t[..n].to_vec());
    for channel in &mut part.channels {
        channel.values.truncate(n);
    }
    part.labels = None;
    part
}
