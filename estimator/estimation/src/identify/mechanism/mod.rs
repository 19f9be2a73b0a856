//! Mechanisms with one degree of freedom: a slide, a door, a motor axis, a pendulum.
//!
//! The regressors are the laws of `haptics::law`; this module only chooses them, stacks them and reports parameters
//! that are not identifiable. Four forms of recording are understood: a coordinate with its force; a tool path with
//! forces, whose constraint is found first; a coordinate without a force, which moves freely; and a path without a
//! clock, which shows its constraint only. Two angles with two torques are a chain of two links (`chain/`).

mod chain;
mod free;
mod gravity;
mod motion_segments;
mod offset;
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

use crate::constraint;
use crate::identify::limits::HELD_OUT;
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::LinearFit;
use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{Constraint, EstimateError, Fit, Parameter, Quality};
use foundation::signal::chain::is_chain;
pub use free::{Stated, stated};
use gravity::Gravity;
use haptics::law::Coordinate;
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use parameters::{CLOCK_TOLERANCE, Known, Term};
use regress::{Shown, System, shown};
use report::Material;
pub use report::{OBJECT, PHASE};
use std::borrow::Cow;
use swing::Swing;
pub use world::{Prediction, measured, path_of, predict, world};

pub use signals::{Piece, Raw};

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
    let pieces = all_pieces(&raws, &usable)?;
    let known = Known::from_meta(&first.meta, raws[0].coordinate);
    let mut result = if raws.iter().all(|r| r.force.is_some()) {
        driven(&raws, &pieces, &known, first)?
    } else if raws.iter().all(|r| r.force.is_none()) {
        freely(&raws, &pieces, &known)?
    } else {
        let text = "some recordings have a force column and others do not; fit the driven and the free ones apart";
        return Err(EstimateError::Other(text.to_owned()));
    };
    result.constraints = constraints;
    result.parameters.extend(transmission::parameters(recordings));
    Ok(result)
}

