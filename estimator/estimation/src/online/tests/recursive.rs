use super::Noise;
use crate::online::recursive::Recursive;
use crate::regression::linear::least_squares;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// A constant, a slow sine and something random.
fn row(i: usize, rng: &mut StdRng) -> [f64; 3] {
    [1.0, (0.01 * i as f64).sin(), rng.sample(StandardNormal)]
}

const TRUTH: [f64; 3] = [0.4, -2.0, 0.05];

fn predicted(row: &[f64; 3], values: &[f64; 3]) -> f64 {
    row.iter().zip(values).map(|(x, v)| x * v).sum()
}

#[test]
fn without_forgetting_it_is_the_batch_fit() {
    let mut rng = StdRng::seed_from_u64(1);
    let mut noise = Noise::new(StdRng::seed_from_u64(2), 0.5);
    let mut fit = Recursive::<3>::new([1.0; 3], f64::INFINITY, 10);
    let (mut columns, mut rhs, mut weights) = (vec![Vec::new(); 3], Vec::new(), Vec::new());
    for i in 0..2000 {
        let x = row(i, &mut rng);
        let (y, w) = (predicted(&x, &TRUTH) + 0.1 * noise.next(), rng.random_range(0.5..1.5));
        fit.push(&x, y, w).expect("finite");
        (0..3).for_each(|j| columns[j].push(x[j]));
        rhs.push(y);
        weights.push(w);
    }
    let batch = least_squares(&columns, &rhs, Some(&weights)).expect("solves");
    let errors = fit.std_errors();
    for (value, expected) in fit.values().iter().zip(&batch.values) {
        assert!((value - expected).abs() < 1e-8, "{:?} {:?}", fit.values(), batch.values);
    }
    for (error, expected) in errors.iter().zip(&batch.std_errors) {
        assert!((0.7..1.4).contains(&(error / expected)), "{errors:?} and {:?}", batch.std_errors);
    }
}

/// Share of 95 % intervals that hold the truth.
fn coverage(rows: usize, rho: f64, memory: f64, block: u32) -> [f64; 3] {
    let trials = 400;
    let mut held = [0.0; 3];
    for seed in 0..trials {
        let mut rng = StdRng::seed_from_u64(seed);
        let mut noise = Noise::new(StdRng::seed_from_u64(seed + 100_000), rho);
        let mut fit = Recursive::<3>::new([1.0; 3], memory, block);
        for i in 0..rows {
            let x = row(i, &mut rng);
            let y = predicted(&x, &TRUTH) + 0.1 * noise.next();
            fit.push(&x, y, 1.0).expect("finite");
        }
        let errors = fit.std_errors();
        for (j, (value, truth)) in fit.values().iter().zip(TRUTH).enumerate() {
            held[j] += f64::from(u8::from((value - truth).abs() < 1.96 * errors[j])) / trials as f64;
        }
    }
    held
}

#[test]
fn intervals_hold_the_truth_with_correlated_noise_and_with_forgetting() {
    // 400 trials: three standard errors of a coverage of 0.95 are 0.033.
    for (rows, rho, memory, block) in [
        (150, 0.0, f64::INFINITY, 5),
        (2000, 0.6, f64::INFINITY, 10),
        (4000, 0.9, f64::INFINITY, 20),
        (6000, 0.5, 800.0, 10),
    ] {
        let held = coverage(rows, rho, memory, block);
        println!("{rows} rows, rho {rho}, memory {memory}: {held:?}");
        for share in held {
            assert!((0.90..=0.995).contains(&share), "{rows} rows, rho {rho}, memory {memory}: {held:?}");
        }
    }
}

#[test]
fn what_is_not_excited_is_not_forgotten_in_hours() {
    let mut rng = StdRng::seed_from_u64(3);
    let mut fit = Recursive::<2>::new([1.0; 2], 500.0, 10);
    for i in 0..2000 {
        let x = [1.0, (0.05 * f64::from(i)).sin()];
        fit.push(&x, 0.4 * x[0] - 2.0 * x[1] + 0.1 * rng.sample::<f64, _>(StandardNormal), 1.0).expect("finite");
    }
    let (before, value) = (fit.std_errors()[1], fit.values()[1]);
    // Ten hours at 30 rows a second in which only the first column speaks.
    for _ in 0..1_000_000 {
        fit.push(&[1.0, 0.0], 0.4 + 0.1 * rng.sample::<f64, _>(StandardNormal), 1.0).expect("finite");
    }
    let after = fit.std_errors()[1];
    assert!(after < 1.6 * before && after > 0.6 * before, "{before} became {after}");
    assert!((fit.values()[1] - value).abs() < 3.0 * before);
    assert!(fit.values()[0].is_finite() && (fit.values()[0] - 0.4).abs() < 0.03);
}

#[test]
fn a_finite_memory_follows_what_changes() {
    let mut rng = StdRng::seed_from_u64(4);
    let mut fit = Recursive::<1>::new([1.0], 300.0, 10);
    for i in 0..6000 {
        let truth = 1.0 + 1e-4 * f64::from(i);
        fit.push(&[1.0], truth + 0.05 * rng.sample::<f64, _>(StandardNormal), 1.0).expect("finite");
    }
    // An exponential memory of 300 rows lags by 300 rows.
    assert!((fit.values()[0] - (1.0 + 1e-4 * 5700.0)).abs() < 0.01, "{:?}", fit.values());
}

#[test]
fn bad_rows_are_left_out_and_unexcited_values_are_not_known() {
    let mut fit = Recursive::<2>::new([1.0; 2], f64::INFINITY, 1);
    assert!(fit.push(&[f64::NAN, 0.0], 1.0, 1.0).is_none() && fit.push(&[0.0, 0.0], 1.0, 1.0).is_none());
    assert!(fit.push(&[1.0, 0.0], f64::INFINITY, 1.0).is_none() && fit.push(&[1.0, 0.0], 1.0, -1.0).is_none());
    for i in 0..100 {
        fit.push(&[1.0, 0.0], 2.0 + 0.01 * f64::from(i % 7), 1.0).expect("finite");
    }
    assert!((fit.values()[0] - 2.03).abs() < 0.01 && fit.std_errors()[0] < 0.01);
    assert!(fit.std_errors()[1].is_infinite());
}
