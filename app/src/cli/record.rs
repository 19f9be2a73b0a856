//! `touchstone record`: a recording made by the virtual hand.

use super::{ControlArgs, Output, find_task};
use crate::operator;
use crate::tasks::Chosen;
use anyhow::Context;
use clap::{Args, ValueEnum};
use haptics::device::{Device, Mistake, ReplayDevice, ScriptedOperator};
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap, TickRecord};
use haptics::world::{State, World, presets};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Arguments of `record`.
#[derive(Args)]
pub struct Record {
    /// What is done: block-stack, crank, needle, barrel, switch, mechanism, or a task of yours that is like one of them (it goes
    /// into the sidecar)
    #[arg(long, value_parser = find_task)]
    task: Chosen,
    /// Who does it: `scripted`, `mouse`, or `replay:LOG`
    #[arg(long, default_value = "scripted")]
    operator: String,
    /// Length; a scripted operator stops when it is done if this is not given
    #[arg(long)]
    seconds: Option<f64>,
    /// Where to write the recording (CSV, with a sidecar beside it)
    #[arg(long)]
    out: PathBuf,
    /// How well the scripted operator does it: steady, novice, intermediate, advanced or expert
    #[arg(long)]
    skill: Option<String>,
    /// What the scripted operator does wrong on purpose, once: weak-pinch, crush, misaligned-stack, early-release,
    /// wrong-direction or overshoot; may be given several times
    #[arg(long)]
    mistake: Vec<String>,
    /// World to act in: a file, or stack, crank, needle, barrel, switch, guide or table; the task's own when not given
    #[arg(long)]
    world: Option<PathBuf>,
    /// Ticks a second, all of them recorded
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// Write every n-th tick only (the servo's rate stays)
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Draws the operator's habits and the sensors' noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How the virtual sensors see it
    #[arg(long, default_value = "typical")]
    sensors: Sensors,
    #[command(flatten)]
    control: ControlArgs,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sensors {
    /// Noise and resolution of good encoders and strain gauges
    Typical,
    /// No error at all
    Ideal,
}

/// Maximum length of a recording, s: an hour at 1 kHz is half a gigabyte of ticks.
pub(super) const LONGEST_S: f64 = 3600.0;

/// What `record --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The recording.
    out: PathBuf,
    /// Its sidecar.
    meta: PathBuf,
    /// Its samples.
    samples: usize,
    /// Its length, s.
    seconds: f64,
}

