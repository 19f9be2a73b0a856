//! Moving parts of a free motion: a mechanism at rest is held by dry friction, anywhere up to its level, and tells
//! nothing of the laws.

use super::signals::Raw;
use crate::identify::limits::{CLEARLY_SIGNIFICANT, LEAST_LINE_ROWS, LEAST_SEGMENT_ROWS};
use foundation::signal::noise::{quantum, white_noise_under_fast_motion};
use std::ops::Range;

/// Length of the windows in which samples are looked at, s.
/// Choice: no case of the ablation reads it.
const STANDING_WINDOW_S: f64 = 0.1;
/// Least number of windows in a row that are a standstill; fewer are a turn of the motion.
/// Choice: no case of the ablation reads it.
const LEAST_WINDOWS: usize = 3;

/// The recordings without their standstills, each moving segment by itself, and whether there was any standstill. They
/// stay as they are if nothing would remain.
pub(super) fn split_by_motion(raws: &[Raw]) -> (Vec<Raw>, bool) {
    let mut parts = Vec::new();
    let mut stood = false;
    for raw in raws {
        let ranges = ranges(raw);
        stood |= ranges.len() != 1 || ranges.first().is_some_and(|r| r.len() < raw.time_s.len());
        parts.extend(ranges.into_iter().filter(|r| r.len() >= LEAST_SEGMENT_ROWS).map(|range| part(raw, range)));
    }
    if parts.is_empty() { (raws.to_vec(), false) } else { (parts, stood) }
}

fn part(raw: &Raw, range: Range<usize>) -> Raw {
    let of = |values: &Vec<f64>| values[range.clone()].to_vec();
    Raw {
        coordinate: raw.coordinate,
        time_s: of(&raw.time_s),
        position: of(&raw.position),
        rate: raw.rate.as_ref().map(of),
        force: raw.force.as_ref().map(of),
        up_along: raw.up_along.as_ref().map(of),
        saturated: raw.saturated[range.clone()].to_vec(),
    }
}

/// Samples of the moving segments.
fn ranges(raw: &Raw) -> Vec<Range<usize>> {
    let n = raw.position.len();
    let period_s = (raw.time_s[n - 1] - raw.time_s[0]) / n.saturating_sub(1).max(1) as f64;
    let length = ((STANDING_WINDOW_S / period_s).round() as usize).max(LEAST_LINE_ROWS);
    let noise = white_noise_under_fast_motion(&raw.position).max(0.5 * quantum(&raw.position));
    let stands: Vec<bool> = raw.position.chunks_exact(length).map(|window| is_still(window, noise)).collect();
    let mut moving = Vec::new();
    let mut begin = 0;
    let mut at = 0;
    for run in stands.chunk_by(|a, b| a == b) {
        let (first, end) = (at * length, (at + run.len()) * length);
        at += run.len();
        if run[0] && run.len() >= LEAST_WINDOWS {
            if first > begin {
                moving.push(begin..first);
            }
            begin = end;
        }
    }
    // The last incomplete window belongs to its neighbour.
    let last_stands = begin > 0 && begin == stands.len() * length;
    if begin < n && !last_stands {
        moving.push(begin..n);
    }
    moving
}

fn is_still(window: &[f64], noise: f64) -> bool {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (early, late) = window.split_at(window.len() / 2);
    let middle = mean(window);
    let allowed = CLEARLY_SIGNIFICANT * noise * (4.0 / window.len() as f64).sqrt();
    (mean(early) - mean(late)).abs() <= allowed
        && window.iter().all(|q| (q - middle).abs() <= (CLEARLY_SIGNIFICANT + 1.0) * noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::law::Coordinate;

    /// A slide that is pushed at 1 s, decelerates evenly and rests from 2 s on; steps of a micrometre.
    fn raw(at: impl Fn(f64) -> f64) -> Raw {
        let time_s: Vec<f64> = (0..2000).map(|i| 2e-3 * f64::from(i)).collect();
        let position = time_s.iter().enumerate().map(|(i, t)| at(*t) + 1e-6 * (1.7 * i as f64).sin()).collect();
        Raw {
            coordinate: Coordinate::Linear,
            saturated: vec![false; time_s.len()],
            time_s,
            position,
            rate: None,
            force: None,
            up_along: None,
        }
    }

    #[test]
    fn standstills_are_left_out_and_turns_are_not() {
        let pushed = raw(|t| if t < 1.0 { 0.0 } else { 0.5 - 0.5 * (2.0 - t.min(2.0)).powi(2) });
        let (parts, stood) = split_by_motion(&[pushed]);
        let [part] = parts.as_slice() else { panic!("{} parts", parts.len()) };
        assert!(stood && (0.85..=1.0).contains(&part.time_s[0]), "from {}", part.time_s[0]);
        let end = part.time_s[part.time_s.len() - 1];
        assert!((1.95..2.15).contains(&end), "to {end}");
        let swing = raw(|t| 0.1 * (5.0 * t).sin());
        let (parts, stood) = split_by_motion(std::slice::from_ref(&swing));
        assert!(!stood && parts.len() == 1 && parts[0].time_s.len() == 2000);
        // A recording without motion is handed on for the fit to report it.
        let still = raw(|_| 0.0);
        assert_eq!(split_by_motion(std::slice::from_ref(&still)).0.len(), 1);
    }
}
