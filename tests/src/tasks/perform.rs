//! A hand that does what an answer asks for with a block: the stepped world under an arm that gives, with a wandering pinch.

use super::sensor::{Instruments, look};
use blind::Chance;
use estimator::diagnose::Experiment;
use haptics::Vec2;
use haptics::device::HandImpedance;
use haptics::recording::{Recording, Task};
use haptics::servo::TickRecord;
use haptics::world::{Input, State, World, step, true_label};

/// Where the hand is wanted: when, s, middle of the tips, m, opening, m, and pinch, N.
type Knot = (f64, Vec2, f64, f64);

/// A carry of the first block; nothing for a motion that nobody knows.
pub fn carry(
    world: &World,
    asked: &Experiment,
    instruments: &Instruments,
    every: usize,
    chance: &mut Chance,
) -> Option<Recording> {
    let sane = [asked.seconds, asked.fast, asked.half_range, asked.across_n].iter().all(|v| v.is_finite() && *v > 0.0);
    if !["carry-let-go", "carry-still"].contains(&asked.id.as_str()) || !sane {
        return None;
    }
    let way = way(world, asked);
    let ticks = act(world, &way, chance);
    let recording = look(world, &ticks, every, instruments, Task::BlockStack, chance);
    Some(Recording { name: "asked".to_owned(), ..recording })
}

fn way(world: &World, asked: &Experiment) -> Vec<Knot> {
    let block = &world.blocks[0];
    let at = block.start.center_m;
    let above = at + Vec2::new(0.0, 0.014);
    // The arm gives under the weight.
    let sag_m = 0.5 * block.mass_kg * world.gravity_m_s2 / HandImpedance::default().stiffness_n_m;
    let lifted = at + Vec2::new(0.0, 2.0 * asked.half_range + sag_m);
    let takes_s = (1.875 * (lifted - at).norm() / asked.fast).max(0.4);
    let (open, pinch) = (block.width_m + 0.006, asked.across_n);
    let mut way: Vec<Knot> = vec![(0.0, above, open, 0.0)];
    let mut then = |long: f64, place: Vec2, opening: f64, pinch: f64| {
        let now = way[way.len() - 1].0;
        way.push((now + long, place, opening, pinch));
    };
    then(asked.free_s.max(0.3), above, open, 0.0);
    then(0.7, at, open, 0.0);
    then(0.5, at, block.width_m, pinch);
    then(0.4, at, block.width_m, pinch);
    then(takes_s, lifted, block.width_m, pinch);
    then(asked.seconds, lifted, block.width_m, pinch);
    if asked.free_s > 0.0 {
        then(takes_s, at, block.width_m, pinch);
        then(0.4, at, block.width_m, pinch);
        then(0.5, at, open, 0.0);
        then(0.7, above, open, 0.0);
        then(asked.free_s, above, open, 0.0);
    }
    way
}

/// One tick a millisecond.
fn act(world: &World, way: &[Knot], chance: &mut Chance) -> Vec<TickRecord> {
    const STEP_S: f64 = 2e-4;
    let arm = HandImpedance::default();
    let phases = [chance.between(0.0, 6.0), chance.between(0.0, 6.0)];
    let tips = |middle: Vec2, opening: f64, pinch: f64| {
        let half = Vec2::new(0.5 * opening - pinch / arm.stiffness_n_m, 0.0);
        [middle - half, middle + half]
    };
    let (mut place, mut velocity) = (tips(way[0].1, way[0].2, 0.0), [Vec2::zeros(); 2]);
    let mut state = State::resting(world);
    let mut ticks = Vec::new();
    for k in 0..(way[way.len() - 1].0 / STEP_S) as usize {
        let t = (k as f64 + 1.0) * STEP_S;
        let next = way.partition_point(|w| w.0 <= t).clamp(1, way.len() - 1);
        let (a, b) = (way[next - 1], way[next]);
        let s = ((t - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
        let (share, rate) = (s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)).powi(2) / (b.0 - a.0));
        // Nobody's pinch is steady, nor anybody's hand.
        let wanders = 1.0 + 0.12 * (1.7 * t + phases[0]).sin();
        let shakes = Vec2::new(0.0, 6e-5 * (9.0 * t + phases[1]).sin());
        let (from, to) = (tips(a.1 + shakes, a.2, a.3 * wanders), tips(b.1 + shakes, b.2, b.3 * wanders));
        for f in 0..2 {
            let wanted = (from[f] + (to[f] - from[f]) * share, (to[f] - from[f]) * rate);
            arm.advance(&mut place[f], &mut velocity[f], wanted, -state.tip_force_n[f], STEP_S);
        }
        let input = Input { tip_in_world: place, tip_velocity: velocity };
        step(world, &mut state, &input, STEP_S);
        if k % 5 == 0 {
            let (tip_force_n, label) = (state.tip_force_n, true_label(world, &state));
            ticks.push(TickRecord { time_s: state.time_s, input, tip_force_n, label, ..TickRecord::default() });
        }
    }
    ticks
}
