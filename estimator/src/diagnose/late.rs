//! A force that comes late by more than a row: a straight line in the delay is then no good, so the force is put back to when it was, by what
//! was found, and all is asked again (Gauss and Newton's step with the recording itself).

use super::report::{Cause, Diagnosis, Verdict};
use crate::estimate::EstimateError;
use crate::signal::derive::interpolate;
use haptics::recording::{Recording, Span};

/// A delay up to this is as good as proportional, s.
const LINEAR_S: f64 = 6e-3;
/// What is less than this of it is settled, s.
const SETTLED_S: f64 = 5e-4;
/// Most rounds.
const ROUNDS: usize = 5;
/// The cause.
const ID: &str = "time-delay";

/// Asks again with the force where it belongs, as long as a large delay is found; then says all of it.
pub fn undo(
    recordings: &[Recording],
    first: Diagnosis,
    ask: &dyn Fn(&[Recording]) -> Result<Diagnosis, EstimateError>,
) -> Diagnosis {
    let Some(mut late_s) = delay_s(&first).filter(|tau| tau.abs() > LINEAR_S) else { return first };
    let mut found = None;
    for _ in 0..ROUNDS {
        let back: Vec<Recording> = recordings.iter().map(|r| put_back(r, late_s)).collect();
        // Where nothing sensible is left the first answer stands.
        let Ok(now) = ask(&back) else { return first };
        let more = now.rest_s.map_or(0.0, |[more, _]| more);
        found = Some(now);
        if more.abs() < SETTLED_S {
            break;
        }
        late_s += more;
    }
    found.map_or_else(|| first.clone(), |found| with_delay(found, &first, late_s))
}

/// The delay that an answer names, s.
fn delay_s(found: &Diagnosis) -> Option<f64> {
    found.causes.iter().find(|c| c.id == ID)?.parameters.first().map(|p| p.value)
}

/// The recording with its forces so much earlier, without the end that has none then.
pub fn put_back(recording: &Recording, late_s: f64) -> Recording {
    let Some(time_s) = recording.time_s.as_ref().filter(|t| t.len() > 2 && late_s != 0.0) else {
        return recording.clone();
    };
    let inside = |t: &f64| *t + late_s >= time_s[0] && *t + late_s <= time_s[time_s.len() - 1];
    let (Some(first), Some(last)) = (time_s.iter().position(inside), time_s.iter().rposition(inside)) else {
        return recording.clone();
    };
    let later: Vec<f64> = time_s.iter().map(|t| t + late_s).collect();
    let mut moved = recording.clone();
    for channel in moved.channels.iter_mut().filter(|c| is_force(&c.name)) {
        channel.values = interpolate(time_s, &channel.values, &later);
    }
    moved.slice(Span { first, end: last + 1 })
}

fn is_force(name: &str) -> bool {
    name.split('_').next().is_some_and(|quantity| {
        let of = quantity.trim_end_matches(['1', '2']);
        ["f", "fx", "fy", "fz", "tau"].contains(&of)
    })
}

/// The answer about the recording as it should have been, with the delay that it has.
fn with_delay(mut found: Diagnosis, first: &Diagnosis, late_s: f64) -> Diagnosis {
    let Some(place) = first.causes.iter().position(|c| c.id == ID) else { return found };
    let mut cause: Cause = first.causes[place].clone();
    let error = found.rest_s.map(|[_, error]| error);
    if let Some(tau) = cause.parameters.first_mut() {
        tau.value = late_s;
        tau.std_error = error.unwrap_or(tau.std_error);
    }
    let (before, after, floor) = (cause.gain.heldout_rms_before, found.end.heldout_rms_n, found.noise_floor_n);
    let power = (before * before - floor * floor).max(1e-3 * before * before);
    let share = ((before * before - after * after) / power).clamp(-1.0, 1.0);
    cause.gain.heldout_rms_after = after;
    cause.gain.share_of_explainable = share;
    cause.gain.interval = [cause.gain.interval[0].min(share), cause.gain.interval[1].max(share)];
    cause.posterior = 1.0;
    found.causes.retain(|c| c.id != ID);
    found.alternatives.retain(|a| a.instead_of != ID && a.id != ID);
    found.not_excited.retain(|n| n.id != ID);
    found.passed_over.retain(|p| p.id != ID);
    found.causes.insert(place.min(found.causes.len()), cause);
    if matches!(found.verdict, Verdict::None | Verdict::Unexplained) {
        found.verdict = Verdict::Causes;
    }
    found.baseline = first.baseline.clone();
    found.late_s = late_s;
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    #[test]
    fn forces_are_put_back_and_motion_stays() {
        let time_s: Vec<f64> = (0..1000).map(|k| 0.002 * f64::from(k)).collect();
        let of = |name: &str, late_s: f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: time_s.iter().map(|t| (3.0 * (t - late_s)).sin()).collect(),
        };
        let channels = vec![of("x_m", 0.0), of("fx_N", 0.031), of("tau_Nm", 0.031)];
        let recording = Recording { time_s: Some(time_s.clone()), channels, ..Recording::default() };
        let back = put_back(&recording, 0.031);
        assert_eq!(back.len(), 1000 - 16);
        for channel in &back.channels {
            let off = |(t, v): (&f64, &f64)| (v - (3.0 * t).sin()).abs();
            let worst = back.time_s.as_ref().expect("times").iter().zip(&channel.values).map(off).fold(0.0, f64::max);
            assert!(worst < 1e-5, "{}: {worst}", channel.name);
        }
    }
}
