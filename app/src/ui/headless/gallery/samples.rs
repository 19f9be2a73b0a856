//! Recordings for the pictures: those bundled with the program, and performances of the scripted operator.

use crate::built_in::built_in;
use crate::experiment::perform;
use crate::experiment::simulated;
use crate::experiment::timetable;
use crate::ui::headless::gallery::filmed::filmed;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::picture_input::PictureInput;
use crate::ui::headless::stage;
use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use crate::video::reading::VideoSource;
use crate::worlds;
use anyhow::{Context as _, anyhow};
use estimator::diagnose::{Experiment, SensorFault};
use haptics::Vec2;
use haptics::law::{EccentricMass, Effect};
use haptics::recording::{Channel, Recording};
use haptics::servo::recorder::SensorModel;
use haptics::world::{Content, World, presets};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Maximum length of a performance, s of simulated time: a script that does not end is cut off.
const LONGEST_S: f64 = 120.0;

/// Cache of generated recordings.
#[derive(Default)]
pub struct Samples {
    known: BTreeMap<Sample, Vec<Recording>>,
    folder: Option<TempDir>,
}

impl Samples {
    /// Recordings of a sample; foreign tables and live worlds have none.
    pub fn recordings(&mut self, sample: Sample) -> anyhow::Result<Vec<Recording>> {
        if let Some(known) = self.known.get(&sample) {
            return Ok(known.clone());
        }
        let made = match sample {
            Sample::Stack => built_in("stack", self.folder()?)?,
            Sample::Crank => built_in("crank", self.folder()?)?,
            Sample::Needle => performed("needle", self.folder()?)?,
            Sample::Door => vec![door()],
            Sample::Rail => vec![one_coordinate("cart", ("q_m", "m", 0.12), ("f_N", "N", [2.0, 5.0, 0.8]))],
            Sample::Askew => vec![askew()?],
            Sample::Leaking => vec![leaking()?],
            Sample::Hinge => vec![hinge().0],
            Sample::Foreign | Sample::World(_) => Vec::new(),
        };
        self.known.insert(sample, made.clone());
        Ok(made)
    }

    /// File with uninformative column names: a cart pushed back and forth, as another program writes it.
    pub fn foreign(&mut self) -> anyhow::Result<PathBuf> {
        let path = self.folder()?.join("bench-7.csv");
        let mut text = String::from("Time [ms],Position (mm),Load cell / N,Temp\n");
        for i in 0..2_000_u32 {
            let t = 0.004 * f64::from(i);
            let place = 100.0 * (1.3 * t).sin() + 40.0 * (3.1 * t).sin();
            let force = 0.6 * (1.3 * t).cos() - 0.9 * (3.1 * t).sin();
            let _ = writeln!(text, "{},{place:.3},{force:.4},{:.1}", 4 * i, 21.0 + 0.1 * t);
        }
        std::fs::write(&path, text)?;
        Ok(path)
    }

    /// Film of the virtual hand in the middle of a recording, from a camera beside it.
    pub fn film(&mut self, input: &PictureInput) -> anyhow::Result<VideoSource> {
        let file = self.folder()?.join("hand.mp4");
        filmed(&mut stage::fitted(input)?, &file)
    }

    fn folder(&mut self) -> anyhow::Result<&Path> {
        if self.folder.is_none() {
            self.folder = Some(tempfile::tempdir().context("there is no room for temporary files")?);
        }
        self.folder.as_ref().map(TempDir::path).context("there is no room for temporary files")
    }
}

/// Built-in crank with an eccentric mass.
pub fn askew_world() -> World {
    let mut world = presets::crank();
    if let Some(crank) = &mut world.crank {
        crank.effects.push(Effect::new(&EccentricMass, &[0.05, 0.0, crank.radius_m]));
    }
    world
}

/// Recording of the scripted operator with that crank.
pub fn askew() -> anyhow::Result<Recording> {
    let asked = Experiment {
        id: "long-mixed".to_owned(),
        seconds: 16.0,
        free_s: 1.5,
        middle: -std::f64::consts::FRAC_PI_2,
        half_range: 4.0,
        fast: 5.0,
        across_n: 0.5,
        added_weight_n: 0.0,
        added_lever_m: 0.0,
    };
    done_with(&askew_world(), &asked, "askew")
}

/// Built-in blocks, of which the first leaks.
pub fn leaking_world() -> World {
    let mut world = presets::stacking();
    if let Some(block) = world.blocks.first_mut() {
        block.content = Some(Content { mass_kg: 0.6 * block.mass_kg, leak_kg_s: 0.5e-3, leaks_from_s: Some(0.0) });
    }
    world
}

/// Recording in which the scripted operator lifts that block and keeps holding it: a drifting sensor would record the
/// same.
pub fn leaking() -> anyhow::Result<Recording> {
    let asked = Experiment {
        id: "carry-still".to_owned(),
        seconds: 6.0,
        free_s: 0.0,
        middle: 0.0,
        half_range: 0.012,
        fast: 0.06,
        across_n: 1.8,
        added_weight_n: 0.0,
        added_lever_m: 0.0,
    };
    done_with(&leaking_world(), &asked, "leaking")
}

