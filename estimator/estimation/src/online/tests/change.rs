use super::Noise;
use crate::online::change::{Change, ChangeDetector};
use crate::online::recursive::Recursive;
use rand::{SeedableRng as _, rngs::StdRng};

/// A weight and the mass that its accelerations show, 16 rows a second; a step of the weight at `step_s` of `step` deviations.
fn watch(seed: u64, seconds: f64, rho: f64, step: Option<(f64, f64)>) -> Vec<Change> {
    const ROW_S: f64 = 0.06;
    let mut noise = Noise::new(StdRng::seed_from_u64(seed), rho);
    let mut fit = Recursive::<2>::new([1.0, 1.0], f64::INFINITY, 8);
    let mut detector = ChangeDetector::<2>::new(0.2, ROW_S, [0.0; 2]);
    let mut found = Vec::new();
    for i in 0..(seconds / ROW_S) as usize {
        let t = i as f64 * ROW_S;
        let x = [1.0, (0.9 * t).sin()];
        let weight = 5.0 + step.filter(|(at, _)| t > *at).map_or(0.0, |(_, size)| size);
        let y = weight * x[0] + 0.3 * x[1] + noise.next();
        let innovation = fit.push(&x, y, 1.0).expect("finite");
        if let Some(change) = detector.push(t, &x, innovation.residual, innovation.leverage) {
            found.push(change);
            fit.reset();
        }
    }
    found
}

#[test]
fn false_alarms_stay_below_the_stated_rate() {
    // 0.2 an hour over 160 hours are 32 at most; the bound is not tight.
    for rho in [0.0, 0.4, 0.8] {
        let hours = 160.0;
        let alarms: usize = (0..16).map(|seed| watch(seed, hours / 16.0 * 3600.0, rho, None).len()).sum();
        println!("rho {rho}: {alarms} false alarms in {hours} hours");
        assert!((alarms as f64) < 0.2 * hours, "{alarms} in {hours} hours");
    }
}

#[test]
fn a_step_is_found_soon_and_its_begin_is_told() {
    let mut delays: Vec<f64> = Vec::new();
    for seed in 0..60 {
        let found = watch(1000 + seed, 180.0, 0.4, Some((100.0, 3.0)));
        let first = found.first().expect("a step of three deviations");
        assert!(first.noticed_s >= 100.0 && (first.began_s - 100.0).abs() < 3.0, "{first:?}");
        delays.push(first.noticed_s - 100.0);
    }
    delays.sort_by(f64::total_cmp);
    println!("delay: median {:.2} s, 95 % {:.2} s", delays[30], delays[57]);
    assert!(delays[57] < 3.0);
    // A small one takes longer; by then it is clear that it is the constant.
    let small = watch(7, 900.0, 0.4, Some((300.0, -0.8)));
    assert!(small.iter().any(|c| c.parameter == 0 && !c.grows && c.noticed_s > 300.0 && c.noticed_s < 420.0));
}
