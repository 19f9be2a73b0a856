//! Diagnosis of the residual between measurement and model: its causes, and the gain of an extended model.
//!
//! The model is evaluated on the measured motion, and the residual is compared with the effect of every known cause.
//! Method: named hypotheses, effective-variance weights, whitening, forward selection with swaps, a locked test part.

pub(crate) mod answer;
pub mod contract;
pub(crate) mod data;
pub(crate) mod experiment;
pub(crate) mod extension;
pub(crate) mod findings;
pub(crate) mod free_run;
pub(crate) mod hypotheses;
pub(crate) mod model_error;
pub(crate) mod options;
pub(crate) mod progress;
pub(crate) mod recording;
pub(crate) mod selection;
pub(crate) mod tasks;
pub(crate) mod validation;
pub(crate) mod worlds;

pub use answer::atlas;
pub use answer::time_series::{Course, Instant};
pub use contract::{
    Alternative, Baseline, Cause, CauseParameter, Diagnosis, Experiment, Final, Gain, ModelError, NamedInTwins,
    NextExperiment, NotExcited, OverVariable, PassedOver, Residual, Rollout, RolloutOf, Settled, Standing, Twins,
    Validation, Verdict,
};
use estimation::segment::task_of;
pub use experiment::strokes::{Stroke, Strokes};
pub use experiment::waypoints::{Insertions, Throw, Throws};
pub use findings::Findings;
use foundation::estimate::EstimateError;
use haptics::recording::{Recording, Task, Warning};
pub use hypotheses::sensor_fault::{SensorFault, Step};
pub use hypotheses::variable::Variable;
use logs::{NO_CLOCK, SPIKES, UNIT};
pub use options::Options;
pub use progress::Progress;
pub use tasks::baseline_models::named;
use tasks::delay_correction;
pub use worlds::{Suspect, Worlds, extended_world, suspects, worlds};

/// Diagnoses one or several recordings of the same object.
pub fn diagnose(recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    let first = recordings
        .first()
        .ok_or_else(|| EstimateError::Other("no recording was given; name at least one log".to_owned()))?;
    let task = task_of(first, options.task)?;
    let repaired = without_spikes(recordings);
    let recordings = repaired.as_deref().unwrap_or(recordings);
    let mut found = of_task(task, recordings, options)?;
    if task != Task::Payload {
        found.settled = answer::resolved_questions::settled(recordings, &found, &|some| of_task(task, some, options));
    }
    let told = |w: &&Warning| [NO_CLOCK, UNIT, SPIKES].contains(&w.kind.as_str());
    let doubtful = recordings.iter().flat_map(|r| r.warnings.iter().filter(told));
    found.warnings.extend(doubtful.map(|w| w.text.clone()));
    found.warnings.dedup();
    found.name_by_unit();
    Ok(found)
}

/// The recordings without spikes of single samples, if any has some, each with a warning for every channel that had. A
/// spike is no bias, no drift and no catch.
fn without_spikes(recordings: &[Recording]) -> Option<Vec<Recording>> {
    let each: Vec<_> = recordings.iter().map(logs::repaired).collect();
    let has_spikes = each.iter().any(Option::is_some);
    let repaired = |(repaired, recording): (Option<(Recording, Vec<Warning>)>, &Recording)| match repaired {
        Some((mut other, said)) => {
            other.warnings.extend(said);
            other
        }
        None => recording.clone(),
    };
    has_spikes.then(|| each.into_iter().zip(recordings).map(repaired).collect())
}

fn of_task(task: Task, recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    match task {
        Task::Payload => tasks::payload::payload(recordings),
        Task::Crank => delay_correction::corrected(recordings, |some, back| tasks::crank::crank(some, options, back)),
        Task::Mechanism => tasks::mechanism::one_of_mechanisms(recordings, options),
        _ => pinched(task, recordings, options),
    }
}

/// Diagnosis of an object held between two fingers, after mirrored axes are corrected.
fn pinched(task: Task, recordings: &[Recording], options: &Options) -> Result<Findings, EstimateError> {
    let looked_at: Vec<_> = recordings.iter().map(recording::grip_axis_signs::upright).collect();
    // Recordings are copied only if an axis is mirrored, which is rare.
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
    match task {
        Task::BlockStack | Task::Barrel if tasks::sliding_block::is_slid(recordings) => {
            delay_correction::corrected(recordings, |some, back| {
                tasks::sliding_block::slid(some, options, &faults, back)
            })
        }
        // A barrel is a carried block.
        Task::BlockStack | Task::Barrel => delay_correction::corrected(recordings, |some, back| {
            tasks::carried_block::blocks(some, options, &faults, back)
        }),
        Task::Needle => {
            delay_correction::corrected(recordings, |some, back| tasks::needle::needle(some, options, &faults, back))
        }
        _ => tasks::switch::switch(recordings, options, &faults),
    }
}

/// Replays the recordings `runs` times without any cause and counts the replays in which a cause is certain. `found`:
/// their diagnosis, with [`Options::twins`].
///
/// # Errors
/// One sentence if these recordings cannot be replayed, and that of a diagnosis that fails.
pub fn twins(
    recordings: &[Recording],
    options: &Options,
    found: &mut Findings,
    runs: u32,
) -> Result<(), EstimateError> {
    found.twins = Some(Box::new(validation::twins::count(recordings, options, found, runs)?));
    found.name_by_unit();
    Ok(())
}

/// Validates the found causes on other recordings of the same object: none is chosen or fitted there. Sensor faults
/// found in the first recordings are corrected in these as well. The path of a crank, and mirrored axes, are checked in
/// each.
pub fn validate(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Findings,
) -> Result<Vec<Validation>, EstimateError> {
    let of = |recording: &Recording| {
        let task = task_of(recording, options.task)?;
        // Cranks and mechanisms have their own tests of signs.
        let upright = if matches!(task, Task::Crank | Task::Mechanism) {
            None
        } else {
            recording::grip_axis_signs::upright(recording)
        };
        let recording = upright.as_ref().map_or(recording, |(other, _)| other);
        let recording = &recording::time_delay::put_back(recording, diagnosis.delay.corrected_s);
        let one = std::slice::from_ref(recording);
        let channels = match task {
            Task::Crank => return tasks::crank::validate(recording, diagnosis),
            Task::Mechanism => return tasks::mechanism::validate(recording, diagnosis),
            Task::BlockStack | Task::Barrel if tasks::sliding_block::is_slid(one) => {
                return tasks::sliding_block::validate(one, options, diagnosis);
            }
            Task::BlockStack | Task::Barrel => tasks::carried_block::channels(one, options)?,
            Task::Needle => tasks::needle::channels(one, options)?,
            Task::Switch => tasks::switch::channels(one, options)?,
            Task::Payload => {
                let text = "--validate has no meaning for the load of a sensor; name both recordings behind `diagnose` to compare them";
                return Err(EstimateError::Other(text.to_owned()));
            }
        };
        let order: Vec<&str> = diagnosis.causes.iter().map(|c| c.id.as_str()).collect();
        validation::on_other_recordings::measure(&diagnosis.kept, &order, &channels)
    };
    recordings.iter().map(of).collect()
}
