//! Every algorithm against the sum over all paths, one by one, on small models drawn at random.

use super::*;
use nalgebra::DMatrix;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

fn distribution(rng: &mut StdRng, allowed: &[bool]) -> Vec<f64> {
    let raw: Vec<f64> = allowed.iter().map(|a| if *a { rng.random_range(0.05..1.0) } else { 0.0 }).collect();
    let total: f64 = raw.iter().sum();
    raw.iter().map(|p| p / total).collect()
}

/// A random model; `left_right`: no way back.
fn model(rng: &mut StdRng, k: usize, d: usize, full: bool, left_right: bool) -> Model {
    let start: Vec<bool> = (0..k).map(|s| s == 0 || !left_right).collect();
    let start = distribution(rng, &start);
    let transition = (0..k)
        .flat_map(|from| {
            let allowed: Vec<bool> = (0..k).map(|to| !left_right || to == from || to == from + 1).collect();
            distribution(rng, &allowed)
        })
        .collect();
    let emissions = (0..k)
        .map(|_| {
            let mean = (0..d).map(|_| rng.random_range(-2.0..2.0)).collect();
            let spread = if full {
                let a = DMatrix::from_fn(d, d, |_, _| rng.random_range(-1.0..1.0));
                Covariance::Full(&a * a.transpose() + DMatrix::identity(d, d) * 0.2)
            } else {
                Covariance::Diagonal((0..d).map(|_| rng.random_range(0.2..2.0)).collect())
            };
            Gaussian::new(mean, spread, &vec![1e-6; d])
        })
        .collect();
    Model::new(Chain::new(start, transition).expect("a chain"), emissions).expect("a model")
}

fn noise(rng: &mut StdRng, count: usize) -> Vec<f64> {
    (0..count).map(|_| 1.5 * rng.sample::<f64, _>(StandardNormal)).collect()
}

/// The density of a normal distribution from its textbook formula.
fn density(g: &Gaussian, x: &[f64]) -> f64 {
    let d = x.len();
    let sigma = match g.covariance() {
        Covariance::Full(m) => m.clone(),
        Covariance::Diagonal(v) => DMatrix::from_fn(d, d, |a, b| if a == b { v[a] } else { 0.0 }),
    };
    let apart = DMatrix::from_fn(d, 1, |c, _| x[c] - g.mean()[c]);
    let inverse = sigma.clone().try_inverse().expect("regular");
    let squared = (apart.transpose() * inverse * &apart)[(0, 0)];
    (-0.5 * squared).exp() / (std::f64::consts::TAU.powf(d as f64) * sigma.determinant()).sqrt()
}

struct Brute {
    likelihood: f64,
    posterior: Vec<f64>,
    transitions: Vec<f64>,
    best: (Vec<u8>, f64),
}

/// All Kᵀ paths.
fn brute(model: &Model, values: &[f64]) -> Brute {
    let (k, d) = (model.chain.states(), model.channels());
    let samples = values.len() / d;
    let mut out = Brute {
        likelihood: 0.0,
        posterior: vec![0.0; samples * k],
        transitions: vec![0.0; k * k],
        best: (Vec::new(), -1.0),
    };
    for number in 0..k.pow(samples as u32) {
        let path: Vec<usize> = (0..samples).map(|t| number / k.pow(t as u32) % k).collect();
        let mut p = model.chain.start()[path[0]];
        for (t, state) in path.iter().enumerate() {
            if t > 0 {
                p *= model.chain.transition()[path[t - 1] * k + state];
            }
            p *= density(&model.emissions[*state], &values[t * d..(t + 1) * d]);
        }
        out.likelihood += p;
        for (t, state) in path.iter().enumerate() {
            out.posterior[t * k + state] += p;
            if t > 0 {
                out.transitions[path[t - 1] * k + state] += p;
            }
        }
        if p > out.best.1 {
            out.best = (path.iter().map(|s| *s as u8).collect(), p);
        }
    }
    let total = out.likelihood;
    out.posterior.iter_mut().chain(&mut out.transitions).for_each(|v| *v /= total);
    out
}

