//! `touchstone bench delay`: durations of tasks with link latency, with and without a predictive model.
//!
//! In simulated time: the servo's tick, the link and the operator have one clock, so that a run is reproducible to the
//! bit.

mod median;

use super::super::{Output, progress};
use crate::operator;
use clap::Args;
use haptics::device::{ScriptedOperator, Skill};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::teleop::{self, Delay, Ends};
use haptics::world::{State, World, presets};
use median::Median;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;

/// Servo period, s.
const DT: f64 = 1e-3;
/// Time limit of a task, s.
const LONGEST_S: f64 = 240.0;
/// Number of ticks for which a block must be held above the ground before a release counts as a drop.
const HELD_TICKS: usize = 100;
/// Force limit of the operator's device, N.
const MOST_N: f64 = 12.0;

/// Arguments of `bench delay`.
#[derive(Args)]
pub struct DelayBench {
    /// Performances of each task on each line
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    seeds: u32,
    /// Round trips, ms, with commas between them
    #[arg(long, value_delimiter = ',', default_value = "0,150,500")]
    round_trips_ms: Vec<f64>,
    /// Extra delay of each packet, each way, evenly between none and this, ms
    #[arg(long, default_value_t = 0.0)]
    jitter_ms: f64,
    /// Share of the packets that is lost, 0 to 1
    #[arg(long, default_value_t = 0.0)]
    loss: f64,
    /// How well the scripted operator does it: novice, intermediate, advanced or expert
    #[arg(long, default_value = "expert")]
    skill: String,
}

/// What `bench delay --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said<'a> {
    /// Performances of each task on each line.
    seeds: u32,
    /// Level of the scripted operator.
    skill: &'a str,
    /// Most extra delay of a packet, s.
    jitter_s: f64,
    /// Share of the packets that is lost.
    loss: f64,
    /// Each task on each line.
    delay: Vec<Compared>,
    /// How far the model's masses are off, relative to the truth; null where nothing was carried with a model.
    mass_off: Option<Off>,
}

/// One task on one line.
#[derive(JsonSchema, Serialize)]
struct Compared {
    /// Its name.
    task: &'static str,
    /// There and back, s.
    round_trip_s: f64,
    /// Without a model.
    without: Side,
    /// With a model that answers at once.
    with: Side,
    /// Time with a model over time without one, seed by seed; null where none was done both ways.
    ratio: Option<Median>,
}

/// All performances of one kind.
#[derive(JsonSchema, Serialize)]
struct Side {
    /// How many were done.
    done: usize,
    /// Their times, s.
    seconds: Option<Median>,
    /// Blocks that were dropped.
    drops: usize,
    /// Largest force of a performance, N.
    #[serde(rename = "peak_N")]
    peak_n: Option<Median>,
    /// Time of each seed, s; null where it was not done.
    all_seconds: Vec<Option<f64>>,
}

/// How far masses are off: medians.
#[derive(JsonSchema, Serialize)]
struct Off {
    /// At first.
    guess: f64,
    /// In the end.
    learnt: f64,
}

/// Definition of a task.
struct TaskOf {
    name: &'static str,
    world: World,
    /// Test of success, from the initial and the final state.
    done: fn(&World, &State, &State) -> bool,
}

/// Result of one performance.
struct Shown {
    seconds: f64,
    done: bool,
    drops: usize,
    peak_n: f64,
    /// Relative errors of the carried bodies' masses, in the initial guess and at the end.
    off: Vec<[f64; 2]>,
}

/// All performances of a task over a link, by seed, without and with a model.
struct Cell {
    task: &'static str,
    round_trip_s: f64,
    shown: [Vec<Shown>; 2],
}

