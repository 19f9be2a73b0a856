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
