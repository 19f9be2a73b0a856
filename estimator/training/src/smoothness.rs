//! Smoothness of a motion, two measures.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Spectral components below this share of the largest one are left out at both ends of the band.
/// Source: Balasubramanian, Melendez-Calderon, Roby-Brami & Burdet 2015.
pub const SPARC_AMPLITUDE: f64 = 0.05;
/// The speed is padded with zeros to 2^level times the next power of two.
pub const SPARC_PAD_LEVEL: u32 = 4;
/// Upper end of the band, Hz.
pub const SPARC_CUTOFF_HZ: f64 = 10.0;

/// Spectral arc length of a speed profile (Balasubramanian et al. 2015, *On the analysis of movement smoothness*). It
/// is the negative length of the normalised amplitude spectrum up to [`SPARC_CUTOFF_HZ`]; without unit, below zero,
/// nearer zero: smoother.
///
/// `speed`: n samples at `rate_hz`, ≥ 0. `None` without motion.
pub fn sparc(speed: &[f64], rate_hz: f64) -> Option<f64> {
    if speed.len() < 2 || !positive(rate_hz) || !speed.iter().all(|v| v.is_finite()) {
        return None;
    }
    let size = speed.len().next_power_of_two() << SPARC_PAD_LEVEL;
    let mut spectrum: Vec<Complex<f64>> = speed.iter().map(|v| Complex::new(*v, 0.0)).collect();
    spectrum.resize(size, Complex::new(0.0, 0.0));
    FftPlanner::new().plan_fft_forward(size).process(&mut spectrum);
    let bins = ((SPARC_CUTOFF_HZ * size as f64 / rate_hz) as usize + 1).min(size / 2 + 1);
    let largest = spectrum.iter().take(size / 2 + 1).map(|c| c.norm()).fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let amplitude: Vec<f64> = spectrum[..bins].iter().map(|c| c.norm() / largest).collect();
    let first = amplitude.iter().position(|a| *a >= SPARC_AMPLITUDE)?;
    let last = amplitude.iter().rposition(|a| *a >= SPARC_AMPLITUDE)?;
    let steps = last.checked_sub(first).filter(|n| *n > 0)? as f64;
    Some(-amplitude[first..=last].windows(2).map(|pair| (1.0 / steps).hypot(pair[1] - pair[0])).sum::<f64>())
}

/// Logarithm of the dimensionless jerk of a speed profile (Hogan & Sternad 2009): −ln(T³/v² ∫ v̈² dt), with T the duration and v the
/// largest speed; without unit, larger: smoother.
///
/// `speed`: n samples at `rate_hz`, ≥ 0. `None` without motion.
pub fn log_dimensionless_jerk(speed: &[f64], rate_hz: f64) -> Option<f64> {
    let largest = speed.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if speed.len() < 4 || !positive(rate_hz) || !positive(largest) {
        return None;
    }
    let step_s = 1.0 / rate_hz;
    let jerk = speed.windows(3).map(|v| (v[2] - 2.0 * v[1] + v[0]) / (step_s * step_s));
    let duration_s = speed.len() as f64 * step_s;
    let scaled = duration_s.powi(3) / largest.powi(2) * step_s * jerk.map(|j| j * j).sum::<f64>();
    (scaled > 0.0 && scaled.is_finite()).then(|| -scaled.ln())
}

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One bell: exp(−5 t²) from −1 to 1 s at 100 Hz, the usual example.
    fn bell() -> Vec<f64> {
        (0..200).map(|k| (-5.0 * (f64::from(k) * 0.01 - 1.0).powi(2)).exp()).collect()
    }

    #[test]
    fn the_usual_example_has_the_published_values() {
        assert!((sparc(&bell(), 100.0).expect("it moves") + 1.41403).abs() < 1e-5);
        assert!((log_dimensionless_jerk(&bell(), 100.0).expect("it moves") + 5.81636).abs() < 1e-5);
    }

    #[test]
    fn neither_size_nor_pace_counts_but_hesitation_does() {
        let larger: Vec<f64> = bell().iter().map(|v| 7.0 * v).collect();
        assert!((sparc(&larger, 100.0).expect("moves") - sparc(&bell(), 100.0).expect("moves")).abs() < 1e-12);
        let slower = log_dimensionless_jerk(&bell(), 50.0).expect("moves");
        assert!((slower - log_dimensionless_jerk(&bell(), 100.0).expect("moves")).abs() < 1e-9);
        let twice: Vec<f64> = bell().into_iter().chain(bell()).collect();
        assert!(sparc(&twice, 100.0).expect("moves") < sparc(&bell(), 100.0).expect("moves") - 0.3);
        assert!(log_dimensionless_jerk(&twice, 100.0) < log_dimensionless_jerk(&bell(), 100.0));
    }

    #[test]
    fn what_stands_still_has_no_smoothness() {
        for still in [vec![], vec![0.0; 100], vec![f64::NAN; 100]] {
            assert!(sparc(&still, 100.0).is_none() && log_dimensionless_jerk(&still, 100.0).is_none());
        }
        assert!(sparc(&bell(), 0.0).is_none());
    }
}
