//! What the simulation gets wrong, the cause, and what mending it gains.
//!
//! Measured motion is put through the model; what remains of the force is compared with what every known cause would leave there.
//! Method: named hypotheses, effective-variance weights, whitening, forward selection with swaps, a locked test part.

mod along;
mod answer;
pub mod atlas;
mod bearing;
mod blocks;
mod blur;
mod candidate;
mod columns;
mod compare;
pub mod course;
mod courses;
mod dictionary;
mod driven;
mod experiment;
mod explain;
mod extend;
mod extra;
mod fine;
mod force;
mod free;
mod gain;
mod generic;
mod geometry;
mod grid;
mod held_arm;
mod hung;
mod impact;
mod kept;
mod late;
mod needle;
mod passed_over;
mod pinched;
mod products;
mod progress;
mod pulled;
mod quality;
pub mod report;
mod residuals;
mod rests;
mod rollout;
mod searched;
mod select;
mod several;
mod signs;
mod slide;
mod sliding;
mod starts;
mod strange_path;
mod stuck;
mod suspects;
mod switch;
mod system;
mod track;
mod validate;
mod white;
mod world;

pub use report::{
    Alternative, Baseline, Cause, CauseParameter, Diagnosis, Experiment, Final, Gain, NextExperiment, NotExcited,
    PassedOver, Rollout, RolloutOf, Settled, Validation, Verdict,
};
pub use residuals::Residual;

pub use course::Course;
pub use experiment::{Insertions, Stroke, Strokes, Throw, Throws};
pub use progress::Progress;
pub use suspects::{SensorFault, Suspect, suspects};
pub use world::{Worlds, extended_world, worlds};

use crate::estimate::EstimateError;
use crate::log::NO_CLOCK;
use crate::pipeline;
use crate::segment::task_of;
use force::Model;
use haptics::law::{Coordinate, CoulombFriction, Effect, Inertia, Law, LoadFriction, ViscousFriction, Weight};
use haptics::recording::{Recording, Task};
use haptics::world::World;
use held_arm::Axes;

/// What may be stated by the user.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The task; told from sidecar and columns when absent.
    pub task: Option<Task>,
    /// The model of a mechanism to start from: `mass`, `mass+viscous` or `mass+viscous+coulomb`.
    pub baseline: Option<String>,
    /// The world to start from.
    pub world: Option<World>,
    /// How far it is, and the wish to end it.
    pub progress: Progress,
    /// Whether [`Diagnosis::atlas`] is wanted: what every suspect alone would take of the force.
    pub atlas: bool,
}

/// Least score of a cause, in units of 2 ln(likelihood): keeps false alarms below 1 in 200 (`facts/diagnosis.md`, 3) …
const THRESHOLD: f64 = 20.0;
/// … and for few rows a second, where the noise hides less well.
const THRESHOLD_SLOW: f64 = 25.0;
/// Slower rows than this count as slow, s.
const SLOW_PERIOD_S: f64 = 0.019;

/// Diagnoses one or several recordings of the same object.
pub fn diagnose(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let first = recordings
        .first()
        .ok_or_else(|| EstimateError::Other("no recording was given; name at least one log".to_owned()))?;
    let task = task_of(first, options.task)?;
    let mut found = of_task(task, recordings, options)?;
    several::settle(recordings, &mut found, &|some| of_task(task, some, options));
    let clockless = recordings.iter().flat_map(|r| r.warnings.iter().filter(|w| w.kind == NO_CLOCK));
    found.warnings.extend(clockless.map(|w| w.text.clone()));
    found.warnings.dedup();
    Ok(found.named_by_unit())
}

fn of_task(task: Task, recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    match task {
        Task::Crank => {
            let ask = |recordings: &[Recording]| crank(recordings, options);
            Ok(late::undo(recordings, crank(recordings, options)?, &ask))
        }
        Task::Mechanism => one_of_mechanisms(recordings, options),
        _ => pinched(task, recordings, options),
    }
}

