//! Offset of a mechanism's force sensor at rest without touch. A sensor bias is present there. Friction by direction, a
//! slope or a preload is not.
//!
//! Without other evidence, a recording counts as untouched at its beginning and end if position and force stay within
//! their noise there. A hand that holds on trembles, and would have to hold equally hard both times.

use crate::diagnose::answer::named::Named;
use crate::diagnose::contract::{Alternative, Cause, NextExperiment};
use crate::diagnose::data::limits::{FEWEST, SETTLING_S, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Track, Zero};
use crate::diagnose::data::row_means::mean_and_error;
use crate::diagnose::experiment::proposal::{SURE_HUNG, power};
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{force_bias, friction_asymmetry, gravity_tilt};
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::noise::{quantum, white_noise};
use haptics::law::Coordinate;
use haptics::recording::Recording;

/// Agreement of a rest with a value, as a share of the constant.
/// Choice: no case of the ablation reads it.
const SHARE: f64 = 0.15;

/// Evidence from the rests of all recordings on the constant force that a study estimated.
pub fn told(study: &ChannelFit, recordings: &[Recording]) -> Zero {
    let is_constant =
        |c: &Candidate| matches!((c.id, c.linear[0].0), (force_bias::ID, "b") | (friction_asymmetry::ID, "dFc"));
    let Some(constant) = study.found().iter().rfind(|(c, _)| is_constant(c)).map(|(_, values)| values[0]) else {
        return Zero::Open;
    };
    let mut said = recordings.iter().map(|r| rest(r).map_or(Zero::Open, |rest| compared(constant, rest)));
    let first = said.next().unwrap_or_default();
    if said.all(|other| other == first) { first } else { Zero::Open }
}

fn compared(constant: f64, (mean, error): (f64, f64)) -> Zero {
    let near = |value: f64| (mean - value).abs() <= (SIGNIFICANT * error).max(SHARE * constant.abs());
    match (near(0.0), near(constant)) {
        (true, false) => Zero::OfThePlant,
        (false, true) => Zero::OfTheSensor,
        _ => Zero::Open,
    }
}

/// Adds the question that stays open about a constant force after the rests, and the experiment for it.
pub fn ask(found: &mut Named, track: &Track) {
    /// Expected power below which a proposed experiment asks for rests as well.
    /// Choice: no case of the ablation reads it.
    const LEAST_POWER: f64 = 0.05;
    let by_direction = |c: &&Cause| c.id == friction_asymmetry::ID && c.parameters.iter().any(|p| p.name == "dFc");
    if track.zero == Zero::OfThePlant && track.coordinate == Coordinate::Linear {
        let Some(posterior) = found.causes.iter().find(by_direction).map(|c| 0.5 * c.posterior) else { return };
        found.causes.iter_mut().filter(|c| by_direction(&&**c)).for_each(|c| c.posterior = posterior);
        found.alternatives.push(Alternative {
            id: gravity_tilt::ID.to_owned(),
            instead_of: friction_asymmetry::ID.to_owned(),
            posterior,
            why: "along a line a slope is the same constant force, and the sensor reads nothing of it where nobody holds on".to_owned(),
        });
        let motion = "turn the track round and move along it again: what a slope pulls changes its sign";
        let separates = [friction_asymmetry::ID, gravity_tilt::ID].map(str::to_owned).to_vec();
        found.next.get_or_insert_with(|| NextExperiment::in_words(motion, separates, SURE_HUNG));
        return;
    }
    let constant =
        found.causes.iter().find(|c| c.id == force_bias::ID).and_then(|c| c.parameters.first()).map(|b| b.value);
    let (Some(next), Some(size)) = (&mut found.next, constant) else { return };
    let of_both = [force_bias::ID, friction_asymmetry::ID].iter().all(|id| next.separates.iter().any(|s| s == id));
    if of_both && next.expected_power < LEAST_POWER {
        let lambda = 2.0 * FREE_S / track.period_s * (size / track.force_noise.max(f64::MIN_POSITIVE)).powi(2);
        "let go of it for two seconds before and after moving it: a bias of the sensor is read then as well"
            .clone_into(&mut next.motion);
        next.expected_power = SURE_HUNG * power(lambda);
        next.experiment = None;
    }
}

/// Mean force without touch at both ends, and its standard error; `None` if an end moves, or the two differ.
fn rest(recording: &Recording) -> Option<(f64, f64)> {
    let [place, force] =
        [["q_m", "q_rad"], ["f_N", "tau_Nm"]].map(|names| names.iter().find_map(|n| recording.channel(n)));
    let (place, force, time) = (place?, force?, recording.time_s.as_ref()?);
    let n = time.len().min(force.len()).min(place.len());
    let period_s = (time.last()? - time.first()?) / n.saturating_sub(1).max(1) as f64;
    let length = ((SETTLING_S / period_s).round() as usize).max(FEWEST);
    // The noise is autocorrelated, so means of windows stay within the noise of a single sample.
    let noise = |values: &[f64]| white_noise(values).max(quantum(values));
    let (still, quiet) = (noise(place), noise(force));
    let means = |values: &[f64], backwards: bool| -> Vec<f64> {
        let mean = |w: &[f64]| w.iter().sum::<f64>() / w.len() as f64;
        if backwards {
            values.rchunks_exact(length).map(mean).collect()
        } else {
            values.chunks_exact(length).map(mean).collect()
        }
    };
    let end = |backwards: bool| -> Option<(f64, f64)> {
        let (place, force) = (means(&place[..n], backwards), means(&force[..n], backwards));
        let stays = |k: usize| (place[k] - place[0]).abs() <= still && (force[k] - force[0]).abs() <= quiet;
        let count = (0..place.len()).take_while(|k| stays(*k)).count();
        // The last window may be partly in motion.
        let rest = &force[..count.saturating_sub(1)];
        if rest.len() < FEWEST {
            return None;
        }
        Some(mean_and_error(rest))
    };
    let ((a, da), (b, db)) = (end(false)?, end(true)?);
    let error = da.hypot(db).max(0.1 * quiet);
    ((a - b).abs() <= SIGNIFICANT * error).then_some((0.5 * (a + b), 0.5 * error))
}
