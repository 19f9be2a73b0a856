//! Phases of the needle, and stiffness of the sheet against its history (thesis, figures 5.13 and 5.14); and a test for
//! a sheet at all: force along the motion that nothing else explains.

use super::loading_curve::Loading;
use super::signals::Along;
use super::strokes::{Push, quiet_force};
use crate::constraint::existence::FALSE_ALARMS;
use crate::identify::limits::MOST_FIT_ROWS;
use crate::regression::linear::least_squares;
use crate::regression::long_run_variance::{HALF_INTERVAL, student_quantile_975};
use foundation::estimate::{Existence, Phase, StrokePhase};
use foundation::signal::task::{smooth, times};
use haptics::recording::Recording;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::ops::Range;

/// Least depth at which force over depth has a meaning, as a share of the dent.
/// Choice: halved or doubled, none of 15 answers changes.
const LEAST_DEPTH: f64 = 0.06;
/// Way back of a needle from which it is drawn out, as a share of the dent.
/// Choice: halved or doubled, none of 15 answers changes.
const BACK: f64 = 0.06;

/// Phases of every push, in order of time.
pub fn phases(along: &Along, pushes: &[Push], loading: &Loading, recording: &Recording) -> Vec<StrokePhase> {
    let surface = loading.surface_m;
    let quiet = quiet_force(along);
    let time = |i: usize| recording.time_s.as_ref().map_or(i as f64, |t| t[i.min(t.len() - 1)]);
    // A single noisy sample crosses the surface too early and is the deepest of all.
    let calm_m = smooth(&times(recording), &along.depth_m).value;
    let calm_n = smooth(&times(recording), &along.force_n).value;
    let mut found: Vec<StrokePhase> = Vec::new();
    let mut add = |phase: Phase, samples: Range<usize>, dent_m: f64| {
        if samples.is_empty() {
            return;
        }
        let deep: Vec<usize> = samples.clone().filter(|&i| along.depth_m[i] - surface > LEAST_DEPTH * dent_m).collect();
        let stiffness = deep.iter().map(|&i| (along.force_n[i] - quiet) / (along.depth_m[i] - surface)).sum::<f64>()
            / deep.len().max(1) as f64;
        found.push(StrokePhase {
            phase,
            t0: time(samples.start),
            t1: time(samples.end - 1),
            stiffness_n_m: (phase != Phase::Free && !deep.is_empty()).then_some(stiffness),
            deepest_m: samples.map(|i| along.depth_m[i] - surface).fold(f64::MIN, f64::max),
        });
    };
    for push in pushes {
        let inside = |i: &usize| calm_m[*i] > surface;
        let start = push.samples.start;
        let met = (start..push.samples.end).find(inside).unwrap_or(push.samples.end);
        add(Phase::Free, start..met, push.dent_m);
        add(Phase::Insertion, met..push.samples.end, push.dent_m);
        let deepest = push.end.max(push.samples.end);
        let hold_end = along.holds[push.hold].end;
        // A hand at rest trembles about the deepest point: the needle counts as drawn out after it has come back by
        // more. This is the needle's own way: the pads yield when the friction of the hole reverses.
        let depth_m = |i: usize| calm_m[i] - along.give_m_n.0 * calm_n[i];
        let back = |i: &usize| depth_m(*i) < depth_m(deepest - 1) - BACK * push.dent_m;
        let turned = (deepest..hold_end).find(back).unwrap_or(hold_end);
        let pressing = if push.puncture.is_some() { Phase::Penetration } else { Phase::Insertion };
        add(pressing, push.samples.end..turned, push.dent_m);
        let out = (turned..hold_end).find(|i| !inside(i)).unwrap_or(hold_end);
        add(Phase::Extraction, turned..out, push.dent_m);
    }
    found
}

/// Mean force beyond the surface against that before it, the needle held: autocorrelation counts.
pub fn existence(along: &Along, pushes: &[Push], loading: &Loading) -> Option<Existence> {
    let loaded = |i: usize| pushes.iter().any(|p| p.samples.contains(&i)) && along.depth_m[i] > loading.surface_m;
    let held: Vec<usize> = along.holds.iter().flat_map(Clone::clone).collect();
    let rows: Vec<usize> = held.iter().copied().step_by((held.len() / MOST_FIT_ROWS).max(1)).collect();
    let outside = |i: usize| along.depth_m[i] < loading.surface_m;
    let rows: Vec<usize> = rows.into_iter().filter(|&i| loaded(i) || outside(i)).collect();
    let inside: Vec<f64> = rows.iter().map(|&i| f64::from(u8::from(loaded(i)))).collect();
    let force: Vec<f64> = rows.iter().map(|&i| along.force_n[i]).collect();
    let fit = least_squares(&[inside.clone(), vec![1.0; rows.len()]], &force, None).ok()?;
    if !fit.identified[0] {
        return None;
    }
    let freedom = (0.4 * fit.effective_samples.powf(2.0 / 3.0)).max(3.0);
    let error = fit.std_errors[0] / (student_quantile_975(freedom) / HALF_INTERVAL).max(1.0);
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    let p_value = 2.0 * (1.0 - student.cdf(fit.values[0].abs() / error.max(f64::MIN_POSITIVE)));
    let rms = (force.iter().zip(&inside).map(|(f, i)| i * (f - fit.values[1]).powi(2)).sum::<f64>()
        / inside.iter().sum::<f64>().max(1.0))
    .sqrt();
    Some(Existence {
        exists: (p_value < FALSE_ALARMS).then_some(true),
        p_value,
        false_alarm_rate: FALSE_ALARMS,
        unexplained_n: fit.values[0],
        std_error_n: error,
        unexplained_rms_n: rms,
        detectable_n: (student.inverse_cdf(1.0 - 0.5 * FALSE_ALARMS) + 1.645) * error,
        effective_samples: fit.effective_samples,
        direction: "tangential".to_owned(),
    })
}
