/// Least evidence of a cause, 2 ln(likelihood): keeps false alarms below 1 in 200 (`facts/diagnosis.md`, 3).
pub(crate) const THRESHOLD: f64 = 20.0;
/// The same for slow rows, whose noise averages out less.
pub(crate) const THRESHOLD_SLOW: f64 = 25.0;
/// Row period from which rows count as slow, s.
pub(crate) const SLOW_PERIOD_S: f64 = 0.019;

pub(crate) fn threshold(period_s: f64) -> f64 {
    if period_s > SLOW_PERIOD_S { THRESHOLD_SLOW } else { THRESHOLD }
}
