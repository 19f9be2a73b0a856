//! Signals of a needle recording along the needle's way: depth, force, and the segments in which it is held.

use crate::identify::limits::{CONTACT_NOISES, LEAST_OF_PARABOLA, PUSH_SHARE};
use crate::identify::pads::SHEAR_GIVE;
use foundation::estimate::EstimateError;
use foundation::signal::noise::{quantum, resolution_error, white_noise};
use foundation::signal::task::{TipSeries, is_two_fingered, times, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;
use std::ops::Range;

/// Share of the largest forces whose mean direction is that of the needle.
/// Choice: halved, 2 of 15 answers change; doubled, 1 of 15 answers change.
const STRONGEST: f64 = 0.02;
/// Least force that shows the needle's direction, in multiples of its noise.
/// Choice: halved or doubled, none of 15 answers changes.
const DIRECTION_NOISES: f64 = 12.0;
/// Time over which points of the loading curve are averaged, s: a hand moves on by a tenth of a millimetre meanwhile.
/// Choice: halved, 1 of 15 answers change; doubled, 1 of 15 answers change.
const CALM_S: f64 = 0.005;
/// Least number of samples of a hold.
/// Choice: halved or doubled, none of 15 answers changes.
const LEAST_HOLD: usize = 30;
/// Slope of width over grip, in standard errors, from which the pads' give is seen.
/// Choice: halved or doubled, none of 3 answers changes.
const PADS_SEEN: f64 = 8.0;

/// The recording along the needle.
#[derive(Clone, Debug)]
pub struct Along {
    /// Way of the held point in the direction of insertion, m.
    pub depth_m: Vec<f64>,
    /// Force in that direction, on the environment, N.
    pub force_n: Vec<f64>,
    /// Way across, m: another place of the sheet.
    pub side_m: Vec<f64>,
    /// Unit vector of insertion in the world.
    pub direction: Vec2,
    /// Segments of samples in which the needle is held.
    pub holds: Vec<Range<usize>>,
    /// Give of the pads between the measured tips and the needle, m/N, and its error.
    pub give_m_n: (f64, f64),
    /// Number of samples averaged to one point of the loading curve: noise in the depth would flatten the bend of the
    /// curve.
    pub calm: usize,
    /// Usual time between two samples, s; 0 where there is no clock.
    pub period_s: f64,
    /// White noise of the force, N.
    pub noise_n: f64,
    /// Mean force of empty hands in that direction, N, and its error; `None` where the needle is held all the time.
    pub free_n: Option<(f64, f64)>,
    /// True when two fingers hold the needle, so that its weight is part of the force.
    pub two_fingered: bool,
}

/// Reads the two fingers or the single tool.
pub fn along(recording: &Recording) -> Result<Along, EstimateError> {
    let missing = |column: &str| EstimateError::MissingColumn {
        task: "the task needle".to_owned(),
        column: column.to_owned(),
        recording: recording.name.clone(),
    };
    let two_fingered = is_two_fingered(recording);
    let forces = |tip: &TipSeries, column: &str| tip.force.clone().ok_or_else(|| missing(column));
    let (position, force, grip) = if two_fingered {
        let tips = [tip_series(recording, "1")?, tip_series(recording, "2")?];
        let (left, right) = (forces(&tips[0], "fx1_N")?, forces(&tips[1], "fx2_N")?);
        let pair = || tips[0].position.iter().zip(&tips[1].position);
        let grip: Vec<f64> = left.iter().zip(&right).map(|(l, r)| l.x.min(-r.x)).collect();
        let width: Vec<f64> = pair().map(|(l, r)| r.x - l.x).collect();
        let position: Vec<Vec2> = pair().map(|(l, r)| 0.5 * (l + r)).collect();
        (position, left.iter().zip(&right).map(|(l, r)| l + r).collect(), Some((grip, width)))
    } else {
        let tool = tip_series(recording, "")?;
        let force = forces(&tool, "fx_N")?;
        (tool.position, force, None)
    };
    let holds = grip.as_ref().map_or_else(|| std::iter::once(0..position.len()).collect(), |(grip, _)| holds(grip));
    let give_m_n = grip.as_ref().map_or((0.0, 0.0), |(grip, width)| give(grip, width, &holds));
    let held = |i: usize| holds.iter().any(|h| h.contains(&i));
    let Some(direction) = direction(&force, &held) else {
        return Err(EstimateError::Other(format!(
            "{} shows no force of a sheet on a needle: nothing stands out of the noise while it is held",
            recording.name
        )));
    };
    let depth_m: Vec<f64> = position.iter().map(|p| p.dot(&direction)).collect();
    let force_n: Vec<f64> = force.iter().map(|f| f.dot(&direction)).collect();
    let side_m = position.iter().map(|p| direction.perp(p)).collect();
    let noise_n = white_noise(&force_n);
    let free_n = free(&force_n, &holds, noise_n);
    let time_s = times(recording);
    let spans_s = time_s.last().zip(time_s.first()).map_or(0.0, |(last, first)| last - first);
    let period_s = spans_s / time_s.len().saturating_sub(1).max(1) as f64;
    let calm = if period_s > 0.0 { ((CALM_S / period_s).round() as usize).max(1) } else { 1 };
    Ok(Along { depth_m, force_n, side_m, direction, holds, give_m_n, calm, period_s, noise_n, free_n, two_fingered })
}

/// Mean of the force well before the first hold and after the last, and its error.
fn free(force_n: &[f64], holds: &[Range<usize>], noise_n: f64) -> Option<(f64, f64)> {
    let (first, last) = (holds.first()?.start, holds.last()?.end);
    // The fingers close and open slowly: half of the samples outside is near a touch.
    let before = &force_n[..first / 2];
    let after = &force_n[last + (force_n.len() - last) / 2..];
    let n = before.len() + after.len();
    if n < LEAST_HOLD {
        return None;
    }
    let mean = before.iter().chain(after).sum::<f64>() / n as f64;
    // A sum of two sensors.
    let rounding = std::f64::consts::SQRT_2 * resolution_error(quantum(force_n), noise_n);
    Some((mean, (noise_n / (n as f64).sqrt()).hypot(rounding)))
}

/// Segments of samples with a grip.
fn holds(grip: &[f64]) -> Vec<Range<usize>> {
    let most = grip.iter().fold(0.0_f64, |a, b| a.max(*b));
    let least = (PUSH_SHARE * most).max(CONTACT_NOISES * white_noise(grip));
    let mut found: Vec<Range<usize>> = Vec::new();
    for (i, _) in grip.iter().enumerate().filter(|(_, g)| **g > least) {
        match found.last_mut() {
            // A few samples of noise do not end a hold.
            Some(last) if i <= last.end + 5 => last.end = i + 1,
            _ => found.push(i..i + 1),
        }
    }
    found.retain(|hold| hold.len() >= LEAST_HOLD);
    found
}

/// Mean direction of the strongest forces while the needle is held; `None` when they do not stand out of the noise.
fn direction(force: &[Vec2], held: &dyn Fn(usize) -> bool) -> Option<Vec2> {
    let mut sizes: Vec<(f64, usize)> =
        force.iter().enumerate().filter(|(i, _)| held(*i)).map(|(i, f)| (f.norm(), i)).collect();
    if sizes.len() < LEAST_HOLD {
        return None;
    }
    sizes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let axis = |pick: fn(&Vec2) -> f64| white_noise(&force.iter().map(pick).collect::<Vec<_>>());
    let noise = axis(|f| f.x).max(axis(|f| f.y));
    let mean = |count: usize| sizes[..count].iter().map(|&(_, i)| force[i]).sum::<Vec2>() / count as f64;
    let most = ((STRONGEST * sizes.len() as f64) as usize).max(LEAST_OF_PARABOLA);
    // A stiff sheet that is pressed fast, or once among many strokes, is felt in fewer samples.
    let counts =
        std::iter::successors(Some(most), |count| Some(count / 2)).take_while(|count| *count >= LEAST_OF_PARABOLA);
    let stands_out = |mean: &Vec2| mean.norm() > DIRECTION_NOISES * noise && mean.norm() > 0.0;
    counts.map(mean).find(stands_out).map(|mean| mean.normalize())
}

/// Give of two pads in shear, m/N, out of how the grip's width follows its force: the fingers' tips are measured, not the
/// needle between the pads.
fn give(grip: &[f64], width: &[f64], holds: &[Range<usize>]) -> (f64, f64) {
    let (mut gg, mut gw, mut n, mut rest) = (0.0, 0.0, 0.0, 0.0);
    for hold in holds {
        let mean = |values: &[f64]| values[hold.clone()].iter().sum::<f64>() / hold.len() as f64;
        let (grip_mean, width_mean) = (mean(grip), mean(width));
        for i in hold.clone() {
            let (g, w) = (grip[i] - grip_mean, width[i] - width_mean);
            (gg, gw, n, rest) = (gg + g * g, gw + g * w, n + 1.0, rest + w * w);
        }
    }
    if gg <= 0.0 || n < 3.0 {
        return (0.0, 0.0);
    }
    let slope = gw / gg;
    let error = ((rest - slope * gw).max(0.0) / n / gg).sqrt();
    // Both pads give: width falls by 2 grip / stiffness.
    let normal_n_m = -2.0 / slope;
    if slope >= 0.0 || -slope < PADS_SEEN * error {
        return (0.0, 0.0);
    }
    let one = 0.5 / normal_n_m;
    (one * SHEAR_GIVE.0, one * SHEAR_GIVE.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A deterministic stand-in for noise of 20 mN.
    fn noise(i: usize) -> Vec2 {
        let at = i as f64;
        0.028 * Vec2::new((at * 12.9898).sin(), (at * 78.233 + 1.0).sin())
    }

    /// A stiff sheet that is pierced once within a long recording is felt for a thousandth of it.
    #[test]
    fn a_short_push_shows_which_way_the_needle_goes() {
        let push = |i: usize| if (9000..9030).contains(&i) { 1.5 * (i - 9000) as f64 / 30.0 } else { 0.0 };
        let force = |push: &dyn Fn(usize) -> f64| -> Vec<Vec2> {
            (0..30_000).map(|i| noise(i) + Vec2::new(0.0, -push(i))).collect()
        };
        let found = direction(&force(&push), &|_| true).expect("a push");
        assert!(found.y < -0.995, "{found}");
        assert!(direction(&force(&|_| 0.0), &|_| true).is_none());
    }
}
