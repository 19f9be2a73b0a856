//! Offset of a mechanism's force sensor at rest without touch. A sensor bias is present there. Friction by direction, a
//! slope or a preload is not.
//!
//! Without other evidence, a recording counts as untouched at its beginning and end if position and force stay within
//! their noise there. A hand that holds on trembles, and would have to hold equally hard both times.

use crate::diagnose::answer::named::Named;
use crate::diagnose::contract::{Alternative, Cause, NextExperiment};
use crate::diagnose::data::limits::{FEWEST, REST_WINDOW_S, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Track, Zero};
use crate::diagnose::experiment::proposal::{SURE_HUNG, power};
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{force_bias, friction_asymmetry, gravity_tilt};
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::noise::{quantum, white_noise};
use haptics::law::Coordinate;
use haptics::recording::Recording;

/// Agreement of a rest with a value, as a share of the constant.
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
        let lambda = 2.0 * FREE_S / track.period_s * (size / track.force_noise.max(1e-9)).powi(2);
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
    let length = ((REST_WINDOW_S / period_s).round() as usize).max(FEWEST);
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
        let mean = rest.iter().sum::<f64>() / rest.len() as f64;
        let spread = rest.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / (rest.len() - 1) as f64;
        Some((mean, (spread / rest.len() as f64).sqrt()))
    };
    let ((a, da), (b, db)) = (end(false)?, end(true)?);
    let error = da.hypot(db).max(0.1 * quiet);
    ((a - b).abs() <= SIGNIFICANT * error).then_some((0.5 * (a + b), 0.5 * error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::diagnose;
    use crate::diagnose::options::Options;
    use haptics::recording::Channel;
    use rand::RngExt as _;
    use rand::SeedableRng as _;
    use rand::rngs::StdRng;

    /// A slide of 1 kg that is moved back and forth with dry and viscous friction and a constant of 0.4 N, between
    /// rests of 1.5 s.
    fn slid(at_rest_n: f64, trembles_n: f64) -> Recording {
        let time: Vec<f64> = (0..6000).map(|i| f64::from(i) * 4e-3).collect();
        let moves = |t: f64| (1.5..22.5).contains(&t);
        let place =
            |t: f64| if moves(t) { 0.05 * (1.0 - (std::f64::consts::TAU * (t - 1.5) / 3.0).cos()) } else { 0.0 };
        let force = |t: f64| {
            if !moves(t) {
                return at_rest_n + trembles_n * (9.0 * t).sin();
            }
            let w = std::f64::consts::TAU / 3.0;
            let (s, c) = (w * (t - 1.5)).sin_cos();
            let (v, a) = (0.05 * w * s, 0.05 * w * w * c);
            a + 3.0 * v + 0.8 * v.signum() + 0.4
        };
        let mut random = StdRng::seed_from_u64(7);
        let mut of = |name: &str, unit: &str, of: &dyn Fn(f64) -> f64, size: f64| Channel {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: time.iter().map(|t| of(*t) + size * random.random_range(-1.0..1.0)).collect(),
        };
        let channels = vec![of("q_m", "m", &place, 2e-6), of("f_N", "N", &force, 0.03)];
        Recording { name: "slide".to_owned(), time_s: Some(time), channels, ..Recording::default() }
    }

    #[test]
    fn what_the_untouched_sensor_reads_tells_a_bias_from_what_is_moved() {
        let named = |recording: Recording| {
            let found = diagnose(&[recording], &Options::default()).expect("an answer");
            let others: Vec<String> = found.alternatives.iter().map(|a| a.id.clone()).collect();
            (found.causes.iter().map(|c| c.id.clone()).collect::<Vec<_>>(), others)
        };
        let (causes, others) = named(slid(0.4, 0.0));
        assert!(causes == ["force-bias"] && others.is_empty(), "{causes:?} or {others:?}");
        let (causes, others) = named(slid(0.0, 0.0));
        assert!(causes == ["friction-asymmetry"] && others == ["gravity-tilt"], "{causes:?} or {others:?}");
        // A hand that holds on gives no evidence.
        let (causes, others) = named(slid(0.0, 0.2));
        assert!(
            causes == ["force-bias"] && others.contains(&"friction-asymmetry".to_owned()),
            "{causes:?} or {others:?}"
        );
    }
}