#[test]
fn agrees_with_the_sum_over_all_paths() {
    let mut rng = StdRng::seed_from_u64(11);
    for case in 0..200 {
        let (k, d, samples) = (rng.random_range(1..4), rng.random_range(1..4), rng.random_range(1..7));
        let m = model(&mut rng, k, d, case % 2 == 0, case % 3 == 0);
        let values = noise(&mut rng, samples * d);
        let log_b = m.log_emissions(&values, 1.0);
        let truth = brute(&m, &values);
        let found = forward_backward(&m.chain, &log_b);
        assert!((found.log_likelihood - truth.likelihood.ln()).abs() < 1e-10, "case {case}");
        for (a, b) in found.posterior.iter().zip(&truth.posterior) {
            assert!((a - b).abs() < 1e-10, "case {case}: posterior {a} and {b}");
        }
        for (a, b) in found.transitions.iter().zip(&truth.transitions) {
            assert!((a - b).abs() < 1e-9, "case {case}: transitions {a} and {b}");
        }
        let (path, log_p) = viterbi(&m.chain, &log_b);
        assert_eq!(path, truth.best.0, "case {case}");
        assert!((log_p - truth.best.1.ln()).abs() < 1e-10, "case {case}");
        assert!((path_log_probability(&m.chain, &log_b, &path) - log_p).abs() < 1e-10, "case {case}");
    }
}

/// A sequence that the model itself makes.
fn drawn(rng: &mut StdRng, m: &Model, samples: usize) -> Vec<f64> {
    let k = m.chain.states();
    let pick = |row: &[f64], u: f64| {
        let mut sum = 0.0;
        let found = row.iter().position(|p| {
            sum += p;
            u < sum
        });
        found.unwrap_or(row.len() - 1)
    };
    let mut state = pick(m.chain.start(), rng.random());
    let mut values = Vec::new();
    for _ in 0..samples {
        let g = &m.emissions[state];
        values.extend(
            (0..m.channels()).map(|c| g.mean()[c] + g.variance(c).sqrt() * rng.sample::<f64, _>(StandardNormal)),
        );
        state = pick(&m.chain.transition()[state * k..(state + 1) * k], rng.random());
    }
    values
}

fn training(d: usize, prior: Option<Prior>) -> Training {
    Training { most_steps: 30, least_gain: f64::NEG_INFINITY, weight: 1.0, floor: vec![1e-4; d], prior }
}

#[test]
fn no_step_of_training_loses_likelihood() {
    let mut rng = StdRng::seed_from_u64(12);
    for case in 0..60 {
        let (k, d) = (rng.random_range(1..5), rng.random_range(1..4));
        let (full, left_right) = (case % 2 == 0, case % 3 == 0);
        let truth = model(&mut rng, k, d, full, left_right);
        let mut values = drawn(&mut rng, &truth, 300);
        if case % 5 == 0 {
            // A channel that never changes, and missing samples.
            values.iter_mut().step_by(d).for_each(|v| *v = 3.0);
            values[7 * d] = f64::NAN;
        }
        let start = model(&mut rng, k, d, full, left_right);
        let prior = (case % 4 > 1).then(|| Prior {
            emissions: start.emissions.clone(),
            emission_samples: vec![20.0; k],
            transitions: start.chain.transition().iter().map(|p| 5.0 * p).collect(),
        });
        let mut how = training(d, prior);
        how.weight = if case % 7 == 0 { 0.3 } else { 1.0 };
        let forbidden: Vec<bool> = start.chain.transition().iter().map(|p| *p == 0.0).collect();
        let trained = baum_welch(start, &values, &how).expect("trains");
        for pair in trained.objective.windows(2) {
            assert!(pair[1] >= pair[0] - 1e-7 * pair[0].abs(), "case {case}: {:?}", trained.objective);
        }
        for (was_forbidden, p) in forbidden.iter().zip(trained.model.chain.transition()) {
            assert!(!was_forbidden || *p == 0.0, "case {case}: a forbidden transition came back");
        }
    }
}

