//! The scripted operator stacks blocks and turns the crank over the line.

use super::*;
use crate::device::{ScriptedOperator, Skill};
use crate::world::presets;

/// Seconds that a performance took, the largest force, N, and how it ended.
fn perform(world: &World, delay: &Delay, seed: u64) -> (f64, f64, State) {
    let state = State::resting(world);
    let guess = guess(world, seed);
    let operator = ScriptedOperator::new(world, &state, Skill::expert(), seed).waiting();
    let (mut servo, _) = over_a_line((world, &state), (&guess, &state), Box::new(operator), delay);
    let ticks = to_the_end(&mut servo);
    let peak_n = ticks.iter().flat_map(|tick| tick.tip_force_n).map(|force| force.norm()).fold(0.0, f64::max);
    (ticks.len() as f64 * DT, peak_n, servo.state().clone())
}

fn is_stacked(state: &State) -> bool {
    let (one, two) = (state.bodies[0].center_m, state.bodies[1].center_m);
    one.x > 0.005 && (one.x - two.x).abs() < 3e-3 && (two.y - one.y - 0.5 * (0.0160 + 0.0127)).abs() < 3e-4
}

#[test]
fn a_model_takes_the_waiting_out_of_stacking_and_the_tower_stands_at_the_far_end() {
    let world = presets::stacking();
    for seed in 0..4 {
        let all = ROUND_TRIPS_S.map(|round_trip_s| {
            [false, true].map(|predicted| perform(&world, &Delay::of(round_trip_s, predicted), seed))
        });
        assert!(all.iter().flatten().all(|(_, _, state)| is_stacked(state)), "seed {seed}");
        let seconds = all.each_ref().map(|pair| pair.each_ref().map(|(seconds, ..)| *seconds));
        // Without a model every movement waits for the line. With it only the end does: the last look, and no more.
        assert!(seconds[2][0] > seconds[1][0] + 2.0 && seconds[1][0] > seconds[0][0] + 0.5, "seed {seed}: {seconds:?}");
        assert!(seconds[2][1] < seconds[0][1] + 1.0 && seconds[1][1] < seconds[0][1] + 0.5, "seed {seed}: {seconds:?}");
        let peaks = all[2].each_ref().map(|(_, peak_n, _)| *peak_n);
        assert!(peaks[1] < peaks[0], "seed {seed}: and it is gentler: {peaks:?} N");
    }
}

#[test]
fn the_crank_is_turned_over_half_a_second_either_way() {
    let world = presets::crank();
    for predicted in [false, true] {
        let (seconds, peak_n, state) = perform(&world, &Delay::of(0.5, predicted), 1);
        // Two turns, five quarters, back by six and on by one: two in all.
        let turned = state.crank.angle_rad - State::resting(&world).crank.angle_rad;
        assert!((turned / std::f64::consts::TAU - 2.0).abs() < 0.05, "predicted: {predicted}, {turned} rad");
        assert!(seconds < 25.0 && peak_n < 12.0, "predicted: {predicted}, {seconds} s, {peak_n} N");
    }
}

/// Test of a world's final state for success in its task.
type Done = fn(&State) -> bool;

fn tasks() -> [(World, Done); 4] {
    [
        (presets::stacking(), is_stacked as Done),
        (presets::needle(), |state| state.membrane.holes.iter().filter(|hole| hole.history.punctured).count() == 2),
        (presets::switch(), |state| state.switch.at_m < -5e-3),
        (presets::barrel(), |state| !state.bodies[0].broken && state.bodies[0].angle_rad.abs() < 0.1),
    ]
}

#[test]
fn every_task_is_done_over_half_a_second_and_no_wait_is_in_vain() {
    for (world, done) in tasks() {
        let (direct_s, _, state) = perform(&world, &Delay::of(0.0, false), 3);
        assert!(done(&state), "{}: {state:?}", world.name);
        for predicted in [false, true] {
            let (seconds, _, state) = perform(&world, &Delay::of(0.5, predicted), 3);
            assert!(done(&state), "{}, predicted {predicted}: {state:?}", world.name);
            let most = if predicted { 1.1 } else { 1.5 };
            assert!(seconds < most * direct_s, "{}, predicted {predicted}: {seconds} s, {direct_s} s", world.name);
        }
    }
}

#[test]
fn every_task_is_done_on_a_model_over_a_line_that_scatters_and_loses() {
    let delay = Delay { jitter_s: 0.05, loss: 0.2, ..Delay::of(0.3, true) };
    for (world, done) in tasks() {
        let (_, _, state) = perform(&world, &delay, 3);
        assert!(done(&state), "{}: {state:?}", world.name);
    }
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    let world = presets::stacking();
    let delay = Delay { jitter_s: 0.02, loss: 0.1, ..Delay::of(0.15, true) };
    let run = || perform(&world, &delay, 2).2;
    assert!(run() == run());
}

#[test]
fn an_operator_that_waits_is_slower_by_what_the_picture_is_late_and_no_more_at_once() {
    // Without a line the waiting costs little: the plan's own pauses cover a reaction.
    let world = presets::stacking();
    let seconds = |waits: bool| {
        let state = State::resting(&world);
        let operator = ScriptedOperator::new(&world, &state, Skill::expert(), 1);
        let operator = if waits { operator.waiting() } else { operator };
        let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits());
        let ticks = to_the_end(&mut servo);
        assert!(is_stacked(servo.state()), "waits: {waits}");
        ticks.len() as f64 * DT
    };
    let [usual, waiting] = [false, true].map(seconds);
    assert!(waiting >= usual && waiting < 1.35 * usual, "{usual} s, waiting {waiting} s");
}