fn all_pieces(raws: &[Raw], of: &[(&Recording, Option<&MechanismPath>)]) -> Result<Vec<Piece>, EstimateError> {
    let each = raws.iter().zip(of).map(|(raw, (recording, _))| signals::pieces(raw, &recording.name));
    Ok(each.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
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

/// Motion under a measured force.
fn driven(raws: &[Raw], pieces: &[Piece], known: &Known, first: &Recording) -> Result<Fit, EstimateError> {
    let coordinate = raws[0].coordinate;
    let base = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
    let mut seen = shown(pieces, known, &base, Term::Coulomb);
    if let Some(nothing) = offset::told_nothing(raws, pieces, &seen, known) {
        return Ok(nothing);
    }
    let can_hang =
        coordinate == Coordinate::Angular && known.value(Term::GravitySine).is_none() && path::up(first).is_some();
    let swing = if can_hang && seen.fitted == base { Swing::of(raws, pieces, known)? } else { None };
    let swings = swing.as_ref().map(Swing::sentence);
    let ratio = swing.as_ref().map(|swing| swing.ratio);
    let gravity = match &swing {
        Some(_) => Some(Gravity::Present(vec![Term::GravitySine, Term::GravityCosine])),
        None if can_hang => Some(gravity::decide(pieces, &seen.fitted, known)?),
        None => None,
    };
    if let Some(Gravity::Present(terms)) = &gravity {
        seen.fitted.extend(terms);
    }
    let (pieces, system, mut solution) = match swing {
        Some(Swing { pieces, system, solution, .. }) => (Cow::Owned(pieces), system, solution),
        None => {
            let system = System::stack(pieces, &seen.fitted, known, force_of);
            let solution = system.solve()?;
            (Cow::Borrowed(pieces), system, solution)
        }
    };
    let pieces = pieces.as_ref();
    if let Some(Gravity::Absent { doubt, .. }) = &gravity {
        solution.widen(doubt);
    }
    solution.widen(&clock_errors(&system.terms, &solution.values));
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt();
    let effect: Vec<f64> = system.columns.iter().map(|c| rms(c)).collect();
    let weights = system.weights(&solution);
    let resampled = block_bootstrap(&system.columns, &system.target, weights.as_deref(), &solution);
    let mut result = Fit { task: "mechanism".to_owned(), ..Fit::default() };
    let material = Material {
        coordinate,
        shown: &seen,
        terms: &system.terms,
        fit: &solution,
        effect: &effect,
        force_rms: rms(&system.target),
        known,
        resampled: resampled.as_ref(),
        gravity: gravity.as_ref(),
    };
    material.push(&mut result);
    result.parameters.extend(ratio.map(|[value, error]| {
        let how = "least squares: the part of the acceleration that follows the sine of the angle";
        Parameter::identified(OBJECT, "gravity_moment_per_inertia_rad_s2", value, error, system.target.len(), how)
    }));
    if moved_by_another(&system.terms, &solution) {
        leave_out_what_is_unsure(&mut result);
    }
    result.correlated = vec![material.correlated()];
    result.quality = quality(pieces, &system, solution.rms, coordinate, known);
    result.warnings = warnings(pieces, &seen, &solution);
    result.warnings.extend(swings);
    Ok(result)
}

/// Errors by the clock's tolerance of parameters of a motion under a measured force: inertia goes as time squared,
/// viscous friction as time.
fn clock_errors(terms: &[Term], values: &[f64]) -> Vec<f64> {
    let powers = |term: &Term| Term::GravitySine.powers_of_time() - term.powers_of_time();
    terms.iter().zip(values).map(|(term, value)| (value * CLOCK_TOLERANCE * powers(term)).abs()).collect()
}

fn force_of(piece: &Piece) -> Vec<f64> {
    piece.force.clone().unwrap_or_else(|| vec![0.0; piece.motion.len()])
}

/// Refit on the first 70 % of every segment, held-out RMS on the last 30 %.
fn quality(pieces: &[Piece], system: &System, rms: f64, coordinate: Coordinate, known: &Known) -> Option<Quality> {
    let early = system.part(|place| place < 1.0 - HELD_OUT).solve().ok()?;
    let late = system.part(|place| place >= 1.0 - HELD_OUT);
    let n = late.target.len();
    if n == 0 {
        return None;
    }
    let residual =
        |i: usize| late.target[i] - late.columns.iter().zip(&early.values).map(|(c, v)| c[i] * v).sum::<f64>();
    let root = |sum: f64| (sum / n as f64).sqrt();
    let heldout_rms = root((0..n).map(|i| residual(i).powi(2)).sum());
    // Relative to the force as measured, its known part included.
    let nothing_known = System::stack(pieces, &[], &Known::default(), force_of).part(|place| place >= 1.0 - HELD_OUT);
    debug_assert!(known.values.is_empty() || nothing_known.target.len() == n, "the same samples either way");
    let force = root(nothing_known.target.iter().map(|f| f * f).sum());
    Some(Quality {
        rms,
        heldout_rms,
        heldout_relative: if force > 0.0 { heldout_rms / force } else { f64::NAN },
        heldout_share: HELD_OUT,
        unit: if coordinate == Coordinate::Linear { "N" } else { "Nm" }.to_owned(),
    })
}

/// One sentence if these recordings are nearly a free swing.
///
/// # Errors
/// As [`fit`].
pub fn swing(recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Result<Option<String>, EstimateError> {
    let each = recordings.iter().zip(paths);
    let raws = each.clone().map(|(r, path)| signals::raw(r, path.as_ref())).collect::<Result<Vec<Raw>, _>>()?;
    let usable: Vec<_> = each.map(|(r, path)| (r, path.as_ref())).collect();
    let pieces = all_pieces(&raws, &usable)?;
    let known = recordings.first().map(|r| Known::from_meta(&r.meta, raws[0].coordinate)).unwrap_or_default();
    Ok(Swing::of(&raws, &pieces, &known)?.map(|swing| swing.sentence()))
}

/// Reason why nothing but the force itself is told.
pub const MOVED_BY_ANOTHER: &str = "the inertia comes out negative and the friction does not: another force moves it, as a hand does, and the recorded one follows the motion, as a controller's does";

/// True if the recorded force cannot be the one that moves the mechanism: a negative inertia, beside a friction that is
/// none. With a wrong sign of the force, both would be negative.
fn moved_by_another(terms: &[Term], solution: &LinearFit) -> bool {
    let is_negative = |term: Term| {
        let is_beyond = |i: usize| solution.values[i] < -HALF_INTERVAL * solution.std_errors[i];
        terms.iter().position(|t| *t == term).is_some_and(is_beyond)
    };
    is_negative(Term::Inertia) && !is_negative(Term::Viscous) && !is_negative(Term::Coulomb)
}

/// Leaves out the values that may as well be zero. The others describe the recorded force.
fn leave_out_what_is_unsure(result: &mut Fit) {
    for parameter in &mut result.parameters {
        let is_sure =
            parameter.value.zip(parameter.std_error).is_some_and(|(v, error)| v.abs() > HALF_INTERVAL * error);
        if !is_sure {
            *parameter = Parameter::unidentified(OBJECT, &parameter.name, parameter.samples, MOVED_BY_ANOTHER);
        }
    }
}

fn warnings(pieces: &[Piece], seen: &Shown, solution: &LinearFit) -> Vec<String> {
    let mut found = Vec::new();
    let is_negative = |(i, term): (usize, &Term)| {
        let is_beyond = solution.values.get(i).is_some_and(|v| *v < -HALF_INTERVAL * solution.std_errors[i]);
        is_beyond && matches!(term, Term::Inertia | Term::Viscous | Term::Coulomb)
    };
    if moved_by_another(&seen.fitted, solution) {
        found.push(format!("{MOVED_BY_ANOTHER}; record the force that moves it"));
    } else if seen.fitted.iter().enumerate().any(is_negative) {
        found.push(
            "inertia or friction comes out negative: check the sign of the force column (\"sign\" in the sidecar)"
                .to_owned(),
        );
    }
    if let Some(piece) = pieces.first() {
        found.push(format!(
            "velocity and acceleration are derived from the recording with a zero-phase filter at {:.1} Hz, which the force also goes through",
            piece.cutoff_hz
        ));
    }
    found
}

#[cfg(test)]
mod tests;
