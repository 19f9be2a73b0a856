//! Mechanisms with one degree of freedom: a slide, a door, a motor axis, a pendulum.
//!
//! The regressors are the laws of `haptics::law`; this module only chooses them, stacks them and reports parameters
//! that are not identifiable. Four forms of recording are understood: a coordinate with its force; a tool path with
//! forces, whose constraint is found first; a coordinate without a force, which moves freely; and a path without a
//! clock, which shows its constraint only. Two angles with two torques are a chain of two links (`chain/`).

mod attenuation;
mod chain;
mod driven;
mod force_channel;
mod foreign_force;
mod free;
mod gravity;
mod motion_segments;
mod offset;
mod parameter_change;
mod parameters;
pub mod path;
mod pendulum;
mod regress;
mod report;
mod resampling;
mod signals;
mod surface;
mod swing;
mod transmission;
mod world;
mod zero_step;

pub use driven::contradicts_its_clock;

use crate::constraint;
use foundation::estimate::{Constraint, EstimateError, Fit, Parameter};
use foundation::signal::chain::is_chain;
pub use free::{Stated, stated};
use haptics::law::Coordinate;
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use parameters::{Known, Term};
pub use report::{OBJECT, PHASE};
use swing::Swing;
pub use world::{Prediction, measured, path_of, predict, world};

pub use signals::{Piece, Raw, saturated};

/// Coordinate and force of one recording, as recorded; of a tool's along `path`, or along its own where none is given.
pub fn raw(recording: &Recording, path: Option<&MechanismPath>) -> Result<Raw, EstimateError> {
    if has_coordinate(recording) || path.is_some() {
        return signals::raw(recording, path);
    }
    signals::raw(recording, paths(std::slice::from_ref(recording)).pop().flatten().as_ref())
}

/// The path of every tool's recording: the first one's for all that keep to it, so that they have one coordinate. None where the
/// coordinate itself was recorded.
pub fn paths(recordings: &[Recording]) -> Vec<Option<MechanismPath>> {
    if recordings.iter().all(has_coordinate) { vec![None; recordings.len()] } else { constraints(recordings).1 }
}

/// Fits one mechanism to all `recordings` of it together.
pub fn fit(recordings: &[Recording]) -> Result<Fit, EstimateError> {
    let first = recordings
        .first()
        .ok_or_else(|| EstimateError::Other("no recording was given; name at least one log".to_owned()))?;
    if recordings.iter().all(is_chain) {
        return chain::fit(recordings);
    }
    if let Some(thrown) = super::tossed::fit(recordings) {
        return Ok(thrown);
    }
    let (constraints, paths) = constraints(recordings);
    if let Some(pressed) = surface::fit(recordings, &constraints) {
        return Ok(pressed);
    }
    if recordings.iter().any(|r| r.time_s.is_none()) {
        return Ok(clockless(recordings, constraints, &paths));
    }
    if paths.iter().all(Option::is_none) && !has_coordinate(first) {
        return without_coordinate(first, constraints);
    }
    let usable: Vec<(&Recording, Option<&MechanismPath>)> = recordings
        .iter()
        .zip(&paths)
        .map(|(r, p)| (r, p.as_ref()))
        .filter(|(r, p)| has_coordinate(r) || p.is_some())
        .collect();
    let raws = usable.iter().map(|(r, p)| signals::raw(r, *p)).collect::<Result<Vec<Raw>, _>>()?;
    if raws.iter().any(|r| r.coordinate != raws[0].coordinate) {
        let text = "some recordings move along a line and others about an axis; fit each mechanism by itself";
        return Err(EstimateError::Other(text.to_owned()));
    }
    let mut each = pieces_of_each(&raws, &usable)?;
    let known = Known::from_meta(&first.meta, raws[0].coordinate);
    let mut defects = Vec::new();
    for ((own, raw), (recording, _)) in each.iter_mut().zip(&raws).zip(&usable) {
        if let Some((lower, said)) = attenuation::behind_a_lower_filter(raw, own, &known, &recording.name) {
            *own = lower;
            defects.push(said);
        }
        defects.extend(force_channel::take_defects_out(own, recording, (raws[0].coordinate, &known)));
    }
    let pieces = each.concat();
    let mut result = if raws.iter().all(|r| r.force.is_some()) {
        driven::fit(&raws, &pieces, &known, recordings)?
    } else if raws.iter().all(|r| r.force.is_none()) {
        freely(&raws, &pieces, &known)?
    } else {
        let text = "some recordings have a force column and others do not; fit the driven and the free ones apart";
        return Err(EstimateError::Other(text.to_owned()));
    };
    result.warnings.extend(defects);
    result.constraints = constraints;
    result.parameters.extend(transmission::parameters(recordings));
    Ok(result)
}

fn pieces_of_each(raws: &[Raw], of: &[(&Recording, Option<&MechanismPath>)]) -> Result<Vec<Vec<Piece>>, EstimateError> {
    raws.iter().zip(of).map(|(raw, (recording, _))| signals::pieces(raw, &recording.name)).collect()
}