impl Record {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        anyhow::ensure!(
            (50.0..=8000.0).contains(&self.rate),
            "a rate of {} Hz is not possible; choose 50 to 8000",
            self.rate
        );
        if let Some(seconds) = self.seconds {
            anyhow::ensure!(
                seconds > 0.0 && seconds <= LONGEST_S,
                "{seconds} s cannot be recorded; choose up to {LONGEST_S} s"
            );
        }
        let world = self.world()?;
        let recording = self.perform(&world)?;
        estimator::log::write_csv(&recording, &self.out)?;
        let sidecar = estimator::log::write_meta(&recording, &self.out)?;
        let seconds = recording.duration_s().unwrap_or(0.0);
        let text =
            format!("{}: {} samples, {seconds:.2} s\n{}", self.out.display(), recording.len(), sidecar.display());
        let said = Said { out: self.out.clone(), meta: sidecar, samples: recording.len(), seconds };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }

    fn world(&self) -> anyhow::Result<World> {
        if let Some(name) = &self.world {
            let world = crate::worlds::find(name)?;
            if let Some(what) = crate::worlds::lacks(&world, self.task.like()) {
                anyhow::bail!(
                    "the world {} has no {what}, so the task {} cannot be done in it; name another world or task",
                    name.display(),
                    self.task.name()
                );
            }
            return Ok(world);
        }
        match self.task.like() {
            Task::BlockStack => Ok(presets::stacking()),
            Task::Crank => Ok(presets::crank()),
            Task::Needle => Ok(presets::needle()),
            Task::Barrel => Ok(presets::barrel()),
            Task::Switch => Ok(presets::switch()),
            Task::Mechanism => {
                anyhow::bail!("there is no built-in world for a mechanism; name one with --world")
            }
            Task::Payload => {
                anyhow::bail!("the load of a sensor is measured with a sensor: there is no world to record it in")
            }
        }
    }

    /// Scripted operator with the requested skill and mistake.
    fn scripted(&self, world: &World, state: &State) -> anyhow::Result<ScriptedOperator> {
        let skill = operator::skill(self.skill.as_deref().unwrap_or(operator::USUAL)).map_err(anyhow::Error::msg)?;
        let mistakes = self.mistakes()?;
        operator::check_mistakes(&mistakes, world).map_err(anyhow::Error::msg)?;
        Ok(ScriptedOperator::with_mistakes(world, state, skill, &mistakes, self.seed))
    }

    fn mistakes(&self) -> anyhow::Result<Vec<Mistake>> {
        self.mistake.iter().map(|name| operator::mistake(name).map_err(anyhow::Error::msg)).collect()
    }

    /// Description of the operator for the sidecar; `None` for the steady operator without mistakes.
    fn about_the_operator(&self) -> Option<serde_json::Value> {
        let skill = self.skill.as_deref().filter(|name| *name != operator::USUAL);
        (skill.is_some() || !self.mistake.is_empty())
            .then(|| json!({ "skill": skill.unwrap_or(operator::USUAL), "mistakes": self.mistake }))
    }

    fn perform(&self, world: &World) -> anyhow::Result<Recording> {
        let mut state = State::resting(world);
        let device: Box<dyn Device> = match self.operator.split_once(':') {
            None if self.operator == "scripted" => Box::new(self.scripted(world, &state)?),
            _ if self.skill.is_some() || !self.mistake.is_empty() => {
                anyhow::bail!("--skill and --mistake are for the scripted operator; leave them out with another one")
            }
            Some(("replay", log)) => {
                let (device, start) = replay(Path::new(log))?;
                state = State::new(world, start);
                Box::new(device)
            }
            None if self.operator == "mouse" => {
                anyhow::bail!("recording by mouse needs the window: run touchstone, open the trainer and press Record")
            }
            _ => anyhow::bail!("there is no operator `{}`; use scripted, mouse or replay:LOG", self.operator),
        };
        let ticks = self.run_servo(world.clone(), state, device);
        let sensor = if self.sensors == Sensors::Ideal { SensorModel::IDEAL } else { SensorModel::TYPICAL };
        let name = self.out.file_stem().map_or("recording".into(), |s| s.to_string_lossy().into_owned());
        let mut recording = to_recording(&name, world, &ticks, self.every as usize, &sensor, self.seed);
        self.task.give_to(&mut recording);
        if let Some(about) = self.about_the_operator() {
            recording.meta.other.insert("operator".to_owned(), about);
        }
        Ok(recording)
    }

    /// Runs the servo's tick in simulated time until the operator is done or the time limit is reached.
    fn run_servo(&self, world: World, state: State, device: Box<dyn Device>) -> Vec<TickRecord> {
        let limits = Limits { max_force_n: device.spec().max_force_n, ..Limits::default() };
        let mut servo =
            Loop::new(Swap::at(world, state), device, limits).with_passivity_control(self.control.passivity_control);
        let most = (self.seconds.unwrap_or(LONGEST_S) * self.rate).round() as usize;
        let mut ticks = Vec::new();
        while ticks.len() < most && (self.seconds.is_some() || !servo.finished()) {
            ticks.push(servo.tick(1.0 / self.rate));
        }
        servo.make_safe();
        ticks
    }
}

fn replay(log: &Path) -> anyhow::Result<(ReplayDevice, [haptics::Vec2; 2])> {
    let recordings = super::read(log, None, &estimator::log::Part::default())?;
    let recording = recordings.first().context("the log holds no recording")?;
    let device = ReplayDevice::from_recording(recording)?;
    let start = device.start_in_world();
    Ok((device, start))
}
