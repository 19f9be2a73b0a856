//! Angles of an encoder that starts anew after a turn.

use crate::checks::{extremes, place};
use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};
use std::f64::consts::{PI, TAU};

/// Angles within a turn, with some room for rounding.
const ONE_TURN: f64 = 1.001 * TAU;
/// Largest distance of a leap from a whole turn, rad.
const NEAR_A_TURN: f64 = 0.5 * PI;

/// Puts the turns of the program's angles together.
pub fn unwrap(recording: &mut Recording) -> Vec<Warning> {
    let leaps: Vec<(usize, Vec<usize>)> = (0..recording.channels.len())
        .map(|k| (k, leaps(&recording.channels[k])))
        .filter(|(_, l)| !l.is_empty())
        .collect();
    let warnings = leaps.iter().map(|(k, leaps)| {
        let channel = &recording.channels[*k];
        let text = format!(
            "{} leaps by a whole turn {} time(s), first at {}: its turns are put together",
            channel.name,
            leaps.len(),
            place(recording, leaps[0])
        );
        let spans = leaps.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
        Warning {
            kind: "wrapped-angle".to_owned(),
            column: Some(channel.name.clone()),
            spans,
            text,
            ..Warning::default()
        }
    });
    let warnings: Vec<Warning> = warnings.collect();
    for (k, leaps) in leaps {
        super::add_cycles(&mut recording.channels[k].values, TAU, &leaps);
    }
    warnings
}

/// Samples at which an angle leaps by about a whole turn.
fn leaps(channel: &Channel) -> Vec<usize> {
    if channel.unit != "rad" || !units::is_program_name(&channel.name) {
        return Vec::new();
    }
    let (low, high, _) = extremes(&channel.values);
    if high - low > ONE_TURN || high - low < TAU - NEAR_A_TURN {
        return Vec::new();
    }
    let step = |i: usize| (channel.values[i] - channel.values[i - 1]).abs();
    // One clear leap shows that the angle wraps. From then on, the shorter way is the one that was turned.
    if !(1..channel.values.len()).any(|i| (step(i) - TAU).abs() < NEAR_A_TURN) {
        return Vec::new();
    }
    (1..channel.values.len()).filter(|i| step(*i) > PI).collect()
}
