//! Values between samples at uneven times.

/// Index of the last sample at or before `t`, or the first one.
pub fn before(time: &[f64], t: f64) -> usize {
    time.partition_point(|&s| s <= t).saturating_sub(1)
}

/// Largest distance of the cubic from its four samples, as a share of their range.
/// Derived: on even times, a slope is at most the range over two steps, and the slopes add at most u (1 − u) ≤ 1/4 steps.
const BEYOND: f64 = 0.125;

/// Value at `t` of the cubic through four neighbours: Hermite, with the slopes of the parabolas through three, so that
/// uneven steps keep their place. A sample at `t` itself is returned unchanged. After the last sample its value holds. Beside
/// stamps that nearly coincide, it stays as near to its samples as on even times.
pub fn cubic(time: &[f64], values: &[f64], t: f64) -> f64 {
    let i = before(time, t);
    if time[i] == t || i + 1 == time.len() {
        return values[i];
    }
    let (left, right) = (values[i], values[i + 1]);
    let step = time[i + 1] - time[i];
    let chord = (right - left) / step;
    let slope_left = if i == 0 { chord } else { slope(time, values, i).unwrap_or(chord) };
    let slope_right = if i + 2 == time.len() { chord } else { slope(time, values, i + 1).unwrap_or(chord) };
    let u = (t - time[i]) / step;
    let (u2, u3) = (u * u, u * u * u);
    let value = (2.0 * u3 - 3.0 * u2 + 1.0) * left
        + (u3 - 2.0 * u2 + u) * step * slope_left
        + (3.0 * u2 - 2.0 * u3) * right
        + (u3 - u2) * step * slope_right;
    // Neighbours that are missing do not count.
    let near = &values[i.saturating_sub(1)..values.len().min(i + 3)];
    let (low, high) = near.iter().fold((left, left), |(low, high), v| (low.min(*v), high.max(*v)));
    let beyond = BEYOND * (high - low);
    if value.is_finite() { value.clamp(low - beyond, high + beyond) } else { value }
}

/// Slope at sample `i` of the parabola through it and its neighbours.
fn slope(time: &[f64], values: &[f64], i: usize) -> Option<f64> {
    let (h0, h1) = (time[i] - time[i - 1], time[i + 1] - time[i]);
    let (d0, d1) = ((values[i] - values[i - 1]) / h0, (values[i + 1] - values[i]) / h1);
    let slope = (h1 * d0 + h0 * d1) / (h0 + h1);
    slope.is_finite().then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_value_leaps_beside_stamps_that_nearly_coincide() {
        let (time, values) = ([0.0, 1.0, 1.000_001, 2.0, 3.0], [0.0, 1.0, 1.2, 2.0, 3.0]);
        let between = (0..3000).map(|k| cubic(&time, &values, f64::from(k) * 1e-3));
        let outside = between.map(|v| (v - 3.0).max(-v)).fold(0.0, f64::max);
        assert!(outside <= 0.125 * 3.0, "{outside}");
    }

    #[test]
    fn the_bound_changes_nothing_on_even_times() {
        let time: Vec<f64> = (0..200).map(f64::from).collect();
        // The steepest turns that samples can have: they jump between their ends.
        let values: Vec<f64> = (0..200_u32).map(|k| f64::from((k * k / 3) % 2)).collect();
        for t in (0..1980).map(|k| f64::from(k) * 0.1) {
            let i = before(&time, t).clamp(1, 196);
            let [a, b, c, d] = [values[i - 1], values[i], values[i + 1], values[i + 2]];
            let u = t - time[i];
            let free = b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
            assert!(!(0.0..1.0).contains(&u) || (cubic(&time, &values, t) - free).abs() < 1e-9, "{t}");
        }
    }
}