/// Motion that nothing drives: without its standstills, if enough motion remains.
fn freely(raws: &[Raw], pieces: &[Piece], known: &Known) -> Result<Fit, EstimateError> {
    let (parts, stood) = motion_segments::split_by_motion(raws);
    if stood {
        let of_parts: Vec<Vec<Piece>> = parts.iter().filter_map(|raw| signals::pieces(raw, "").ok()).collect();
        if of_parts.len() == parts.len() {
            let mut found = free::fit(&parts, &of_parts.concat(), known)?;
            found.warnings.push(
                "what stands in the recording is left out: dry friction holds it there, and it shows nothing of the laws".to_owned(),
            );
            return Ok(found);
        }
    }
    free::fit(raws, pieces, known)
}

fn has_coordinate(recording: &Recording) -> bool {
    recording.channel("q_m").is_some() || recording.channel("q_rad").is_some()
}

/// The constraint of every tool path, and its path: see [`paths`].
fn constraints(recordings: &[Recording]) -> (Vec<Constraint>, Vec<Option<MechanismPath>>) {
    let mut found = Vec::new();
    let mut paths = Vec::new();
    let mut first: Option<(MechanismPath, &Recording)> = None;
    for recording in recordings {
        let constraint = constraint::detect_in(recording);
        let shared = first.filter(|(path, like)| path::lies_on(recording, path, like)).map(|(path, _)| path);
        let path = shared.or_else(|| path::from_constraint(constraint.as_ref()?, recording));
        first = first.or_else(|| Some((path?, recording)));
        paths.push(path);
        found.extend(constraint);
    }
    (found, paths)
}

/// A path that is neither line nor circle has no coordinate: the constraint's own answer is the result.
fn without_coordinate(recording: &Recording, constraints: Vec<Constraint>) -> Result<Fit, EstimateError> {
    if constraints.is_empty() {
        return Err(EstimateError::MissingColumn {
            task: "a mechanism".to_owned(),
            column: "q_m, q_rad, or x_m and y_m".to_owned(),
            recording: recording.name.clone(),
        });
    }
    let why = "the path is not decided to be a line or a circle, so there is no coordinate to fit along";
    Ok(Fit {
        task: "mechanism".to_owned(),
        parameters: ["mass_kg", "coulomb_N", "viscous_N_s_m", "offset_N"]
            .map(|name| Parameter::unidentified(OBJECT, name, recording.len(), why))
            .to_vec(),
        constraints,
        warnings: vec![why.to_owned()],
        ..Fit::default()
    })
}

/// Without a clock there are no rates: constraints, and the mean force along them.
fn clockless(recordings: &[Recording], constraints: Vec<Constraint>, paths: &[Option<MechanismPath>]) -> Fit {
    let angular = paths.iter().any(|p| matches!(p, Some(MechanismPath::Revolute { .. })))
        || recordings.iter().any(|r| r.channel("q_rad").is_some());
    let coordinate = if angular { Coordinate::Angular } else { Coordinate::Linear };
    let samples = recordings.iter().map(Recording::len).sum();
    let why = "the log has no clock, so there are no rates; give a t_s column or rate_hz in the sidecar";
    let names = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset].map(|t| t.name(coordinate));
    let mut result = Fit {
        task: "mechanism".to_owned(),
        parameters: names.map(|name| Parameter::unidentified(OBJECT, name, samples, why)).to_vec(),
        constraints,
        warnings: vec![format!("{why}; only constraints and the force along them can be shown")],
        ..Fit::default()
    };
    for (recording, path) in recordings.iter().zip(paths) {
        let force = path.as_ref().and_then(|p| path::project(recording, p).ok()).and_then(|p| p.force);
        if let Some(force) = force.filter(|f| !f.is_empty()) {
            let mean = force.iter().sum::<f64>() / force.len() as f64;
            let unit = if coordinate == Coordinate::Linear { "N" } else { "N m" };
            result.warnings.push(format!("mean force along the motion of {}: {mean:.3} {unit}", recording.name));
        }
    }
    result
}

/// One sentence if these recordings are nearly a free swing.
///
/// # Errors
/// As [`fit`].
pub fn swing(recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Result<Option<String>, EstimateError> {
    let each = recordings.iter().zip(paths);
    let raws = each.clone().map(|(r, path)| signals::raw(r, path.as_ref())).collect::<Result<Vec<Raw>, _>>()?;
    let usable: Vec<_> = each.map(|(r, path)| (r, path.as_ref())).collect();
    let pieces = pieces_of_each(&raws, &usable)?.concat();
    let known = recordings.first().map(|r| Known::from_meta(&r.meta, raws[0].coordinate)).unwrap_or_default();
    Ok(Swing::of(&raws, &pieces, &known)?.map(|swing| swing.sentence()))
}

#[cfg(test)]
mod tests;
