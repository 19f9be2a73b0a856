//! Standard errors that are true: over worlds that the estimator was never tuned on, at three levels of sensor noise, the 95 %
//! intervals of every parameter hold the truth in 92 to 98 % of the recordings.
//!
//! `TOUCHSTONE_COVERAGE=500` runs as many worlds as that statement needs; without it a hundred are drawn, whose scatter is allowed
//! for. `TOUCHSTONE_SEED` draws others.

use estimator::estimate::Fit;
use haptics::device::Skill;
use haptics::recording::Recording;
use haptics::servo::recorder::SensorModel;
use haptics::world::World;
use tests::coverage::{LEVELS, Scores, demand, over, seeds};
use tests::generate::{Performance, Truth, crank_world, perform_at_levels, stacking_world};

/// What a recording cannot show it must say, and may not say often.
const LEAST_SHOWN: f64 = 0.95;

/// `center_error_m`: how well the generator itself knows the crank's centre along y.
fn score(fit: &Fit, truth: &Truth, center_error_m: f64) -> Scores {
    truth
        .iter()
        // A slip is an accident of a few recordings: tests/friction.rs judges what is made of it.
        .filter(|(name, _)| name.1 != "friction")
        .filter_map(|(name, true_value)| {
            let found = fit.parameter(&name.0, &name.1)?;
            let (value, error) = (found.value?, found.std_error?);
            let known_to = if name.1 == "center_y_m" { center_error_m } else { 0.0 };
            Some((name.clone(), ((value - true_value) / error.hypot(known_to), error / true_value.abs())))
        })
        .collect()
}

/// Demands what the head of this file says of worlds from `draw`, as `fit` finds them.
fn covered(draw: fn(u64) -> (World, Truth), fit: fn(&Recording, &Truth, u64) -> Fit) {
    let sensors = LEVELS.map(|level| SensorModel::TYPICAL.noisier(level));
    let scores = |seed: u64| -> Vec<Scores> {
        let (world, mut truth) = draw(seed);
        let performances = perform_at_levels(&world, seed, Skill::default(), 5, &sensors);
        // The centre that a fit can know is that of the grasp points' circle.
        if let Some(center) = truth.get_mut(&("crank".to_owned(), "center_y_m".to_owned())) {
            *center += performances[0].grasp_offset_y_m;
        }
        let scored = |p: &Performance| score(&fit(&p.recording, &truth, seed), &truth, p.grasp_offset_error_m);
        performances.iter().map(scored).collect()
    };
    // Where the generator knows the truth hardly better than the fit does, intervals are too wide by that.
    let cautious = |name: &str| if name == "center_y_m" { 1.0 } else { 0.0 };
    // The estimator was tuned on seeds around 100 000; these it never saw.
    demand(&over(seeds(5_000, 100), scores), &|_| LEAST_SHOWN, &cautious);
}

fn fit_blocks(recording: &Recording, truth: &Truth, seed: u64) -> Fit {
    let (fit, segmentation) = estimator::identify::block::fit(recording, None).expect("blocks were carried");
    assert_eq!(segmentation.sequence(), "132313231", "seed {seed}");
    for block in ["block-1", "block-2"] {
        let bound = fit.parameter(block, "friction_lower_bound").expect("always reported");
        let (value, error) = (bound.value.expect("a firm grip"), bound.std_error.expect("with its error"));
        let friction = truth[&(block.to_owned(), "friction".to_owned())];
        assert!(value - 2.0 * error <= friction, "seed {seed}: bound {value} ± {error} above {friction}");
    }
    fit
}

#[test]
fn stacked_blocks_are_covered() {
    covered(stacking_world, fit_blocks);
}

#[test]
fn cranks_are_covered() {
    covered(crank_world, |recording, _, _| estimator::identify::crank::fit(recording, None).expect("turned").0);
}
