//! Measures of the scripted operator, whose mistakes and skill are known.

use super::*;
use haptics::device::{Mistake, ScriptedOperator, Skill};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};

/// A force that is too large, N.
const LIMIT_N: f64 = 4.0;

/// The operator does a world's task once, seen through perfect sensors or usual ones.
fn performed(world: &World, skill: Skill, mistakes: &[Mistake], seed: u64, sensor: &SensorModel) -> Recording {
    let state = State::resting(world);
    let operator = ScriptedOperator::with_mistakes(world, &state, skill, mistakes, seed);
    let length_s = operator.duration_s() + 1.0;
    let mut body = Loop::new(Swap::new(world.clone()), Box::new(operator), Limits::default());
    let ticks: Vec<_> = (0..(length_s * 1e3) as usize).map(|_| body.tick(1e-3)).collect();
    to_recording("attempt", world, &ticks, 1, sensor, seed)
}

fn measured(world: &World, skill: Skill, mistakes: &[Mistake], seed: u64) -> Measures {
    measure(&performed(world, skill, mistakes, seed, &SensorModel::IDEAL), Some(world), LIMIT_N).expect("measured")
}

fn blocks(measures: &Measures) -> &course::BlockMeasures {
    measures.course.as_ref().and_then(|c| c.blocks.as_ref()).expect("there are blocks")
}

#[test]
fn a_good_stack_is_seen_as_one() {
    let world = presets::stacking();
    let found = measured(&world, Skill::default(), &[], 1);
    let blocks = blocks(&found);
    assert!(blocks.drops.is_empty() && blocks.slips.is_empty(), "{blocks:?}");
    assert_eq!(blocks.stacks.len(), 1, "{blocks:?}");
    assert!(blocks.stacks[0].offset_m.abs() < 2e-3 && blocks.stacks[0].tilt_rad.abs() < 0.02, "{blocks:?}");
    assert!(blocks.at_rest_since_s.is_some_and(|t| t < found.hand.duration_s), "{blocks:?}");
    for (carried, displaced) in blocks.carried_m.iter().zip(&blocks.displaced_m) {
        assert!(*displaced > 0.005 && carried >= displaced, "{blocks:?}");
    }
    assert!(found.hand.path_length_m.iter().all(|way| *way > blocks.displaced_m.iter().sum()));
}

#[test]
fn every_mistake_shows_in_its_measure() {
    let world = presets::stacking();
    let of = |mistake: Mistake| measured(&world, Skill::default(), &[mistake], 3);
    let fine = measured(&world, Skill::default(), &[], 3);
    let weak = of(Mistake::WeakPinch);
    assert!(!blocks(&weak).slips.is_empty() && !blocks(&weak).drops.is_empty(), "{:?}", blocks(&weak));
    let early = of(Mistake::EarlyRelease);
    assert!(!blocks(&early).drops.is_empty(), "{:?}", blocks(&early));
    let crooked = of(Mistake::MisalignedStack);
    let offset = |m: &Measures| blocks(m).stacks.first().map_or(0.0, |s| s.offset_m.abs());
    assert!(offset(&crooked) > offset(&fine) + 2e-3, "{} m and {} m", offset(&crooked), offset(&fine));
    let crushed = of(Mistake::Crush);
    assert!(crushed.hand.peak_force_n > fine.hand.peak_force_n.map(|n| 2.0 * n));
    assert!(crushed.hand.over_limit_s.is_some_and(|s| s > 0.1) && fine.hand.over_limit_s == Some(0.0));
}

#[test]
fn a_crank_is_turned_and_turned_the_wrong_way() {
    let world = presets::crank();
    let crank = |m: &Measures| m.course.as_ref().and_then(|c| c.crank).expect("there is a crank");
    let fine = crank(&measured(&world, Skill::default(), &[], 5));
    let wrong = crank(&measured(&world, Skill::default(), &[Mistake::WrongDirection], 5));
    assert!(fine.turns > 0.9 && fine.mean_speed_rad_s > 0.5, "{fine:?}");
    assert!(wrong.reversals > fine.reversals, "{wrong:?} against {fine:?}");
    assert!(fine.off_tangent_j > 0.0 && fine.speed_variation > 0.0, "{fine:?}");
}