impl DelayBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let skill = operator::skill(&self.skill).map_err(anyhow::Error::msg)?;
        anyhow::ensure!(
            skill.reaction_s.is_some(),
            "the {} operator does not look: choose a level that does",
            self.skill
        );
        let lines: Vec<Delay> = self.round_trips_ms.iter().map(|ms| self.line(*ms)).collect();
        for line in &lines {
            line.check()?;
        }
        let tasks = [
            TaskOf { name: "two blocks", world: presets::stacking(), done: is_stacked },
            TaskOf { name: "crank", world: presets::crank(), done: is_turned },
        ];
        let mut cells = Vec::new();
        for task in &tasks {
            for line in &lines {
                let what = format!("{} over {:.0} ms", task.name, 1e3 * line.round_trip_s);
                cells.push(progress::during(&what, |_| self.cell(task, line, skill))?);
            }
        }
        Ok(Output { text: self.text(&cells), json: serde_json::to_value(self.said(&cells))? })
    }

    fn line(&self, round_trip_ms: f64) -> Delay {
        Delay { round_trip_s: 1e-3 * round_trip_ms, jitter_s: 1e-3 * self.jitter_ms, loss: self.loss, predicted: false }
    }

    fn cell(&self, task: &TaskOf, line: &Delay, skill: Skill) -> anyhow::Result<Cell> {
        let all = |predicted: bool| {
            let line = Delay { predicted, ..*line };
            (1..=u64::from(self.seeds))
                .map(|seed| perform(task, &line, skill, seed))
                .collect::<anyhow::Result<Vec<_>>>()
        };
        Ok(Cell { task: task.name, round_trip_s: line.round_trip_s, shown: [all(false)?, all(true)?] })
    }

    fn text(&self, cells: &[Cell]) -> String {
        let mut text = format!(
            "{} performances each by the {} operator, who moves and waits; simulated time\n\
             {:<11} {:>10}  {:<8} {:>7} {:>22} {:>6} {:>13}\n",
            self.seeds, self.skill, "task", "round trip", "model", "done", "time, s (95 %)", "drops", "peak force, N"
        );
        for cell in cells {
            for (shown, model) in cell.shown.iter().zip(["without", "with"]) {
                let (time, peak) = (time_s(shown), peak_n(shown));
                let done = format!("{}/{}", shown.iter().filter(|s| s.done).count(), shown.len());
                let drops: usize = shown.iter().map(|s| s.drops).sum();
                let _ = writeln!(
                    text,
                    "{:<11} {:>7.0} ms  {model:<8} {done:>7} {:>22} {drops:>6} {:>13.1}",
                    cell.task,
                    1e3 * cell.round_trip_s,
                    time.map_or_else(|| "-".to_owned(), |m| m.text(1)),
                    peak.map_or(f64::NAN, |m| m.middle),
                );
            }
            if let Some(ratio) = cell.ratio() {
                let _ = writeln!(text, "{:<11} {:>10}  {:<8} {:>7} {:>22}", "", "", "ratio", "", ratio.text(2));
            }
        }
        if let Some([guess, learnt]) = offs(cells) {
            let _ = writeln!(
                text,
                "The model began with masses {:.0} % off and ended {:.2} % off (medians of what was carried).",
                1e2 * guess,
                1e2 * learnt
            );
        }
        text
    }

    fn said(&self, cells: &[Cell]) -> Said<'_> {
        Said {
            seeds: self.seeds,
            skill: &self.skill,
            jitter_s: 1e-3 * self.jitter_ms,
            loss: self.loss,
            delay: cells.iter().map(Compared::from).collect(),
            mass_off: offs(cells).map(|[guess, learnt]| Off { guess, learnt }),
        }
    }
}

impl Side {
    fn of(shown: &[Shown]) -> Self {
        Self {
            done: shown.iter().filter(|s| s.done).count(),
            seconds: time_s(shown),
            drops: shown.iter().map(|s| s.drops).sum(),
            peak_n: peak_n(shown),
            all_seconds: shown.iter().map(|s| s.done.then_some(s.seconds)).collect(),
        }
    }
}

impl From<&Cell> for Compared {
    fn from(cell: &Cell) -> Self {
        let [without, with] = cell.shown.each_ref().map(|shown| Side::of(shown));
        Self { task: cell.task, round_trip_s: cell.round_trip_s, without, with, ratio: cell.ratio() }
    }
}

impl Cell {
    /// Ratio of the durations with and without a model, seed by seed, where both succeeded.
    fn ratio(&self) -> Option<Median> {
        let pairs = self.shown[0].iter().zip(&self.shown[1]).filter(|(without, with)| without.done && with.done);
        Median::of(pairs.map(|(without, with)| with.seconds / without.seconds).collect())
    }
}

fn time_s(shown: &[Shown]) -> Option<Median> {
    Median::of(shown.iter().filter(|s| s.done).map(|s| s.seconds).collect())
}

fn peak_n(shown: &[Shown]) -> Option<Median> {
    Median::of(shown.iter().map(|s| s.peak_n).collect())
}

/// Relative errors of the masses, in the initial guess and at the end.
fn offs(cells: &[Cell]) -> Option<[f64; 2]> {
    let all: Vec<[f64; 2]> = cells.iter().flat_map(|cell| &cell.shown[1]).flat_map(|s| s.off.iter().copied()).collect();
    let middle = |which: usize| Median::of(all.iter().map(|off| off[which]).collect()).map(|m| m.middle);
    Some([middle(0)?, middle(1)?])
}

