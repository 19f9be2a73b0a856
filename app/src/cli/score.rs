//! `touchstone score`: the score of a task, from its recording.

use super::{LogArgs, Output};
use anyhow::Context as _;
use clap::Args;
use estimator::training::course::Course;
use estimator::training::definitions::{ALL, Definition};
use estimator::training::lesson::advice::shown;
use estimator::training::lesson::{Attempted, Grade, grade};
use estimator::training::{Measures, measure};
use haptics::recording::Recording;
use haptics::world::World;
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `score`.
#[derive(Args)]
pub struct Score {
    /// Recording of a trainee's attempt
    log: PathBuf,
    #[command(flatten)]
    source: LogArgs,
    /// The world that was touched: a file, or a built-in world; the one in the recording when not given
    #[arg(long)]
    world: Option<PathBuf>,
    /// Force of a finger above which a press counts as too hard, N
    #[arg(long, default_value_t = 4.0, value_parser = parse_limit)]
    limit_n: f64,
    /// Say how every measure is computed
    #[arg(long)]
    definitions: bool,
}

/// What `score --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// Name of the world that was touched; null without one.
    world: Option<String>,
    /// Of each recording in the log.
    measures: Vec<Scored>,
    /// How every measure is computed, with `--definitions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    definitions: Option<Vec<Told>>,
}

/// One recording.
#[derive(JsonSchema, Serialize)]
struct Scored {
    /// Its name.
    name: String,
    #[serde(flatten)]
    measures: Measures,
    /// Of an attempt at a lesson whose world is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    grade: Option<Grade>,
}

/// How a measure is computed.
#[derive(Clone, JsonSchema, Serialize)]
struct Told {
    /// Its key in JSON.
    key: &'static str,
    /// Its name.
    name: &'static str,
    /// Its unit; empty without one.
    unit: &'static str,
    /// How it is computed.
    text: &'static str,
    /// Whether less of it is better; null where that depends on the task.
    less_is_better: Option<bool>,
}

impl From<Definition> for Told {
    fn from(d: Definition) -> Self {
        Self { key: d.key, name: d.name, unit: d.unit, text: d.text, less_is_better: d.less_is_better }
    }
}

fn parse_limit(text: &str) -> Result<f64, String> {
    let limit = text.parse().ok().filter(|limit: &f64| *limit > 0.0 && limit.is_finite());
    limit.ok_or_else(|| format!("`{text}` is no force; write a number above 0, in N"))
}

impl Score {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let recordings = self.source.load(&self.log)?;
        let world = self.world()?;
        let (mut text, mut all) = (String::new(), Vec::new());
        for recording in &recordings {
            let measures = super::progress::during("measuring", |_| measure(recording, world.as_ref(), self.limit_n))?;
            let _ = writeln!(text, "{}", recording.name);
            describe(&measures, &mut text);
            let mut scored = Scored { name: recording.name.clone(), measures, grade: None };
            if let (Some(attempted), Some(world)) = (Attempted::of(recording)?, &world) {
                let grade = grade_of(&attempted, world, recording)?;
                describe_grade(&grade, &mut text);
                scored.grade = Some(grade);
            }
            all.push(scored);
        }
        if world.is_none() {
            text.push_str("No world is in the recording; name it with --world to have what became of its objects.\n");
        }
        if self.definitions {
            for definition in ALL {
                let _ = writeln!(text, "{} ({}): {}", definition.name, definition.key, definition.text);
            }
        }
        let definitions = self.definitions.then(|| ALL.map(Told::from).to_vec());
        let said = Said { world: world.map(|w| w.name), measures: all, definitions };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }

    fn world(&self) -> anyhow::Result<Option<World>> {
        if let Some(named) = &self.world {
            return crate::worlds::find(named).map(Some);
        }
        let Some(bytes) = estimator::log::attached(&self.log, "world.json")? else { return Ok(None) };
        let text = String::from_utf8(bytes).context("the world in the recording is no text")?;
        let world = World::from_json(&text).with_context(|| {
            format!("the world in the recording cannot be used; name one with --world: {}", self.log.display())
        })?;
        Ok(Some(world))
    }
}

