//! `touchstone bench online`: run time of the online estimator per sample, compared with a servo tick.

use super::super::Output;
use anyhow::Context;
use clap::Args;
use estimator::online::{Online, Settings};
use haptics::device::{ScriptedOperator, Skill};
use haptics::recording::Task;
use haptics::servo::recorder::{Rows, SensorModel};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::time::Instant;

/// Servo period, s.
const DT: f64 = 1e-3;

/// Arguments of `bench online`.
#[derive(Args)]
pub struct OnlineBench {
    /// How often each task is performed
    #[arg(long, default_value_t = 5)]
    pub(super) rounds: u32,
}

/// What `bench online --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Costs in each world.
    online: [Cost; 2],
}

/// Costs in one world.
#[derive(JsonSchema, Serialize)]
struct Cost {
    /// Its name.
    world: &'static str,
    /// A tick of the servo, s.
    tick_s: f64,
    /// A sample of the estimator, s.
    sample_s: f64,
    /// The second over the first.
    ratio: f64,
    /// All that is known by then, asked for once, s.
    report_s: f64,
    /// Samples that were given.
    samples: usize,
}

impl OnlineBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        anyhow::ensure!(
            (1..=10_000).contains(&self.rounds),
            "{} rounds are not possible; choose 1 to 10000",
            self.rounds
        );
        let costs = [
            self.cost("two blocks", Task::BlockStack, presets::stacking())?,
            self.cost("crank", Task::Crank, presets::crank())?,
        ];
        let mut text = format!("{:<12} {:>9} {:>10} {:>7} {:>10}\n", "world", "tick", "sample", "ratio", "report");
        for c in &costs {
            let _ = writeln!(
                text,
                "{:<12} {:>6.2} µs {:>7.2} µs {:>7.2} {:>7.0} µs",
                c.world,
                1e6 * c.tick_s,
                1e6 * c.sample_s,
                c.ratio,
                1e6 * c.report_s
            );
        }
        Ok(Output { text, json: serde_json::to_value(Said { online: costs })? })
    }

    /// Measures a task of the scripted operator: first the servo's ticks, then the same ticks through the estimator.
    fn cost(&self, name: &'static str, task: Task, world: World) -> anyhow::Result<Cost> {
        let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 1);
        let count = (operator.duration_s() / DT) as usize;
        let mut servo = Loop::new(Swap::new(world), Box::new(operator), Limits::default());
        let mut ticks = Vec::with_capacity(count);
        let begun = Instant::now();
        for _ in 0..count {
            ticks.push(servo.tick(DT));
        }
        let tick_s = begun.elapsed().as_secs_f64() / count as f64;
        let mut rows = Rows::new(SensorModel::TYPICAL, 1);
        let samples: Vec<_> = ticks.iter().map(|t| (t.time_s, rows.row(t))).collect();
        let last_s = samples.last().context("the script is empty")?.0;
        let mut online = Online::new(task, DT, Settings::default())?;
        let begun = Instant::now();
        for round in 0..self.rounds {
            for (time_s, sample) in &samples {
                online.push(time_s + f64::from(round) * (last_s + 1.0), sample);
            }
        }
        let pushed = count * self.rounds as usize;
        let sample_s = begun.elapsed().as_secs_f64() / pushed as f64;
        let begun = Instant::now();
        let report = online.report();
        let report_s = begun.elapsed().as_secs_f64();
        anyhow::ensure!(!report.parameters.is_empty(), "nothing was measured in the world {name}");
        Ok(Cost { world: name, tick_s, sample_s, ratio: sample_s / tick_s, report_s, samples: pushed })
    }
}
