//! Tasks as files: the built-in ones, one of a user's, and what is no task.

use super::FIRST_SEED;
use super::generator::{log, perform, stacking};
use estimator::estimate::Fit;
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::segment::definition::{Definition, StateRule};
use estimator::segment::{Method, Segmentation, SystemState, segment_by};
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::world::{World, presets};

fn recording(world: &World, task: Task, seed: u64) -> Recording {
    let ticks = perform(world, Skill::default(), &[], seed);
    let mut recording = log(world, &ticks, 1000.0, 1.0, seed);
    recording.meta.task = Some(task);
    recording
}

fn subtasks(found: &Segmentation) -> Vec<&str> {
    found.states.iter().filter_map(|i| i.subtask.as_deref()).collect()
}

#[test]
fn the_example_of_the_guide_segments_a_recording() {
    let guide = include_str!("../../../docs/tasks.md");
    let text = guide.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let task = Definition::parse(text, "docs/tasks.md").expect("the example is a task");
    let mut recording = recording(&stacking(FIRST_SEED + 400), Task::BlockStack, FIRST_SEED + 400);
    task.give_to(&mut recording);
    for method in [Method::Threshold, Method::Hmm] {
        let found = segment_by(method, &recording, None, None).expect("segments");
        assert_eq!((found.task.as_str(), found.thresholds.force_n), ("lifts", 0.12));
        assert_eq!(subtasks(&found), ["lift-1", "lift-2"], "{method:?}: {:?}", found.states);
    }
    // Another task that is asked for is that one.
    assert!(segment_by(Method::Threshold, &recording, Some(Task::Barrel), None).is_ok_and(|s| s.task == "barrel"));
}

#[test]
fn what_rules_say_decides() {
    let plain = recording(&stacking(FIRST_SEED + 401), Task::BlockStack, FIRST_SEED + 401);
    let total = |found: &Segmentation, state: SystemState| {
        found.states.iter().filter(|i| i.state == state).map(|i| i.t1 - i.t0).sum::<f64>()
    };
    let usual = segment_by(Method::Threshold, &plain, None, None).expect("segments");
    let mut task = Definition::built_in(Task::BlockStack).expect("the built-in task");
    // Nothing is ever called carried.
    task.states.retain(|rule| rule.state != SystemState::HoldAboveGround);
    let mut other = plain.clone();
    task.give_to(&mut other);
    let error = segment_by(Method::Threshold, &other, None, None).expect_err("a subtask without its state").to_string();
    assert!(error.contains("carry-block-{n}") && error.contains("add one"), "{error}");
    let mut task = Definition::built_in(Task::BlockStack).expect("the built-in task");
    task.thresholds.force_n = Some(1e3);
    task.give_to(&mut other);
    let blind = segment_by(Method::Threshold, &other, None, None).expect("segments");
    assert!(total(&usual, SystemState::HoldAboveGround) > 1.0);
    assert_eq!(total(&blind, SystemState::HoldAboveGround), 0.0);
}

#[test]
fn every_built_in_task_is_told_from_its_recordings() {
    let seed = FIRST_SEED + 410;
    let barrel = segment_by(Method::Threshold, &recording(&presets::barrel(), Task::Barrel, seed), None, None);
    let barrel = barrel.expect("a barrel");
    assert!(subtasks(&barrel).contains(&"carry-barrel-1"), "{:?}", barrel.states);
    let switch = recording(&presets::switch(), Task::Switch, seed);
    for method in [Method::Threshold, Method::Hmm] {
        let found = segment_by(method, &switch, None, None).expect("a switch");
        assert!(subtasks(&found).contains(&"throw-1"), "{method:?}: {:?}", found.states);
    }
    let needle = recording(&presets::needle(), Task::Needle, seed);
    for method in [Method::Threshold, Method::Hmm] {
        let found = segment_by(method, &needle, None, None).expect("a needle");
        for step in ["insertion-1", "penetration-1", "extraction-1"] {
            assert!(subtasks(&found).contains(&step), "{method:?}, {step}: {:?}", found.states);
        }
        assert!(found.states.windows(2).all(|w| w[0].end == w[1].first && w[0].state != w[1].state));
        assert_eq!(found.posterior.is_some(), method == Method::Hmm);
    }
}

