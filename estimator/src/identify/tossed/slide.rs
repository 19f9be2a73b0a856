//! Sliding flat: height and orientation stay, the speed falls evenly.

use super::pose::Track;
use crate::signal::derive::polynomial;
use nalgebra::Vector3;

/// Slower than this it may stick or creep, m/s.
const SLOW_M_S: f64 = 0.05;
/// Turning faster than this it rolls or spins, rad/s.
const TURNING_RAD_S: f64 = 0.6;
/// Rising or falling faster than this it is not flat, m/s …
const RISING_M_S: f64 = 0.03;
/// … and all of a slide lies within this height, m.
const LEVEL_M: f64 = 2e-3;
/// A shorter slide tells nothing, samples and s.
const LEAST: usize = 8;
const LEAST_S: f64 = 0.05;

/// One slide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slide {
    pub slowing_m_s2: f64,
    pub samples: usize,
    /// Which track, and its first sample there.
    pub track: usize,
    pub first: usize,
}

/// The slides of all tracks.
pub(crate) fn slides(tracks: &[Track]) -> Vec<Slide> {
    let all = tracks.iter().enumerate();
    all.flat_map(|(k, track)| of_track(track).into_iter().map(move |s| Slide { track: k, ..s })).collect()
}

fn of_track(track: &Track) -> Vec<Slide> {
    let (points, time) = (&track.points, &track.time_s);
    let n = points.len();
    let flat = |i: usize| {
        let (a, b) = (i.saturating_sub(2), (i + 2).min(n - 1));
        let span = time[b] - time[a];
        let moved = points[b] - points[a];
        let level = moved.x.hypot(moved.y) / span;
        level > SLOW_M_S && moved.z.abs() / span < RISING_M_S && track.angle(a, b) / span < TURNING_RAD_S
    };
    let mut found = Vec::new();
    let mut start = None;
    for i in 0..=n {
        let goes_on =
            i < n && n > 4 && flat(i) && start.is_none_or(|s: usize| (points[i].z - points[s].z).abs() < LEVEL_M);
        match (start, goes_on) {
            (None, true) => start = Some(i),
            (Some(first), false) => {
                // Both ends still see what came before and after.
                found.extend(slide(track, first + 2, i.saturating_sub(2)));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// The way along the mean direction, as a parabola.
fn slide(track: &Track, first: usize, end: usize) -> Option<Slide> {
    if end < first + LEAST || track.time_s[end - 1] - track.time_s[first] < LEAST_S {
        return None;
    }
    let (points, time) = (&track.points[first..end], &track.time_s[first..end]);
    let total = points[points.len() - 1] - points[0];
    let along = Vector3::new(total.x, total.y, 0.0).try_normalize(1e-9)?;
    let way: Vec<f64> = points.iter().map(|p| along.dot(&(p - points[0]))).collect();
    let since: Vec<f64> = time.iter().map(|t| t - time[0]).collect();
    let fitted = polynomial(&since, &way, 2);
    let slowing_m_s2 = -2.0 * fitted.get(2)?;
    (slowing_m_s2 > 0.0).then_some(Slide { slowing_m_s2, samples: points.len(), track: 0, first })
}
