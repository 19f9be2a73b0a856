//! Over a slow line with and without a model: whole performances, stability, and the effects of a wrong model.

mod passive;
mod performance;
mod wrong_model;

use super::*;
use crate::device::HandImpedance;
use crate::servo::safety::Limits;
use crate::servo::{Loop, Swap, TickRecord};
use crate::world::{State, World};

const DT: f64 = 1e-3;

/// Round trips of the lessons, s.
const ROUND_TRIPS_S: [f64; 3] = [0.0, 0.15, 0.5];

/// Limits that are the device's own.
fn limits() -> Limits {
    Limits { max_force_n: 12.0, ..Limits::default() }
}

/// A servo on `world` in `state`, with `operator` behind a line. The operator's end believes in `guess`, in the state `believed`.
fn over_a_line(
    (world, state): (&World, &State),
    (guess, believed): (&World, &State),
    operator: Box<dyn Device>,
    delay: &Delay,
) -> (Loop, ViewSource) {
    let ends = Ends { world, state: believed, guess: Some(guess), limits: limits(), period_s: DT, seed: 5 };
    let (device, view) = connect(operator, &ends, delay).expect("a line");
    (Loop::new(Swap::at(world.clone(), state.clone()), device, limits()), view)
}

/// Runs until the operator is done; the far servo's ticks.
fn to_the_end(servo: &mut Loop) -> Vec<TickRecord> {
    let mut ticks = Vec::new();
    while !servo.finished() {
        ticks.push(servo.tick(DT));
        assert!(ticks.len() < 300_000, "it comes to an end");
    }
    ticks
}
