//! Delay for which a plain model has the smallest residual of the forces, which are shifted against the motion step by
//! step.

use estimation::regression::linear::least_squares_values;

/// Step of the tried delays, s, or one sample if that is longer.
/// Choice: halved or doubled, none of 12 answers changes.
const STEP_S: f64 = 2e-3;

/// The same search in whole samples, about a step apart. `left`: as for [`look`], with the forces of this many samples
/// later.
pub fn look_by_samples(sample_s: f64, demands: &Demands, left: &dyn Fn(isize) -> Option<(f64, f64)>) -> Option<Late> {
    let step = (STEP_S / sample_s.max(1e-9)).round().max(1.0);
    let late = look(step * sample_s, demands, &|by| left(by * step as isize));
    late.filter(|late| late.error_s.is_finite())
}

/// Residual power per row of a plain fit, and number of rows; `None` with too few rows.
pub fn left_of_fit(mut columns: Vec<Vec<f64>>, y: &[f64]) -> Option<(f64, f64)> {
    columns.retain(|column| column.iter().any(|v| *v != 0.0));
    if y.len() <= 2 * columns.len() {
        return None;
    }
    let rms = least_squares_values(&columns, y, None).ok()?.rms;
    Some((rms * rms, y.len() as f64))
}

/// Result of the search for a delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Late {
    /// Delay of the forces after the motion, and its standard error, s; infinite if the residual has no minimum.
    pub tau_s: f64,
    pub error_s: f64,
    /// True if it is significant.
    pub is_seen: bool,
    /// Residual RMS of the plain model without a delay.
    pub plain_rms: f64,
}

/// Range of the search, and the demands on a delay.
#[derive(Clone, Copy, Debug)]
pub struct Demands {
    /// Longest tried delay, s, in both directions.
    pub longest_s: f64,
    /// Least share of the rows without a delay that have a force at the shifted time.
    pub enough: f64,
    /// Share of the power that a delay leaves, at most; and by how much likelier it makes the forces, at least: 2
    /// ln(likelihood).
    pub leaves: f64,
    pub likelier: f64,
}

/// Delay with the smallest residual, interpolated by the parabola through the best step and its neighbours. `left`:
/// residual power per row, and number of rows, with the forces of this many steps of `step_s` later.
pub fn look(step_s: f64, demands: &Demands, left: &dyn Fn(isize) -> Option<(f64, f64)>) -> Option<Late> {
    let most = (demands.longest_s / step_s.max(1e-9)) as isize;
    let tried: Vec<(isize, f64, f64)> =
        (-most..=most).filter_map(|by| left(by).map(|(power, rows)| (by, power, rows))).collect();
    let (_, plain, count) = *tried.iter().find(|(by, ..)| *by == 0)?;
    let enough = tried.iter().filter(|(.., rows)| *rows > demands.enough * count);
    let (best, power, rows) = *enough.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let at = |by: isize| tried.iter().find(|(tried, ..)| *tried == by).map(|(_, power, _)| *power);
    let sure = power.max(f64::MIN_POSITIVE);
    let (between, error) = match (at(best - 1), at(best + 1)) {
        (Some(before), Some(after)) if before + after > 2.0 * power => {
            let bend = before + after - 2.0 * power;
            // Twice the log likelihood falls by one at one standard error.
            ((0.5 * (before - after) / bend).clamp(-0.5, 0.5), (rows * 0.5 * bend / sure).powf(-0.5))
        }
        _ => (0.0, f64::INFINITY),
    };
    let is_seen = power <= demands.leaves * plain && count * (plain / sure).ln() >= demands.likelier;
    let (tau_s, error_s) = ((best as f64 + between) * step_s, error * step_s);
    Some(Late { tau_s, error_s, is_seen, plain_rms: plain.max(0.0).sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEMANDS: Demands = Demands { longest_s: 0.1, enough: 0.5, leaves: 0.8, likelier: 40.0 };

    #[test]
    fn the_lowest_point_is_told_between_the_steps() {
        let left = |by: isize| Some((1.0 + (0.01 * by as f64 - 0.033).powi(2) * 1e4, 500.0));
        let late = look(0.01, &DEMANDS, &left).expect("a delay");
        assert!((late.tau_s - 0.033).abs() < 1e-9 && late.is_seen, "{late:?}");
        // 500 rows: ln(power) grows by 1/500 at sqrt(1/500/1e4).
        assert!((late.error_s / (500.0_f64 * 1e4).powf(-0.5) - 1.0).abs() < 0.1, "{late:?}");
    }

    #[test]
    fn what_leaves_as_much_is_no_delay_and_too_few_rows_are_none() {
        let even = |by: isize| Some((1.0 - 1e-3 * by as f64, 500.0));
        let late = look(0.01, &DEMANDS, &even).expect("the last one");
        assert!(!late.is_seen && late.error_s.is_infinite(), "{late:?}");
        let few = |by: isize| Some(if by == 5 { (0.01, 100.0) } else { (1.0 + 0.01 * by.abs() as f64, 500.0) });
        assert!(look(0.01, &DEMANDS, &few).expect("none").tau_s.abs() < 0.01);
    }
}
