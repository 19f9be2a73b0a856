//! Diagnosis of mechanisms with one degree of freedom.
//!
//! Axis signs of a mechanism: a force that drives its motion on balance is counted the other way.

pub(crate) mod rows;
pub(crate) mod sensor_zero;

use super::baseline_models::{known_laws, named};
use super::coordinate_answer::{explain, without_known};
use super::delay_correction::corrected;
use super::{free_motion, one_coordinate, thrown_body, transmission, untimed_path};
use crate::diagnose::answer::build::Evidence;
use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::contract::{Cause, Validation};
use crate::diagnose::data::regression_data::{Model, Place, Track};
use crate::diagnose::data::{coordinate, covariates, hung_weight, regression_data};
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::hypotheses;
use crate::diagnose::model_error::competition::settle;
use crate::diagnose::options::{Options, nothing};
use crate::diagnose::recording::{driving_force, rate_signs, sample_faults, time_delay};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::rms;
use crate::diagnose::validation::on_other_recordings;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use haptics::world::MechanismPath;

/// Diagnosis of thrown bodies, paths without a clock, transmissions, and motions along one coordinate.
pub fn one_of_mechanisms(recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    if let Some(chain) = recordings.iter().find(|r| foundation::signal::chain::is_chain(r)) {
        return Err(EstimateError::Other(format!(
            "{} is of a chain of two joints, which cannot be diagnosed yet; `touchstone fit` tells its inertias, moments and frictions",
            chain.name
        )));
    }
    if let Some(thrown) = thrown_body::impact(recordings, options) {
        return thrown;
    }
    if untimed_path::is_pulled(recordings) {
        return untimed_path::pulled(recordings, options);
    }
    if transmission::is_driven(recordings) {
        return transmission::driven(recordings, options);
    }
    let paths = estimation::identify::mechanism::paths(recordings);
    if free_motion::is_free(recordings, &paths)? {
        return free_motion::diagnose(recordings, &paths, options);
    }
    corrected(recordings, |some, back| Ok(studied(some, options)?.answer(options, back)))
}

/// Rounds in which an offset between force and motion is removed.
/// Choice: halved or doubled, none of 5 answers changes.
const OFFSET_ROUNDS: usize = 2;
/// Share of the linear estimate of that offset that is used.
/// Choice: halved, 1 of 2 answers change; doubled, 1 of 2 answers change.
const OF_SKEW: f64 = 0.7;

/// Doubt about a recording whose clock or rate is wrong.
const CONTRADICTED: &str =
    "a recorded rate contradicts the position and the clock, so no cause is certain; correct one of them first";

/// Recordings of one mechanism, compared with all causes.
struct Studied {
    track: Track,
    model: Model,
    study: ChannelFit,
    /// Faults of the samples and of the signs.
    faults: Vec<Cause>,
    /// Reason why the forces tell no cause for certain.
    doubt: Option<String>,
    along: coordinate::Along,
    /// True if a weight is known.
    is_weighed: bool,
    /// Part of a sample by which the motion was shifted to the forces, s.
    skew_s: f64,
}

/// The comparison. A delay of a fraction of a sample between channels is removed from the motion itself. The force of a
/// stiff loop changes too fast for a linear regressor, which overestimates it.
fn studied(recordings: &[Recording], options: &Options) -> Result<Studied, EstimateError> {
    let mut found = Studied::of(recordings, options, 0.0)?;
    for _ in 0..OFFSET_ROUNDS {
        let Some(more_s) = time_delay::skewed_s(&found.study, &found.track) else { break };
        let skew_s = found.skew_s + OF_SKEW * more_s;
        let together: Vec<Recording> = recordings.iter().map(|r| time_delay::motion_apart(r, skew_s)).collect();
        let Ok(again) = Studied::of(&together, options, skew_s) else { break };
        if again.names_a_delay() || again.heldout_rms() > found.heldout_rms() {
            break;
        }
        found = again;
    }
    Ok(found)
}

