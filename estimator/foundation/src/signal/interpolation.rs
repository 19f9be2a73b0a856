//! Values between samples at uneven times.

/// Index of the last sample at or before `t`, or the first one.
pub fn before(time: &[f64], t: f64) -> usize {
    time.partition_point(|&s| s <= t).saturating_sub(1)
}

/// Value at `t` of the cubic through four neighbours: Hermite, with the slopes of the parabolas through three, so that
/// uneven steps keep their place. A sample at `t` itself is returned unchanged. After the last sample its value holds.
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
    (2.0 * u3 - 3.0 * u2 + 1.0) * left
        + (u3 - 2.0 * u2 + u) * step * slope_left
        + (3.0 * u2 - 2.0 * u3) * right
        + (u3 - u2) * step * slope_right
}

/// Slope at sample `i` of the parabola through it and its neighbours.
fn slope(time: &[f64], values: &[f64], i: usize) -> Option<f64> {
    let (h0, h1) = (time[i] - time[i - 1], time[i + 1] - time[i]);
    let (d0, d1) = ((values[i] - values[i - 1]) / h0, (values[i + 1] - values[i]) / h1);
    let slope = (h1 * d0 + h0 * d1) / (h0 + h1);
    slope.is_finite().then_some(slope)
}