/// What is held between two fingers, with mirrored axes put right.
fn pinched(task: Task, recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let looked_at: Vec<_> = recordings.iter().map(pinched::upright).collect();
    // Nothing is copied where nothing is mirrored, which is nearly always.
    let upright: Vec<Recording> = if looked_at.iter().any(Option::is_some) {
        let pairs = looked_at.iter().zip(recordings);
        pairs.map(|(other, recording)| other.as_ref().map_or(recording, |(other, _)| other).clone()).collect()
    } else {
        Vec::new()
    };
    let recordings = if upright.is_empty() { recordings } else { &upright };
    let mut faults: Vec<Cause> = looked_at.into_iter().flatten().map(|(_, fault)| fault).collect();
    // The same axis in several recordings is one fault.
    let which = |fault: &Cause| fault.parameters.first().map(|p| p.name.clone());
    faults.dedup_by(|a, b| which(a) == which(b));
    let mut found = match task {
        Task::BlockStack | Task::Barrel if slide::is_slid(recordings) => slide::slid(recordings, options),
        // A barrel is a block that is carried.
        Task::BlockStack | Task::Barrel => blocks::blocks(recordings, options),
        Task::Needle => needle::needle(recordings, options),
        _ => switch::switch(recordings, options),
    }?;
    if !faults.is_empty() && found.verdict == Verdict::None {
        found.verdict = Verdict::Causes;
    }
    found.causes.splice(0..0, faults);
    Ok(found)
}

/// Bodies that are thrown, paths without a clock, transmissions, and what moves along one coordinate.
fn one_of_mechanisms(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    if let Some(chain) = recordings.iter().find(|r| crate::identify::mechanism::is_chain(r)) {
        return Err(EstimateError::Other(format!(
            "{} is of a chain of two joints, which cannot be diagnosed yet; `touchstone fit` tells its inertias, moments and frictions",
            chain.name
        )));
    }
    if let Some(thrown) = impact::impact(recordings, options) {
        return thrown;
    }
    if pulled::is_pulled(recordings) {
        return pulled::pulled(recordings, options);
    }
    if driven::is_driven(recordings) {
        return driven::driven(recordings, options);
    }
    let ask = |recordings: &[Recording]| mechanism(recordings, options);
    Ok(late::undo(recordings, mechanism(recordings, options)?, &ask))
}

/// What was found, on other recordings of the same object: nothing is chosen there, and no cause is fitted. Faults of the sensors that
/// were found in the first recordings are taken out of these as well; the path of a crank, and mirrored axes, are looked at in each.
pub fn validate(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Diagnosis,
) -> Result<Vec<Validation>, EstimateError> {
    let of = |recording: &Recording| {
        let task = task_of(recording, options.task)?;
        // Cranks and mechanisms have laws of their own for their signs.
        let upright = if matches!(task, Task::Crank | Task::Mechanism) { None } else { pinched::upright(recording) };
        let recording = upright.as_ref().map_or(recording, |(other, _)| other);
        let one = std::slice::from_ref(recording);
        let channels = match task {
            Task::Crank => return along_a_crank(recording, diagnosis),
            Task::Mechanism => {
                let recording = &late::motion_apart(&late::put_back(recording, diagnosis.late_s), diagnosis.skew_s);
                let along = diagnosis.along.ok_or_else(|| along::none(recording))?;
                let path = along.path_of(recording)?;
                let mut track = track_of(recording, path.as_ref(), diagnosis)?;
                along.demand(track.coordinate, recording)?;
                let Diagnosis { plain, effects, kept, .. } = diagnosis;
                return Ok(validate::validate(&mut track, plain, effects, &[], kept));
            }
            Task::BlockStack | Task::Barrel if slide::is_slid(one) => return slide::validate(one, options, diagnosis),
            Task::BlockStack | Task::Barrel => blocks::channels(one, options)?,
            Task::Needle => needle::channels(one, options)?,
            Task::Switch => switch::channels(one, options)?,
        };
        let order: Vec<&str> = diagnosis.causes.iter().map(|c| c.id.as_str()).collect();
        kept::measure(&diagnosis.kept, &order, &channels)
    };
    recordings.iter().map(of).collect()
}

/// Rows of a recording on which a mechanism's answer is measured, driven or free.
fn track_of(
    recording: &Recording,
    path: Option<&haptics::world::MechanismPath>,
    diagnosis: &Diagnosis,
) -> Result<track::Track, EstimateError> {
    let bad = quality::faults(recording).bad;
    if crate::identify::mechanism::raw(recording, path)?.force.is_some() {
        if diagnosis.per_inertia {
            return Err(EstimateError::Other(format!(
                "{} has a force column, and what was diagnosed is known per unit of inertia only: state the inertia, or what tells it, \
                 under \"known\" in the sidecar",
                recording.name
            )));
        }
        return sliding::track(recording, &bad, path);
    }
    free::track(recording, &bad, path)
}