impl Studied {
    /// `skew_s`: shift of these recordings' motion.
    fn of(recordings: &[Recording], options: &Options, skew_s: f64) -> Result<Self, EstimateError> {
        let paths = estimation::identify::mechanism::paths(recordings);
        let (mut faults, mut tracks) = (Vec::new(), Vec::new());
        for (recording, path) in recordings.iter().zip(&paths) {
            let found = sample_faults::faults(recording);
            let (recording, mirrored_rate) = rate_signs::with_rates_of_motion(recording);
            let recording = recording.as_ref();
            let mut rows = rows::track(recording, &found.bad, path.as_ref())?;
            if let Some(first) = tracks.first() {
                coordinate::one_kind(first, &rows, recording)?;
            }
            rows.hung = vec![hung_weight::Hung::on_mechanism(recording, rows.coordinate)];
            rows.extra = vec![covariates::of(recording)];
            faults.extend(of_mechanism(&mut rows, recording, mirrored_rate)?);
            tracks.push(rows);
            faults.extend(found.causes);
        }
        let mut track = regression_data::join(tracks).ok_or_else(nothing)?;
        let contradicted = recordings.iter().any(estimation::identify::mechanism::contradicts_its_clock);
        let doubt =
            contradicted.then(|| CONTRADICTED.to_owned()).or_else(|| driving_force::swing(&track, recordings, &paths));
        let mut model: Model = match (&options.world, options.baseline.as_deref()) {
            (Some(world), _) => world.mechanism.as_ref().map(|m| m.effects.clone()).unwrap_or_default(),
            (None, name) => named(name.unwrap_or("mass+viscous+coulomb"))?,
        };
        options.progress.tell(0.4)?;
        let fixed = known_laws(&recordings[0], track.coordinate, &mut model);
        let mut study = one_coordinate::study(&mut track, &model, &fixed)?;
        track.zero = sensor_zero::told(&study, recordings);
        if track.zero != regression_data::Zero::Open {
            study = one_coordinate::study(&mut track, &model, &fixed)?;
        }
        options.progress.tell(0.8)?;
        let is_weighed = !fixed.is_empty() || track.hung.iter().any(Option::is_some);
        let along = coordinate::Along::of(track.coordinate, recordings, &paths);
        Ok(Self { track, model, study, faults, doubt, along, is_weighed, skew_s })
    }

    /// True if a delay is named as a cause.
    fn names_a_delay(&self) -> bool {
        let is_delay = |(k, pick): (usize, usize)| {
            self.study.candidates[pick].id == hypotheses::time_delay::ID
                && time_delay::skew(&self.study, k, &self.track).is_none()
        };
        self.study.picks().into_iter().enumerate().any(is_delay)
    }

    /// RMS of the held-out residual with the causes found.
    fn heldout_rms(&self) -> f64 {
        let along: Vec<bool> = self.track.rows.iter().map(|r| r.place == Place::Along).collect();
        rms(&self.study, &self.study.picks(), &along).0
    }

    fn answer(self, options: &Options, put_back: Option<&PutBack<'_>>) -> Findings {
        let Self { track, model, study, faults, doubt, along, is_weighed, skew_s } = self;
        // A free motion has too few rows for structured errors.
        let study = if track.freely.is_some() { study } else { settle(study) };
        let evidence = Evidence {
            causes: faults,
            remarks: (skew_s != 0.0).then(|| time_delay::apart(skew_s)).into_iter().collect(),
            without_known: without_known(is_weighed, true),
            atlas: options.atlas,
            twins: options.twins,
            delay: DelayFindings { guess_s: time_delay::guess_s(&track, &model), ..DelayFindings::default() },
            skew_s,
            ..Evidence::default()
        };
        let mut draft = explain(&track, &model, &study, Vec::new(), evidence);
        sensor_zero::ask(&mut draft.named, &track);
        if let Some(why) = doubt {
            draft.doubt(why);
        }
        Findings { along: Some(along), ..draft.finish(put_back) }
    }
}

/// Validates the found causes on another recording of the same mechanism.
pub fn validate(recording: &Recording, diagnosis: &Findings) -> Result<Validation, EstimateError> {
    let recording = &time_delay::motion_apart(recording, diagnosis.skew_s);
    let along = diagnosis.along.ok_or_else(|| coordinate::none(recording))?;
    let path = along.path_of(recording)?;
    let mut track = track_of(recording, path.as_ref(), diagnosis)?;
    along.demand(track.coordinate, recording)?;
    let Findings { plain, effects, kept, .. } = diagnosis;
    Ok(on_other_recordings::validate(&mut track, plain, effects, &[], kept))
}

/// Rows of a recording for the validation of a mechanism, driven or free.
fn track_of(recording: &Recording, path: Option<&MechanismPath>, diagnosis: &Findings) -> Result<Track, EstimateError> {
    let bad = sample_faults::faults(recording).bad;
    if estimation::identify::mechanism::raw(recording, path)?.force.is_some() {
        if diagnosis.per_inertia {
            return Err(EstimateError::Other(format!(
                "{} has a force column, and what was diagnosed is known per unit of inertia only: state the inertia, or what tells it, \
                 under \"known\" in the sidecar",
                recording.name
            )));
        }
        return rows::track(recording, &bad, path);
    }
    free_motion::rows::track(recording, &bad, path)
}

/// Detects a force with the sign of the reaction: mass and friction are then negative, each of them significantly. The
/// sign is corrected in the rows.
pub fn of_mechanism(
    track: &mut Track,
    recording: &Recording,
    rate: Option<&str>,
) -> Result<Option<Cause>, EstimateError> {
    if !driving_force::drives(track, &named("mass+viscous+coulomb")?)? {
        return Ok(rate.map(sample_faults::against_motion));
    }
    for row in &mut track.rows {
        row.target = -row.target;
        row.force = -row.force;
        row.force_rate = -row.force_rate;
    }
    // If a rate contradicts the position and the force drives the motion, the position is the mirrored one.
    let names: &[&str] = if rate.is_some() { &["q_m", "q_rad"] } else { &["f_N", "tau_Nm"] };
    let name = names.iter().find(|name| recording.channel(name).is_some()).unwrap_or(&"the force");
    Ok(Some(sample_faults::driving(name)))
}
