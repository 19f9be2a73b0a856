//! Strong laws and extreme worlds: stable where they are legal, refused in words where they cannot be stepped.

use super::super::*;
use super::{AWAY, DT};
use crate::Vec2;
use crate::law::{Effect, Inertia, Law, QuadraticDrag, ReturnSpring, ViscousFriction};

const MASS_KG: f64 = 0.03;

/// A crank with one law, set going at 0.5 m/s; the largest speed after that and the speed at the end, m/s.
fn swing(law: &'static dyn Law, values: &[f64], dt_s: f64, seconds: f64) -> (f64, f64) {
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![Effect::new(&Inertia, &[MASS_KG]), Effect::new(law, values)];
    let radius_m = crank.radius_m;
    crank.start_rad = 0.0;
    world.check().expect("a legal world");
    let mut state = State::new(&world, AWAY);
    state.crank.rate_rad_s = 0.5 / radius_m;
    let (input, mut fastest) = (state.input, 0.0_f64);
    for _ in 0..(seconds / dt_s) as usize {
        step(&world, &mut state, &input, dt_s);
        fastest = fastest.max((radius_m * state.crank.rate_rad_s).abs());
    }
    (fastest, radius_m * state.crank.rate_rad_s)
}

#[test]
fn a_damper_of_any_strength_slows_down_and_never_turns_round() {
    for c in [1.0, 30.0, 70.0, 1e4] {
        let (fastest, end) = swing(&ViscousFriction, &[c], DT, 0.02);
        // m dv/dt = −c v: exp(−c t/m), met to first order.
        let expected = 0.5 * (-c * 0.02 / MASS_KG).exp();
        assert!(fastest < 0.5 && end >= 0.0 && (end - expected).abs() < 0.02, "c = {c}: {end} against {expected}");
    }
    for k in [1.0, 1e3, 1e6] {
        let (fastest, end) = swing(&QuadraticDrag, &[k], DT, 0.02);
        // m dv/dt = −k v²: v0/(1 + k v0 t/m).
        let expected = 0.5 / (1.0 + k * 0.5 * 0.02 / MASS_KG);
        assert!(fastest < 0.5 && end >= 0.0 && (end - expected).abs() < 0.02, "k = {k}: {end} against {expected}");
    }
}

#[test]
fn a_strong_spring_swings_without_gaining() {
    for k in [100.0, 1e4, 1e5, 1e6] {
        let (fastest, _) = swing(&ReturnSpring, &[k], DT, 2.0);
        // It starts at its rest place: 0.5 m/s is its largest speed.
        assert!(fastest < 0.5 * 1.35, "k = {k}: {fastest} m/s");
    }
}

fn refused(change: impl Fn(&mut World)) -> String {
    let mut world = presets::stacking();
    world.crank = presets::crank().crank;
    change(&mut world);
    world.check().expect_err("it cannot be stepped").to_string()
}

#[test]
fn what_cannot_be_stepped_is_refused_and_named() {
    assert!(refused(|w| w.blocks[1].mass_kg = 1e-6).contains("block-2 would need"));
    assert!(refused(|w| w.floor.as_mut().expect("a floor").stiffness_n_m = 1e10).contains("softer"));
    assert!(refused(|w| w.floor.as_mut().expect("a floor").damping_n_s_m = 1e4).contains("would need"));
    let light = |w: &mut World| w.crank.as_mut().expect("a crank").effects[1].values[0] = 1e-7;
    assert!(refused(light).contains("the crank's handle"));
    assert!(refused(|w| w.blocks[0].start.center_m.y -= 0.005).contains("inside block-2"));
    assert!(refused(|w| w.blocks[1].start.center_m.y -= 0.003).contains("inside the floor"));
    let giving =
        |w: &mut World| w.crank.as_mut().expect("a crank").effects.push(Effect::new(&ViscousFriction, &[-5.0]));
    assert!(refused(giving).contains("viscous-friction has c = -5"));
    let text = presets::stacking().to_json().replace("\"gravity_m_s2\"", "\"grvity_m_s2\"");
    assert!(World::from_json(&text).expect_err("a misspelt name").to_string().contains("grvity_m_s2"));
}

#[test]
fn a_finger_on_the_sheet_feels_its_depth_and_nothing_else() {
    let world = presets::needle();
    let sheet = world.membrane.expect("there is one").center_m;
    let mut state = State::resting(&world);
    let force_at = |world: &World, state: &mut State, way: &[(f64, f64)]| {
        for (x, y) in way {
            let to = sheet + Vec2::new(*x, *y);
            let from = state.input.tip_in_world[0];
            for part in 1..=400 {
                let mut input = state.input;
                input.tip_in_world[0] = from + (to - from) * f64::from(part) / 400.0;
                input.tip_in_world[1] = Vec2::new(0.05, -0.05);
                step(world, state, &input, DT);
            }
        }
        -state.tip_force_n[0].y
    };
    let pressed = force_at(&world, &mut state, &[(-0.012, 0.005), (-0.012, -0.006)]);
    assert!(pressed > 0.5, "{pressed} N");
    // Deeper, past the edge and back: at the same depth the same force, without a jump to nothing.
    let again = force_at(&world, &mut state, &[(-0.012, -0.012), (-0.022, -0.012), (-0.022, -0.006), (-0.012, -0.006)]);
    assert!((again - pressed).abs() < 0.02 * pressed, "{again} against {pressed} N");
    // Without the cup's wall in the way: from below nothing.
    let mut world = world;
    world.floor = None;
    let below = force_at(&world, &mut state, &[(-0.012, 0.005), (-0.04, 0.005), (-0.04, -0.012), (-0.012, -0.012)]);
    assert_eq!(below, 0.0);
}
