//! The whole way from recordings to a calibrated world, for the command line, the app and the tests alike.

use crate::agreement::{self, average, disagreement_about};
use crate::calibrate;
use crate::identify::{barrel, block, crank, mechanism, needle, payload, priors, switch};
use crate::plausible;
use crate::segment::score::score;
use crate::segment::{Method, Segmentation, segment_by, task_of};
use crate::zero_jumps;
use foundation::cancellation;
use foundation::estimate::{EstimateError, Fit};
use foundation::tasks::Thresholds;
use haptics::recording::{Recording, Task};
use haptics::world::World;
use std::sync::OnceLock;

/// Options of the user.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The task; told from sidecar and columns when absent.
    pub task: Option<Task>,
    /// Thresholds; chosen from the noise when absent.
    pub thresholds: Option<Thresholds>,
    /// Method of segmentation.
    pub method: Method,
}

/// Everything that one or several recordings of the same object show.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// The task they were read as.
    pub task: Task,
    /// Parameters and constraints.
    pub fit: Fit,
    /// Segmentation of every recording, where there is one (a clockless path has none).
    pub segmentations: Vec<Option<Segmentation>>,
    /// A world with the fitted values.
    pub world: World,
}

/// Part of the analysis of recordings that does not depend on the options: an analysis that shares it with the one
/// before takes a fraction of the time. It belongs to its recordings, in their order.
#[derive(Default)]
pub struct Prepared {
    cranks: OnceLock<Vec<crank::Prepared>>,
}

/// Segments, fits and calibrates. All recordings must be of one task and one object.
pub fn analyse(recordings: &[Recording], options: &Options) -> Result<Analysis, EstimateError> {
    analyse_prepared(recordings, &Prepared::default(), options)
}

/// [`analyse`] for the second time and on: `prepared` keeps the first one's results for the same recordings. Jumps of a force
/// sensor's zero are taken out, with a warning.
pub fn analyse_prepared(
    recordings: &[Recording],
    prepared: &Prepared,
    options: &Options,
) -> Result<Analysis, EstimateError> {
    let mut found = analyse_as_recorded(recordings, prepared, options)?;
    if matches!(found.task, Task::Mechanism | Task::Payload) {
        // A mechanism need not be let go: its fit looks for the step itself. A payload is never without its load.
        return Ok(found);
    }
    let jumps = zero_jumps::find(recordings, &found.segmentations);
    if let Some(others) = zero_jumps::taken_out(recordings, &jumps) {
        found = analyse_as_recorded(&others, &Prepared::default(), options)?;
    }
    found.fit.warnings.extend(jumps.iter().map(|jump| zero_jumps::said(jump, recordings)));
    Ok(found)
}

fn analyse_as_recorded(
    recordings: &[Recording],
    prepared: &Prepared,
    options: &Options,
) -> Result<Analysis, EstimateError> {
    let first = recordings
        .first()
        .ok_or_else(|| EstimateError::Other("no recording was given; name at least one log".to_owned()))?;
    let task = task_of(first, options.task)?;
    for recording in &recordings[1..] {
        let other = task_of(recording, options.task)?;
        if other != task {
            return Err(EstimateError::Other(format!(
                "{} is of the task {} and {} of {}; fit them one after the other",
                first.name,
                task.name(),
                recording.name,
                other.name()
            )));
        }
    }
    let (mut fit, mut segmentations) = match task {
        Task::BlockStack if recordings.len() > 1 => blocks(recordings, options)?,
        Task::BlockStack => each(recordings, |r| block::fit_by(options.method, r, options.thresholds))?,
        Task::Crank => cranks(recordings, prepared, options)?,
        Task::Mechanism => (mechanisms(recordings)?, states(recordings, task, options)),
        Task::Needle => {
            let fits = recordings.iter().map(needle::fit).collect::<Result<Vec<_>, _>>()?;
            (average(&fits), states(recordings, task, options))
        }
        Task::Switch => {
            let fits = recordings.iter().map(switch::fit).collect::<Result<Vec<_>, _>>()?;
            (average(&fits), states(recordings, task, options))
        }
        Task::Payload => {
            let fits = recordings.iter().map(payload::fit).collect::<Result<Vec<_>, _>>()?;
            (average(&fits), states(recordings, task, options))
        }
        Task::Barrel => each(recordings, |r| barrel::fit_by(options.method, r, options.thresholds))?,
    };
    doubt(&mut fit);
    plausible::doubt(&mut fit);
    priors::apply(&mut fit, &first.meta);
    for (recording, found) in recordings.iter().zip(&mut segmentations) {
        if let Some(found) = found.as_mut().filter(|found| found.score.is_none()) {
            found.score = score(recording, found);
        }
    }
    let world = calibrate::world(task, recordings, &fit, &segmentations);
    cancellation::check()?;
    Ok(Analysis { task, fit, segmentations, world })
}

