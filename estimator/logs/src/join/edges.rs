//! Edges of a signal with two levels, such as a trigger or a pulse.

use super::grid::Signal;

/// Share of the range on either side within which a sample is on a level.
const LEVEL: f64 = 0.25;
/// Share of the samples that are on a level. Of a sine it is two thirds, of a signal with one ramp in twenty 0.97.
const ON_LEVELS: f64 = 0.9;

/// A passage from one level to the other.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Time at which the middle is passed, s.
    pub time_s: f64,
    /// True from the lower to the upper level.
    pub rises: bool,
}

/// Edges of a signal; none if it has not two levels.
pub fn edges(signal: Signal<'_>) -> Vec<Edge> {
    let Signal { time_s, values } = signal;
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    let is_low = |v: f64| v <= low + LEVEL * range;
    let is_high = |v: f64| v >= low + (1.0 - LEVEL) * range;
    let on_levels = values.iter().filter(|&&v| is_low(v) || is_high(v)).count();
    if !(range.is_finite() && range > 0.0) || (on_levels as f64) < ON_LEVELS * values.len() as f64 {
        return Vec::new();
    }
    let middle = low + 0.5 * range;
    let (mut found, mut state) = (Vec::new(), None);
    for (j, &value) in values.iter().enumerate() {
        let now = if is_high(value) { Some(true) } else { is_low(value).then_some(false) };
        if let (Some(rises), Some(was)) = (now, state)
            && rises != was
            && let Some(i) = (0..j).rev().find(|&i| (values[i] > middle) != rises)
        {
            let share = (middle - values[i]) / (values[i + 1] - values[i]);
            found.push(Edge { time_s: time_s[i] + share.clamp(0.0, 1.0) * (time_s[i + 1] - time_s[i]), rises });
        }
        state = now.or(state);
    }
    found
}

/// Times of the edges of both signals that belong together, s: the log's and the other's. `shift_s`: seconds that put the
/// other's edges near those of the log. `within_s`: most that they differ by then. `is_turned`: one rises where the other
/// falls.
pub fn pairs(own: &[Edge], other: &[Edge], shift_s: f64, within_s: f64, is_turned: bool) -> Vec<(f64, f64)> {
    let partner = |edge: &Edge| {
        let distance = |of: &Edge| (of.time_s + shift_s - edge.time_s).abs();
        let alike = other.iter().filter(|of| (of.rises == edge.rises) != is_turned && distance(of) <= within_s);
        let nearest = alike.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some((edge.time_s, nearest.time_s))
    };
    own.iter().filter_map(partner).collect()
}
