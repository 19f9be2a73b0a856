//! Diagnosis of cranks.

pub(crate) mod axis_signs;
pub(crate) mod bearing_load;
pub(crate) mod contact_phases;
pub(crate) mod grasp_slip;
pub(crate) mod handle_motion;
pub(crate) mod path;
pub(crate) mod path_answer;
pub(crate) mod path_points;
pub(crate) mod rows;

use super::baseline_models::plain_crank;
use super::coordinate_answer::{explain, without_known};
use super::one_coordinate;
use crate::diagnose::answer::build::Evidence;
use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::contract::{Cause, Validation};
use crate::diagnose::data::limits::AMBIGUOUS;
use crate::diagnose::data::regression_data::Model;
use crate::diagnose::data::{covariates, regression_data};
use crate::diagnose::extension::hypothetical_worlds::found_fault;
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::hypotheses::sensor_fault::SensorFault;
use crate::diagnose::hypotheses::{force_cross_axis, joint_offset};
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::options::{Options, nothing};
use crate::diagnose::recording::{sample_faults, time_delay};
use crate::diagnose::selection::comparison;
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::validation::on_other_recordings;
use foundation::estimate::EstimateError;
use foundation::words::amount;
use haptics::law::{Effect, Law as _, Weight};
use haptics::recording::Recording;
use path_answer::{Link, PathFit};
use path_points::Path;

/// Diagnoses recordings of one crank.
pub fn crank(
    recordings: &[Recording],
    options: &Options,
    put_back: Option<&PutBack<'_>>,
) -> Result<Findings, EstimateError> {
    let Geometry { tracks, swapped, mut paths, held, short, faults, mut link, scale } = geometry(recordings, options)?;
    let other = swapped.iter().any(Option::is_some).then(|| {
        let either = swapped.iter().zip(&tracks).map(|(other, rows)| other.as_ref().unwrap_or(rows).clone());
        regression_data::join(either.collect())
    });
    let mut track = regression_data::join(tracks).ok_or_else(nothing)?;
    let mut model: Model = match &options.world {
        Some(world) => world.crank.as_ref().map(|c| c.effects.clone()).unwrap_or_default(),
        None => plain_crank(),
    };
    let fixed = known_weight(&recordings[0], &mut model);
    options.progress.tell(0.4)?;
    let gravity_m_s2 = recordings[0].meta.gravity();
    let look = |track: &mut regression_data::Track| -> Result<_, EstimateError> {
        Ok((bearing_load::load(track, &model, &fixed, gravity_m_s2)?, one_coordinate::study(track, &model, &fixed)?))
    };
    let as_measured = track.clone();
    let (mut bearing_n, mut study) = look(&mut track)?;
    if bearing_n.is_none() {
        let again = bearing_load::beside_causes(&as_measured, (&track, &study), (&model, &fixed), gravity_m_s2)?;
        if let Some((weight_n, other, found)) = again {
            (bearing_n, track, study) = (Some(weight_n), other, found);
        }
    }
    // The link was chosen by the plain model, which hidden causes may have misled.
    if let Some(mut other) = other.flatten().filter(|_| is_turned(&study)) {
        let (other_n, again) = look(&mut other)?;
        if !is_turned(&again) {
            let swapped = if link == Some(Link::First) { Link::Second } else { Link::First };
            (track, bearing_n, study, link) = (other, other_n, again, Some(swapped));
        }
    }
    options.progress.tell(0.8)?;
    let study = settle(study);
    if let Some(fault) = found_fault(&study) {
        without_fault(&mut paths, held, &fault)?;
    }
    // The path itself may have shown a scale of all lengths.
    let scale = scale.filter(|scale| paths.iter().all(|p| !p.study.has(&scale.id)));
    let is_known = |name: &str| recordings.iter().any(|r| r.meta.known.contains_key(name));
    let evidence = Evidence {
        causes: scale.into_iter().chain(faults).collect(),
        remarks: bearing_n.map(on_bearing).into_iter().chain(short).collect(),
        without_known: without_known(!fixed.is_empty() || is_known("added_weight_N"), is_known("radius_m")),
        atlas: options.atlas,
        twins: options.twins,
        delay: DelayFindings { guess_s: time_delay::guess_s(&track, &model), ..DelayFindings::default() },
        ..Evidence::default()
    };
    for path in &mut paths {
        path.link = link;
    }
    Ok(explain(&track, &model, &study, paths.iter().map(PathFit::part).collect(), evidence).finish(put_back))
}

/// Remark about the load that the friction goes with.
fn on_bearing(weight_n: f64) -> String {
    let weight = amount(weight_n, "N");
    format!(
        "friction goes with the load on the bearing, {weight} of the handle's weight included, not with the fingers' pull alone"
    )
}

/// Geometry of all recordings, with the rows on their circles.
#[derive(Default)]
struct Geometry {
    tracks: Vec<regression_data::Track>,
    /// The same rows with an error of the other link's angle, if one link's angle has an error.
    swapped: Vec<Option<regression_data::Track>>,
    paths: Vec<PathFit>,
    /// Points of those paths.
    held: Vec<Path>,
    /// Warnings of arcs that are too short for a circle.
    short: Vec<String>,
    faults: Vec<Cause>,
    /// The link whose angle has an error.
    link: Option<Link>,
    /// A scale of all lengths, by a known radius.
    scale: Option<Cause>,
}