/// Grade of an attempt by the lesson embedded in its recording, or by the lesson of that name.
fn grade_of(attempted: &Attempted, world: &World, recording: &Recording) -> anyhow::Result<Grade> {
    let lesson = match &attempted.definition {
        Some(lesson) => (**lesson).clone(),
        None => crate::lessons::find(&attempted.id)?,
    };
    Ok(grade(&lesson, attempted, world, recording)?)
}

fn describe_grade(grade: &Grade, text: &mut String) {
    let score = grade.score.map_or("not completed".to_owned(), |score| format!("{score:.0} of 100"));
    let lesson = format!("lesson {}", grade.lesson);
    let _ = writeln!(text, "  {lesson:<34} {score}, proficient from {:.0} on", grade.score_criterion);
    for figure in &grade.figures {
        let Some(definition) = Definition::of(&figure.measure) else { continue };
        let (value, mean) = (shown(figure.value, definition.unit), shown(figure.expert_mean, definition.unit));
        let _ = writeln!(text, "    {:<32} {value}, experts {mean}", definition.name);
    }
    let _ = writeln!(text, "  {}", grade.advice);
}

fn describe(measures: &Measures, text: &mut String) {
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<34} {value}");
    };
    let hand = &measures.hand;
    line("time", format!("{:.1} s, {:.1} s of it in motion", hand.duration_s, hand.moving_s));
    let paths: Vec<String> = hand.path_length_m.iter().map(|way| format!("{:.0} mm", 1e3 * way)).collect();
    line("path of each finger", paths.join(", "));
    let [wide, high] = hand.range_m;
    line("room used", format!("{:.0} mm wide, {:.0} mm high", 1e3 * wide, 1e3 * high));
    if let (Some(peak), Some(over_s)) = (hand.peak_force_n, hand.over_limit_s) {
        let usual = hand.rms_force_n.map_or_else(String::new, |n| format!(", usually {n:.2} N"));
        line("force", format!("{peak:.2} N at the most{usual}, {over_s:.2} s above {} N", hand.limit_n));
    }
    if let (Some(sparc), Some(jerk)) = (hand.sparc, hand.log_dimensionless_jerk) {
        line("smoothness", format!("spectral arc length {sparc:.2}, log dimensionless jerk {jerk:.2}"));
    }
    if let Some(course) = &measures.course {
        describe_course(course, &mut line);
    }
}

fn describe_course(course: &Course, line: &mut dyn FnMut(&str, String)) {
    if let Some(blocks) = &course.blocks {
        let counts = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
        let grasps: usize = blocks.grasps.iter().sum();
        let (drops, slips) = (counts(blocks.drops.len(), "drop"), counts(blocks.slips.len(), "slip"));
        line("blocks", format!("{}, {drops}, {slips}", counts(grasps, "grasp")));
        for stack in &blocks.stacks {
            let what = format!("block {} on block {}", stack.upper + 1, stack.lower + 1);
            let tilt_deg = stack.tilt_rad.to_degrees();
            line(&what, format!("{:+.1} mm beside its middle, tilted by {tilt_deg:+.1}°", 1e3 * stack.offset_m));
        }
        for (k, (carried, needed)) in blocks.carried_m.iter().zip(&blocks.displaced_m).enumerate() {
            if *carried > 0.0 {
                line(
                    &format!("block {} carried", k + 1),
                    format!("{:.0} mm for {:.0} mm", 1e3 * carried, 1e3 * needed),
                );
            }
        }
        let done = blocks.at_rest_since_s.map_or("not at rest at the end".to_owned(), |t| format!("after {t:.1} s"));
        line("done", done);
    }
    if let Some(crank) = &course.crank {
        line("crank", format!("{:.2} turns, {} times turned back", crank.turns, crank.reversals));
        let even = 100.0 * crank.speed_variation;
        line("speed", format!("{:.2} rad/s on the average, ± {even:.0} %", crank.mean_speed_rad_s));
        line("effort off the tangent", format!("{:.3} J", crank.off_tangent_j));
    }
    if let Some(needle) = &course.needle {
        for puncture in &needle.punctures {
            let (beyond, beside) = (1e3 * puncture.overshoot_m, 1e3 * puncture.along_m);
            let when = format!("pierced after {:.1} s", puncture.time_s);
            line(
                &when,
                format!("{beyond:.1} mm too far, {beside:+.1} mm from the middle, at {:.2} N", puncture.force_n),
            );
        }
    }
}
