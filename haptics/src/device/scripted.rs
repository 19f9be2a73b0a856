//! A scripted operator that does the tasks like a person: reaches in minimum jerk, pinches with a spare margin, trembles,
//! lets go. It sees the world as a person sees the screen, and drives the fingers through the arm's impedance.

mod plan;

use super::{Command, Device, DeviceSpec, HandImpedance, Sample};
use crate::Vec2;
use crate::world::{State, World};
use plan::{Goal, Plan};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// How well the operator does it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skill {
    /// Duration of a movement relative to the usual one.
    pub pace: f64,
    /// Amplitude of the physiological tremor (8–12 Hz), m.
    pub tremor_m: f64,
    /// Usual pinch force, N.
    pub pinch_n: f64,
}

impl Default for Skill {
    fn default() -> Self {
        Self { pace: 1.0, tremor_m: 0.06e-3, pinch_n: 1.6 }
    }
}

/// A device that performs a task by itself.
pub struct ScriptedOperator {
    spec: DeviceSpec,
    impedance: HandImpedance,
    plan: Plan,
    tremor: [Tremor; 2],
    pinch_wander: Wander,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    now_s: f64,
}

impl ScriptedOperator {
    /// An operator for whatever stands in `world` (a crank is turned, blocks are unstacked and restacked), whose hand starts
    /// where `state` has it. The same seed gives the same motion to the bit.
    pub fn new(world: &World, state: &State, skill: Skill, seed: u64) -> Self {
        let mut rng = StdRng::seed_from_u64(seed);
        let start = Goal::from_tips(state.input.tip_in_world);
        let plan = Plan::for_world(world, state, start, skill, &mut rng);
        Self {
            spec: DeviceSpec {
                name: "Scripted operator".to_owned(),
                force_feedback: true,
                max_force_n: 12.0,
                damping_n_s_m: HandImpedance::default().damping_n_s_m,
                coulomb_n: 0.0,
                resolution_m: 0.0,
            },
            impedance: HandImpedance::default(),
            plan,
            tremor: [Tremor::new(skill.tremor_m, &mut rng), Tremor::new(skill.tremor_m, &mut rng)],
            pinch_wander: Wander::new(&mut rng),
            position: state.input.tip_in_world,
            velocity: [Vec2::zeros(); 2],
            now_s: 0.0,
        }
    }

    /// Length of the whole performance, s.
    pub fn duration_s(&self) -> f64 {
        self.plan.duration_s()
    }
}

impl Device for ScriptedOperator {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        let (goal, rate) = self.plan.at(self.now_s);
        // Squeezing harder than touching is done by wanting the tips closer: force over the arm's stiffness.
        let squeeze = goal.pinch_n * (1.0 + self.pinch_wander.at(self.now_s)) / self.impedance.stiffness_n_m;
        for (finger, side) in [(0, -1.0), (1, 1.0)] {
            let offset = Vec2::new(side * (0.5 * goal.aperture_m - squeeze), 0.0);
            let tremor = self.tremor[finger].at(self.now_s);
            let wanted = goal.center_m + offset + tremor;
            let wanted_rate = rate.center_m + Vec2::new(side * 0.5 * rate.aperture_m, 0.0);
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            self.impedance.advance(position, velocity, (wanted, wanted_rate), command.force_n[finger], dt_s);
        }
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: true }
    }

    fn make_safe(&mut self) {}

    fn finished(&self) -> bool {
        self.now_s > self.plan.duration_s()
    }
}

/// Physiological tremor: three sines between 8 and 12 Hz in each direction.
struct Tremor {
    waves: [(f64, f64, Vec2); 3],
}

impl Tremor {
    fn new(amplitude_m: f64, rng: &mut StdRng) -> Self {
        let waves = [(); 3].map(|()| {
            let share = amplitude_m / 3.0_f64.sqrt();
            let direction = Vec2::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)) * share;
            (std::f64::consts::TAU * rng.random_range(8.0..12.0), rng.random_range(0.0..6.2), direction)
        });
        Self { waves }
    }

    fn at(&self, t_s: f64) -> Vec2 {
        self.waves.iter().map(|(w, phase, direction)| direction * (w * t_s + phase).sin()).sum()
    }
}

/// Slow relative wander of the pinch force: nobody holds a force constant.
struct Wander {
    waves: [(f64, f64, f64); 3],
}

impl Wander {
    fn new(rng: &mut StdRng) -> Self {
        Self {
            waves: [(); 3].map(|()| {
                (
                    std::f64::consts::TAU * rng.random_range(0.15..1.2),
                    rng.random_range(0.0..6.2),
                    rng.random_range(0.05..0.15),
                )
            }),
        }
    }

    fn at(&self, t_s: f64) -> f64 {
        self.waves.iter().map(|(w, phase, share)| share * (w * t_s + phase).sin()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{presets, step, true_label};

    /// Runs the operator against the world; returns the sequence of true labels without repeats, and the last state.
    fn perform(world: &World, seed: u64) -> (Vec<&'static str>, State) {
        let mut state = State::resting(world);
        let mut operator = ScriptedOperator::new(world, &state, Skill::default(), seed);
        let mut labels = Vec::new();
        let (mut current, mut since) = ("", 0);
        while !operator.finished() {
            let force = state.tip_force_n.map(|f| -f);
            let sample = operator.exchange(&Command { force_n: force }, 1e-3);
            let input = crate::world::Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
            step(world, &mut state, &input, 1e-3);
            let label = true_label(world, &state);
            if label == current {
                since += 1;
            } else {
                (current, since) = (label, 0);
            }
            // Contact chatters at touch-down: a state counts once it has lasted 100 ms.
            if since == 100 && labels.last() != Some(&label) {
                labels.push(label);
            }
        }
        (labels, state)
    }

    #[test]
    fn unstacks_and_restacks_two_blocks() {
        let world = presets::stacking();
        for seed in 0..5 {
            let (labels, state) = perform(&world, seed);
            let (free, ground, air) = ("free-motion", "hold-on-ground", "hold-above-ground");
            assert_eq!(labels, [free, ground, air, ground, free, ground, air, ground, free], "seed {seed}");
            let (one, two) = (state.bodies[0].center_m, state.bodies[1].center_m);
            assert!(one.x > 0.005 && (one.x - two.x).abs() < 2e-3, "block 2 stands on block 1: {one:?} {two:?}");
            assert!((two.y - one.y - 0.5 * (0.0160 + 0.0127)).abs() < 2e-4);
        }
    }

    #[test]
    fn turns_the_crank_forwards_and_back() {
        let world = presets::crank();
        for seed in 0..5 {
            let mut state = State::resting(&world);
            let mut operator = ScriptedOperator::new(&world, &state, Skill::default(), seed);
            let start = state.crank.angle_rad;
            let (mut most, mut lost) = (start, 0);
            while !operator.finished() {
                let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, 1e-3);
                let input =
                    crate::world::Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
                step(&world, &mut state, &input, 1e-3);
                most = f64::max(most, state.crank.angle_rad);
                lost += usize::from(state.contacts.iter().any(|c| c.sliding));
            }
            assert!(most - start > 3.0 * std::f64::consts::TAU * 0.9, "seed {seed}: {}", most - start);
            assert!(most - state.crank.angle_rad > 4.0, "seed {seed}: and back");
            assert!(lost < 600, "seed {seed}: the handle slipped in {lost} ticks");
        }
    }
}
