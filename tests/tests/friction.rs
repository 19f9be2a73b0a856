//! True static friction: found where the fingers slip on a block, with a true error, and never claimed where they do not.

use haptics::device::{Mistake, Skill};
use haptics::servo::recorder::SensorModel;
use rayon::prelude::*;
use tests::generate::{perform, perform_with_mistakes, stacking_world};

/// The estimator was tuned on seeds 0 to 99.
const FIRST: u64 = 9_000;
const LOGS: u64 = 60;

#[test]
fn friction_is_found_at_a_slip() {
    let found: Vec<Vec<(f64, f64)>> = (FIRST..FIRST + LOGS)
        .into_par_iter()
        .map(|seed| {
            let (mut world, truth) = stacking_world(seed);
            // A dropped block is counted as carried: which of the two it was does not matter here.
            let friction = truth[&("block-1".to_owned(), "friction".to_owned())];
            world.blocks.iter_mut().for_each(|block| block.finger_friction = friction);
            let sensor = SensorModel::TYPICAL;
            let mistakes = [Mistake::WeakPinch];
            let shown = perform_with_mistakes(&world, seed, Skill::advanced(), &mistakes, 5, &[sensor]).remove(0);
            let (fit, _) = estimator::identify::block::fit(&shown.recording, None).expect("blocks were carried");
            fit.parameters
                .iter()
                .filter(|p| p.name == "friction")
                .filter_map(|p| Some(((p.value? - friction) / p.std_error?, p.std_error? / friction)))
                .collect()
        })
        .collect();
    let logs = found.iter().filter(|one| !one.is_empty()).count();
    let z: Vec<f64> = found.iter().flatten().map(|f| f.0).collect();
    let held = z.iter().filter(|z| z.abs() <= 1.96).count();
    let relative = found.iter().flatten().map(|f| f.1).sum::<f64>() / z.len().max(1) as f64;
    println!(
        "slips found in {logs} of {LOGS} logs, {} values, {held} held by their 95 % intervals, mean relative error {relative:.4}",
        z.len()
    );
    assert!(logs * 10 >= 6 * LOGS as usize, "slips found in {logs} of {LOGS}");
    assert!(held * 100 >= 88 * z.len(), "{held} of {} held", z.len());
    assert!(relative < 0.03, "{relative}");
}

/// Error in standard errors of every friction that is claimed of steady performances, with the fingers' friction as drawn or as given.
fn claims(friction: Option<f64>) -> Vec<f64> {
    (FIRST..FIRST + LOGS)
        .into_par_iter()
        .flat_map_iter(|seed| {
            let (mut world, _) = stacking_world(seed);
            if let Some(friction) = friction {
                world.blocks.iter_mut().for_each(|block| block.finger_friction = friction);
            }
            let shown = perform(&world, seed, Skill::default(), 5, &SensorModel::TYPICAL);
            let (fit, _) = estimator::identify::block::fit(&shown.recording, None).expect("blocks were carried");
            let error = move |block: &haptics::world::Block| {
                let claimed = fit.parameter(&block.name, "friction")?;
                Some((claimed.value? - block.finger_friction) / claimed.std_error?)
            };
            world.blocks.iter().filter_map(error).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn steady_fingers_slip_at_the_most_when_they_let_go() {
    let slipped = claims(None);
    println!("steady hands: {} slips in {LOGS} logs, errors {slipped:.1?}", slipped.len());
    // The pinch fades with a little shear left in the pads: now and then that is a slip, and it shows the same friction.
    assert!(slipped.iter().all(|z| z.abs() < 3.5) && slipped.len() < LOGS as usize / 3);
}

#[test]
fn without_a_slip_only_a_bound_is_given() {
    const NEVER_SLIPS: f64 = 20.0;
    assert!(claims(Some(NEVER_SLIPS)).is_empty());
}
