//! Forces and pictures of the far world correct the model, without a jump.

use super::*;
use crate::Vec2;
use crate::device::{Command, DeviceSpec, MouseTarget, Sample, ScriptedOperator, Skill, mouse};
use crate::world::presets;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

#[test]
fn a_block_that_stands_elsewhere_is_moved_in_the_model_to_where_it_is() {
    let world = presets::stacking();
    let believed = State::resting(&world);
    let mut state = believed.clone();
    for body in &mut state.bodies {
        body.center_m.x += 0.008;
    }
    for round_trip_s in ROUND_TRIPS_S {
        let [left, right] = believed.input.tip_in_world;
        let start = MouseTarget { center_in_world: 0.5 * (left + right), aperture_m: right.x - left.x };
        let (_handle, device) = mouse(start, world.hand.workspace);
        let delay = Delay { jitter_s: 0.01, loss: 0.1, ..Delay::of(round_trip_s, true) };
        let (mut servo, mut view) = over_a_line((&world, &state), (&world, &believed), Box::new(device), &delay);
        let mut fastest_m = 0.0_f64;
        let mut before = view.newest().here.bodies[0].center_m;
        for _ in 0..3_000 {
            servo.tick(DT);
            let now = view.newest().here.bodies[0].center_m;
            fastest_m = fastest_m.max((now - before).norm());
            before = now;
        }
        let view = view.newest();
        for (here, there) in view.here.bodies.iter().zip(&servo.state().bodies) {
            let off_m = (here.center_m - there.center_m).norm();
            assert!(off_m < 5e-4, "{round_trip_s} s: {off_m} m off, and does not swing");
        }
        assert!(fastest_m < 4e-4, "{round_trip_s} s: no jump, {fastest_m} m in a tick");
    }
}

#[test]
fn what_slips_out_of_the_far_fingers_is_lost_in_the_model_too_and_fetched_again() {
    // In truth the block is slippery: the pinch of the plan holds it in the model only.
    let guess = presets::stacking();
    let mut world = guess.clone();
    world.blocks[0].finger_friction = 0.10;
    let state = State::resting(&world);
    let delay = Delay::of(0.5, true);
    let operator = || Box::new(ScriptedOperator::new(&guess, &state, Skill::expert(), 1).waiting());
    let (mut servo, mut view) = over_a_line((&world, &state), (&guess, &state), operator(), &delay);
    let (mut held_here, mut lost_here) = (false, false);
    let mut steepest_n = 0.0_f64;
    let mut before = [Vec2::zeros(); 2];
    let mut ticks = 0;
    while !servo.finished() && ticks < 120_000 {
        let tick = servo.tick(DT);
        let here = &view.newest().here;
        let (block, far) = (here.bodies[0].center_m.y, servo.state().bodies[0].center_m.y);
        let start = state.bodies[0].center_m.y;
        held_here |= block > start + 0.006 && far < start + 0.003;
        lost_here |= held_here && block < start + 0.003;
        if !lost_here {
            steepest_n = steepest_n.max(jump_n(&here.tip_force_n, &before));
        }
        before = here.tip_force_n;
        ticks += 1;
        assert!(tick.sent_force_n.iter().all(|force| force.norm() < 12.0));
    }
    assert!(held_here, "the model held what the far hand had lost");
    assert!(lost_here, "and learnt that it was lost");
    let (mut alone, _) = over_a_line((&guess, &state), (&guess, &state), operator(), &delay);
    let undisturbed = to_the_end(&mut alone).len();
    assert!(ticks > undisturbed + 2_000, "the operator tried again: {ticks} ticks, {undisturbed} without a loss");
    // A block that leaves the pads leaves them suddenly; that it is taken out of them by corrections adds nothing.
    let mut touched = Loop::new(Swap::at(world.clone(), state.clone()), operator(), limits());
    let forces: Vec<_> = to_the_end(&mut touched).iter().map(|tick| tick.tip_force_n).collect();
    let usual_n = forces.windows(2).map(|pair| jump_n(&pair[1], &pair[0])).fold(0.0, f64::max);
    assert!(steepest_n < usual_n, "{steepest_n} N in a tick, {usual_n} N where the block itself is touched");
}

