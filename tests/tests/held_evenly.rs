//! Blocks in fingers that press evenly: letting go of them is no slip, and the calibrated world presses as hard as the hand did.

use estimator::pipeline::{Options, analyse};
use estimator::simulate::simulate;
use rayon::prelude::*;
use tests::held_evenly::{PAD_N_M, WIDTH_M, carried_evenly};

#[test]
fn letting_go_of_a_block_that_stands_is_no_slip() {
    let cells = [(50.0, 0.03), (50.0, 0.015), (200.0, 0.03), (1000.0, 0.015)];
    let cases: Vec<(u64, (f64, f64))> = (0..24).flat_map(|seed| cells.map(|cell| (seed, cell))).collect();
    let claimed: Vec<(u64, f64)> = cases
        .par_iter()
        .filter_map(|(seed, (rate_hz, noise_n))| {
            let log = carried_evenly(*seed, *rate_hz, *noise_n);
            let (fit, _) = estimator::identify::block::fit(&log, None).expect("a block was carried");
            Some((*seed, fit.value("block-1", "friction")?))
        })
        .collect();
    println!("friction claimed in {} of {} logs: {claimed:.2?}", claimed.len(), cases.len());
    // The last of the grip may slip indeed: then it shows the friction that there is, 1.
    assert!(claimed.iter().all(|(_, mu)| (mu - 1.0).abs() < 0.2), "{claimed:?}");
}

#[test]
fn the_world_presses_as_hard_as_the_hand_did() {
    (0..8_u64).into_par_iter().for_each(|seed| {
        let log = carried_evenly(100 + seed, 500.0, 0.01);
        let analysis = analyse(std::slice::from_ref(&log), &Options::default()).expect("a block was carried");
        let found = simulate(&analysis.world, &log).expect("can be replayed");
        let pressed = |values: &[f64]| values[1_000..3_100].iter().sum::<f64>() / 2_100.0;
        let predicted = &found.predicted.iter().find(|c| c.name == "fx1_N").expect("predicted").values;
        let ratio = pressed(predicted) / pressed(log.channel("fx1_N").expect("measured"));
        assert!((ratio - 1.0).abs() < 0.03, "seed {seed}: {ratio:.3} of the grip");
        let width = analysis.fit.parameter("block-1", "width_m").expect("there");
        let (value, error) = (width.value.expect("seen"), width.std_error.expect("has one"));
        assert!((value - WIDTH_M).abs() < 4.0 * error && error < 0.2e-3, "seed {seed}: {width:?}");
        let pad = analysis.fit.value("pad", "stiffness_N_m").expect("the way into the grip shows it");
        assert!((pad / PAD_N_M - 1.0).abs() < 0.2, "seed {seed}: {pad}");
        assert!(found.inputs.iter().any(|i| i.contains("no measured force")), "{:?}", found.inputs);
    });
}