/// Recording of a directly driven hinge, and the object for another motion of it.
pub fn hinge() -> (Recording, blind::case::Object) {
    let effects = vec![(blind::Effect::Eccentric, 0)];
    let spec = blind::Spec { rate_hz: 250.0, ..blind::Spec::hiding(effects, 2.0, blind::Bench::Angular) };
    let (mut case, _, object) = blind::case::make_with_object(&spec, &[], 4);
    let mut recording = case.recordings.pop().unwrap_or_default();
    "hinge".clone_into(&mut recording.name);
    (recording, object)
}

/// Recording of an experiment on a world that represents the real object.
pub fn done_with(world: &World, asked: &Experiment, name: &str) -> anyhow::Result<Recording> {
    let table = timetable::Timetable::new(world, asked, "move about").map_err(|problem| anyhow!(problem))?;
    let sensing = (&SensorFault::default(), SensorModel::TYPICAL.force_noise_n);
    let mut recording = perform::perform(&table, asked, name, sensing, 5, &|_| true).context("nobody ended it")?;
    // Here the world represents the real object.
    recording.meta.other.remove(simulated::SIMULATED);
    name.clone_into(&mut recording.name);
    Ok(recording)
}

/// Recording of a handle 30 cm from its hinge. A tool moves it through a sixth of a turn and also pulls, with the noise
/// of a tracker and of a force sensor.
fn door() -> Recording {
    const RADIUS_M: f64 = 0.30;
    // A Lehmer generator (1951): the same picture on every machine.
    let mut seed = 7_u64;
    let mut noise = move || {
        let mut draw = || {
            seed = seed * 48_271 % 0x7FFF_FFFF;
            seed as f64 / f64::from(0x7FFF_FFFF_u32)
        };
        // Approximately normal, of variance 1.
        (0..12).map(|_| draw()).sum::<f64>() - 6.0
    };
    let n = 600_u32;
    let mut channels = ["x_m", "y_m", "fx_N", "fy_N"].map(|name| Channel {
        name: name.to_owned(),
        unit: name.rsplit('_').next().unwrap_or_default().to_owned(),
        values: Vec::with_capacity(n as usize),
    });
    for i in 0..n {
        let share = f64::from(i) / f64::from(n - 1);
        let angle = 2.1 + 1.05 * share * share * (3.0 - 2.0 * share);
        let (out, along) = (Vec2::new(angle.cos(), angle.sin()), Vec2::new(-angle.sin(), angle.cos()));
        let force = (4.0 + 3.0 * (7.0 * share).sin()) * out + 1.5 * along;
        let values = [RADIUS_M * out.x, RADIUS_M * out.y, force.x, force.y];
        for ((channel, value), size) in channels.iter_mut().zip(values).zip([6e-4, 6e-4, 0.15, 0.15]) {
            channel.values.push(value + size * noise());
        }
    }
    let time_s = Some((0..n).map(|i| 0.01 * f64::from(i)).collect());
    Recording { name: "door".to_owned(), channels: channels.into(), time_s, ..Recording::default() }
}

/// Ten seconds of an object with inertia, viscous and Coulomb friction, pushed back and forth.
fn one_coordinate(
    name: &str,
    (coordinate, unit, reach): (&str, &str, f64),
    (effort, effort_unit, [inertia, viscous, coulomb]): (&str, &str, [f64; 3]),
) -> Recording {
    let time: Vec<f64> = (0..2_000).map(|i| f64::from(i) * 5e-3).collect();
    let motion = |t: f64| reach * ((1.3 * t).sin() + 0.4 * (3.1 * t).sin());
    let rate = |t: f64| reach * (1.3 * (1.3 * t).cos() + 1.24 * (3.1 * t).cos());
    let change = |t: f64| -reach * (1.69 * (1.3 * t).sin() + 3.844 * (3.1 * t).sin());
    let needed = |t: f64| inertia * change(t) + viscous * rate(t) + coulomb * rate(t).signum();
    let channel = |name: &str, unit: &str, values: Vec<f64>| Channel { name: name.into(), unit: unit.into(), values };
    Recording {
        name: name.to_owned(),
        channels: vec![
            channel(coordinate, unit, time.iter().map(|t| motion(*t)).collect()),
            channel(effort, effort_unit, time.iter().map(|t| needed(*t)).collect()),
        ],
        time_s: Some(time),
        ..Recording::default()
    }
}

/// The scripted operator's recording in a built-in world.
fn performed(world: &str, folder: &Path) -> anyhow::Result<Vec<Recording>> {
    let mut trainer = Trainer::default();
    (trainer.clock, trainer.operator) = (Clock::Manual, Operator::Scripted);
    (trainer.file, trainer.choice) = (Some(worlds::find(Path::new(world))?), WorldChoice::File);
    trainer.recordings_folder = Some(folder.to_path_buf());
    trainer.ensure_running().map_err(|problem| anyhow!(problem))?;
    trainer.start_recording().map_err(|problem| anyhow!(problem))?;
    let mut left_s = LONGEST_S;
    while !trainer.performance_over() && left_s > 0.0 {
        trainer.advance(1.0);
        left_s -= 1.0;
    }
    let stopping = trainer.stop_recording().context("the performance was not recorded")?;
    let finished = stopping.wait().map_err(|problem| anyhow!(problem))?;
    Ok(estimator::log::load(&finished.path, None)?)
}
