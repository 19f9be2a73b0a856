//! False alarms of this site: how often a diagnosis names a cause in replays that have none.

use crate::diagnose::contract::{Baseline, NamedInTwins, Twins};
use crate::diagnose::diagnose;
use crate::diagnose::findings::Findings;
use crate::diagnose::hypotheses::axis_sign;
use crate::diagnose::options::Options;
use crate::diagnose::recording::time_delay::put_back;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rayon::prelude::*;
use statrs::distribution::{Beta, ContinuousCDF};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Diagnoses replays of the recordings without any cause, and counts those with a certain one.
///
/// # Errors
/// One sentence if these recordings cannot be replayed, and that of a diagnosis that fails.
pub fn count(recordings: &[Recording], options: &Options, found: &Findings, runs: u32) -> Result<Twins, EstimateError> {
    let Some(twin) = &found.twin else { return Err(no_replays(found)) };
    let measured: Vec<Recording> = recordings.iter().map(|r| put_back(r, found.delay.corrected_s)).collect();
    let path_of = |r| found.along.as_ref().map_or(Ok(None), |along| along.path_of(r));
    let paths = measured.iter().map(path_of).collect::<Result<Vec<_>, _>>()?;
    let inner = Options { progress: <_>::default(), atlas: false, twins: false, ..options.clone() };
    let done = AtomicUsize::new(0);
    let answers: Vec<Findings> = (0..runs)
        .into_par_iter()
        .map(|run| {
            let replay = twin.replay(&measured, &paths, &mut StdRng::seed_from_u64(u64::from(run)));
            let answer = diagnose(&replay, &inner)?;
            let share = (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / f64::from(runs);
            options.progress.tell(share).map(|()| answer)
        })
        .collect::<Result<_, _>>()?;
    let remains: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).filter(|id| !twin.lacks(id)).collect();
    let mut twins = counted(&answers, &remains);
    twins.heldout_rms_n = residual(&answers, &found.baseline);
    Ok(twins)
}

/// `remains`: causes of the recordings that are in the replays, too.
fn counted(answers: &[Findings], remains: &[&str]) -> Twins {
    let names: Vec<Vec<&str>> = answers
        .iter()
        .map(|answer| {
            let certain = answer.certain().into_iter().map(|c| c.id.as_str());
            certain.filter(|id| !remains.contains(id) && !id.starts_with("other:")).collect()
        })
        .collect();
    let mut by_cause: Vec<NamedInTwins> = Vec::new();
    for id in names.iter().flatten() {
        if by_cause.iter().all(|n| n.id != *id) {
            let runs = names.iter().filter(|own| own.contains(id)).count();
            by_cause.push(NamedInTwins { id: (*id).to_owned(), runs });
        }
    }
    by_cause.sort_by(|a, b| b.runs.cmp(&a.runs).then_with(|| a.id.cmp(&b.id)));
    let named = names.iter().filter(|own| !own.is_empty()).count();
    Twins {
        runs: answers.len(),
        named,
        interval: interval(named, answers.len()),
        by_cause,
        heldout_rms_n: 0.0,
        heldout_rms_nm: None,
    }
}

/// Median residual of the base model in the replays whose answer is about the same channel.
fn residual(answers: &[Findings], measured: &Baseline) -> f64 {
    let same = answers.iter().map(|a| &a.baseline).filter(|b| (&b.of, &b.unit) == (&measured.of, &measured.unit));
    let mut residuals: Vec<f64> = same.map(|b| b.heldout_rms_n).collect();
    residuals.sort_by(f64::total_cmp);
    residuals.get(residuals.len() / 2).copied().unwrap_or(0.0)
}

/// 95 % interval of a share (Clopper & Pearson 1934).
fn interval(hits: usize, of: usize) -> [f64; 2] {
    let (k, n) = (hits as f64, of as f64);
    let bound = |a: f64, b: f64, p: f64| Beta::new(a, b).ok().map(|beta| beta.inverse_cdf(p));
    // A share of none or of all has no lower or no upper bound.
    [bound(k, n - k + 1.0, 0.025).unwrap_or(0.0), bound(k + 1.0, n - k, 0.975).unwrap_or(1.0)]
}

/// The reason why recordings cannot be replayed.
fn no_replays(found: &Findings) -> EstimateError {
    let axis = found.causes.iter().find(|c| c.id == axis_sign::ID && c.standing.is_none());
    EstimateError::Other(match axis {
        Some(cause) => format!(
            "--twin needs a recording with true axes, and this one has a fault: {}; correct it in the sidecar and repeat",
            cause.evidence
        ),
        None => "--twin replays cranks, driven mechanisms, carried blocks, needles and switches; of other tasks, and of motions without a force, there are no replays yet".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_exact() {
        let near = |got: [f64; 2], wanted: [f64; 2]| {
            assert!(got.iter().zip(wanted).all(|(g, w)| (g - w).abs() < 1e-4), "{got:?} {wanted:?}");
        };
        // 0 of 20 and 20 of 20: 1 - 0.025^(1/20).
        near(interval(0, 20), [0.0, 0.168_43]);
        near(interval(20, 20), [0.831_57, 1.0]);
        near(interval(1, 20), [0.001_27, 0.248_73]);
        near(interval(0, 0), [0.0, 1.0]);
    }
}
