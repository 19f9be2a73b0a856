//! Free flight, from the first sample to the first blow.

use super::pose::Track;
use crate::identify::limits::{CERTAIN, LEAST_OF_PARABOLA, SIGNIFICANT};
use nalgebra::{DMatrix, DVector, Vector3};

/// Time at the beginning that shows undisturbed flight, s.
/// Choice: halved or doubled, none of 6 answers changes.
const FIRST_S: f64 = 0.068;
/// Time on either side over which second differences are taken, s: a blow shows more, noise does not.
/// Choice: halved, 1 of 6 answers change; doubled, 3 of 6 answers change.
const BLOW_REACH_S: f64 = 0.020;
/// Least change of the velocity by a blow, as the time in which free fall makes it, s.
/// Choice: halved or doubled, none of 6 answers changes.
pub const BLOW_S: f64 = 0.015;
/// Number of samples left out before a blow.
/// Choice: halved, 0 of 6 answers change; doubled, 1 of 6 answers change.
const GUARD: usize = 1;
/// Least duration of a flight that is judged, s.
/// Choice: halved or doubled, none of 6 answers changes.
const LEAST_FLIGHT_S: f64 = 0.047;

/// Samples of the shortest flight that tells something.
pub fn least(track: &Track) -> usize {
    LEAST_OF_PARABOLA.max(track.steps(LEAST_FLIGHT_S) + 1)
}

/// Parameters common to all flights.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// Downward acceleration, m/s².
    pub down_m_s2: f64,
    /// Standard error of it, m/s².
    pub error_m_s2: f64,
    /// Level acceleration, m/s².
    pub aside_m_s2: f64,
    /// Number of flights.
    pub throws: usize,
    /// Number of samples in all flights.
    pub samples: usize,
}

impl Fall {
    /// One regression over all flights: each has its own place and speed, all have one acceleration and, where orientations
    /// were recorded, one place of the tracked point in the body.
    pub fn of(tracks: &[Track]) -> Option<Self> {
        let flights = flights(tracks)?;
        let turned = flights.iter().all(|(t, _)| t.turned.is_some());
        Self::solve(&flights, turned).or_else(|| Self::solve(&flights, false))
    }

    /// The same, as if the tracked point were the middle.
    pub fn of_points(tracks: &[Track]) -> Option<Self> {
        Self::solve(&flights(tracks)?, false)
    }

    fn solve(flights: &[(&Track, usize)], turned: bool) -> Option<Self> {
        let size = if turned { 6 } else { 3 };
        let blocks: Vec<Block> =
            flights.iter().flat_map(|(track, n)| (0..3).map(move |axis| rows(track, *n, axis, turned))).collect();
        let normal: DMatrix<f64> =
            blocks.iter().map(|(a, _)| a.tr_mul(a)).fold(DMatrix::zeros(size, size), |s, m| s + m);
        let right: DVector<f64> = blocks.iter().map(|(a, b)| a.tr_mul(b)).fold(DVector::zeros(size), |s, v| s + v);
        let inverse = normal.try_inverse()?;
        let values = &inverse * right;
        let (covariance, free) = if flights.len() > 1 {
            (by_flight(&blocks, &values, &inverse), flights.len() as f64 - 1.0)
        } else {
            by_sample(&blocks, &values, &inverse)?
        };
        let error = covariance[(2, 2)].max(0.0).sqrt();
        let few = crate::regression::long_run_variance::inflation(free.max(1.0)).sqrt();
        (error.is_finite() && !flights.is_empty()).then(|| Self {
            down_m_s2: -values[2],
            error_m_s2: error * few,
            aside_m_s2: values[0].hypot(values[1]),
            throws: flights.len(),
            samples: flights.iter().map(|(_, n)| n).sum(),
        })
    }
}

