//! Change of a block's weight while it was carried: a leak or the sensors (see [`crate::online::leak`]).

use super::signals::Blocks;
use crate::identify::limits::{FREE_ENDS_S, LEAST_FREE_S};
use crate::online::block::leak_parameter;
use crate::online::leak::{LeakAnswer, Series, Verdict, Weighing, leak_or_drift};
use foundation::estimate::Parameter;
use foundation::signal::task::smooth;
use foundation::tasks::SystemState;

/// Times and forces.
type Reading = (Vec<f64>, Vec<f64>);

/// `leak_kg_s` of one block of this mass, kg, where its weight changes; `None` where it does not, or where nothing can be said.
pub(super) fn leak(blocks: &Blocks<'_>, number: usize, count: usize, masses_kg: &[f64]) -> Option<Parameter> {
    let rows = carried(blocks, number);
    let answer = judge(blocks, &rows, number, count, masses_kg)?;
    let changes = answer.verdict != Verdict::Steady;
    changes.then(|| leak_parameter(&super::signals::object(number), &answer, rows.len()))
}

fn carried(blocks: &Blocks<'_>, number: usize) -> Vec<usize> {
    blocks.rows(&blocks.samples(&[format!("carry-block-{number}")]))
}

fn judge(blocks: &Blocks<'_>, rows: &[usize], number: usize, count: usize, masses_kg: &[f64]) -> Option<LeakAnswer> {
    let time = &blocks.signals.time_s;
    let mass = masses_kg.get(number - 1).copied().unwrap_or(0.0);
    // Biases stay in, a constant that was taken out does no harm.
    let lift = |rows: &[usize], mass: f64| -> Reading {
        rows.iter().map(|&i| (time[i], blocks.lift[i] - mass * blocks.acceleration_y[i])).unzip()
    };
    let (carried_s, carried_n) = lift(rows, mass);
    let (free_s, free_n) = lift(&free(blocks), 0.0);
    let others: Vec<Reading> = (1..=count)
        .filter(|k| *k != number)
        .map(|k| lift(&carried(blocks, k), masses_kg.get(k - 1).copied().unwrap_or(0.0)))
        .collect();
    let others: Vec<Series<'_>> = others.iter().map(|(t, f)| Series { time_s: t, force_n: f }).collect();
    let horizontal: Vec<f64> = blocks.signals.velocity.iter().map(|v| v.x).collect();
    let push: Vec<f64> = blocks.signals.net_force_n.iter().map(|f| f.x).collect();
    let (acceleration, push) = (smooth(time, &horizontal).slope, smooth(time, &push).value);
    let across: Vec<f64> = rows.iter().map(|&i| push[i] - mass * acceleration[i]).collect();
    let fingers = [0, 1].map(|f: usize| -> Vec<f64> {
        rows.iter().map(|&i| blocks.mean_force(f, i).y - 0.5 * mass * blocks.acceleration_y[i]).collect()
    });
    let weighing = Weighing {
        others: &others,
        across_n: Some(&across),
        fingers_n: Some([&fingers[0], &fingers[1]]),
        ..Weighing::new(
            Series { time_s: &carried_s, force_n: &carried_n },
            Series { time_s: &free_s, force_n: &free_n },
            blocks.recording.meta.gravity(),
        )
    };
    leak_or_drift(&weighing).ok()
}

/// Rows of free motion.
fn free(blocks: &Blocks<'_>) -> Vec<usize> {
    let time = &blocks.signals.time_s;
    let states = blocks.segmentation.states.iter();
    let long = states.filter(|i| i.state == SystemState::FreeMotion && i.t1 - i.t0 >= LEAST_FREE_S);
    let samples: Vec<usize> = long
        .flat_map(|i| (i.first..i.end).filter(|k| time[*k] > i.t0 + FREE_ENDS_S && time[*k] < i.t1 - FREE_ENDS_S))
        .collect();
    blocks.rows(&samples)
}
