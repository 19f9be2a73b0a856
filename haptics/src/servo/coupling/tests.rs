//! A simulated device of known mass and damping, integrated exactly between the ticks, in front of a stiff table.

use super::*;
use crate::device::{Command, Device, HandImpedance};
use crate::servo::safety::Limits;
use crate::servo::{Loop, Swap};
use crate::world::presets;

const T: f64 = 1e-3;

fn spec(damping_n_s_m: f64) -> DeviceSpec {
    DeviceSpec {
        name: "simulated".to_owned(),
        force_feedback: true,
        max_force_n: 4.0,
        damping_n_s_m,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    }
}

/// Wanted positions of the fingers at a time, s.
type Wish = fn(f64) -> [Vec2; 2];

/// Two masses with a damper each, and hands that push with a constant force or pull towards a wanted place.
struct Simulated {
    spec: DeviceSpec,
    mass_kg: f64,
    at: [Vec2; 2],
    velocity: [Vec2; 2],
    push_n: [Vec2; 2],
    /// Impedance of the hands and the positions they pull to; `None`: no hands.
    wanted: Option<(HandImpedance, Wish)>,
    time_s: f64,
}

impl Simulated {
    fn new(damping_n_s_m: f64, at: [Vec2; 2]) -> Self {
        Self {
            spec: spec(damping_n_s_m),
            mass_kg: 0.1,
            at,
            velocity: [Vec2::zeros(); 2],
            push_n: [Vec2::zeros(); 2],
            wanted: None,
            time_s: 0.0,
        }
    }
}

