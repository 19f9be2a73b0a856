//! Whole answers to single cases: experiments that settle, gains of models that run on their own.

use super::draw::{Bench, Spec};
use super::effect::Effect;
use super::interval::quantile;
use super::score::{Row, ask};
use super::sets::{Job, Set};
use estimator::diagnose::{Findings, Rollout, RolloutOf};

fn job(bench: Bench, effects: Vec<(Effect, u32)>, ratio: f64, seed: u64) -> Job {
    let set = if effects.is_empty() { Set::Null } else { Set::Single };
    Job { set, spec: Spec { seconds: 20.0, ..Spec::hiding(effects, ratio, bench) }, seed }
}

fn asked(job: Job) -> Row {
    let mut rows = ask(&[job], &|r, o| estimator::diagnose::diagnose(r, o).map_err(|e| e.to_string()));
    rows.remove(0)
}

fn answer(row: &Row) -> &Findings {
    row.answer.as_ref().expect("an answer")
}

#[test]
fn a_hung_weight_tells_an_eccentric_mass_from_a_tilted_plane() {
    for (effect, bench) in
        [(Effect::Eccentric, Bench::OneFinger), (Effect::Tilt, Bench::OneFinger), (Effect::Eccentric, Bench::Angular)]
    {
        let row = asked(job(bench, vec![(effect, 0)], 1.0, 21));
        let followed = row.proposed().expect("two causes that are one force ask for an experiment");
        assert_eq!(followed.id, "hang-weight");
        assert!(row.settled() && row.question_answered(), "{effect:?}: {:?}", followed.answer);
        let settled = &followed.answer.as_ref().expect("an answer").settled;
        assert!(settled.iter().any(|s| s.kept == effect.id()), "{settled:?}");
    }
}

/// What running forward says of a cause that is hidden and found, and how.
fn rollout((effect, bench, of): (Effect, Bench, RolloutOf), seed: u64) -> Rollout {
    let row = asked(job(bench, vec![(effect, 0)], 2.0, seed));
    let cause = answer(&row).causes.iter().find(|c| c.id == effect.id());
    let rollout = cause.expect("it is found").gain.rollout.clone().expect("the world can run it");
    assert_eq!(rollout.of, of);
    assert!(rollout.interval[0] <= rollout.share && rollout.share <= rollout.interval[1], "{rollout:?}");
    assert!(rollout.window_s > 0.2 && rollout.windows >= 3, "{rollout:?}");
    rollout
}

#[test]
fn a_model_with_the_found_cause_runs_closer_to_what_was_measured() {
    for effect in [Effect::Inertia, Effect::Ripple] {
        let rollout = rollout((effect, Bench::OneFinger, RolloutOf::Force), 503);
        assert!(rollout.rms_after < 0.8 * rollout.rms_before, "{effect:?}: {rollout:?}");
    }
}

/// When a mechanism that sticks breaks loose is a matter of luck: one recording need not gain, and its interval then says so.
#[test]
fn sticking_gains_on_the_whole_and_says_how_uncertain_it_is() {
    for what in
        [(Effect::Stribeck, Bench::Linear, RolloutOf::Position), (Effect::Spring, Bench::Angular, RolloutOf::Position)]
    {
        let shares: Vec<f64> = [503, 511, 512, 513, 514, 515]
            .into_iter()
            .map(|seed| {
                let rollout = rollout(what, seed);
                assert!(rollout.interval[1] > 0.0, "{seed}: {rollout:?}");
                rollout.share
            })
            .collect();
        assert!(quantile(&shares, 0.5) > 0.1, "{what:?}: {shares:?}");
    }
}

#[test]
fn where_nothing_is_hidden_nothing_is_run_forward() {
    for bench in [Bench::OneFinger, Bench::Linear, Bench::Angular] {
        let row = asked(job(bench, Vec::new(), 0.0, 77));
        assert!(answer(&row).causes.iter().all(|c| c.gain.rollout.is_none()), "{:?}", answer(&row).causes);
        assert!(row.followed.is_none());
    }
}

#[test]
fn friction_that_bends_before_it_slides_takes_the_place_of_the_friction_that_there_was() {
    let row = asked(job(Bench::OneFinger, vec![(Effect::Hysteresis, 0)], 2.0, 5));
    let answer = answer(&row);
    assert!(row.first_right(), "{:?}", row.named());
    let loads: Vec<f64> = answer.course.instants.iter().map(|i| i.normal_force_n.abs()).collect();
    // Under any load: it goes with that as before.
    for share in [0.5, 1.0, 2.0] {
        let normal_force_n = share * quantile(&loads, 0.5);
        let sliding = haptics::law::Motion { direction: 1.0, normal_force_n, ..haptics::law::Motion::default() };
        let level = |laws: &[haptics::law::Effect]| -> f64 {
            laws.iter().filter(|e| e.law().is_dry()).map(|e| e.force(&sliding)).sum()
        };
        let (before, after) = (level(&answer.plain), level(&answer.effects));
        assert!(after < 1.5 * before && after > 0.5 * before, "{before} N before, {after} N after");
    }
}