/// True if both blocks are stacked on the other side, at rest.
fn is_stacked(world: &World, _: &State, end: &State) -> bool {
    let (one, two) = (&world.blocks[0], &world.blocks[1]);
    let (lower, upper) = (&end.bodies[0], &end.bodies[1]);
    let way = upper.center_m - lower.center_m;
    lower.center_m.x > 0.0
        && way.x.abs() < 0.3 * one.width_m
        && (way.y - 0.5 * (one.height_m + two.height_m)).abs() < 1e-3
}

/// True after two turns in total: two, one and a quarter, back by one and a half, forward by a quarter.
fn is_turned(_: &World, begun: &State, end: &State) -> bool {
    ((end.crank.angle_rad - begun.crank.angle_rad) / std::f64::consts::TAU - 2.0).abs() < 0.1
}

/// Runs one performance over a link. The time ends when the operator has *seen* the success: a round trip after the
/// last motion.
fn perform(task: &TaskOf, line: &Delay, skill: Skill, seed: u64) -> anyhow::Result<Shown> {
    let world = &task.world;
    let begun = State::resting(world);
    let operator = ScriptedOperator::new(world, &begun, skill, seed).waiting();
    let guess = teleop::guess(world, seed);
    let limits = Limits { max_force_n: MOST_N, ..Limits::default() };
    let ends = Ends { world, state: &begun, guess: Some(&guess), limits, period_s: DT, seed };
    let (device, mut view) = teleop::connect(Box::new(operator), &ends, line)?;
    let mut servo = Loop::new(Swap::at(world.clone(), begun.clone()), device, limits);
    let (mut drops, mut held, mut peak_n) = (0, 0, 0.0_f64);
    let mut learnt = vec![None; world.blocks.len()];
    while !servo.finished() && servo.state().time_s < LONGEST_S {
        let tick = servo.tick(DT);
        peak_n = tick.tip_force_n.iter().fold(peak_n, |most, force| most.max(force.norm()));
        let open = matches!(tick.label, "free-motion" | "no-state");
        drops += usize::from(held >= HELD_TICKS && open);
        held = if tick.label == "hold-above-ground" { held + 1 } else { 0 };
        if let Some(weighed) = view.newest().weighed {
            learnt[weighed.body] = Some(weighed);
        }
    }
    servo.make_safe();
    let off = world.blocks.iter().zip(learnt).filter_map(|(block, weighed)| {
        let weighed = weighed?;
        Some([weighed.guess_kg, weighed.mass_kg].map(|kg| (kg / block.mass_kg - 1.0).abs()))
    });
    let done = servo.finished() && (task.done)(world, &begun, servo.state());
    Ok(Shown { seconds: servo.state().time_s, done, drops, peak_n, off: off.collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bench(seeds: u32) -> DelayBench {
        DelayBench { seeds, round_trips_ms: vec![0.0, 500.0], jitter_ms: 0.0, loss: 0.0, skill: "expert".to_owned() }
    }

    #[test]
    fn a_model_makes_both_tasks_quicker_over_half_a_second_and_not_over_nothing() {
        let output = bench(3).run().expect("a bench");
        let rows = output.json["delay"].as_array().expect("rows");
        assert_eq!(rows.len(), 4);
        for row in rows {
            let late = row["round_trip_s"] == 0.5;
            let ratio = row["ratio"]["middle"].as_f64().expect("both done");
            assert!(if late { ratio < 0.95 } else { (0.9..1.1).contains(&ratio) }, "{row}");
            assert_eq!((row["with"]["done"].as_u64(), row["without"]["done"].as_u64()), (Some(3), Some(3)), "{row}");
        }
        let off = &output.json["mass_off"];
        assert!(off["learnt"].as_f64() < Some(0.03) && off["guess"].as_f64() > off["learnt"].as_f64(), "{off}");
        assert!(output.text.contains("500 ms") && output.text.contains("ratio"), "{}", output.text);
        assert_eq!(bench(3).run().expect("a bench").json, output.json, "the same to the bit");
    }

    #[test]
    fn impossible_lines_and_operators_that_do_not_look_are_refused_in_words() {
        let said = |bench: DelayBench| bench.run().err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said(DelayBench { loss: 2.0, ..bench(1) }).contains("loss"));
        assert!(said(DelayBench { skill: "steady".to_owned(), ..bench(1) }).contains("does not look"));
        assert!(said(DelayBench { skill: "wizard".to_owned(), ..bench(1) }).contains("novice"));
    }
}
