use foundation::signal::task::DERIVATIVE_WINDOW_S;
use haptics::recording::Recording;
use std::borrow::Cow;

/// Rates and their positions.
pub(crate) const RATES: [(&str, &str); 12] = [
    ("dq_m_s", "q_m"),
    ("dq_rad_s", "q_rad"),
    ("vx_m_s", "x_m"),
    ("vy_m_s", "y_m"),
    ("vx1_m_s", "x1_m"),
    ("vy1_m_s", "y1_m"),
    ("vx2_m_s", "x2_m"),
    ("vy2_m_s", "y2_m"),
    ("dqb_rad_s", "qb_rad"),
    ("dqt_rad_s", "qt_rad"),
    ("dqb1_rad_s", "qb1_rad"),
    ("dqt1_rad_s", "qt1_rad"),
];

/// Correlation, of either sign, that is certain.
/// Choice: halved, 0 of 68 answers change; doubled, 1 of 68 answers change (1 to right).
pub(crate) const CORRELATED: f64 = 0.8;

/// The recording with the sign of a rate corrected that goes against its motion, and the name of that rate.
pub fn with_rates_of_motion(recording: &Recording) -> (Cow<'_, Recording>, Option<&'static str>) {
    let against = RATES.iter().find(|(rate, of)| correlation(recording, rate, of).is_some_and(|c| c < -CORRELATED));
    match against {
        Some((rate, _)) => (Cow::Owned(mirrored(recording, &[rate])), Some(rate)),
        None => (Cow::Borrowed(recording), None),
    }
}

/// Correlation of a recorded rate with the differences of its position.
pub(crate) fn correlation(recording: &Recording, rate: &str, of: &str) -> Option<f64> {
    let (rate, place) = (recording.channel(rate)?, recording.channel(of)?);
    let time_s = recording.time_s.as_ref()?;
    let n = time_s.len();
    let period_s = (time_s.last()? - time_s.first()?) / n.max(2) as f64;
    let half = ((0.5 * DERIVATIVE_WINDOW_S / period_s).round() as usize).max(1);
    let (mut across, mut of_rate, mut of_slope) = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in (half..n.saturating_sub(half)).step_by(half) {
        let slope = (place[i + half] - place[i - half]) / (time_s[i + half] - time_s[i - half]).max(1e-9);
        let mean = rate[i - half..=i + half].iter().sum::<f64>() / (2 * half + 1) as f64;
        if slope.is_finite() && mean.is_finite() {
            across += slope * mean;
            of_rate += mean * mean;
            of_slope += slope * slope;
        }
    }
    (of_rate > 0.0 && of_slope > 0.0).then(|| across / (of_rate * of_slope).sqrt())
}

/// The recording with some of its channels mirrored.
pub fn mirrored(recording: &Recording, names: &[&str]) -> Recording {
    let mut other = recording.clone();
    for channel in other.channels.iter_mut().filter(|c| names.contains(&c.name.as_str())) {
        channel.values.iter_mut().for_each(|v| *v = -*v);
    }
    other
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    #[test]
    fn a_rate_against_its_motion_is_turned_and_noise_is_not() {
        let time_s: Vec<f64> = (0..2000).map(|k| 0.005 * f64::from(k)).collect();
        let channel = |name: &str, of: &dyn Fn(f64) -> f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: time_s.iter().map(|t| of(*t)).collect(),
        };
        let noise = |t: f64| (t * 7_731.3).sin();
        let place = channel("q_m", &|t| 0.1 * (2.0 * t).sin() + 1e-5 * noise(t));
        let make = |rate: &dyn Fn(f64) -> f64| Recording {
            time_s: Some(time_s.clone()),
            channels: vec![place.clone(), channel("dq_m_s", rate)],
            ..Recording::default()
        };
        let against = make(&|t| -0.2 * (2.0 * t).cos() + 0.02 * noise(t));
        let (turned, rate) = with_rates_of_motion(&against);
        assert_eq!(rate, Some("dq_m_s"));
        assert!(correlation(&turned, "dq_m_s", "q_m").expect("both are there") > 0.9);
        assert_eq!(with_rates_of_motion(&make(&|t| 0.2 * (2.0 * t).cos())).1, None);
        assert_eq!(with_rates_of_motion(&make(&noise)).1, None);
    }
}
