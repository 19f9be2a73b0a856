//! Test of a push that depends on the side of the plane.
//!
//! Plane and push were chosen to fit, so they are tested on held-out data. The recording is cut into blocks. Plane and
//! split of every other block tell the contact, and the push in the blocks between is compared: its mean on the plane
//! and off it. Each block is one sample, because rows within a block are correlated (Welch's t). With a clock the
//! inertial force is taken off: a mass that is shaken pushes hardest at its reversals.

use super::super::existence::FALSE_ALARMS;
use super::fit::Plane;
use super::split::{Pressed, Split};
use crate::regression::linear::least_squares;
use foundation::estimate::Existence;
use foundation::signal::derive::savitzky_golay;
use nalgebra::Vector3;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Blocks of the recording.
const PIECES: usize = 24;
/// Rows of one side in a block that make a mean.
const LEAST_ROWS: usize = 3;
/// Largest number of rows that the tested blocks are averaged to.
const ROWS: usize = 600;
/// Model error of a grip, as a share of the force.
const MODEL_SHARE: f64 = 0.02;
/// Largest distance of a sample on the plane, in multiples of the plane's own residual.
const ON_NOISES: f64 = 3.0;
/// Half of the window over which motion is smoothed for its acceleration, s.
const HALF_S: f64 = 0.05;

/// The test; `None` where the cut leaves too little on either side.
pub(super) fn existence(pressed: &Pressed<'_>, split: &Split, plane: &Plane) -> Option<Existence> {
    let n = pressed.points.len();
    let learned: Vec<bool> = (0..n).map(|i| (i * PIECES / n).is_multiple_of(2)).collect();
    let own = learn(pressed, split, &learned).unwrap_or_else(|| plane.clone());
    let noise = ON_NOISES * (own.rms_m + split.position_noise_m);
    let acceleration = accelerations(pressed, &own.normal);
    let width = n.div_ceil(ROWS).max(1);
    let mut columns = vec![Vec::new(); 3];
    let (mut push, mut piece) = (Vec::new(), Vec::new());
    for start in (0..n).step_by(width) {
        let part = start..(start + width).min(n);
        if part.clone().any(|i| learned[i]) {
            continue;
        }
        let mean = |of: &dyn Fn(usize) -> f64| part.clone().map(of).sum::<f64>() / part.len() as f64;
        // On it, off it, or on the way.
        columns[0].push(mean(&|i| f64::from(own.height_m(&pressed.points[i]) < noise)));
        piece.push(start * PIECES / n);
        columns[1].push(1.0);
        columns[2].push(mean(&|i| acceleration.as_ref().map_or(0.0, |a| a[i])));
        push.push(mean(&|i| -own.normal.dot(&split.force[i])));
    }
    if acceleration.is_none() {
        columns.pop();
    }
    let fit = least_squares(&columns, &push, None).ok()?;
    let inertia = |row: usize| columns.get(2).map_or(0.0, |a| fit.values[2] * a[row]);
    let (mut on, mut off) = (Vec::new(), Vec::new());
    for at in (1..PIECES).step_by(2) {
        let side = |wanted: f64| {
            let rows: Vec<f64> = (0..push.len())
                .filter(|&r| piece[r] == at && columns[0][r] == wanted)
                .map(|r| push[r] - inertia(r))
                .collect();
            (rows.len() >= LEAST_ROWS).then(|| rows.iter().sum::<f64>() / rows.len() as f64)
        };
        on.extend(side(1.0));
        off.extend(side(0.0));
    }
    let (pushed, nothing) = (Group::of(&on)?, Group::of(&off)?);
    let rms = (push.iter().map(|f| f * f).sum::<f64>() / push.len() as f64).sqrt();
    compared(&pushed, &nothing, rms)
}

/// The mean push on the plane against that off it: Welch (1947), two groups of unlike scatter. `rms`: of the push, N.
fn compared(pushed: &Group, nothing: &Group, rms: f64) -> Option<Existence> {
    let variance = pushed.variance + nothing.variance;
    let freedom = variance * variance
        / (pushed.variance.powi(2) / (pushed.count - 1.0) + nothing.variance.powi(2) / (nothing.count - 1.0))
            .max(f64::MIN_POSITIVE);
    let student = StudentsT::new(0.0, 1.0, freedom.clamp(1.0, 1e6)).ok()?;
    let error = variance.sqrt().hypot(MODEL_SHARE * rms);
    let value = pushed.mean - nothing.mean;
    let p_value = 1.0 - student.cdf(value / error.max(f64::MIN_POSITIVE));
    Some(Existence {
        exists: (p_value < FALSE_ALARMS).then_some(true),
        p_value,
        false_alarm_rate: FALSE_ALARMS,
        unexplained_n: value,
        std_error_n: error * (student.inverse_cdf(0.975) / 1.96).max(1.0),
        unexplained_rms_n: rms,
        detectable_n: (student.inverse_cdf(1.0 - FALSE_ALARMS) + 1.645) * error,
        effective_samples: pushed.count + nothing.count,
        direction: "normal".to_owned(),
    })
}

/// Mean of some blocks and the variance of that mean.
struct Group {
    mean: f64,
    variance: f64,
    count: f64,
}

impl Group {
    fn of(values: &[f64]) -> Option<Self> {
        let count = values.len() as f64;
        if values.len() < 3 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count;
        let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        Some(Self { mean, variance: square / (count - 1.0) / count, count })
    }
}

/// The plane of the learned blocks alone.
fn learn(pressed: &Pressed<'_>, split: &Split, learned: &[bool]) -> Option<Plane> {
    let contact = split.contact.iter().zip(learned).map(|(c, l)| *c && *l).collect();
    Plane::fit(pressed, &Split { contact, ..split.clone() })
}

/// Acceleration along the normal, m/s².
fn accelerations(pressed: &Pressed<'_>, normal: &Vector3<f64>) -> Option<Vec<f64>> {
    let time = pressed.time_s.filter(|t| t.len() == pressed.points.len())?;
    let period = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let half = ((HALF_S / period).round() as usize).clamp(3, 200);
    let height: Vec<f64> = pressed.points.iter().map(|p| normal.dot(p)).collect();
    Some(savitzky_golay(time, &height, half, 3).second)
}
