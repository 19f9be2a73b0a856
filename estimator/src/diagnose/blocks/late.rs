//! Forces that come later than the motion of carried blocks: with the forces of another moment, their weight and mass explain more.

use super::rows::{Place, Row, Rows};
use crate::identify::linear::least_squares;

/// Longest delay that is tried, s, both ways: a hand has done something else by then.
const LONGEST_S: f64 = 0.12;
/// It is tried in steps of this, s, or of a sample where those are longer.
const STEP_S: f64 = 2e-3;
/// A delay is one where it leaves less than this share of the power, and makes the forces that much likelier (2 ln likelihood).
const LEAVES: f64 = 0.9;
const LIKELIER: f64 = 40.0;
/// Fewer rows as a share of those that are compared without a delay say nothing about one.
const ENOUGH: f64 = 0.8;

/// By how much forces come later than motion.
#[derive(Clone, Copy, Debug)]
pub struct Late {
    /// The delay and its standard error, s.
    pub tau_s: f64,
    pub error_s: f64,
    /// Whether it is more than chance.
    pub is_seen: bool,
}

/// The delay with which weights, their masses and constant errors of the sensors leave least. `known`: weights that the sidecar states, N.
pub fn late(rows: &Rows<'_>, known: &[Option<f64>], period_s: f64) -> Option<Late> {
    let carried: Vec<&Row> = rows.all.iter().filter(|r| matches!(r.place, Place::Carried { .. })).collect();
    let sample_s = rows.seen.iter().map(|s| s.sample_s).fold(0.0, f64::max);
    let step = (STEP_S / sample_s.max(1e-9)).round().max(1.0);
    let most = (LONGEST_S / (step * sample_s).max(1e-9)) as isize;
    let step_s = step * sample_s;
    let tried: Vec<(isize, f64, f64)> = (-most..=most)
        .filter_map(|k| left(rows, &carried, known, k * step as isize).map(|(power, count)| (k, power, count)))
        .collect();
    let (_, plain, count) = *tried.iter().find(|(k, ..)| *k == 0)?;
    let enough = tried.iter().filter(|(.., n)| *n > ENOUGH * count);
    let (best, power, rows_left) = *enough.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let at = |k: isize| tried.iter().find(|(tried, ..)| *tried == k).map(|(_, power, _)| *power);
    let (before, after) = (at(best - 1)?, at(best + 1)?);
    let bend = before + after - 2.0 * power;
    if bend <= 0.0 {
        return None;
    }
    let between = (0.5 * (before - after) / bend).clamp(-0.5, 0.5);
    // Twice the logarithm of the likelihood falls by one at one standard error; rows are a window of the filter apart.
    let error_s = step_s.max(0.1 * period_s) / (rows_left * 0.5 * bend / power.max(f64::MIN_POSITIVE)).sqrt();
    let is_seen = power < LEAVES * plain && count * (plain / power.max(f64::MIN_POSITIVE)).ln() > LIKELIER;
    Some(Late { tau_s: (best as f64 + between) * step_s, error_s, is_seen })
}

/// Power that is left a row with the forces of so many samples later, and rows.
fn left(rows: &Rows<'_>, carried: &[&Row], known: &[Option<f64>], by: isize) -> Option<(f64, f64)> {
    let blocks = rows.blocks();
    let mut columns = vec![Vec::new(); blocks + 2];
    let mut y = Vec::new();
    for row in carried {
        let Place::Carried { number, axis } = row.place else { continue };
        let one = &rows.seen[row.recording];
        let Some(acceleration) = row.i.checked_add_signed(-by).and_then(|i| one.acceleration[axis].get(i)) else {
            continue;
        };
        let up = if axis == 1 { 1.0 } else { 0.0 };
        let needed = up + acceleration / one.blocks.recording.meta.gravity().max(1e-9);
        let given = known[number - 1].map_or(0.0, |weight_n| weight_n * needed);
        for (k, column) in columns[..blocks].iter_mut().enumerate() {
            column.push(if k + 1 == number && known[k].is_none() { needed } else { 0.0 });
        }
        for (k, column) in columns[blocks..].iter_mut().enumerate() {
            // A constant beside weights that are open would leave those to the accelerations alone.
            let is_open = axis == 1 && known.iter().any(Option::is_none);
            column.push(f64::from(u8::from(k == axis && !is_open)));
        }
        y.push(rows.force_n(row) - given);
    }
    columns.retain(|column| column.iter().any(|v| *v != 0.0));
    if y.len() <= 2 * columns.len() {
        return None;
    }
    let fit = least_squares(&columns, &y, None).ok()?;
    let rss: f64 = (0..y.len())
        .map(|i| (y[i] - columns.iter().zip(&fit.values).map(|(c, v)| c[i] * v).sum::<f64>()).powi(2))
        .sum();
    Some((rss / y.len() as f64, y.len() as f64))
}
