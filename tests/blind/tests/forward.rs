//! What a diagnosis puts into the world is what it found: run forward, and asked by `simulate` to predict the same recording, the extended laws
//! must gain by every cause that a world has a law for.
//!
//! `TOUCHSTONE_SEED=20400 cargo test -p blind --test forward` repeats a day.

use blind::{Bench, Case, Effect, Spec, make, score};
use estimator::diagnose::{Findings, diagnose, worlds};
use estimator::simulate::simulate;
use std::time::{SystemTime, UNIX_EPOCH};

/// Draws of each; one that is not named (or has hardly a gain) says nothing.
const DRAWS: u64 = 3;
/// Some held-out pieces are too short or too slow to show it (one in thirty): share of all that gain at least.
const MOST: f64 = 0.85;
/// A prediction is of samples, not of rows: a mechanism's has the noise of its acceleration in it, several times what is hidden.
const LESS: f64 = 0.97;

/// What a world has a law for that acts at once.
const RUN: [(Bench, Effect); 15] = [
    (Bench::OneFinger, Effect::Asymmetry),
    (Bench::OneFinger, Effect::Coulomb),
    (Bench::OneFinger, Effect::Stribeck),
    (Bench::OneFinger, Effect::Drag),
    (Bench::OneFinger, Effect::Eccentric),
    (Bench::OneFinger, Effect::Ripple),
    (Bench::OneFinger, Effect::Spring),
    (Bench::OneFinger, Effect::Local),
    (Bench::OneFinger, Effect::Leak),
    (Bench::OneFinger, Effect::Cable),
    (Bench::Linear, Effect::Viscous),
    (Bench::Linear, Effect::Drag),
    (Bench::Linear, Effect::Local),
    (Bench::Linear, Effect::Ripple),
    (Bench::Angular, Effect::Spring),
];

/// Whether the extended world leaves less of the recording than the plain one.
fn foretells(case: &Case, found: &Findings) -> bool {
    let worlds = worlds(&case.recordings, &score::options(case), found).expect("it can be calibrated");
    let left_n = |world| {
        let predicted = simulate(world, &case.recordings[0]).expect("the motion was recorded");
        // Where everything moves, no part stands apart.
        let whole = predicted.residual_rms.first().map(|(_, left)| *left);
        predicted.part.and_then(|part| part.rms_n).or(whole).expect("the force was recorded")
    };
    let [after, before] = [left_n(&worlds.after), left_n(&worlds.before)];
    after < LESS * before
}

#[test]
fn what_was_found_gains_when_the_extended_laws_run_on_their_own() {
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    let seed = std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or_else(today);
    println!("TOUCHSTONE_SEED={seed}");
    let (mut failed, mut all) = (Vec::new(), (0, 0, 0));
    for (bench, effect) in RUN {
        let (mut asked, mut gained, mut foretold) = (0, 0, 0);
        for draw in 0..DRAWS {
            let effects = vec![(effect, effect.forms_on(bench.is_crank()).start)];
            let spec = Spec { rate_hz: 250.0, seconds: 25.0, ..Spec::hiding(effects, 2.0, bench) };
            let (case, _) = make(&spec, seed.wrapping_mul(DRAWS) + draw);
            let found = diagnose(&case.recordings, &score::options(&case)).expect("it can be diagnosed");
            let clear = |gain: &estimator::diagnose::Gain| gain.share_of_explainable > 0.5;
            let Some(cause) = found.causes.iter().find(|c| c.id == effect.id() && clear(&c.gain)) else { continue };
            asked += 1;
            gained += u32::from(cause.gain.rollout.as_ref().is_some_and(|rollout| rollout.share > 0.2));
            foretold += u32::from(foretells(&case, &found));
        }
        println!("{} {}: {gained} and {foretold} of {asked}", bench.name(), effect.id());
        all = (all.0 + asked, all.1 + gained, all.2 + foretold);
        if asked > 1 && gained.min(foretold) == 0 {
            failed.push(format!("{} {}", bench.name(), effect.id()));
        }
    }
    assert!(failed.is_empty(), "{failed:?} never gain");
    let enough = |count: u32| f64::from(count) > MOST * f64::from(all.0);
    assert!(enough(all.1) && enough(all.2) && all.0 > 30, "{} of {} gain, {} foretell", all.1, all.0, all.2);
}