#[test]
fn training_finds_the_model_that_made_the_data() {
    let mut rng = StdRng::seed_from_u64(13);
    let gaussian = |m: f64, v: f64| Gaussian::new(vec![m], Covariance::Diagonal(vec![v]), &[1e-6]);
    let chain = |stay: f64| Chain::new(vec![0.5; 2], vec![stay, 1.0 - stay, 1.0 - stay, stay]).expect("a chain");
    let truth = Model::new(chain(0.98), vec![gaussian(0.0, 1.0), gaussian(3.0, 0.25)]).expect("a model");
    let values = drawn(&mut rng, &truth, 20_000);
    let start = Model::new(chain(0.7), vec![gaussian(-1.0, 2.0), gaussian(2.0, 2.0)]).expect("a model");
    let found = baum_welch(start, &values, &training(1, None)).expect("trains").model;
    assert!((found.emissions[0].mean()[0]).abs() < 0.05 && (found.emissions[1].mean()[0] - 3.0).abs() < 0.05);
    assert!(
        (found.emissions[0].variance(0) - 1.0).abs() < 0.07 && (found.emissions[1].variance(0) - 0.25).abs() < 0.03
    );
    assert!((found.chain.transition()[0] - 0.98).abs() < 0.006, "{:?}", found.chain);
}

#[test]
fn a_prior_without_end_keeps_a_state() {
    let mut rng = StdRng::seed_from_u64(14);
    let start = model(&mut rng, 2, 2, true, false);
    let values = noise(&mut rng, 400);
    let prior = Prior {
        emissions: start.emissions.clone(),
        emission_samples: vec![f64::INFINITY, 1.0],
        transitions: vec![1.0; 4],
    };
    let trained = baum_welch(start.clone(), &values, &training(2, Some(prior))).expect("trains").model;
    assert_eq!(trained.emissions[0], start.emissions[0]);
    assert_ne!(trained.emissions[1], start.emissions[1]);
}

#[test]
fn a_million_samples_stay_finite() {
    let mut rng = StdRng::seed_from_u64(15);
    let m = model(&mut rng, 4, 2, false, false);
    let mut values = drawn(&mut rng, &m, 1_000_000);
    // A sample that fits nothing, and one far beyond it.
    values[1000] = 1e6;
    values[2001] = -1e9;
    let log_b = m.log_emissions(&values, 1.0);
    let found = forward_backward(&m.chain, &log_b);
    assert!(found.log_likelihood.is_finite());
    for row in found.posterior.chunks_exact(4) {
        let sum: f64 = row.iter().sum();
        assert!((sum - 1.0).abs() < 1e-9, "{row:?}");
    }
    assert!((found.transitions.iter().sum::<f64>() - 999_999.0).abs() < 1e-3);
    let (path, log_p) = viterbi(&m.chain, &log_b);
    assert!(log_p <= found.log_likelihood && log_p.is_finite() && path.len() == 1_000_000);
}

#[test]
fn a_path_through_an_impossible_sample_is_not_lost() {
    // 0 → 1 → 2 only; the middle sample speaks against state 1 by far more than a number can hold.
    let chain = Chain::new(vec![1.0, 0.0, 0.0], vec![0.5, 0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 1.0]).expect("a chain");
    let log_b = [0.0, -9e3, -9e3, 0.0, -2e3, -9e3, -9e3, -9e3, 0.0];
    let found = forward_backward(&chain, &log_b);
    assert!((found.log_likelihood - (0.25_f64.ln() - 2e3)).abs() < 1e-9, "{found:?}");
    assert!((found.posterior[4] - 1.0).abs() < 1e-12 && (found.transitions[1] - 1.0).abs() < 1e-12, "{found:?}");
    assert_eq!(viterbi(&chain, &log_b).0, [0, 1, 2]);
}

#[test]
fn a_constant_channel_and_nonsense_keep_a_density() {
    for spread in [
        Covariance::Diagonal(vec![0.0, 1.0]),
        Covariance::Diagonal(vec![f64::NAN, 1.0]),
        Covariance::Full(DMatrix::zeros(2, 2)),
        Covariance::Full(DMatrix::from_element(2, 2, 1.0)),
        Covariance::Full(DMatrix::from_element(2, 2, f64::NAN)),
    ] {
        let g = Gaussian::new(vec![1.0, 2.0], spread, &[1e-4, 1e-4]);
        assert!(g.log_density(&[1.0, 2.0]).is_finite() && g.log_density(&[5.0, -3.0]).is_finite());
        assert!(g.variance(0) >= 0.99e-4, "{g:?}");
    }
}

