use super::*;

const T: f64 = 1e-3;

#[test]
fn the_general_criterion_gives_the_closed_form() {
    for (k, b) in [(1000.0, 0.0), (2000.0, 0.4), (500.0, 1.2)] {
        let numeric = required_damping_of(wall(k, b, T), T);
        assert!((numeric / required_damping(k, b, T) - 1.0).abs() < 1e-5, "K {k}, B {b}: {numeric}");
    }
}

/// True if a mass released in a two-sided sampled wall comes to rest. The mass is integrated exactly between the
/// samples.
fn settles(stiffness: f64, wall_damping: f64, device_damping: f64, delay_periods: usize) -> bool {
    let mass = 0.1;
    let decay = (-device_damping / mass * T).exp();
    let mut held = vec![0.0; delay_periods + 1];
    let (mut x, mut v, mut before) = (1e-3, 0.0, 1e-3);
    let mut late_peak: f64 = 0.0;
    for tick in 0..60_000 {
        held.rotate_right(1);
        held[0] = -stiffness * x - wall_damping * (x - before) / T;
        before = x;
        let force = held[delay_periods];
        let terminal = force / device_damping;
        x += terminal * T + (v - terminal) * mass / device_damping * (1.0 - decay);
        v = terminal + (v - terminal) * decay;
        if !x.is_finite() || x.abs() > 1.0 {
            return false;
        }
        if tick >= 50_000 {
            late_peak = late_peak.max(x.abs());
        }
    }
    late_peak < 1e-3
}

#[test]
fn the_stability_boundary_is_where_the_formula_says() {
    for (b, wall_damping, delay) in [(0.5, 0.0, 0), (0.5, 0.5, 0), (0.4, 0.0, 1), (0.3, 0.6, 0)] {
        let limit = stable_stiffness(b, wall_damping, T, delay as f64 * T);
        assert!(
            settles(0.97 * limit, wall_damping, b, delay),
            "b {b}, B {wall_damping}, delay {delay}: {limit} too high"
        );
        assert!(
            !settles(1.03 * limit, wall_damping, b, delay),
            "b {b}, B {wall_damping}, delay {delay}: {limit} too low"
        );
    }
}

#[test]
fn stable_and_never_passive() {
    // B > b: a soft wall is stable, and yet no stiffness is passive.
    let (b, wall_damping) = (0.3, 0.6);
    assert!(settles(300.0, wall_damping, b, 0));
    let device = oracles::device(b, 0.0, 0.0);
    assert_eq!(passive_stiffness(&device, wall_damping, T, 0.0), 0.0);
    for stiffness in [0.0, 1.0, 10.0, 100.0, 300.0] {
        let wall = oracles::Wall { stiffness, damping: wall_damping, delay: 0 };
        let energy = oracles::shaken(&wall, &device, std::f64::consts::PI);
        assert!(energy < 0.0, "{stiffness} N/m: {energy} J");
    }
}

#[test]
fn the_controller_only_acts_in_the_red_and_is_capped() {
    let still = Vec2::zeros();
    let along = |x: f64| [Vec2::new(x, 0.0), still];
    let mut observer = Observer::default();
    observer.add([still; 2], along(-1.0), 0.0);
    observer.add(along(1e-3), [still; 2], 0.0);
    assert!((observer.energy_j() + 1e-3).abs() < 1e-15, "1 N helped along 1 mm: 1 mJ was given out");
    let [force, other] = control(&observer, along(0.5), T, 100.0);
    assert!((force.x + 0.5 * 4.0).abs() < 1e-9, "α = 1 mJ / (1 ms · 0.25 m²/s²) = 4 N s/m: {force}");
    assert_eq!(other, still);
    assert!((control(&observer, along(0.5), T, 1.0)[0].x + 0.5).abs() < 1e-12);
    assert_eq!(control(&observer, [still; 2], T, 100.0), [still; 2]);
    assert_eq!(control(&Observer::default(), along(1.0), T, 100.0), [still; 2]);
}

#[test]
fn what_one_finger_gives_and_the_other_takes_is_no_activity() {
    // A rigid block pinched with 2 N and carried 10 mm: the left finger pushes, the right one is pushed.
    let mut observer = Observer::default();
    let pinch = [Vec2::new(2.0, 0.0), Vec2::new(-2.0, 0.0)];
    observer.add([Vec2::new(-0.01, 0.0), Vec2::new(0.01, 0.0)], pinch, 0.0);
    observer.add([Vec2::new(0.0, 0.0), Vec2::new(0.02, 0.0)], pinch, 0.0);
    assert!(observer.energy_j().abs() < 1e-15);
}

/// Work spent on lifting comes back on lowering: that is no activity. Energy that was never stored is.
#[test]
fn what_the_world_held_may_come_back() {
    let mut observer = Observer::default();
    let along = |y: f64| [Vec2::new(0.0, y); 2];
    // Half a newton up on each finger holds a newton that sinks a centimetre.
    observer.add(along(0.01), along(0.5), 0.01);
    observer.add(along(0.0), along(0.5), 0.0);
    assert!(observer.energy_j().abs() < 1e-12, "{}", observer.energy_j());
    observer.add(along(-0.01), along(0.5), 0.0);
    assert!((observer.energy_j() + 0.01).abs() < 1e-12, "nothing sank, and yet work came out");
}

/// In every built-in world, whatever the scripted operator does: lifting, lowering, turning, throwing and piercing.
#[test]
fn worlds_that_dissipate_are_never_accused() {
    use crate::device::{ScriptedOperator, Skill};
    use crate::servo::{Loop, Swap, safety::Limits};
    use crate::world::{State, presets};
    for world in presets::all() {
        let state = State::resting(&world);
        let device = ScriptedOperator::new(&world, &state, Skill::default(), 7);
        let ticks = (device.duration_s().min(30.0) / 1e-3) as usize;
        let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(device), Limits::default());
        let least_j = (0..ticks).map(|_| servo.tick(1e-3).energy_j).fold(0.0, f64::min);
        println!("{}: {:.3} mJ at the least", world.name, 1e3 * least_j);
        assert!(least_j > -2e-4, "{}: {least_j} J", world.name);
        // Another world begins a new account.
        servo.swap(Swap::new(presets::table()));
        assert!(servo.tick(1e-3).energy_j.abs() < 1e-6, "{}", world.name);
    }
}
