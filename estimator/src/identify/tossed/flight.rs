//! Free flight, from the first sample to the first blow.

use super::pose::Track;
use nalgebra::{DMatrix, DVector, Vector3};

/// Samples that tell what flight looks like, at the beginning.
const FIRST: usize = 11;
/// Second differences are taken over so many samples on either side: a blow shows more, noise does not.
const REACH: usize = 3;
/// A flight that strays from its parabola by so many times what flights usually do is left out.
const BENT: f64 = 3.0;
/// A blow changes the second difference by so many times what it usually scatters …
const BLOW_NOISES: f64 = 5.0;
/// … and by this velocity, m/s.
const BLOW_M_S: f64 = 0.15;
/// Samples left out before a blow.
const GUARD: usize = 1;
/// A shorter flight tells nothing.
pub(crate) const LEAST: usize = 8;

/// What all flights have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fall {
    pub down_m_s2: f64,
    pub error_m_s2: f64,
    /// Level acceleration, m/s².
    pub aside_m_s2: f64,
    pub throws: usize,
    pub samples: usize,
}

impl Fall {
    /// One regression over all flights: each has its own place and speed, all have one acceleration and, where orientations
    /// were recorded, one place of the tracked point in the body.
    pub(crate) fn of(tracks: &[Track]) -> Option<Self> {
        let flights: Vec<(&Track, usize)> = tracks.iter().map(|t| (t, end(t))).filter(|(_, n)| *n >= LEAST).collect();
        // A blow that was not seen bends a flight far more than the tracker's noise does.
        let rms: Vec<f64> = flights.iter().map(|(t, n)| own_rms(t, *n)).collect();
        let mut sorted = rms.clone();
        sorted.sort_by(f64::total_cmp);
        let most = BENT * sorted.get(sorted.len() / 2)?;
        let flights: Vec<(&Track, usize)> =
            flights.into_iter().zip(&rms).filter(|(_, r)| **r <= most).map(|(f, _)| f).collect();
        let turned = flights.iter().all(|(t, _)| t.turned.is_some());
        Self::solve(&flights, turned).or_else(|| Self::solve(&flights, false))
    }

    fn solve(flights: &[(&Track, usize)], turned: bool) -> Option<Self> {
        let size = if turned { 6 } else { 3 };
        let blocks: Vec<(DMatrix<f64>, DVector<f64>)> =
            flights.iter().flat_map(|(track, n)| (0..3).map(move |axis| rows(track, *n, axis, turned))).collect();
        let normal: DMatrix<f64> =
            blocks.iter().map(|(a, _)| a.tr_mul(a)).fold(DMatrix::zeros(size, size), |s, m| s + m);
        let right: DVector<f64> = blocks.iter().map(|(a, b)| a.tr_mul(b)).fold(DVector::zeros(size), |s, v| s + v);
        let inverse = normal.try_inverse()?;
        let values = &inverse * right;
        // Errors by flight: what happens within one hangs together.
        let mut scatter = DMatrix::zeros(size, size);
        for flight in blocks.chunks(3) {
            let pull: DVector<f64> =
                flight.iter().map(|(a, b)| a.tr_mul(&(b - a * &values))).fold(DVector::zeros(size), |s, v| s + v);
            scatter += &pull * pull.transpose();
        }
        let count = flights.len() as f64;
        let covariance = &inverse * scatter * &inverse * (count / (count - 1.0).max(1.0));
        let error = covariance[(2, 2)].max(0.0).sqrt();
        let few = crate::identify::long_run::inflation((count - 1.0).max(1.0)).sqrt();
        (error.is_finite() && flights.len() >= 2).then(|| Self {
            down_m_s2: -values[2],
            error_m_s2: error * few,
            aside_m_s2: values[0].hypot(values[1]),
            throws: flights.len(),
            samples: flights.iter().map(|(_, n)| n).sum(),
        })
    }
}

/// Rows of one coordinate of one flight, with its own place and speed taken out of both sides.
fn rows(track: &Track, n: usize, axis: usize, turned: bool) -> (DMatrix<f64>, DVector<f64>) {
    let middle = track.time_s[..n].iter().sum::<f64>() / n as f64;
    let time = |i: usize| track.time_s[i] - middle;
    let size = if turned { 6 } else { 3 };
    let columns = DMatrix::from_fn(n, size, |i, j| match (j, &track.turned) {
        (j, _) if j == axis => 0.5 * time(i).powi(2),
        (j, Some(turned)) if j >= 3 => turned[i][(axis, j - 3)],
        _ => 0.0,
    });
    let own = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { time(i) }).qr().q();
    let right = DVector::from_fn(n, |i, _| track.points[i][axis]);
    (&columns - &own * own.tr_mul(&columns), &right - &own * own.tr_mul(&right))
}

/// Samples of the flight at the beginning.
pub(crate) fn end(track: &Track) -> usize {
    let (points, time) = (&track.points, &track.time_s);
    if points.len() < FIRST + REACH + 1 {
        return 0;
    }
    let step = (time[points.len() - 1] - time[0]) / (points.len() - 1) as f64;
    let bend = |i: usize| points[i + REACH] - points[i] * 2.0 + points[i - REACH];
    let begin = || REACH..FIRST - REACH + 1;
    let usual = median_vector(&begin().map(bend).collect::<Vec<_>>());
    let mut scatter: Vec<f64> = begin().map(|i| (bend(i) - usual).norm()).collect();
    scatter.sort_by(f64::total_cmp);
    let least = (BLOW_NOISES * scatter[scatter.len() / 2]).max(BLOW_M_S * step * REACH as f64);
    let blow = (REACH..points.len() - REACH).find(|&i| (bend(i) - usual).norm() > least);
    blow.map_or(points.len(), |i| (i + 1).saturating_sub(GUARD))
}

/// Root mean square distance of a flight from its own parabola, m.
fn own_rms(track: &Track, n: usize) -> f64 {
    let square: f64 = (0..3)
        .map(|axis| {
            let since = |i: usize| track.time_s[i] - track.time_s[0];
            let own = DMatrix::from_fn(n, 3, |i, j| [1.0, since(i), since(i) * since(i)][j]).qr().q();
            let right = DVector::from_fn(n, |i, _| track.points[i][axis]);
            (&right - &own * own.tr_mul(&right)).norm_squared()
        })
        .sum();
    (square / (3 * (n - 3)) as f64).sqrt()
}

fn median_vector(values: &[Vector3<f64>]) -> Vector3<f64> {
    Vector3::from_fn(|k, _| {
        let mut one: Vec<f64> = values.iter().map(|v| v[k]).collect();
        one.sort_by(f64::total_cmp);
        one[one.len() / 2]
    })
}