/// The largest change of a finger's force, N.
fn jump_n(now: &[Vec2; 2], before: &[Vec2; 2]) -> f64 {
    now.iter().zip(before).map(|(now, before)| (now - before).norm()).fold(0.0, f64::max)
}

#[test]
fn the_model_learns_what_things_weigh() {
    let world = presets::stacking();
    let state = State::resting(&world);
    for seed in 0..6 {
        let guess = guess(&world, seed);
        let operator = ScriptedOperator::new(&world, &state, Skill::expert(), seed).waiting();
        let delay = Delay { jitter_s: 0.02, loss: 0.1, ..Delay::of(0.5, true) };
        let (mut servo, mut view) = over_a_line((&world, &state), (&guess, &state), Box::new(operator), &delay);
        let mut known = [None; 2];
        while !servo.finished() {
            servo.tick(DT);
            if let Some(weighed) = view.newest().weighed {
                known[weighed.body] = Some(weighed);
            }
        }
        for (index, known) in known.into_iter().enumerate() {
            let Weighed { guess_kg, mass_kg, std_kg, .. } = known.expect("carried");
            let truth_kg = world.blocks[index].mass_kg;
            assert_eq!(guess_kg, guess.blocks[index].mass_kg);
            let off_kg = (mass_kg - truth_kg).abs();
            assert!(
                off_kg < 0.03 * truth_kg && off_kg < 3.0 * std_kg,
                "seed {seed}: {mass_kg} kg, truth {truth_kg} kg"
            );
            assert!(
                off_kg < 0.3 * (guess_kg - truth_kg).abs() || off_kg < 0.01 * truth_kg,
                "seed {seed}: guess {guess_kg} kg"
            );
        }
    }
}

/// A pair of fingers on a table that is lost when told.
struct Lost(DeviceSpec, [Vec2; 2], Arc<AtomicBool>, Arc<std::sync::Mutex<Vec<f64>>>);

impl Device for Lost {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, command: &Command, _: f64) -> Sample {
        self.3.lock().expect("one thread").push(command.force_n[0].norm());
        let fresh = [!self.2.load(Ordering::Relaxed); 2];
        Sample { tip_in_world: self.1, tip_velocity: [Vec2::zeros(); 2], fresh }
    }

    fn make_safe(&mut self) {}
}

#[test]
fn a_device_that_is_lost_feels_no_force_of_the_model_and_a_line_that_breaks_leaves_the_far_hand_holding() {
    let world = presets::table();
    let mut state = State::resting(&world);
    let pressed = [-0.02, 0.02].map(|x| Vec2::new(x, -0.1255));
    state.input.tip_in_world = pressed;
    let (lost, felt) = (Arc::new(AtomicBool::new(false)), Arc::default());
    let spec = DeviceSpec { force_feedback: false, damping_n_s_m: 9.0, ..crate::device::udp::UdpConfig::unstated() };
    let device = Lost(spec, pressed, Arc::clone(&lost), Arc::clone(&felt));
    // The line breaks at once: nothing that is said arrives.
    let delay = Delay { loss: 1.0, ..Delay::of(0.15, true) };
    let (mut servo, _) = over_a_line((&world, &state), (&world, &state), Box::new(device), &delay);
    for _ in 0..1_000 {
        servo.tick(DT);
    }
    let newest = || *felt.lock().expect("one thread").last().expect("ticks");
    assert!(newest() > 0.3, "the model presses back: {} N", newest());
    let far = servo.state().input.tip_in_world;
    assert!((far[0] - pressed[0]).norm() < 2e-3, "the far hand stays where it was");
    servo.interrupted();
    servo.tick(DT);
    servo.tick(DT);
    assert!(newest() < 0.05, "a servo that stood still comes up softly: {} N", newest());
    for _ in 0..1_000 {
        servo.tick(DT);
    }
    lost.store(true, Ordering::Relaxed);
    for _ in 0..30 {
        servo.tick(DT);
    }
    assert_eq!(newest(), 0.0, "and a lost device gets none");
}
