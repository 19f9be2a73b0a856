//! Segments of a recording without a gap.

use std::ops::Range;

/// Step between two samples above which a segment ends, in usual steps.
const GAP: f64 = 2.5;

/// Samples that follow each other without a gap and are all usable, and the usual (median) step between two samples, s. Without two samples the step
/// is one second.
pub fn pieces(time_s: &[f64], usable: &dyn Fn(usize) -> bool) -> (Vec<Range<usize>>, f64) {
    let mut steps: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let period_s = steps.get(steps.len() / 2).copied().unwrap_or(1.0).max(1e-9);
    let mut found: Vec<Range<usize>> = Vec::new();
    for i in (0..time_s.len()).filter(|i| usable(*i)) {
        match found.last_mut() {
            Some(last) if last.end == i && time_s[i] - time_s[i - 1] <= GAP * period_s => last.end = i + 1,
            _ => found.push(i..i + 1),
        }
    }
    (found, period_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_unusable_samples_end_a_piece() {
        let mut time_s: Vec<f64> = (0..10).map(|k| 0.01 * f64::from(k)).collect();
        time_s.iter_mut().skip(7).for_each(|t| *t += 0.02);
        let (found, period_s) = pieces(&time_s, &|i| i != 0 && i != 3);
        assert_eq!(found, [1..3, 4..7, 7..10]);
        assert!((period_s - 0.01).abs() < 1e-12);
    }

    #[test]
    fn nothing_has_no_pieces() {
        assert_eq!(pieces(&[], &|_| true), (Vec::new(), 1.0));
    }
}