fn along_a_crank(recording: &Recording, diagnosis: &Diagnosis) -> Result<Validation, EstimateError> {
    let recording = &late::put_back(recording, diagnosis.late_s);
    let signs::Looked { signals, circle, rows, .. } = signs::Looked::at(recording, &quality::faults(recording).bad)?;
    let mut track = turned(&signals, recording, &circle, rows)?.rows;
    // A weight that is stated is no part of what was fitted, and acts all the same.
    let known = known_weight(recording, &mut diagnosis.plain.clone());
    let with_known = |effects: &[Effect]| -> Model {
        let weighs = effects.iter().any(|e| e.law().id() == Weight.id());
        effects.iter().chain(known.iter().filter(|_| !weighs)).copied().collect()
    };
    let (before, after) = (with_known(&diagnosis.plain), with_known(&diagnosis.effects));
    Ok(validate::validate(&mut track, &before, &after, &known, &diagnosis.kept))
}

fn threshold(period_s: f64) -> f64 {
    if period_s > SLOW_PERIOD_S { THRESHOLD_SLOW } else { THRESHOLD }
}

fn crank(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let mut tracks = Vec::new();
    let (mut geometries, mut strange, mut short) = (Vec::new(), Vec::new(), Vec::new());
    let mut faults = Vec::new();
    let mut swapped = Vec::new();
    let mut link = None;
    let mut scale = None;
    for (k, recording) in recordings.iter().enumerate() {
        options.progress.tell(0.4 * k as f64 / recordings.len() as f64)?;
        let found = quality::faults(recording);
        let (upright, mirrored, looked) = signs::of_crank(recording, &found.bad)?;
        let recording = &upright;
        let signs::Looked { signals, circle, rows, axis } = looked;
        faults.extend(mirrored);
        faults.extend(found.causes);
        faults.extend(axis);
        let Turned { mut rows, other, link: of_this } = turned(&signals, recording, &circle, rows)?;
        rows.extra = vec![extra::of(recording)];
        link = link.or(of_this);
        // The same recording with the other link's angle wrong.
        swapped.push(other.map(|other| track::Track { extra: rows.extra.clone(), ..other }));
        let known_m = recording.meta.known.get("radius_m").copied().filter(|r| r.is_finite() && *r > 0.0);
        if scale.is_none() {
            scale = known_m.and_then(|r| quality::scaled("radius", circle.too_large(r)?));
        }
        tracks.push(rows);
        let path = signals.path(recording);
        strange.extend(strange_path::unexplained(&path, &circle.arm, &circle.study));
        short.extend(strange_path::short_arc(&path, &circle.arm, &circle.study));
        geometries.push(circle.study);
    }
    let other = swapped.iter().any(Option::is_some).then(|| {
        let either = swapped.iter().zip(&tracks).map(|(other, rows)| other.as_ref().unwrap_or(rows).clone());
        track::join(either.collect())
    });
    let mut track = track::join(tracks).ok_or_else(nothing)?;
    let mut model: Model = match &options.world {
        Some(world) => world.crank.as_ref().map(|c| c.effects.clone()).unwrap_or_default(),
        None => plain_crank(),
    };
    let fixed = known_weight(&recordings[0], &mut model);
    let limit = threshold(track.period_s);
    options.progress.tell(0.4)?;
    let look = |track: &mut track::Track| -> Result<_, EstimateError> {
        Ok((bearing::load(track, &model, &fixed)?, force::study(track, &model, &fixed, limit)?))
    };
    let (mut bearing_n, mut study) = look(&mut track)?;
    // Whose angle is wrong was asked of the plain model, which something hidden may have kept from telling.
    if let Some(mut other) = other.flatten().filter(|_| is_turned(&study)) {
        let (other_n, again) = look(&mut other)?;
        if !is_turned(&again) {
            let swapped = if link == Some(Link::First) { Link::Second } else { Link::First };
            (track, bearing_n, study, link) = (other, other_n, again, Some(swapped));
        }
    }
    options.progress.tell(0.8)?;
    let mut found = explain::explain(&track, &model, &study, &geometries, faults);
    found.warnings.extend(bearing_n.map(|weight_n| {
        format!("friction goes with the load on the bearing, {weight_n:.3} N of the handle's weight included, not with the fingers' pull alone")
    }));
    explain::add_of_path(&mut found, &strange);
    found.warnings.extend(short);
    if options.atlas {
        found.atlas = atlas::atlas(&track, &study, limit);
    }
    found.guess_s = late::guess_s(&track, &model);
    name_joint(&mut found, link);
    if let Some(cause) = scale.filter(|scale: &Cause| found.causes.iter().all(|c| c.id != scale.id)) {
        found.causes.insert(0, cause);
        if found.verdict == Verdict::None {
            found.verdict = Verdict::Causes;
        }
    }
    let is_known = |name: &str| recordings.iter().any(|r| r.meta.known.contains_key(name));
    explain::without_known(&mut found, !fixed.is_empty() || is_known("added_weight_N"), is_known("radius_m"));
    Ok(found)
}

