//! The crank's laws are learnt from pictures of a hand that turns it.

use super::super::album::PICTURE_S;
use super::super::guess;
use super::super::picture::Picture;
use super::*;
use crate::device::{Command, Device, ScriptedOperator, Skill};
use crate::law::{Motion, drive_force};
use crate::world::{Input, presets, step};

const DT: f64 = 1e-3;

/// Force that turns a crank upwards at a speed, N.
fn drive_n(world: &World, speed_m_s: f64) -> f64 {
    let motion = Motion {
        velocity: speed_m_s,
        direction: speed_m_s.signum(),
        normal_force_n: 0.5,
        up_along: 0.0,
        ..Motion::default()
    };
    world.crank.as_ref().map_or(0.0, |crank| drive_force(&crank.effects, &motion))
}

#[test]
fn a_crank_that_was_guessed_wrong_feels_like_the_far_one_after_it_was_turned() {
    let truth = presets::crank();
    for seed in 0..6 {
        let mut model = guess(&truth, seed);
        let mut state = State::resting(&truth);
        let mut tutor = Tutor::new(&model, &state, 0.5);
        let mut operator = ScriptedOperator::new(&truth, &state, Skill::expert(), seed);
        let mut picture = Picture::of(&state);
        let before = model.clone();
        while !operator.finished() {
            let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, DT);
            let input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
            step(&truth, &mut state, &input, DT);
            if state.tick.is_multiple_of((PICTURE_S / DT) as u64) {
                picture.take(&state);
                tutor.learn(&picture, state.time_s, Grasp::of(&state));
            }
            tutor.laws.bleed(&mut model, DT);
        }
        for speed_m_s in [-0.15, -0.05, 0.05, 0.15] {
            let [told, guessed, learnt] = [&truth, &before, &model].map(|world| drive_n(world, speed_m_s));
            let (off, was) = ((learnt - told).abs(), (guessed - told).abs());
            assert!(off < 0.25 * was || off < 0.01, "seed {seed}, {speed_m_s} m/s: {told} N, {guessed} N, {learnt} N");
        }
    }
}

/// Model that a tutor makes of a far world. A scripted hand acts there by the plan made for `planned`.
fn taught(world: &World, planned: &World, guessed: &World, skill: Skill, seed: u64) -> World {
    let mut model = guessed.clone();
    let mut state = State::resting(world);
    let mut tutor = Tutor::new(&model, &state, 0.5);
    let mut operator = ScriptedOperator::new(planned, &state, skill, seed);
    let mut picture = Picture::of(&state);
    while !operator.finished() && state.time_s < 60.0 {
        let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, DT);
        let input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
        step(world, &mut state, &input, DT);
        if state.tick.is_multiple_of((PICTURE_S / DT) as u64) {
            picture.take(&state);
            tutor.learn(&picture, state.time_s, Grasp::of(&state));
        }
        tutor.touch.bleed(&mut model, DT);
    }
    model
}

#[test]
fn friction_is_learnt_from_what_slips_and_from_what_holds_though_it_should_slip() {
    let planned = presets::stacking();
    // It slips out of a pinch that was meant for more friction.
    let mut slippery = planned.clone();
    slippery.blocks[0].finger_friction = 0.15;
    for seed in 0..6 {
        let guessed = guess(&planned, seed);
        let model = taught(&slippery, &planned, &guessed, Skill::expert(), seed);
        let (learnt, told) = (model.blocks[0].finger_friction, 0.15);
        assert!((learnt - told).abs() < 0.1 * told, "seed {seed}: {learnt}");
    }
    // A weakly held block tells the least value of its friction; without a slip no more is known.
    let mut rough = planned.clone();
    rough.blocks[0].finger_friction = 0.2;
    let truth = planned.blocks[0].finger_friction;
    let model = taught(&planned, &planned, &rough, Skill::expert(), 3);
    let learnt = model.blocks[0].finger_friction;
    assert!(learnt > 0.21 && learnt < 1.02 * truth, "{learnt}");
}

#[test]
fn the_stiffness_of_a_wall_is_learnt_by_squeezing_it() {
    let truth = presets::barrel();
    let told = truth.blocks[0].wall.expect("it gives").stiffness_n_m;
    for seed in 0..6 {
        let guessed = guess(&truth, seed);
        let first = guessed.blocks[0].wall.expect("it gives").stiffness_n_m;
        let model = taught(&truth, &truth, &guessed, Skill::expert(), seed);
        let learnt = model.blocks[0].wall.expect("it gives").stiffness_n_m;
        let (off, was) = ((learnt - told).abs(), (first - told).abs());
        assert!(was < 0.01 * told || off < 0.25 * was, "seed {seed}: {told} N/m, {first} N/m, {learnt} N/m");
    }
}

#[test]
fn a_wall_that_broke_at_the_far_end_is_broken_in_the_model_once_nobody_holds_it() {
    let world = presets::barrel();
    let mut state = State::resting(&world);
    let mut tutor = Tutor::new(&world, &state, 0.5);
    let (mut held, mut far) = (Picture::of(&state), Picture::of(&state));
    (far.bodies[0].broken, far.bodies[0].leaked_kg) = (true, 0.02);
    held.bodies[0] = far.bodies[0];
    held.grasp.body = Some(0);
    let none = poses::Corrected::none(state.bodies.len());
    let then = Picture::of(&state);
    for (picture, broken) in [(&held, false), (&far, true)] {
        tutor.poses.compare(&then, &none, picture, Grasp::default());
        tutor.poses.bleed(&mut state, DT);
        assert_eq!(state.bodies[0].broken, broken);
    }
    assert!((state.bodies[0].leaked_kg - 0.02).abs() < 1e-12);
}