/// Largest ratio of the two estimates of the same error: a larger one means too few independent segments for either.
const DOUBTFUL: f64 = 2.0;

/// Replaces an error by that of the bootstrap, with a warning, if that is much larger than the covariance says.
fn doubt(fit: &mut Fit) {
    for parameter in &mut fit.parameters {
        let (Some(error), Some(resampled)) = (parameter.std_error, parameter.bootstrap_error) else { continue };
        if resampled > DOUBTFUL * error {
            parameter.std_error = Some(resampled);
            fit.warnings.push(format!(
                "the error of {} {} is {:.1} times as large by resampling as by covariance: the larger one is given; a longer \
                 recording would settle it",
                parameter.object,
                parameter.name,
                resampled / error
            ));
        }
    }
}

/// The states of recordings whose fit does not need them, where they can be told.
fn states(recordings: &[Recording], task: Task, options: &Options) -> Vec<Option<Segmentation>> {
    recordings.iter().map(|r| segment_by(options.method, r, Some(task), options.thresholds).ok()).collect()
}

type Fitted = (Fit, Vec<Option<Segmentation>>);

/// Fits every recording by itself and combines the parameters.
fn each(
    recordings: &[Recording],
    fit: impl Fn(&Recording) -> Result<(Fit, Segmentation), EstimateError>,
) -> Result<Fitted, EstimateError> {
    let mut fits = Vec::new();
    let mut segmentations = Vec::new();
    for recording in recordings {
        let (one, segmentation) = fit(recording)?;
        fits.push(one);
        segmentations.push(Some(segmentation));
    }
    Ok((average(&fits), segmentations))
}

/// One or several recordings of a crank: geometry from each, the laws from all of them at once.
fn cranks(recordings: &[Recording], prepared: &Prepared, options: &Options) -> Result<Fitted, EstimateError> {
    let prepared = if let Some(made) = prepared.cranks.get() {
        made
    } else {
        let made = recordings.iter().map(crank::Prepared::of).collect::<Result<Vec<_>, _>>()?;
        // They are kept for the next fit: only whole ones.
        cancellation::check()?;
        prepared.cranks.get_or_init(|| made)
    };
    let together = crank::refit_jointly(options.method, recordings, prepared, options.thresholds)?;
    let mut fit = average(&together.fits);
    if recordings.len() > 1 {
        for shared in together.shared {
            match fit.parameters.iter_mut().find(|p| p.object == shared.object && p.name == shared.name) {
                Some(average) => *average = shared,
                None => fit.parameters.push(shared),
            }
        }
        fit.correlated = vec![together.correlated];
    }
    Ok((fit, together.segmentations.into_iter().map(Some).collect()))
}

/// One or several recordings of a mechanism: one fit of all of them. Each alone says if they are of the same object.
fn mechanisms(recordings: &[Recording]) -> Result<Fit, EstimateError> {
    let mut fit = mechanism::fit(recordings)?;
    if recordings.len() > 1 {
        // One that shows nothing alone adds to the others.
        let alone: Vec<Fit> =
            recordings.iter().filter_map(|one| mechanism::fit(std::slice::from_ref(one)).ok()).collect();
        agreement::check(&mut fit, &alone);
    }
    Ok(fit)
}

/// Several recordings of the same blocks: heights and friction from each, weights, widths and pads from all of them at once.
fn blocks(recordings: &[Recording], options: &Options) -> Result<Fitted, EstimateError> {
    let together = block::fit_jointly(options.method, recordings, options.thresholds)?;
    let mut fit = average(&together.fits);
    for shared in together.shared {
        // Blocks that are not the same have no common value; the average says how far they lie apart.
        let said = disagreement_about(&shared.full_name());
        if fit.warnings.iter().any(|w| w.starts_with(&said)) {
            continue;
        }
        match fit.parameters.iter_mut().find(|p| p.object == shared.object && p.name == shared.name) {
            Some(average) => *average = shared,
            None => fit.parameters.push(shared),
        }
    }
    fit.correlated = together.correlated;
    let warnings = &fit.warnings;
    let alike = |name: &String| !warnings.iter().any(|w| w.starts_with(&disagreement_about(name)));
    fit.correlated.retain(|c| c.parameters.iter().all(alike));
    Ok((fit, together.segmentations.into_iter().map(Some).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_to_fit_is_a_sentence() {
        assert!(analyse(&[], &Options::default()).expect_err("no recording").to_string().contains("no recording"));
    }
}
