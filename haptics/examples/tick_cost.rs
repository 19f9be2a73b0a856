//! How long a tick takes, in nanoseconds: `cargo run --release -p haptics --example tick_cost`. Compare figures of one machine
//! and one hour only.

use haptics::Vec2;
use haptics::world::{Input, State, World, presets, step};
use std::time::Instant;

const TICKS: u32 = 50_000;
const DT_S: f64 = 1e-3;

/// Best mean of twenty rounds, ns a tick: fingers on both sides of `grasp_m`, gently moving.
fn nanoseconds(world: &World, grasp_m: Vec2, half_m: f64) -> f64 {
    let mut state = State::resting(world);
    let half = Vec2::new(half_m, 0.0);
    let best = (0..20)
        .map(|_| {
            let start = Instant::now();
            for tick in 0..TICKS {
                let wobble = Vec2::new(1e-4 * (f64::from(tick) * DT_S).sin(), 0.0);
                let tip_in_world = [grasp_m - half + wobble, grasp_m + half + wobble];
                step(world, &mut state, &Input { tip_in_world, ..Input::default() }, DT_S);
            }
            start.elapsed().as_secs_f64() / f64::from(TICKS)
        })
        .fold(f64::MAX, f64::min);
    best * 1e9
}

fn main() {
    let crank = presets::crank();
    if let Some(handle) = State::resting(&crank).handle_in_world(&crank) {
        println!("crank held by two pads      {:>7.0} ns", nanoseconds(&crank, handle, 0.0045));
    }
    let blocks = presets::stacking();
    let upper = blocks.blocks[0].start.center_m;
    println!(
        "two blocks, one pinched     {:>7.0} ns",
        nanoseconds(&blocks, upper, 0.5 * blocks.blocks[0].width_m - 4e-4)
    );
}
