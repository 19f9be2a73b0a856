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
    // No damping at all: a sampled spring gives out K/2 Σ Δx².
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