#[test]
fn what_is_no_task_is_refused_in_one_sentence() {
    let whole = serde_json::to_value(Definition::built_in(Task::BlockStack).expect("the built-in task")).expect("JSON");
    let with = |pointer: &str, value: serde_json::Value| {
        let mut task = whole.clone();
        *task.pointer_mut(pointer).expect("there is such a key") = value;
        task.to_string()
    };
    let wrong = [
        ("{".to_owned(), "not understood"),
        (with("/like", "juggling".into()), "juggling"),
        (with("/thresholds/leave", 1.5.into()), "`leave`"),
        (with("/states/1/when", serde_json::json!({ "warmth": "+" })), "`warmth`; use one of contact"),
        (with("/states/1/when", serde_json::json!({ "grip": "x" })), "grip to be `x`; use +, 0, -"),
        (with("/states/1/when", serde_json::json!({ "contact": "-" })), "contact to be `-`"),
        (with("/states", serde_json::json!([])), "no states"),
        (with("/subtasks/most", 0.into()), "`most` from 1 to"),
        (with("/subtasks/first/0/state", "turning".into()), "needs the state turning"),
        (with("/like", "crank".into()), "`contact`; use one of load, speed"),
        (with("/name", "../mine".into()), "letters, digits"),
        (with("/states/1/shows", serde_json::json!(["warmth"])), "shows `warmth`, which no fit"),
        (with("/subtasks/repeat/1/name", "carry".into()), "put {n} into its name"),
        (with("/subtasks/repeat/1/name", "pick-up-block-{n}".into()), "two subtasks are called pick-up-block-{n}"),
    ];
    for (text, wanted) in wrong {
        let error = Definition::parse(&text, "my.json").expect_err(wanted).to_string();
        assert!(error.contains("my.json") && error.contains(wanted) && !error.contains('\n'), "{error}");
    }
    let error = Definition::read("no-such.json".as_ref()).expect_err("no file").to_string();
    assert!(error.contains("no-such.json") && error.contains("check its path"), "{error}");
}

/// A task like blocks whose subtasks have other names, and one step more.
fn renamed() -> Definition {
    let text =
        serde_json::to_string(&Definition::built_in(Task::BlockStack).expect("the built-in task")).expect("JSON");
    let text = text.replace("pick-up-block", "grab").replace("carry-block", "haul").replace("place-block", "set-down");
    let text = text
        .replace("release-block", "leave")
        .replace("pregrasp-block", "reach")
        .replace("block-stack\",\"title", "hauls\",\"title");
    Definition::parse(&text, "hauls.json").expect("a task")
}

#[test]
fn fits_take_their_samples_from_what_the_task_says_shows_the_parameter() {
    let plain = recording(&stacking(FIRST_SEED + 402), Task::BlockStack, FIRST_SEED + 402);
    let fit = |task: &Definition| {
        let mut recording = plain.clone();
        task.give_to(&mut recording);
        let analysis = analyse(&[recording], &Options::default()).expect("fits");
        assert!(analysis.world.blocks.len() == 2, "calibrated");
        analysis
    };
    let usual = analyse(std::slice::from_ref(&plain), &Options::default()).expect("fits");
    // Other names, the same numbers.
    let own = fit(&renamed());
    let found = own.segmentations[0].as_ref().expect("segmented");
    assert_eq!(found.task, "hauls");
    assert!(subtasks(found).contains(&"haul-2"), "{:?}", found.states);
    assert_eq!(found.shows["hold-above-ground"][0], "weight_N");
    let values = |a: &Analysis| a.fit.parameters.iter().map(|p| (p.name.clone(), p.value)).collect::<Vec<_>>();
    assert_eq!(values(&own), values(&usual));
    assert_eq!(own.world.blocks, usual.world.blocks);
    // What no state shows has no value, and the reason is said.
    let mut blind = renamed();
    blind.states.iter_mut().for_each(|rule| rule.shows.retain(|name| name == "weight_N" || name == "width_m"));
    let less = fit(&blind);
    for (name, there) in [("weight_N", true), ("width_m", true), ("height_m", false), ("friction_lower_bound", false)] {
        let parameter = less.fit.parameter("block-1", name).expect("listed");
        assert_eq!(parameter.identified, there, "{name}: {}", parameter.how);
        assert!(there || parameter.how.contains("no state of the task hauls shows"), "{}", parameter.how);
    }
    // Fewer states, fewer samples: the width from the air alone.
    let ground = |rule: &&mut StateRule| rule.state == SystemState::HoldOnGround;
    let mut airborne = renamed();
    airborne.states.iter_mut().filter(ground).for_each(|rule| rule.shows.retain(|name| name != "width_m"));
    let samples = |a: &Analysis| a.fit.parameter("block-1", "width_m").expect("listed").samples;
    assert!(samples(&fit(&airborne)) < samples(&usual));
}

#[test]
fn a_task_without_an_order_is_fitted_from_the_states_that_it_counts() {
    let guide = include_str!("../../../docs/tasks.md");
    let text = guide.split("```json\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    let mut recording = recording(&stacking(FIRST_SEED + 403), Task::BlockStack, FIRST_SEED + 403);
    let usual = analyse(std::slice::from_ref(&recording), &Options::default()).expect("fits");
    Definition::parse(text, "docs/tasks.md").expect("a task").give_to(&mut recording);
    let fit = analyse(&[recording], &Options::default()).expect("fits").fit;
    for block in ["block-1", "block-2"] {
        let weight =
            |fit: &Fit| fit.parameter(block, "weight_N").and_then(|p| p.value.zip(p.std_error)).expect("a weight");
        let ((own, error), (known, _)) = (weight(&fit), weight(&usual.fit));
        assert!((own - known).abs() < 4.0 * error, "{block}: {own} ± {error} N, {known} N");
        assert!(!fit.parameter(block, "height_m").expect("listed").identified);
    }
}