/// How much more likely the force must be when the first link's angle is wrong, not the second's (2 ln likelihood).
const TURNED: f64 = 10.0;

/// Rows of a crank whose path shows that an angle of the finger is wrong.
struct Turned {
    /// With that link's angle put right which is the likelier one.
    rows: track::Track,
    /// With the other one's; nothing where no angle is wrong.
    other: Option<track::Track>,
    /// Which is the likelier one; none where the forces do not tell.
    link: Option<Link>,
}

/// A link of a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Link {
    First,
    Second,
}

/// An offset of the first link's angle bends the path as the opposite offset of the second one does, and turns all of it: the circle is
/// the same, the force then has another direction beside it.
fn turned(
    signals: &held_arm::Signals,
    recording: &Recording,
    circle: &geometry::Geometry,
    rows: track::Track,
) -> Result<Turned, EstimateError> {
    let study = &circle.study;
    let mut at = study.base.len();
    let mut offset = None;
    for chosen in &study.chosen {
        let candidate = &study.candidates[chosen.candidate];
        if candidate.id == "joint-offset" {
            offset = study.solved.as_ref().map(|s| s.values[at]);
        }
        at += candidate.columns.len();
    }
    // With two fingers it is one of two arms: the handle's own is not turned.
    let Some(turn_rad) = offset.filter(|_| !signals.two_fingered) else {
        return Ok(Turned { rows, other: None, link: None });
    };
    let arm = geometry::Arm { turn_rad, ..circle.arm.clone() };
    let other = signals.rows(recording, &arm, Axes::PLAIN)?;
    let model = plain_crank();
    let (before, _) = force::plain_rms(&mut rows.clone(), &model)?;
    let (after, _) = force::plain_rms(&mut other.clone(), &model)?;
    let likelier = 2.0 * rows.along().count() as f64 * (before / after.max(1e-300)).ln();
    let link =
        if likelier.abs() < TURNED { None } else { Some(if likelier > 0.0 { Link::First } else { Link::Second }) };
    let (rows, other) = if link == Some(Link::First) { (other, rows) } else { (rows, other) };
    Ok(Turned { rows, other: Some(other), link })
}

/// Whether the forces seem to be turned against the motion.
fn is_turned(study: &geometry::Study) -> bool {
    study.chosen.iter().any(|c| study.candidates[c.candidate].id == "force-cross-axis")
}

/// Says whose angle is wrong, as far as that shows.
fn name_joint(found: &mut Diagnosis, link: Option<Link>) {
    // Of two fingers it is said which of them, and the path shows no more.
    let of_the_finger = |c: &&mut Cause| c.id == "joint-offset" && c.parameters.iter().any(|p| p.name == "delta");
    let Some(cause) = found.causes.iter_mut().find(of_the_finger) else { return };
    cause.evidence += match link {
        Some(Link::First) => "; it is the angle of the first link",
        Some(Link::Second) => "; it is the angle of the second link",
        None => {
            "; the first link's angle being off by the opposite makes the same path, and the forces do not tell the two apart"
        }
    };
    if link == Some(Link::First) {
        cause.parameters.iter_mut().for_each(|p| p.value = -p.value);
    }
}

/// The thesis's crank (eq. 5.2).
fn plain_crank() -> Model {
    [&Weight as &dyn Law, &LoadFriction, &ViscousFriction].map(|law| Effect::new(law, &[1.0])).to_vec()
}

/// A weight that the sidecar states is no part of what is fitted.
fn known_weight(recording: &Recording, model: &mut Model) -> Model {
    let known = &recording.meta.known;
    let weight = known.get("weight_N").copied().or_else(|| Some(known.get("mass_kg")? * recording.meta.gravity()));
    let Some(weight) = weight else { return Model::new() };
    model.retain(|e| e.law().id() != Weight.id());
    vec![Effect::new(&Weight, &[weight])]
}

fn nothing() -> EstimateError {
    EstimateError::Other("no recording was given; name at least one log".to_owned())
}