#[test]
fn a_needle_that_goes_too_far_overshoots() {
    let world = presets::needle();
    let needle = |m: &Measures| m.course.clone().and_then(|c| c.needle).expect("there is a sheet");
    let fine = needle(&measured(&world, Skill::default(), &[], 7));
    let far = needle(&measured(&world, Skill::default(), &[Mistake::Overshoot], 7));
    assert!(!fine.punctures.is_empty(), "{fine:?}");
    let worst = |n: &course::NeedleMeasures| n.punctures.iter().map(|p| p.overshoot_m).fold(0.0, f64::max);
    assert!(far.deepest_m > fine.deepest_m + 4e-3, "{far:?} against {fine:?}");
    assert!(worst(&far) > worst(&fine) + 2e-3 && fine.punctures.iter().all(|p| p.force_n > 0.1), "{fine:?}");
}

#[test]
fn an_experts_hand_is_quicker_lighter_and_shorter_than_a_novices() {
    let world = presets::stacking();
    for seed in 20..23 {
        let [novice, expert] = [Skill::novice(), Skill::expert()].map(|skill| measured(&world, skill, &[], seed).hand);
        assert!(expert.moving_s < novice.moving_s, "seed {seed}");
        assert!(expert.peak_force_n < novice.peak_force_n, "seed {seed}");
        assert!(expert.path_length_m[0] < novice.path_length_m[0], "seed {seed}");
        assert!(expert.log_dimensionless_jerk > novice.log_dimensionless_jerk, "seed {seed}");
    }
}

#[test]
fn the_same_recording_gives_the_same_numbers_to_the_bit() {
    let world = presets::stacking();
    let recording = performed(&world, Skill::novice(), &[], 9, &SensorModel::TYPICAL);
    let twice = [(); 2].map(|()| measure(&recording, Some(&world), LIMIT_N).expect("measured"));
    assert_eq!(twice[0], twice[1]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("attempt.mcap");
    logs::write(std::slice::from_ref(&recording), &file, &[]).expect("written");
    let read = logs::load(&file, None).expect("read").remove(0);
    assert_eq!(measure(&read, Some(&world), LIMIT_N).expect("measured"), twice[0], "from its file");
}

#[test]
fn usual_sensors_change_little() {
    let world = presets::stacking();
    let of = |sensor| {
        measure(&performed(&world, Skill::default(), &[], 11, &sensor), Some(&world), LIMIT_N).expect("measured")
    };
    let (ideal, real) = (of(SensorModel::IDEAL), of(SensorModel::TYPICAL));
    let near = |a: f64, b: f64| (a - b).abs() < 0.02 * a.abs();
    assert!(near(ideal.hand.path_length_m[0], real.hand.path_length_m[0]));
    assert!(near(ideal.hand.rms_force_n.expect("touched"), real.hand.rms_force_n.expect("touched")));
    assert_eq!(blocks(&real).drops.len(), 0, "{:?}", blocks(&real));
    assert_eq!(blocks(&real).stacks.len(), 1, "{:?}", blocks(&real));
}

#[test]
fn every_number_has_a_definition() {
    let mut keys = std::collections::BTreeSet::new();
    let worlds = [presets::stacking(), presets::crank(), presets::needle()];
    for world in worlds {
        let json = serde_json::to_value(measured(&world, Skill::default(), &[], 1)).expect("JSON");
        for part in ["/hand", "/course/blocks", "/course/crank", "/course/needle"] {
            let map = json.pointer(part).and_then(|v| v.as_object()).cloned().unwrap_or_default();
            keys.extend(map.into_iter().map(|(key, _)| key));
        }
    }
    let told = |key: &str| definitions::ALL.iter().any(|d| d.key == key || d.key.starts_with(&format!("{key}.")));
    let untold: Vec<_> = keys.iter().filter(|key| !told(key)).collect();
    assert!(untold.is_empty(), "{untold:?}");
}

#[test]
fn a_recording_without_a_clock_says_so() {
    let world = presets::stacking();
    let mut recording = performed(&world, Skill::default(), &[], 1, &SensorModel::IDEAL);
    recording.time_s = None;
    let why = measure(&recording, None, LIMIT_N).expect_err("no clock").to_string();
    assert!(why.contains("no clock"), "{why}");
}
