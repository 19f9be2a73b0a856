use super::*;
use crate::device::{DeviceSpec, ReplayDevice, Sample};
use crate::world::presets;

/// Fingers that press against the table along a sine, faster than a stiff pad sampled at 1 kHz can follow passively.
struct Prodding(DeviceSpec, f64);

impl Device for Prodding {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, _: &Command, dt_s: f64) -> Sample {
        self.1 += dt_s;
        let omega = std::f64::consts::TAU * 25.0;
        let (sin, cos) = (omega * self.1).sin_cos();
        let tip = |x: f64| Vec2::new(x, -0.1262 + 0.001 * sin);
        let velocity = Vec2::new(0.0, 0.001 * omega * cos);
        Sample { tip_in_world: [tip(-0.03), tip(0.03)], tip_velocity: [velocity; 2], fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

fn prodding(control: Option<f64>) -> TickRecord {
    let mut world = presets::table();
    // No damping at all: a sampled spring generates K/2 Σ Δx².
    world.pad.damping_n_s_m = 0.0;
    let still = || vec![Vec2::zeros(); 2];
    let spec = ReplayDevice::new("spec", vec![0.0, 1.0], [still(), still()], [still(), still()])
        .expect("two samples")
        .spec()
        .clone();
    let limits = Limits { max_force_n: 50.0, max_slew_n_s: 1e6, ramp_s: 1e-3, ..Limits::default() };
    let mut servo = Loop::new(Swap::new(world), Box::new(Prodding(spec, 0.0)), limits).with_passivity_control(control);
    let mut last = TickRecord::default();
    for _ in 0..2_000 {
        last = servo.tick(1e-3);
    }
    last
}

#[test]
fn the_observer_sees_a_sampled_spring_give_out_energy_and_the_controller_takes_it_back() {
    let watched = prodding(None).energy_j;
    assert!(watched < -1e-3, "a sampled spring is active: {watched}");
    let controlled = prodding(Some(50.0)).energy_j;
    assert!(controlled > 0.02 * watched, "{controlled} against {watched}");
}

#[test]
fn a_held_world_has_no_time_and_no_force_and_goes_on_softly() {
    for force_feedback in [true, false] {
        let still = || vec![Vec2::zeros(); 2];
        let spec =
            ReplayDevice::new("spec", vec![0.0, 1.0], [still(), still()], [still(), still()]).expect("two samples");
        let spec = DeviceSpec { force_feedback, max_force_n: 4.0, ..spec.spec().clone() };
        let mut servo = Loop::new(Swap::new(presets::table()), Box::new(Prodding(spec, 0.0)), Limits::default());
        for _ in 0..1_000 {
            servo.tick(1e-3);
        }
        let before = (servo.state().time_s, servo.state().input.tip_in_world);
        servo.hold(true);
        let mut seen = Vec::new();
        for _ in 0..100 {
            seen.push(servo.tick(1e-3));
        }
        assert_eq!((servo.state().time_s, servo.state().input.tip_in_world), before, "the world stands still");
        assert!(seen.iter().all(|tick| tick.time_s == before.0));
        assert!(seen[60..].iter().all(|tick| tick.sent_force_n == [Vec2::zeros(); 2]), "the force is gone");
        let heard = seen.windows(2).any(|w| w[0].device_in_world != w[1].device_in_world);
        assert_eq!(heard, force_feedback, "a real hand is listened to, a thought-out one waits");
        servo.hold(false);
        let after = servo.tick(1e-3);
        assert!(after.time_s > before.0 && after.sent_force_n[0].norm() < 0.05, "{after:?}");
    }
}