fn mechanism(recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let (mut found, mut rest_s) = mechanism_as_it_is(recordings, options)?;
    // What is no delay, a part of a sample, is taken out of the motion itself: a stiff loop's force changes too fast for a straight line, which
    // says too much of it.
    for _ in 0..CLOSER {
        let Some(more_s) = rest_s else { break };
        let skew_s = found.skew_s + OF_SKEW * more_s;
        let together: Vec<Recording> = recordings.iter().map(|r| late::motion_apart(r, skew_s)).collect();
        let Ok((mut again, rest)) = mechanism_as_it_is(&together, options) else { break };
        if again.causes.iter().any(|c| c.id == "time-delay") || again.end.heldout_rms_n > found.end.heldout_rms_n {
            break;
        }
        again.skew_s = skew_s;
        again.warnings.retain(|w| !w.starts_with(explain::APART));
        again.warnings.push(explain::apart(skew_s));
        (found, rest_s) = (again, rest);
    }
    Ok(found)
}

/// Rounds in which a skew of force and motion is taken out, and the share of what a straight line says of it.
const CLOSER: usize = 2;
const OF_SKEW: f64 = 0.7;

/// The answer, and by what part of a sample force and motion are apart, s.
fn mechanism_as_it_is(recordings: &[Recording], options: &Options) -> Result<(Diagnosis, Option<f64>), EstimateError> {
    let mut faults = Vec::new();
    let mut tracks = Vec::new();
    let paths = crate::identify::mechanism::paths(recordings);
    if free::is_free(recordings, &paths)? {
        return Ok((free::diagnose(recordings, &paths, options)?, None));
    }
    for (recording, path) in recordings.iter().zip(&paths) {
        let found = quality::faults(recording);
        let (recording, mirrored_rate) = signs::with_rates_of_motion(recording);
        let recording = recording.as_ref();
        let mut rows = sliding::track(recording, &found.bad, path.as_ref())?;
        rows.hung = vec![hung::Hung::on_mechanism(recording, rows.coordinate)];
        rows.extra = vec![extra::of(recording)];
        faults.extend(signs::of_mechanism(&mut rows, recording, mirrored_rate)?);
        tracks.push(rows);
        faults.extend(found.causes);
    }
    let mut track = track::join(tracks).ok_or_else(nothing)?;
    let mut model: Model = match (&options.world, options.baseline.as_deref()) {
        (Some(world), _) => world.mechanism.as_ref().map(|m| m.effects.clone()).unwrap_or_default(),
        (None, name) => named(name.unwrap_or("mass+viscous+coulomb"))?,
    };
    let limit = threshold(track.period_s);
    options.progress.tell(0.4)?;
    let fixed = known_laws(&recordings[0], track.coordinate, &mut model);
    let study = force::study(&mut track, &model, &fixed, limit)?;
    options.progress.tell(0.8)?;
    let mut found = explain::explain(&track, &model, &study, &[], faults);
    found.along = Some(along::Along::of(track.coordinate, recordings, &paths));
    found.guess_s = late::guess_s(&track, &model);
    let is_hung = track.hung.iter().any(Option::is_some);
    explain::without_known(&mut found, !fixed.is_empty() || is_hung, true);
    if options.atlas {
        found.atlas = atlas::atlas(&track, &study, limit);
    }
    let skew_s = explain::skewed_s(&study, &track);
    Ok((found, skew_s))
}

/// Laws of a mechanism that the sidecar states are no part of what is fitted.
fn known_laws(recording: &Recording, coordinate: Coordinate, model: &mut Model) -> Model {
    let known = &recording.meta.known;
    // The mass of a pendulum is not what it resists with.
    let names = match coordinate {
        Coordinate::Linear => ["mass_kg", "viscous_N_s_m", "coulomb_N"],
        Coordinate::Angular => ["inertia_kg_m2", "viscous_Nm_s", "coulomb_Nm"],
    };
    let laws: [&'static dyn Law; 3] = [&Inertia, &ViscousFriction, &CoulombFriction];
    let mut fixed = Model::new();
    for (law, name) in laws.into_iter().zip(names) {
        let Some(value) = known.get(name).copied().filter(|_| model.iter().any(|e| e.law().id() == law.id())) else {
            continue;
        };
        model.retain(|e| e.law().id() != law.id());
        fixed.push(Effect::new(law, &[value]));
    }
    fixed
}

/// The laws of a baseline's name.
///
/// # Errors
/// A part that is no law of a baseline, in a sentence.
pub fn named(name: &str) -> Result<Model, EstimateError> {
    name.split('+')
        .map(|part| match part.trim() {
            "mass" | "inertia" => Ok(Effect::new(&Inertia, &[1.0])),
            "viscous" => Ok(Effect::new(&ViscousFriction, &[1.0])),
            "coulomb" => Ok(Effect::new(&CoulombFriction, &[1.0])),
            other => Err(EstimateError::Other(format!(
                "`{other}` is no part of a baseline; write mass, mass+viscous or mass+viscous+coulomb, or name a world file"
            ))),
        })
        .collect()
}