/// Flights that are long enough, with their samples, but those with a blow that was not seen: it bends a flight far more than the tracker's noise does.
fn flights(tracks: &[Track]) -> Option<Vec<(&Track, usize)>> {
    let flights: Vec<(&Track, usize)> = tracks.iter().map(|t| (t, end(t))).filter(|(t, n)| *n >= least(t)).collect();
    let rms: Vec<f64> = flights.iter().map(|(t, n)| own_rms(t, *n)).collect();
    let mut sorted = rms.clone();
    sorted.sort_by(f64::total_cmp);
    let most = SIGNIFICANT * sorted.get(sorted.len() / 2)?;
    Some(flights.into_iter().zip(&rms).filter(|(_, r)| **r <= most).map(|(f, _)| f).collect())
}

/// Columns and right sides of one coordinate of one flight.
type Block = (DMatrix<f64>, DVector<f64>);

/// Covariance of the values by the differences between flights: samples of one flight are correlated.
fn by_flight(blocks: &[Block], values: &DVector<f64>, inverse: &DMatrix<f64>) -> DMatrix<f64> {
    let size = values.len();
    let mut scatter = DMatrix::zeros(size, size);
    for flight in blocks.chunks(3) {
        let pull: DVector<f64> =
            flight.iter().map(|(a, b)| a.tr_mul(&(b - a * values))).fold(DVector::zeros(size), |s, v| s + v);
        scatter += &pull * pull.transpose();
    }
    let count = (blocks.len() / 3) as f64;
    inverse * scatter * inverse * (count / (count - 1.0).max(1.0))
}

/// The same for one flight, by the residuals of its samples, and the number of free ones; `None` if none is.
fn by_sample(blocks: &[Block], values: &DVector<f64>, inverse: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    /// Largest correlation of neighbouring residuals.
    /// Choice: no case of the ablation reads it.
    const MOST_ALIKE: f64 = 0.9;
    let left: Vec<DVector<f64>> = blocks.iter().map(|(a, b)| b - a * values).collect();
    let rss: f64 = left.iter().map(DVector::norm_squared).sum();
    // Each coordinate has its own place and speed beside.
    let rows: usize = left.iter().map(|r| r.len() - 2).sum();
    let free = rows.checked_sub(values.len()).filter(|free| *free > 0)? as f64;
    // Trackers smooth. The fit makes neighbours less alike than they are, by about its share of the samples.
    let together: f64 = left.iter().map(|r| r.iter().zip(r.iter().skip(1)).map(|(a, b)| a * b).sum::<f64>()).sum();
    let samples: usize = left.iter().map(DVector::len).sum();
    let alike = (together / rss.max(f64::MIN_POSITIVE) + 1.0 - free / samples as f64).clamp(0.0, MOST_ALIKE);
    Some((inverse * (rss / free * (1.0 + alike) / (1.0 - alike)), free))
}

/// Rows of one coordinate of one flight, with its own place and speed taken out of both sides.
fn rows(track: &Track, n: usize, axis: usize, turned: bool) -> Block {
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
pub fn end(track: &Track) -> usize {
    let points = &track.points;
    let reach = track.steps(BLOW_REACH_S);
    // Three second differences at least: their median is then no blow.
    let first = (track.steps(FIRST_S) + 1).max(2 * reach + 3);
    if points.len() < first + reach + 1 {
        return 0;
    }
    let bend = |i: usize| points[i + reach] - points[i] * 2.0 + points[i - reach];
    let begin = || reach..first - reach;
    let usual = median_vector(&begin().map(bend).collect::<Vec<_>>());
    let mut scatter: Vec<f64> = begin().map(|i| (bend(i) - usual).norm()).collect();
    scatter.sort_by(f64::total_cmp);
    let least = (CERTAIN * scatter[scatter.len() / 2]).max(usual.norm() * BLOW_S / (track.step_s() * reach as f64));
    let blow = (reach..points.len() - reach).find(|&i| (bend(i) - usual).norm() > least);
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
