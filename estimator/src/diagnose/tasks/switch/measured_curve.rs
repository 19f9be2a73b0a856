//! Force over the travel of a throw, estimated at nodes.

use super::rows::{Place, Row, direction};

/// Spacing of the nodes of the estimated curve, as a share of the fingers' range.
/// Choice: halved, 6 of 21 answers change; doubled, 11 of 21 answers change.
pub const APART: f64 = 0.027;
/// Largest number of nodes of the estimated curve.
/// Choice: halved, 1 of 21 answers change; doubled, 0 of 21 answers change.
const MOST_PLACES: usize = 24;
/// Position on the estimated curve, along the travel: rising in both directions.
pub fn along_m(row: &Row) -> f64 {
    row.side().map_or(0.0, |side| direction(side) * row.tip.x)
}

/// A piecewise linear curve in one direction.
#[derive(Clone)]
pub struct Curve {
    pub side: usize,
    pub places: Vec<f64>,
}

impl Curve {
    pub fn of(rows: &[Row], side: usize, apart_m: f64) -> Option<Self> {
        let own: Vec<f64> = rows.iter().filter(|r| r.place == Place::Push(side)).map(along_m).collect();
        let (low, high) = own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        if own.len() < 2 || high - low < apart_m {
            return None;
        }
        let pieces = (((high - low) / apart_m).ceil() as usize).clamp(1, MOST_PLACES).min(own.len() / 4).max(1);
        let places = (0..=pieces).map(|k| low + (high - low) * k as f64 / pieces as f64).collect();
        Some(Self { side, places })
    }

    /// Share of the k-th node in a row.
    fn share(&self, row: &Row, k: usize) -> f64 {
        if row.place == Place::Push(self.side) { self.share_at(along_m(row), k) } else { 0.0 }
    }

    /// Share of the k-th node at a position along the travel, m.
    fn share_at(&self, along_m: f64, k: usize) -> f64 {
        let step = (self.places[self.places.len() - 1] - self.places[0]) / (self.places.len() - 1) as f64;
        (1.0 - (along_m - self.places[k]).abs() / step).max(0.0)
    }

    /// Force of a curve with these node values at a position along the travel, N; constant beyond its ends.
    pub fn force_n(&self, along_m: f64, force_n: &[f64]) -> f64 {
        let within = along_m.clamp(self.places[0], self.places[self.places.len() - 1]);
        force_n.iter().enumerate().map(|(k, force)| self.share_at(within, k) * force).sum()
    }

    /// Number of its regressors.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    pub fn columns(&self, rows: &[Row]) -> Vec<Vec<f64>> {
        (0..self.places.len()).map(|k| rows.iter().map(|r| self.share(r, k)).collect()).collect()
    }

    /// Slope of a curve with these forces at a row, N/m along the travel.
    pub fn slope(&self, row: &Row, force_n: &[f64]) -> f64 {
        if row.place != Place::Push(self.side) {
            return 0.0;
        }
        let k = self.places.partition_point(|p| *p <= along_m(row)).clamp(1, self.places.len() - 1);
        (force_n[k] - force_n[k - 1]) / (self.places[k] - self.places[k - 1])
    }

    pub fn top_m(&self, force_n: &[f64]) -> f64 {
        let most = (0..self.places.len()).max_by(|a, b| force_n[*a].total_cmp(&force_n[*b])).unwrap_or(0);
        self.places[most]
    }
}
