//! A channel as it would be if no cause acted: base model, structured errors and noise.

use super::smooth::rms;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Noise of weighted rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Autoregression {
    /// Coefficients of the lags from 1 on.
    pub coefficients: Vec<f64>,
    /// Standard deviation of what each row adds.
    pub innovation: f64,
}

impl Autoregression {
    /// Noise of consecutive rows. As many rows pass before them, so that it is stationary.
    fn draw(&self, rows: usize, rng: &mut impl Rng) -> Vec<f64> {
        let mut noise: Vec<f64> = Vec::with_capacity(2 * rows);
        for _ in 0..2 * rows {
            let past: f64 = self.coefficients.iter().zip(noise.iter().rev()).map(|(a, e)| a * e).sum();
            noise.push(past + self.innovation * normal(rng));
        }
        noise.split_off(rows)
    }
}

/// A random function of some variables.
#[derive(Clone, Debug, PartialEq)]
pub struct StructuredError {
    /// Columns of random coefficients, without their part along the model's regressors.
    pub waves: Vec<Vec<f64>>,
    /// Root mean square of their sum, N or N m.
    pub rms: f64,
}

impl StructuredError {
    /// Another function of the same size.
    fn draw(&self, weight: &[f64], rng: &mut impl Rng) -> Vec<f64> {
        let mut drawn = vec![0.0; weight.len()];
        for wave in &self.waves {
            let value = normal(rng);
            drawn.iter_mut().zip(wave).for_each(|(d, w)| *d += value * w);
        }
        let scale = self.rms / rms(&drawn, weight).max(f64::MIN_POSITIVE);
        drawn.into_iter().map(|d| scale * d).collect()
    }
}

/// The best model of a channel without any cause.
#[derive(Clone, Debug, PartialEq)]
pub struct NullModel {
    /// Prediction of the base model, row by row, N or N m.
    pub predicted: Vec<f64>,
    pub errors: Vec<StructuredError>,
    /// Noise of the weighted rows.
    pub noise: Autoregression,
    /// Weight of each row's error.
    pub weight: Vec<f64>,
    /// The measured value of each row.
    pub target: Vec<f64>,
}

impl NullModel {
    /// A replay less the measurement, row by row: other structured errors of the same size and other noise of the same
    /// spectrum.
    pub fn change(&self, rng: &mut impl Rng) -> Vec<f64> {
        let mut drawn = self.predicted.clone();
        for error in &self.errors {
            let error = error.draw(&self.weight, rng);
            drawn.iter_mut().zip(error).for_each(|(d, e)| *d += e);
        }
        let noise = self.noise.draw(self.target.len(), rng);
        drawn.into_iter().zip(noise).zip(&self.target).map(|((d, e), y)| d + e - y).collect()
    }
}

fn normal(rng: &mut impl Rng) -> f64 {
    StandardNormal.sample(rng)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::StdRng;

    const ROWS: usize = 20_000;

    fn power(values: &[f64]) -> f64 {
        values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
    }

    #[test]
    fn noise_has_the_variance_of_its_autoregression_from_its_first_row_on() {
        let noise = Autoregression { coefficients: vec![0.8], innovation: 0.3 };
        let mut rng = StdRng::seed_from_u64(1);
        let wanted = 0.09 / (1.0 - 0.64);
        assert!((power(&noise.draw(ROWS, &mut rng)) / wanted - 1.0).abs() < 0.1);
        let first: Vec<f64> = (0..2000).map(|_| noise.draw(50, &mut rng)[0]).collect();
        assert!((power(&first) / wanted - 1.0).abs() < 0.15);
    }

    #[test]
    fn a_replay_has_the_prediction_a_structured_error_of_its_size_and_noise() {
        let wave: Vec<f64> = (0..ROWS).map(|i| (0.01 * i as f64).sin()).collect();
        let size = rms(&wave, &vec![1.0; ROWS]);
        let null = NullModel {
            predicted: vec![3.0; ROWS],
            errors: vec![StructuredError { waves: vec![wave.clone()], rms: 2.0 }],
            noise: Autoregression { coefficients: Vec::new(), innovation: 0.1 },
            weight: vec![1.0; ROWS],
            target: vec![1.0; ROWS],
        };
        let change = null.change(&mut StdRng::seed_from_u64(2));
        let other = null.change(&mut StdRng::seed_from_u64(3));
        let along = |values: &[f64]| {
            let product: f64 = values.iter().zip(&wave).map(|(v, w)| (v - 2.0) * w / size).sum();
            product / ROWS as f64
        };
        assert!([along(&change), along(&other)].iter().all(|size| (size.abs() - 2.0).abs() < 0.01));
        let noise: Vec<f64> = change.iter().zip(&wave).map(|(v, w)| v - 2.0 - along(&change) * w / size).collect();
        assert!((power(&noise) - 0.01).abs() < 1e-3);
    }
}