#[test]
fn what_is_no_model_is_refused_in_a_sentence() {
    assert!(Chain::new(vec![], vec![]).is_err());
    assert!(Chain::new(vec![1.0], vec![1.0, 0.0]).is_err());
    let refused = Chain::new(vec![0.5, 0.5], vec![0.9, 0.2, 0.5, 0.5]).expect_err("110 %").to_string();
    assert!(refused.contains("row 0"), "{refused}");
    let g = Gaussian::new(vec![0.0], Covariance::Diagonal(vec![1.0]), &[1e-6]);
    assert!(Model::new(Chain::sticky(2, 10.0, &[1.0; 4]).expect("a chain"), vec![g]).is_err());
    let empty = forward_backward(&Chain::sticky(2, 10.0, &[1.0; 4]).expect("a chain"), &[]);
    assert!(empty.posterior.is_empty() && empty.log_likelihood == 0.0);
}

/// Reference for every processor: density by density, then the general walk.
fn by_definition(m: &Model, values: &[f64], weight: f64) -> Vec<f64> {
    let densities = |x: &[f64]| m.emissions.iter().map(|e| weight * e.log_density(x)).collect::<Vec<_>>();
    let none = vec![0.0; m.chain.states()];
    let row = |x: &[f64]| if x.iter().all(|v| v.is_finite()) { densities(x) } else { none.clone() };
    values.chunks_exact(m.channels()).flat_map(row).collect()
}

#[test]
fn decoding_in_one_pass_is_the_definition_step_by_step() {
    let mut rng = StdRng::seed_from_u64(16);
    for (case, k) in [1, 2, 3, 4, 5, 6, 7, 8, 9, 12].into_iter().cycle().take(40).enumerate() {
        let d = rng.random_range(1..14);
        let mut m = model(&mut rng, k, d, case % 2 == 0, case % 3 == 0);
        if case % 5 == 0 {
            // One state of another kind than the rest.
            let spread = Covariance::Diagonal(vec![0.7; d]);
            m.emissions[k / 2] = Gaussian::new(vec![0.3; d], spread, &vec![1e-6; d]);
        }
        // Lengths about those of blocks and segments.
        let samples = [0, 1, 3, 31, 33, 1024, 1027, 8192, 8193, 20_001][case % 10];
        let mut values = noise(&mut rng, samples * d);
        if samples > 30 {
            values[7 * d] = f64::NAN;
            values[11 * d + d - 1] = f64::INFINITY;
            values[23 * d] = 1e200;
        }
        let weight = if case % 4 == 0 { 0.3 } else { 1.0 };
        let truth = by_definition(&m, &values, weight);
        let found = m.log_emissions(&values, weight);
        assert_eq!(found.len(), truth.len(), "case {case}");
        for (i, (a, b)) in found.iter().zip(&truth).enumerate() {
            assert!(a == b || (a - b).abs() <= 1e-11 * b.abs().max(1.0), "case {case}, number {i}: {a} and {b}");
        }
        let walked = viterbi::plain(&m.chain, &found);
        assert_eq!(viterbi(&m.chain, &found), walked, "case {case}");
        assert_eq!(m.decode(&m.chain, &values, weight).expect("fits"), walked, "case {case}");
    }
}

#[test]
fn every_processor_computes_the_same() {
    // The way for processors without wide registers, on this one.
    let mut rng = StdRng::seed_from_u64(17);
    for full in [true, false] {
        let m = model(&mut rng, 5, 12, full, false);
        let mut values = noise(&mut rng, 12 * 1000);
        values[12 * 40 + 3] = f64::NAN;
        let truth = by_definition(&m, &values, 1.0);
        let mut rows = vec![0.0; 5 * 1000];
        emissions::Job { model: &m, weight: 1.0, stride: 5 }.fill_plain(&values, &mut rows);
        assert_eq!(rows, truth);
    }
}

#[test]
fn a_chain_of_another_size_is_refused() {
    let mut rng = StdRng::seed_from_u64(18);
    let m = model(&mut rng, 3, 2, true, false);
    let other = Chain::sticky(2, 10.0, &[1.0; 4]).expect("a chain");
    assert!(m.decode(&other, &[0.0; 8], 1.0).expect_err("two states").to_string().contains("3 emissions"));
}