fn geometry(recordings: &[Recording], options: &Options) -> Result<Geometry, EstimateError> {
    let mut found = Geometry::default();
    for (k, recording) in recordings.iter().enumerate() {
        options.progress.tell(0.4 * k as f64 / recordings.len() as f64)?;
        let of_samples = sample_faults::faults(recording);
        let (upright, mirrored, looked) = axis_signs::of_crank(recording, &of_samples.bad)?;
        let recording = &upright;
        let axis_signs::Looked { signals, circle, rows, axis } = looked;
        found.faults.extend(mirrored);
        found.faults.extend(of_samples.causes);
        found.faults.extend(axis);
        let Turned { mut rows, other, link: of_this } = turned(&signals, recording, &circle, rows)?;
        rows.extra = vec![covariates::of(recording)];
        found.link = found.link.or(of_this);
        // The same recording with an error of the other link's angle.
        found.swapped.push(other.map(|other| regression_data::Track { extra: rows.extra.clone(), ..other }));
        let known_m = recording.meta.known.get("radius_m").copied().filter(|r| r.is_finite() && *r > 0.0);
        if found.scale.is_none() {
            found.scale = known_m.and_then(|r| sample_faults::scaled("radius", circle.too_large(r)?));
        }
        found.tracks.push(rows);
        let path = signals.path(recording);
        found.short.extend(path::short_arc(&path, &circle.arm, &circle.study));
        found.paths.push(PathFit::of(&path, circle));
        found.held.push(path);
    }
    Ok(found)
}

/// Compares the paths that pads follow anew, without a fault of the force sensors: a drift reads as a slip of the grasp.
fn without_fault(paths: &mut [PathFit], held: Vec<Path>, fault: &SensorFault) -> Result<(), EstimateError> {
    for (fit, mut path) in paths.iter_mut().zip(held).filter(|(_, path)| path.two_fingered) {
        path.take_off(fault);
        let signals = path.points.last().map_or(0, |point| point.index + 1);
        *fit = PathFit::of(&path, path::geometry(&path, signals, Rules::of_path(path.period_s))?);
    }
    Ok(())
}

/// Validates the found causes on another recording of the same crank.
pub fn validate(recording: &Recording, diagnosis: &Findings) -> Result<Validation, EstimateError> {
    let axis_signs::Looked { signals, circle, rows, .. } =
        axis_signs::Looked::at(recording, &sample_faults::faults(recording).bad)?;
    let mut track = turned(&signals, recording, &circle, rows)?.rows;
    // A stated weight was not fitted, but acts all the same.
    let known = known_weight(recording, &mut diagnosis.plain.clone());
    let with_known = |effects: &[Effect]| -> Model {
        let weighs = effects.iter().any(|e| e.law().id() == Weight.id());
        effects.iter().chain(known.iter().filter(|_| !weighs)).copied().collect()
    };
    let (before, after) = (with_known(&diagnosis.plain), with_known(&diagnosis.effects));
    Ok(on_other_recordings::validate(&mut track, &before, &after, &known, &diagnosis.kept))
}

/// Rows of a crank whose path shows an angle error of the finger.
struct Turned {
    /// With that link's angle put right which is the likelier one.
    rows: regression_data::Track,
    /// Rows if the other link's angle is wrong; `None` if no angle is.
    other: Option<regression_data::Track>,
    /// Likelier link of the two. None if the forces do not tell.
    link: Option<Link>,
}

/// Corrects an angle error of the finger. An offset of the first link distorts the path as the opposite offset of the
/// second does, and also rotates it. The circle is the same, but the force has another direction relative to it.
fn turned(
    signals: &rows::Signals,
    recording: &Recording,
    circle: &path::Geometry,
    rows: regression_data::Track,
) -> Result<Turned, EstimateError> {
    let found = circle.study.found();
    let offset = found.iter().rfind(|(c, _)| c.id == joint_offset::ID).map(|(_, values)| values[0]);
    // With two fingers, the error is of one arm of two: the handle itself is not rotated.
    let Some(turn_rad) = offset.filter(|_| !signals.two_fingered) else {
        return Ok(Turned { rows, other: None, link: None });
    };
    let arm = path::Arm { turn_rad, ..circle.arm.clone() };
    let other = signals.rows(recording, &arm)?;
    let model = plain_crank();
    let (before, _) = one_coordinate::plain_rms(&mut rows.clone(), &model)?;
    let (after, _) = one_coordinate::plain_rms(&mut other.clone(), &model)?;
    let likelier = 2.0 * rows.along().count() as f64 * (before / after.max(1e-300)).ln();
    let link =
        if likelier.abs() < AMBIGUOUS { None } else { Some(if likelier > 0.0 { Link::First } else { Link::Second }) };
    let (rows, other) = if link == Some(Link::First) { (other, rows) } else { (rows, other) };
    Ok(Turned { rows, other: Some(other), link })
}

/// True if the forces seem rotated against the motion.
fn is_turned(study: &comparison::ChannelFit) -> bool {
    study.has(force_cross_axis::ID)
}

/// Takes a weight that the sidecar states out of the fitted laws.
fn known_weight(recording: &Recording, model: &mut Model) -> Model {
    let known = &recording.meta.known;
    let weight = known.get("weight_N").copied().or_else(|| Some(known.get("mass_kg")? * recording.meta.gravity()));
    let Some(weight) = weight else { return Model::new() };
    model.retain(|e| e.law().id() != Weight.id());
    vec![Effect::new(&Weight, &[weight])]
}
