//! Rows of a needle as in a recording, with effects that must not be named as causes.

use super::rows::{Needle, Phase, Puncture, Row};
use super::sheet;
use crate::diagnose::data::regression_data::Span;
use crate::diagnose::selection::rules::Rules;
use crate::diagnose::tasks::needle::punctures;
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;

const PERIOD_S: f64 = 0.036;
const STIFFNESS_N_M: f64 = 400.0;
const NOISE_N: f64 = 6e-3;

fn normals(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = rand::rngs::StdRng::seed_from_u64(seed);
    move || {
        let (a, b): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }
}

/// Five pushes at places 10 mm apart, each at its own speed. `askew`: rise of the surface per distance across;
/// `goes_on`: correlation of the noise of neighbouring rows.
fn needle(seed: u64, askew: f64, goes_on: f64) -> Needle {
    let mut normal = normals(seed);
    let (mut rows, mut time_s, mut noise) = (Vec::new(), 0.0, 0.0);
    let mut row = |push: usize, phase: Phase, depth_m: f64, rate_m_s: f64| {
        noise = goes_on * noise + NOISE_N * (1.0 - goes_on * goes_on).sqrt() * normal();
        time_s += PERIOD_S;
        let side_m = 0.01 * push as f64;
        let pressed_m = if phase == Phase::Loading { depth_m - askew * side_m } else { 0.0 };
        Row {
            recording: 0,
            start_s: 0.0,
            time_s,
            depth_m,
            rate_m_s,
            acceleration_m_s2: 0.0,
            side_m,
            force_n: STIFFNESS_N_M * pressed_m + noise,
            phase,
            hold: 0,
            push,
            deepest_m: depth_m,
            stretch: 2 * push + usize::from(phase == Phase::Loading),
            span: Span::default(),
        }
    };
    for (push, rate_m_s) in [0.006, 0.01, 0.014, 0.017, 0.02].into_iter().enumerate() {
        rows.extend((0..60).map(|_| row(push, Phase::Outside, -0.01, rate_m_s)));
        let way_m = rate_m_s * PERIOD_S;
        let steps = (3.5e-3 / way_m) as usize;
        rows.extend((1..=steps).map(|k| row(push, Phase::Loading, 3e-4 + k as f64 * way_m, rate_m_s)));
    }
    Needle {
        rows,
        fine: Vec::new(),
        joined: false,
        recordings: 1,
        holds: 1,
        period_s: PERIOD_S,
        two_fingered: false,
        stiffness_n_m: STIFFNESS_N_M,
        at_surface_m: 5e-4,
        rate_noise_m_s: 1e-5,
        slope_noise_m_s: 1e-5,
        directions: vec![haptics::Vec2::y()],
        punctures: Vec::new(),
        late: None,
    }
}

fn named(needle: &Needle) -> Vec<&'static str> {
    let found = sheet::sheet(needle, None, Rules::of_observations()).expect("a sheet").compared;
    found.study.picks().into_iter().map(|p| found.study.candidates[p].id).collect()
}

/// The axis of a needle is known from its forces to a few thousandths, so each place has a slightly different surface,
/// and its own speed.
#[test]
fn a_sheet_that_is_not_square_to_the_needle_does_not_drag() {
    for seed in 0..6 {
        let found = named(&needle(seed, 3e-3, 0.0));
        assert!(found.is_empty(), "seed {seed}: {found:?}");
    }
}

#[test]
fn noise_that_goes_on_from_row_to_row_is_no_drift() {
    let found: Vec<_> = (0..20).map(|seed| named(&needle(seed, 0.0, 0.8))).filter(|ids| !ids.is_empty()).collect();
    assert!(found.len() <= 1, "{found:?}");
}

/// A sensor drift between two punctures is no difference of the sheet.
#[test]
fn punctures_are_compared_without_what_the_sensor_drifts_by() {
    let at = |time_s: f64, force_n: f64| Puncture { recording: 0, time_s, force_n, error_n: 0.01, hold: 0 };
    let pierced = Needle { punctures: vec![at(2.0, 1.04), at(18.0, 1.36)], ..needle(1, 0.0, 0.0) };
    let names = ["needle"];
    assert!(punctures(&pierced, &names, &|_| 0.0).is_some());
    assert!(punctures(&pierced, &names, &|p| 0.02 * p.time_s).is_none());
    // Few samples of a stiff sheet that is pushed fast locate the puncture poorly.
    let coarse = pierced.punctures.iter().map(|p| Puncture { error_n: 0.1, ..*p }).collect();
    assert!(punctures(&Needle { punctures: coarse, ..pierced }, &names, &|_| 0.0).is_none());
}
