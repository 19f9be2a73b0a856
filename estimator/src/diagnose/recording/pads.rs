//! Compliance of the pads with which two fingers hold an object, from the closing of their grip.

use super::grip_axis_signs::PRESSING;
use crate::diagnose::data::limits::HALF;
use estimation::regression::linear::least_squares_values;
use foundation::signal::task::{TaskSignals, smooth};
use haptics::Vec2;

/// Compliance of one of two equal pads along their line of grip, m/N. An object of constant width between them brings the
/// tips nearer to each other by twice as much for each newton of grip; it lies behind each tip by this for each newton of
/// that finger's force.
///
/// `None` if the grip does not explain most of the changes of its width.
pub fn compliance_m_n(signals: &TaskSignals) -> Option<f64> {
    let force = |k: usize, i: usize| signals.tips[k].force.as_ref().map_or(0.0, |force: &Vec<Vec2>| force[i].x);
    let grip_n = |i: usize| 0.5 * (force(0, i) - force(1, i));
    let firmest_n = signals.grip_force_n.iter().copied().fold(0.0, f64::max);
    let pressed: Vec<usize> =
        (0..signals.grip_force_n.len()).filter(|i| signals.grip_force_n[*i] > PRESSING * firmest_n).collect();
    let width_m: Vec<f64> = pressed.iter().map(|i| signals.grip_width_m[*i]).collect();
    let grips: Vec<f64> = pressed.iter().map(|i| grip_n(*i)).collect();
    let fit = least_squares_values(&[vec![1.0; grips.len()], grips], &width_m, None).ok()?;
    let mean_m = width_m.iter().sum::<f64>() / width_m.len() as f64;
    let spread_m = (width_m.iter().map(|w| (w - mean_m).powi(2)).sum::<f64>() / width_m.len() as f64).sqrt();
    let explains = fit.rms.powi(2) < HALF * spread_m.powi(2);
    (explains && fit.values[1] < 0.0).then_some(-0.5 * fit.values[1])
}

/// Position, m, and velocity, m/s, along the grip of the object behind one finger's pad: those of the tip less the give of
/// a pad of this compliance, m/N.
pub fn behind_pad(signals: &TaskSignals, finger: usize, pad_m_n: f64) -> (Vec<f64>, Vec<f64>) {
    let tip = &signals.tips[finger];
    let along = |values: &Option<Vec<Vec2>>| -> Vec<f64> {
        values.as_ref().map_or_else(|| vec![0.0; signals.len()], |all| all.iter().map(|v| v.x).collect())
    };
    let force_n = along(&tip.force);
    let rate_n_s = smooth(&signals.time_s, &force_n).slope;
    let less = |tip: f64, force: &f64| tip - pad_m_n * force;
    let position = tip.position.iter().map(|p| p.x).zip(&force_n).map(|(tip, force)| less(tip, force));
    let velocity = along(&tip.velocity).into_iter().zip(&rate_n_s).map(|(tip, rate)| less(tip, rate));
    (position.collect(), velocity.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use foundation::signal::task::task_signals;
    use haptics::recording::{Channel, Recording};

    /// Two fingers that close on an object and pull it back and forth. `give`: of either pad, m/N.
    fn held(give: f64) -> Recording {
        let n = 2000;
        let closed = |i: usize| (0.01 * i as f64 - 2.0).clamp(0.0, 3.0);
        let pull = |i: usize| 0.4 * (0.02 * i as f64).sin() * closed(i) / 3.0;
        let noise = |i: usize, k: usize| 5e-6 * (1.3 * (i * i + 7 * k) as f64).sin();
        let force = |i: usize, side: f64| closed(i) * -side + 0.5 * pull(i);
        let tip = |i: usize, side: f64, k: usize| {
            let open = if closed(i) > 0.0 { 0.0 } else { 2e-5 * (200.0 - i as f64) };
            side * (0.005 + open) + give * force(i, side) + 1e-3 * (0.004 * i as f64).sin() + noise(i, k)
        };
        let channel = |name: &str, of: &dyn Fn(usize) -> f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: (0..n).map(of).collect(),
        };
        let channels = vec![
            channel("x1_m", &|i| tip(i, -1.0, 1)),
            channel("x2_m", &|i| tip(i, 1.0, 2)),
            channel("y1_m", &|_| 0.0),
            channel("y2_m", &|_| 0.0),
            channel("fx1_N", &|i| force(i, -1.0)),
            channel("fx2_N", &|i| force(i, 1.0)),
            channel("fy1_N", &|_| 0.0),
            channel("fy2_N", &|_| 0.0),
        ];
        let time_s = Some((0..n).map(|i| 0.005 * i as f64).collect());
        Recording { time_s, channels, ..Recording::default() }
    }

    #[test]
    fn the_closing_of_a_grip_shows_its_pads_and_rigid_fingertips_show_none() {
        let of = |give: f64| compliance_m_n(&task_signals(&held(give)).expect("signals"));
        let compliance_m_n = of(4e-4).expect("the closing shows it");
        assert!((compliance_m_n / 4e-4 - 1.0).abs() < 0.02, "{compliance_m_n}");
        assert_eq!(of(0.0), None);
    }
}