impl Device for Simulated {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.time_s += dt_s;
        for finger in 0..2 {
            let mut force = command.force_n[finger] + self.push_n[finger];
            if let Some((hand, wanted)) = &self.wanted {
                force += (wanted(self.time_s)[finger] - self.at[finger]) * hand.stiffness_n_m
                    - self.velocity[finger] * hand.damping_n_s_m;
            }
            // Exact for a force that is held: towards its terminal velocity.
            let terminal = force / self.spec.damping_n_s_m;
            let decay = (-self.spec.damping_n_s_m / self.mass_kg * dt_s).exp();
            let lag_s = self.mass_kg / self.spec.damping_n_s_m * (1.0 - decay);
            self.at[finger] += terminal * dt_s + (self.velocity[finger] - terminal) * lag_s;
            self.velocity[finger] = terminal + (self.velocity[finger] - terminal) * decay;
        }
        Sample { tip_in_world: self.at, tip_velocity: self.velocity, fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

/// A loop without a coupling, whatever the device says: the behaviour before there was one.
fn uncoupled(mut device: Simulated) -> Simulated {
    device.spec.force_feedback = false;
    device
}

fn limits() -> Limits {
    Limits { max_force_n: 50.0, max_slew_n_s: 1e6, ramp_s: 1e-3, ..Limits::default() }
}

/// Motion within 16 s of a finger that is pushed against the table with 1 N from 1 mm above it.
struct Pressed {
    /// Energy that the table generated beyond the dissipation of the device's own damper, J: the worst of the whole
    /// time.
    given_j: f64,
    /// Fastest motion of the last second, m/s.
    restless_m_s: f64,
    /// Rest positions of device and tip, m below the table.
    device_depth_m: f64,
    tip_depth_m: f64,
}

fn press(device: Simulated, period_s: f64) -> Pressed {
    let mut world = presets::table();
    // No damping in the pad: the worst case that the formula speaks of.
    (world.pad.damping_n_s_m, world.pad.shear_damping_n_s_m) = (0.0, 0.0);
    let damping = device.spec.damping_n_s_m;
    let table_m = world.floor.as_ref().expect("a table").height_m;
    let mut servo = Loop::new(Swap::new(world), Box::new(device), limits());
    let (mut taken_j, mut given_j, mut restless): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let ticks = (16.0 / period_s) as usize;
    let mut last = servo.tick(period_s);
    for tick in 0..ticks {
        let now = servo.tick(period_s);
        let speed = (now.device_in_world[0] - last.device_in_world[0]).norm() / period_s;
        // Mean speed: a lower bound of the damper's dissipation (∫v² ≥ (∫v)²/T).
        taken_j += damping * speed * speed * period_s;
        given_j = given_j.max(-(now.energy_j + taken_j));
        if tick > 3 * ticks / 4 {
            restless = restless.max(speed);
        }
        last = now;
    }
    Pressed {
        given_j,
        restless_m_s: restless,
        device_depth_m: table_m - last.device_in_world[0].y,
        tip_depth_m: table_m - last.input.tip_in_world[0].y,
    }
}

fn pushed(damping: f64) -> Simulated {
    let mut device = Simulated::new(damping, [Vec2::new(-0.02, -0.124), Vec2::new(0.02, -0.06)]);
    device.push_n[0] = Vec2::new(0.0, -1.0);
    device
}

#[test]
fn the_coupling_is_what_the_formulas_allow() {
    // b = 0.5 N s/m at 1 kHz: K T/2 + B = 0.9 b.
    let coupling = Coupling::passive(&spec(0.5), T, 0.0);
    assert!((coupling.damping_n_s_m - 0.05).abs() < 1e-12 && (coupling.stiffness_n_m - 800.0).abs() < 1e-9);
    let needed = crate::servo::passivity::required_damping(coupling.stiffness_n_m, coupling.damping_n_s_m, T);
    assert!((needed / 0.5 - MARGIN).abs() < 1e-12, "{needed}");
    // Four times the rate, four times the stiffness; a delay of a period makes a third of it.
    assert!((Coupling::passive(&spec(0.5), T / 4.0, 0.0).stiffness_n_m - 3200.0).abs() < 1e-9);
    assert!((Coupling::passive(&spec(0.5), T, T).stiffness_n_m - 800.0 / 3.0).abs() < 1e-9);
    // Encoder steps: 0.05 N / 0.2 mm = 250 N/m allow a damper of 0.25 N s/m, or a spring of 500 N/m; a tenth of the one and
    // nine tenths of the whole: K = 2 (0.9 · 250 − 0.025/T).
    let coarse = Coupling::passive(&DeviceSpec { coulomb_n: 0.05, resolution_m: 0.2e-3, ..spec(0.5) }, T, 0.0);
    assert!((coarse.damping_n_s_m - 0.025).abs() < 1e-12 && (coarse.stiffness_n_m - 400.0).abs() < 1e-9);
    assert_eq!(Coupling::passive(&spec(0.0), T, 0.0).stiffness_n_m, SOFTEST_N_M);
    // Unknown device and half a second of delay: the passive coupling for 0.5 N s/m of a hand.
    let slow = Coupling::passive(&spec(0.0), T, 0.5);
    assert!((slow.stiffness_n_m * (0.5 * T + 0.5) - HAND_DAMPING_N_S_M).abs() < 1e-12 && slow.damping_n_s_m == 0.0);
    assert!((coupling.felt_n_m(2500.0) - 800.0 * 2500.0 / 3300.0).abs() < 1e-9);
}

#[test]
fn the_coupling_uses_nine_tenths_of_what_is_passive_on_any_device() {
    for (b, coulomb_n, resolution_m) in [(0.1, 0.05, 1e-4), (2.0, 0.05, 1e-4), (0.5, 0.0, 0.0), (6.0, 0.3, 1e-5)] {
        for (period_s, delay_s) in [(T, 0.0), (T / 4.0, 0.0), (T, 0.02), (T / 8.0, 0.5)] {
            let device = DeviceSpec { coulomb_n, resolution_m, ..spec(b) };
            let coupling = Coupling::passive(&device, period_s, delay_s);
            let less = DeviceSpec { damping_n_s_m: MARGIN * b, coulomb_n: MARGIN * coulomb_n, ..device };
            let most = passive_stiffness(&less, coupling.damping_n_s_m, period_s, delay_s);
            assert!((coupling.stiffness_n_m / most - 1.0).abs() < 1e-9, "{less:?}: {coupling:?} of {most} N/m");
        }
    }
}

#[test]
fn a_delayed_spring_needs_the_damping_that_the_formula_says() {
    // The general criterion with H(z) = K z^-2: K (T/2 + 2 T).
    let delayed = |z: nalgebra::Complex<f64>| (z * z).inv() * 400.0;
    let numeric = crate::servo::passivity::required_damping_of(delayed, T);
    assert!((numeric / (400.0 * 2.5 * T) - 1.0).abs() < 1e-4, "{numeric}");
}

#[test]
fn only_a_force_device_that_cannot_render_the_pad_is_coupled() {
    let world = presets::stacking();
    assert!(Coupling::needed(&spec(0.5), &world, T, 0.0).is_some());
    // 4000 N/m and 3 N s/m of pad need 5 N s/m at 1 kHz and 3.5 N s/m at 4 kHz.
    assert!(Coupling::needed(&spec(4.9), &world, T, 0.0).is_some());
    assert!(Coupling::needed(&spec(5.1), &world, T, 0.0).is_none());
    assert!(Coupling::needed(&spec(3.6), &world, T / 4.0, 0.0).is_none());
    let shown = DeviceSpec { force_feedback: false, ..spec(0.1) };
    assert!(Coupling::needed(&shown, &world, T, 0.0).is_none(), "a force that nobody feels needs no coupling");
}

#[test]
fn a_pad_that_the_device_cannot_render_is_active_without_a_coupling_and_passive_with_one() {
    // 2500 N/m at 1 kHz needs 1.25 N s/m; this device has 0.5.
    let direct = press(uncoupled(pushed(0.5)), T);
    let coupled = press(pushed(0.5), T);
    assert!(direct.given_j > 1e-4 && direct.restless_m_s > 0.02, "{} J, {} m/s", direct.given_j, direct.restless_m_s);
    assert!(coupled.given_j < 1e-7, "{} J given out", coupled.given_j);
    assert!(coupled.restless_m_s < 1e-5, "{} m/s", coupled.restless_m_s);
    // 1 N on 2500 N/m of pad, and on 800 N/m of coupling behind it.
    assert!((coupled.tip_depth_m - 1.0 / 2500.0).abs() < 2e-6, "{} m", coupled.tip_depth_m);
    let felt = Coupling::passive(&spec(0.5), T, 0.0).felt_n_m(2500.0);
    assert!((coupled.device_depth_m - 1.0 / felt).abs() < 5e-6, "{} m", coupled.device_depth_m);
}

#[test]
fn the_coupling_is_passive_at_every_rate_and_damping() {
    for (damping, period_s) in [(0.1, T), (0.1, T / 4.0), (1.0, T), (2.0, T / 4.0)] {
        let coupled = press(pushed(damping), period_s);
        assert!(coupled.given_j < 1e-6, "b {damping}, {period_s} s: {} J", coupled.given_j);
    }
}

/// Fingers that close on block 1, lift it by 20 mm and hold it.
fn pinch_and_lift(time_s: f64) -> [Vec2; 2] {
    let block = &presets::stacking().blocks[0];
    let smooth = |from: f64, to: f64| {
        let x = ((time_s - from) / (to - from)).clamp(0.0, 1.0);
        x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let half = 0.5 * block.width_m + 0.010 - 0.018 * smooth(0.3, 1.0);
    let center = block.start.center_m + Vec2::new(0.0, 0.02 * smooth(1.5, 2.2));
    [center - Vec2::new(half, 0.0), center + Vec2::new(half, 0.0)]
}

#[test]
fn a_block_is_pinched_and_lifted_through_the_coupling_and_free_motion_is_free() {
    let world = presets::stacking();
    let start = pinch_and_lift(0.0);
    let mut device = Simulated::new(0.5, start);
    device.wanted = Some((HandImpedance { damping_n_s_m: 6.0, ..HandImpedance::default() }, pinch_and_lift));
    let state = State::new(&world, start);
    let ground = state.bodies[0].center_m;
    let mut servo = Loop::new(Swap::at(world, state), Box::new(device), limits());
    let (mut free_n, mut shake_m): (f64, f64) = (0.0, 0.0);
    let mut held = None;
    for tick in 0..4_000 {
        let now = servo.tick(T);
        if tick < 300 {
            free_n = free_n.max(now.sent_force_n[0].norm());
        }
        if tick >= 3_000 {
            let at = servo.state().bodies[0].center_m;
            let before = *held.get_or_insert(at);
            shake_m = shake_m.max((at - before).norm());
        }
    }
    assert!(servo.coupling().is_some());
    assert!(free_n < 1e-9, "nothing is touched and {free_n} N are felt");
    assert!(servo.state().bodies[0].center_m.y - ground.y > 0.018, "lifted");
    assert!(shake_m < 2e-5, "it is held still, within {shake_m} m");
}

/// Fingers that are carried along a path by something that takes no notice of force, on a device that states no damping.
struct Carried(DeviceSpec, f64);

impl Device for Carried {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, _: &Command, dt_s: f64) -> Sample {
        self.1 += dt_s;
        // Held still for a second, 2 mm in the table, then drawn back and forth along it.
        let (sin, cos) = (2.0 * (self.1 - 1.0).max(0.0)).sin_cos();
        let tip_in_world = [Vec2::new(-0.02 + 0.01 * sin, -0.127), Vec2::new(0.03, -0.127)];
        let moving = if self.1 > 1.0 { 0.02 * cos } else { 0.0 };
        Sample { tip_in_world, tip_velocity: [Vec2::new(moving, 0.0), Vec2::zeros()], fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

#[test]
fn friction_does_not_throw_a_softly_coupled_tip_about() {
    let device = Carried(spec(0.0), 0.0);
    let mut servo = Loop::new(Swap::new(presets::table()), Box::new(device), Limits::default());
    let (mut turns, mut before) = (0, 0.0_f64);
    for tick in 0..6_000 {
        let record = servo.tick(T);
        for (tip, device) in record.input.tip_in_world.iter().zip(record.device_in_world) {
            // The coupling of 40 N/m under 0.08 N of friction: 2 mm behind, and 1.8 mm of the depth.
            assert!((tip - device).norm() < 4e-3 || tick < 600, "tick {tick}: {tip:?} for {device:?}");
        }
        let force = record.sent_force_n[1].x;
        turns += usize::from(tick > 600 && force * before < 0.0);
        before = force;
    }
    assert!(turns < 5, "the force on a finger at rest turned round {turns} times");
}
