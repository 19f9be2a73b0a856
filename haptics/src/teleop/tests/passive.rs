//! The line without a model generates no energy, however late it is and however hard the world; with one, only the
//! model answers.

use super::*;
use crate::Vec2;
use crate::device::{Command, DeviceSpec, Sample};
use crate::world::presets;
use std::sync::{Arc, Mutex};

/// Far walls, N/m: as stiff as pads at the end of a hard grip.
const WALL_N_M: f64 = 6_000.0;

/// Energies, positions and forces at the operator.
#[derive(Default)]
struct Felt {
    energy_j: f64,
    least_j: f64,
    tips: Vec<[Vec2; 2]>,
    forces: Vec<[Vec2; 2]>,
}

/// A passive hand that closes over and over, then stays closed.
struct Grip {
    spec: DeviceSpec,
    center_m: Vec2,
    /// Wanted position of each finger, m outwards from the middle: open and closed.
    open_m: f64,
    closed_m: f64,
    stops_s: f64,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    now_s: f64,
    felt: Arc<Mutex<Felt>>,
}

impl Device for Grip {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        let swing = if self.now_s < self.stops_s { 0.5 - 0.5 * (2.1 * self.now_s).cos() } else { 1.0 };
        let mut felt = self.felt.lock().expect("one thread");
        for (finger, side) in [(0, -1.0), (1, 1.0)] {
            let out_m = self.open_m + (self.closed_m - self.open_m) * swing;
            let wanted = (self.center_m + Vec2::new(side * out_m, 0.0), Vec2::zeros());
            let (before, force) = (self.position[finger], command.force_n[finger]);
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            HandImpedance::default().advance(position, velocity, wanted, force, dt_s);
            felt.energy_j -= force.dot(&(*position - before));
        }
        felt.least_j = felt.least_j.min(felt.energy_j);
        felt.tips.push(self.position);
        felt.forces.push(command.force_n);
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

fn grip(center_m: Vec2, [open_m, closed_m]: [f64; 2], stops_s: f64) -> (Box<Grip>, Arc<Mutex<Felt>>) {
    let felt = Arc::new(Mutex::new(Felt::default()));
    let spec = DeviceSpec {
        name: "Passive hand".to_owned(),
        force_feedback: true,
        max_force_n: 12.0,
        damping_n_s_m: HandImpedance::default().damping_n_s_m,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    };
    let position = [-open_m, open_m].map(|x| center_m + Vec2::new(x, 0.0));
    let velocity = [Vec2::zeros(); 2];
    let grip =
        Grip { spec, center_m, open_m, closed_m, stops_s, position, velocity, now_s: 0.0, felt: Arc::clone(&felt) };
    (Box::new(grip), felt)
}

#[test]
fn a_hard_grip_over_waves_gives_no_energy_out_and_comes_to_rest() {
    let world = presets::table();
    let lines = [(0.0, 0.0), (0.02, 0.0), (0.0, 0.3), (0.05, 0.5)];
    for round_trip_s in ROUND_TRIPS_S {
        for (jitter_s, loss) in lines {
            for deep_m in [0.004, 0.020] {
                let case = format!("{round_trip_s} s, jitter {jitter_s} s, loss {loss}, {deep_m} m deep");
                let (operator, felt) = grip(Vec2::zeros(), [0.006, -deep_m], 12.0);
                let state = State::resting(&world);
                let delay = Delay { jitter_s, loss, ..Delay::of(round_trip_s, false) };
                let ends = Ends { world: &world, state: &state, guess: None, limits: limits(), period_s: DT, seed: 3 };
                let (mut device, _) = connect(operator, &ends, &delay).expect("a line");
                let (mut command, mut far) = (Command::default(), Vec::new());
                for _ in 0..40_000 {
                    let sample = device.exchange(&command, DT);
                    // A rigid thing 4 mm wide: left finger stopped at −2 mm, right one at 2 mm.
                    for (finger, side) in [(0, -1.0), (1, 1.0)] {
                        let depth_m = 0.002 - side * sample.tip_in_world[finger].x;
                        let pressed = sample.fresh[finger] && depth_m > 0.0;
                        command.force_n[finger].x = if pressed { side * WALL_N_M * depth_m } else { 0.0 };
                    }
                    far.push(sample.tip_in_world);
                }
                let felt = felt.lock().expect("one thread");
                assert!(felt.least_j > -1e-6, "{case}: {} J came out", -felt.least_j);
                let moved = |tips: &[[Vec2; 2]]| (tips[39_999][0] - tips[35_000][0]).norm();
                assert!(moved(&felt.tips) < 2e-4 && moved(&far) < 2e-4, "{case}: at rest");
                // Over a line that loses packets and does not scatter them the receivers smooth little, and a hard grip fades away:
                // passive, too, but not held.
                let held = loss == 0.0 || jitter_s > 0.0;
                assert!(
                    !held || -felt.forces[39_999][0].x > 0.02,
                    "{case}: and it is felt: {} N",
                    felt.forces[39_999][0].x
                );
            }
        }
    }
}

#[test]
fn on_a_model_the_line_has_no_say_in_the_forces_while_the_model_is_true() {
    let world = presets::stacking();
    let run = |delay: Delay| {
        let mut state = State::resting(&world);
        let (operator, felt) = grip(state.bodies[0].center_m, [0.012, 0.004], 4.0);
        state.input.tip_in_world = operator.position;
        let (mut servo, _) = over_a_line((&world, &state), (&world, &state), operator, &delay);
        for _ in 0..6_000 {
            servo.tick(DT);
        }
        assert_eq!(servo.state().contacts.iter().filter(|c| c.normal_force_n > 0.8).count(), 2, "held at the far end");
        std::mem::take(&mut felt.lock().expect("one thread").forces)
    };
    let direct = run(Delay::of(0.0, true));
    assert!(direct.iter().flatten().any(|force| force.norm() > 1.0), "the block is felt");
    let lossy = Delay { loss: 0.5, jitter_s: 0.05, ..Delay::of(0.5, true) };
    for delay in [Delay::of(0.15, true), Delay::of(0.5, true), lossy] {
        assert!(run(delay) == direct, "{delay:?}");
    }
}

#[test]
fn an_impact_is_known_late_over_the_line_and_at_once_on_a_model() {
    // A block falls onto the other one while the hand stays away.
    let mut world = presets::stacking();
    world.blocks[0].start.center_m.y += 0.01;
    let state = State::resting(&world);
    for predicted in [false, true] {
        let (operator, _) = grip(state.input.tip_in_world[0] + Vec2::new(0.012, 0.0), [0.012, 0.012], 1.0);
        let delay = Delay::of(0.5, predicted);
        let (mut servo, mut view) = over_a_line((&world, &state), (&world, &state), operator, &delay);
        let (mut there, mut here) = (None, None);
        for tick in 0..1_500_i32 {
            let record = servo.tick(DT);
            there = there.or((record.impact_m_s > 0.1).then_some(tick));
            let knock = view.newest().knock;
            here = here.or((knock.number > 0 && knock.speed_m_s > 0.1).then_some(tick));
            let off_m = (knock.at_in_world - world.blocks[0].start.center_m).norm();
            assert!(knock.speed_m_s < 0.1 || off_m < 0.03, "tick {tick}, predicted {predicted}: {knock:?}");
        }
        let late = here.expect("known") - there.expect("it fell");
        assert!(
            if predicted { late.abs() < 5 } else { (250..=254).contains(&late) },
            "predicted {predicted}: {late} ms"
        );
    }
}
