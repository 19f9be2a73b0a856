//! The crank against numbers computed by hand.

use super::super::*;
use super::{AWAY, DT, run};

#[test]
fn crank_spins_down_under_coulomb_and_viscous_friction() {
    // m dv/dt = −Fc − c v stops at t = (m/c) ln(1 + c v0/Fc).
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    let (mass, coulomb, viscous, speed) = (0.05, 0.01, 0.1, 0.3);
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[mass]),
        crate::law::Effect::new(&crate::law::CoulombFriction, &[coulomb]),
        crate::law::Effect::new(&crate::law::ViscousFriction, &[viscous]),
    ];
    let radius = crank.radius_m;
    let mut state = State::new(&world, AWAY);
    state.crank.rate_rad_s = speed / radius;
    let input = state.input;
    let mut ticks = 0;
    while state.crank.rate_rad_s != 0.0 && ticks < 10_000 {
        step(&world, &mut state, &input, DT);
        ticks += 1;
    }
    let expected = mass / viscous * (1.0 + viscous * speed / coulomb).ln();
    assert!((f64::from(ticks) * DT - expected).abs() < 2.0 * DT, "{} against {expected}", f64::from(ticks) * DT);
}

#[test]
fn crank_swings_with_the_pendulum_period() {
    // A handle whose weight is m g swings like a mathematical pendulum: T = 2π sqrt(R/g) for small angles.
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[0.05]),
        crate::law::Effect::new(&crate::law::Weight, &[0.05 * 9.81]),
    ];
    crank.start_rad = -std::f64::consts::FRAC_PI_2 + 0.05;
    let expected = std::f64::consts::TAU * (crank.radius_m / 9.81).sqrt();
    let mut state = State::new(&world, AWAY);
    let input = state.input;
    let (mut crossings, mut last) = (Vec::new(), 1.0);
    while crossings.len() < 21 {
        step(&world, &mut state, &input, 1e-4);
        let swing = state.crank.angle_rad + std::f64::consts::FRAC_PI_2;
        if swing.signum() != last {
            crossings.push(state.time_s);
        }
        last = swing.signum();
    }
    let period = (crossings[20] - crossings[0]) / 10.0;
    assert!((period / expected - 1.0).abs() < 1e-3, "{period} against {expected}");
}

#[test]
fn a_crank_remembers_its_presliding_and_hangs_in_it() {
    // A handle of 0.16 N level with the axis hangs in presliding friction of 0.4 N and 800 N/m. Fc z = W, so z = 0.4.
    // It sinks by l ln(1/(1 − 0.4)), l = 0.5 mm, along its path (cos θ = 1 to 1e-4), and stays there.
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[0.05]),
        crate::law::Effect::new(&crate::law::Weight, &[0.16]),
        crate::law::Effect::new(&crate::law::Hysteresis, &[0.4, 800.0]),
        // Enough to come to rest without overshoot: 2 √(k m) = 13 N s/m.
        crate::law::Effect::new(&crate::law::ViscousFriction, &[20.0]),
    ];
    crank.start_rad = 0.0;
    let radius = crank.radius_m;
    let mut state = State::new(&world, AWAY);
    run(&world, &mut state, 3.0);
    let sunk = -radius * state.crank.angle_rad;
    assert!((sunk / (5e-4 * (1.0_f64 / 0.6).ln()) - 1.0).abs() < 2e-3, "{sunk}");
    run(&world, &mut state, 10.0);
    assert!((-radius * state.crank.angle_rad - sunk).abs() < 1e-9);
}
