//! Scale of the lengths from free fall, whose acceleration is g.

use crate::diagnose::contract::{Alternative, Cause, Gain, RolloutOf, parameter};
use crate::diagnose::data::limits::ASSUMED_ERROR;
use crate::diagnose::free_run::windows::{Compared, Errors, told};
use crate::diagnose::hypotheses::{channel_fault, length_scale};
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use crate::diagnose::selection::normal_equations::LOCKED_EVERY;
use crate::diagnose::selection::rules::THRESHOLD;
use crate::diagnose::tasks::thrown_body::powers;
use estimation::identify::tossed::Tossed;
use estimation::identify::tossed::flight::{Fall, end, least};
use estimation::identify::tossed::pose::Track;
use haptics::law::Kind;
use nalgebra::DVector;

/// Before anything is seen: clocks are off by this share (a crystal by far less; one standard deviation, generously).
/// Choice: halved or doubled, none of 3 answers changes.
const CLOCKS: f64 = 1e-3;

/// The scale as a cause, with a clock error as its alternative; `None` if the fall agrees with gravity.
pub fn scale(seen: &Tossed, gravity_m_s2: f64) -> Option<(Cause, Alternative)> {
    let (value, error) = (seen.fall.down_m_s2 / gravity_m_s2 - 1.0, seen.fall.error_m_s2 / gravity_m_s2);
    let lambda = (value / error).powi(2);
    if lambda - (seen.fall.throws as f64).ln() < THRESHOLD {
        return None;
    }
    // A relative clock error δ changes the acceleration by 2 δ.
    let likely =
        |spread: f64, at: f64| (-0.5 * at * at / (spread * spread + error * error)).exp() / spread.hypot(error);
    let (length, clock) = (likely(ASSUMED_ERROR, value), likely(CLOCKS, 0.5 * value));
    let posterior = length / (length + clock);
    let cause = Cause {
        id: length_scale::ID.to_owned(),
        kind: Kind::Instrument,
        parameters: vec![parameter("epsilon", value, error, "1")],
        p_value: chi_square_tail(lambda, 1.0),
        posterior,
        standing: None,
        gain: held_out(&seen.tracks, gravity_m_s2),
        evidence: format!(
            "in {} flights the body falls with {:.3} ± {:.3} m/s² where gravity is {gravity_m_s2}: lengths are recorded {:+.2} % off",
            seen.fall.throws,
            seen.fall.down_m_s2,
            seen.fall.error_m_s2,
            100.0 * value
        ),
    };
    let other = Alternative {
        id: channel_fault::ID.to_owned(),
        instead_of: length_scale::ID.to_owned(),
        posterior: 1.0 - posterior,
        why: format!(
            "a clock that is {:+.2} % off makes the same fall; clocks are rarely off by so much (0.1 % was assumed, 2 % for lengths)",
            100.0 * ((1.0 + value).recip().sqrt() - 1.0)
        ),
    };
    Some((cause, other))
}

/// Residual RMS of the heights of all flights: with standard gravity, with their common fall, and with each one's own,
/// m.
pub fn left_m(seen: &Tossed, gravity_m_s2: f64) -> [f64; 3] {
    let squares = squares(&seen.tracks, [gravity_m_s2, seen.fall.down_m_s2]);
    let sum = squares.iter().fold([0.0; 4], |a, s| std::array::from_fn(|k| a[k] + s[k]));
    [0, 1, 2].map(|k| (sum[k] / sum[3].max(1.0)).sqrt())
}

/// Residual sums of squares of the heights of each flight with two accelerations and with its own, m², and its rows.
/// Flights with a blow that was not seen say nothing: they stray from their own parabolas far more than others do.
fn squares(tracks: &[Track], [first, second]: [f64; 2]) -> Vec<[f64; 4]> {
    let flights = tracks.iter().map(|t| (t, end(t))).filter(|(t, n)| *n >= least(t));
    let of = |(track, n): (&Track, usize)| {
        let [by_first, by_second, own] = [Some(first), Some(second), None].map(|down| left(track, n, down));
        [by_first, by_second, own, n as f64]
    };
    let squares: Vec<[f64; 4]> = flights.map(of).collect();
    let mut own: Vec<f64> = squares.iter().map(|s| s[2] / s[3]).collect();
    own.sort_by(f64::total_cmp);
    let usual = 9.0 * own.get(own.len() / 2).copied().unwrap_or(f64::INFINITY);
    squares.into_iter().filter(|s| s[2] / s[3] <= usual).collect()
}

/// Heights of held-out flights, with gravity and with the acceleration of the others.
fn held_out(tracks: &[Track], gravity_m_s2: f64) -> Gain {
    let (mut others, mut tested) = (Vec::new(), Vec::new());
    for (k, track) in tracks.iter().enumerate() {
        if k % LOCKED_EVERY == LOCKED_EVERY - 1 { &mut tested } else { &mut others }.push(track.clone());
    }
    let Some(fall) = Fall::of(&others) else { return Gain::default() };
    let squares = squares(&tested, [gravity_m_s2, fall.down_m_s2]);
    let share = |of: &mut dyn Iterator<Item = &[f64; 4]>| {
        let sum = of.fold([0.0; 4], |a, s| std::array::from_fn(|k| a[k] + s[k]));
        (((sum[0] - sum[1]) / (sum[0] - sum[2]).max(1e-3 * sum[0]).max(1e-300)).min(1.0), sum)
    };
    let (all, sum) = share(&mut squares.iter());
    // A flight is tied to the measurement only by its start, which is fitted.
    let mean_s = tracks.iter().map(|t| t.time_s[end(t).max(1) - 1] - t.time_s[0]).sum::<f64>() / tracks.len() as f64;
    let what = Compared { of: RolloutOf::Position, unit: "m", window_s: mean_s, in_turn: false };
    let errors: Vec<[Errors; 2]> = squares.iter().map(|s| [(s[0], s[3]), (s[1], s[3])]).collect();
    let forward = told(&what, &errors);
    // Leaving out one flight after the other (jackknife).
    let n = squares.len() as f64;
    let parts: Vec<f64> = (0..squares.len())
        .map(|k| share(&mut squares.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, s)| s)).0)
        .collect();
    let mean = parts.iter().sum::<f64>() / n.max(1.0);
    let spread = ((n - 1.0).max(0.0) / n.max(1.0) * parts.iter().map(|p| (p - mean).powi(2)).sum::<f64>()).sqrt();
    Gain {
        heldout_rms_before: (sum[0] / sum[3].max(1.0)).sqrt(),
        heldout_rms_after: (sum[1] / sum[3].max(1.0)).sqrt(),
        share_of_explainable: all,
        interval: [all - 1.96 * spread, (all + 1.96 * spread).min(1.0)],
        unit: Some("m".to_owned()),
        ..Gain::default()
    }
    .run(forward)
}

/// Residual sum of squares of a flight's heights for an acceleration (or its own), with position and speed fitted, m².
fn left(track: &Track, n: usize, down_m_s2: Option<f64>) -> f64 {
    let since = |i: usize| track.time_s[i] - track.time_s[0];
    let size = if down_m_s2.is_some() { 2 } else { 3 };
    let own = powers(n, size, since).qr().q();
    let fall = down_m_s2.unwrap_or(0.0);
    let height = DVector::from_fn(n, |i, _| track.points[i].z + 0.5 * fall * since(i).powi(2));
    (&height - &own * own.tr_mul(&height)).norm_squared()
}
