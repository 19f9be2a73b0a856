//! Diagnosis of the residual between measurement and model: its causes, and the gain of an extended model.
//!
//! The model is evaluated on the measured motion, and the residual is compared with the effect of every known cause.
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
mod crank;
mod dictionary;
mod driven;
mod experiment;
mod explain;
mod extend;
mod extra;
mod fine;
mod force;
mod free;
mod friction;
mod gain;
mod generic;
mod geometry;
mod grid;
mod held_arm;
mod hung;
mod impact;
mod kept;
mod late;
mod means;
mod mechanism;
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
mod shifted;
mod signs;
mod skew;
mod slide;
mod sliding;
mod slowest;
mod starts;
mod strange_path;
mod stuck;
mod suspects;
mod switch;
mod system;
mod track;
mod unseen;
mod validate;
mod white;
mod world;
mod zero;

pub use report::{
    Alternative, Baseline, Cause, CauseParameter, Diagnosis, Experiment, Final, Gain, NextExperiment, NotExcited,
    PassedOver, Rollout, RolloutOf, Settled, Validation, Verdict,
};
pub use residuals::Residual;

pub use course::Course;
pub use experiment::{Insertions, Stroke, Strokes, Throw, Throws};
pub use mechanism::named;
pub use progress::Progress;
pub use suspects::{SensorFault, Suspect, suspects};
pub use world::{Worlds, extended_world, worlds};

use crate::estimate::EstimateError;
use crate::log::NO_CLOCK;
use crate::segment::task_of;
use haptics::recording::{Recording, Task};
use haptics::world::World;

/// Settings of the user.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The task; inferred from sidecar and channels if absent.
    pub task: Option<Task>,
    /// Base model of a mechanism: `mass`, `mass+viscous` or `mass+viscous+coulomb`.
    pub baseline: Option<String>,
    /// The world to start from.
    pub world: Option<World>,
    /// Share done, and the wish to end.
    pub progress: Progress,
    /// True to compute [`Diagnosis::atlas`]: the part of the force's residual that every candidate alone would explain.
    pub atlas: bool,
}

/// Least evidence of a cause, 2 ln(likelihood): keeps false alarms below 1 in 200 (`facts/diagnosis.md`, 3).
const THRESHOLD: f64 = 20.0;
/// The same for slow rows, whose noise averages out less.
const THRESHOLD_SLOW: f64 = 25.0;
/// Row period from which rows count as slow, s.
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
            let ask = |recordings: &[Recording]| crank::crank(recordings, options);
            Ok(late::undo(recordings, ask(recordings)?, &ask))
        }
        Task::Mechanism => mechanism::one_of_mechanisms(recordings, options),
        _ => pinched(task, recordings, options),
    }
}

/// Diagnosis of an object held between two fingers, after mirrored axes are corrected.
fn pinched(task: Task, recordings: &[Recording], options: &Options) -> Result<Diagnosis, EstimateError> {
    let looked_at: Vec<_> = recordings.iter().map(pinched::upright).collect();
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
    let mut found = match task {
        Task::BlockStack | Task::Barrel if slide::is_slid(recordings) => slide::slid(recordings, options),
        // A barrel is a carried block.
        Task::BlockStack | Task::Barrel => {
            let ask = |recordings: &[Recording]| blocks::blocks(recordings, options);
            ask(recordings).map(|found| late::undo(recordings, found, &ask))
        }
        Task::Needle => {
            let ask = |recordings: &[Recording]| needle::needle(recordings, options);
            ask(recordings).map(|found| late::undo(recordings, found, &ask))
        }
        _ => switch::switch(recordings, options),
    }?;
    if !faults.is_empty() && found.verdict == Verdict::None {
        found.verdict = Verdict::Causes;
    }
    found.causes.splice(0..0, faults);
    Ok(found)
}

/// Validates the found causes on other recordings of the same object: none is chosen or fitted there. Sensor faults
/// found in the first recordings are corrected in these as well. The path of a crank, and mirrored axes, are checked in
/// each.
pub fn validate(
    recordings: &[Recording],
    options: &Options,
    diagnosis: &Diagnosis,
) -> Result<Vec<Validation>, EstimateError> {
    let of = |recording: &Recording| {
        let task = task_of(recording, options.task)?;
        // Cranks and mechanisms have their own tests of signs.
        let upright = if matches!(task, Task::Crank | Task::Mechanism) { None } else { pinched::upright(recording) };
        let recording = upright.as_ref().map_or(recording, |(other, _)| other);
        let one = std::slice::from_ref(recording);
        let channels = match task {
            Task::Crank => return crank::validate(recording, diagnosis),
            Task::Mechanism => return mechanism::validate(recording, diagnosis),
            Task::BlockStack | Task::Barrel if slide::is_slid(one) => return slide::validate(one, options, diagnosis),
            Task::BlockStack | Task::Barrel if diagnosis.late_s != 0.0 => {
                blocks::channels(&[late::put_back(recording, diagnosis.late_s)], options)?
            }
            Task::BlockStack | Task::Barrel => blocks::channels(one, options)?,
            Task::Needle if diagnosis.late_s != 0.0 => {
                needle::channels(&[late::put_back(recording, diagnosis.late_s)], options)?
            }
            Task::Needle => needle::channels(one, options)?,
            Task::Switch => switch::channels(one, options)?,
        };
        let order: Vec<&str> = diagnosis.causes.iter().map(|c| c.id.as_str()).collect();
        kept::measure(&diagnosis.kept, &order, &channels)
    };
    recordings.iter().map(of).collect()
}

fn threshold(period_s: f64) -> f64 {
    if period_s > SLOW_PERIOD_S { THRESHOLD_SLOW } else { THRESHOLD }
}

fn nothing() -> EstimateError {
    EstimateError::Other("no recording was given; name at least one log".to_owned())
}
