//! The trainer without a window and without a thread: a pointer path through the mouse device.

use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use haptics::Vec2;
use haptics::teleop::Delay;
use haptics::world::State;

fn manual() -> Trainer {
    let mut trainer = Trainer { clock: Clock::Manual, ..Trainer::default() };
    trainer.ensure_running().expect("a loop");
    trainer
}

/// Moves the pointer in a straight line, like a person.
fn drag(trainer: &mut Trainer, from: Vec2, to: Vec2, seconds: f64) {
    let steps = (seconds * 60.0) as usize;
    for step in 1..=steps {
        trainer.pinch.move_to(from + (to - from) * (step as f64 / steps as f64));
        trainer.advance(1.0 / 60.0);
    }
}

fn body(trainer: &Trainer, index: usize) -> Vec2 {
    trainer.scene().expect("running").0.state.bodies[index].center_m
}

/// Picks up a block and puts it down elsewhere.
fn carry(trainer: &mut Trainer, index: usize, to: Vec2) {
    let from = body(trainer, index);
    let up = Vec2::new(0.0, 0.024);
    drag(trainer, from + up, from, 0.6);
    trainer.pinch.button = true;
    trainer.advance(0.8);
    drag(trainer, from, from + up, 0.8);
    let lifted = body(trainer, index);
    assert!(lifted.y - from.y > 0.02, "block {index} was lifted by {} m", lifted.y - from.y);
    drag(trainer, from + up, to + up, 1.0);
    drag(trainer, to + up, to, 0.8);
    trainer.pinch.button = false;
    trainer.advance(0.6);
    drag(trainer, to, to + up, 0.6);
}

#[test]
fn a_pointer_path_pinches_lifts_and_restacks_the_blocks() {
    let mut trainer = manual();
    let floor_m = -0.125;
    carry(&mut trainer, 0, Vec2::new(0.015, floor_m + 0.0080));
    carry(&mut trainer, 1, Vec2::new(0.015, floor_m + 0.0160 + 0.00635));
    trainer.advance(0.5);
    let (one, two) = (body(&trainer, 0), body(&trainer, 1));
    assert!((one.x - 0.015).abs() < 3e-3, "block 1 at {one:?}");
    assert!((one.x - two.x).abs() < 3e-3, "block 2 above block 1: {two:?}");
    assert!((two.y - one.y - 0.5 * (0.0160 + 0.0127)).abs() < 5e-4, "block 2 stands on block 1: {one:?} {two:?}");
}

#[test]
fn the_pinch_reaches_its_strength_and_the_wheel_changes_it() {
    let mut trainer = manual();
    let block = body(&trainer, 0);
    drag(&mut trainer, block + Vec2::new(0.0, 0.02), block, 0.6);
    trainer.pinch.latched = true;
    trainer.advance(1.5);
    let grip = |trainer: &Trainer| trainer.history.newest().expect("ticks").grip_n;
    assert!((grip(&trainer) - trainer.pinch.strength_n()).abs() < 0.05, "{}", grip(&trainer));
    trainer.pinch.strengthen(1.0);
    trainer.advance(1.0);
    assert!((grip(&trainer) - 2.5).abs() < 0.08, "{}", grip(&trainer));
}

#[test]
fn the_crank_can_be_turned_with_the_mouse() {
    let mut trainer = manual();
    trainer.choose(WorldChoice::Crank).expect("the crank");
    trainer.advance(0.3);
    let (snapshot, world) = trainer.scene().expect("running");
    let crank = world.crank.clone().expect("a crank");
    let start = snapshot.state.crank.angle_rad;
    let at = |angle: f64| crank.center_m + Vec2::new(angle.cos(), angle.sin()) * crank.radius_m;
    drag(&mut trainer, at(start) + Vec2::new(0.0, -0.01), at(start), 0.5);
    trainer.pinch.strengthen(2.0);
    trainer.pinch.button = true;
    trainer.advance(0.8);
    for step in 1..=240 {
        trainer.pinch.move_to(at(start + std::f64::consts::TAU * f64::from(step) / 240.0));
        trainer.advance(1.0 / 60.0);
    }
    let turned = trainer.scene().expect("running").0.state.crank.angle_rad - start;
    assert!(turned > 5.0, "turned by {turned} rad");
}

#[test]
fn a_barrel_that_is_squeezed_too_hard_leaks_and_a_soft_pinch_carries_it() {
    for (change_n, breaks) in [(0.5, false), (9.0, true)] {
        let mut trainer = manual();
        trainer.choose(WorldChoice::Barrel).expect("the barrel");
        trainer.advance(0.3);
        let at = body(&trainer, 0);
        drag(&mut trainer, at + Vec2::new(0.0, 0.03), at, 0.8);
        trainer.pinch.strengthen(change_n);
        trainer.pinch.button = true;
        trainer.advance(1.0);
        drag(&mut trainer, at, at + Vec2::new(0.0, 0.02), 0.8);
        let (snapshot, _) = trainer.scene().expect("running");
        let strong = trainer.pinch.strength_n();
        assert_eq!(snapshot.state.bodies[0].leaked_kg > 0.0, breaks, "with {strong} N: {:?}", snapshot.state.bodies[0]);
        assert!(breaks || snapshot.state.bodies[0].center_m.y - at.y > 0.008, "carried with {strong} N");
    }
}

#[test]
fn a_recording_starts_at_zero_and_can_be_fitted() {
    let mut trainer = Trainer { clock: Clock::Manual, operator: Operator::Scripted, ..Trainer::default() };
    trainer.ensure_running().expect("a loop");
    trainer.advance(0.5);
    let folder = tempfile::tempdir().expect("a temporary folder");
    trainer.recordings_folder = Some(folder.path().join("not yet there"));
    trainer.start_recording().expect("begins");
    while !trainer.performance_over() {
        trainer.advance(0.5);
    }
    let finished = trainer.stop_recording().expect("it ran").wait().expect("written");
    let recording = estimator::log::load(&finished.path, None).expect("opens").remove(0);
    assert_eq!((finished.status.dropped, finished.status.ticks), (0, recording.len() as u64));
    assert_eq!(recording.time_s.as_ref().map(|t| t[0]), Some(0.0));
    let servo = recording.meta.other.get("servo").expect("how the servo kept its time");
    assert_eq!(servo["timing"]["rate"]["rate_hz"], 1000.0);
    assert!(servo["timing"]["force_age"]["p999_s"].is_number() && servo["why"].is_string());
    let analysis = estimator::pipeline::analyse(&[recording], &estimator::pipeline::Options::default()).expect("a fit");
    let weight = analysis.fit.value("block-1", "weight_N").expect("carried");
    assert!((weight - 0.343).abs() < 0.02, "{weight}");
}

#[test]
fn a_pause_keeps_the_world_as_it_was() {
    let mut trainer = manual();
    let block = body(&trainer, 0);
    drag(&mut trainer, block + Vec2::new(0.0, 0.02), block, 0.6);
    let before = trainer.scene().expect("running").0.state.input.tip_in_world;
    trainer.pause();
    trainer.ensure_running().expect("again");
    let after = trainer.scene().expect("running").0.state.input.tip_in_world;
    assert!((before[0] - after[0]).norm() < 1e-3 && (before[1] - after[1]).norm() < 1e-3);
}

#[test]
fn a_recording_that_loses_its_world_is_kept_and_one_that_is_not_wanted_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut trainer = manual();
    trainer.recordings_folder = Some(folder.path().to_path_buf());
    trainer.start_recording().expect("begins");
    trainer.advance(0.5);
    trainer.choose(WorldChoice::Crank).expect("the crank");
    assert!(!trainer.is_recording());
    trainer.advance(0.2);
    let kept = trainer.take_ended_recording().expect("told").wait().expect("written");
    assert!(trainer.take_ended_recording().is_none(), "once");
    let log = estimator::log::load(&kept.path, None).expect("opens").remove(0);
    let time = log.time_s.as_ref().expect("a clock");
    assert!((490..=500).contains(&time.len()), "{}: all of this world, nothing of the next", time.len());
    assert!(time.windows(2).all(|w| (w[1] - w[0] - 1e-3).abs() < 1e-9));
    std::fs::remove_file(&kept.path).expect("there");
    trainer.start_recording().expect("begins");
    trainer.advance(0.5);
    trainer.discard_recording();
    let begun = std::time::Instant::now();
    let left = || std::fs::read_dir(folder.path()).expect("there").count();
    while left() > 0 && begun.elapsed().as_secs() < 20 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(left(), 0);
}

#[test]
fn a_folder_that_takes_no_files_is_one_sentence_and_training_goes_on() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a-file");
    std::fs::write(&file, "no folder").expect("writes");
    let mut trainer = manual();
    trainer.recordings_folder = Some(file.join("recordings"));
    trainer.start_recording().expect("begins; the disk answers later");
    let begun = std::time::Instant::now();
    let ended = loop {
        trainer.advance(0.05);
        match trainer.take_ended_recording() {
            Some(ended) => break ended,
            None => assert!(begun.elapsed().as_secs() < 20, "never told"),
        }
    };
    let problem = ended.wait().expect_err("it is a file");
    assert!(problem.starts_with("The recording cannot be written (") && problem.ends_with('.'), "{problem}");
    assert!(!trainer.is_recording());
    let before_s = trainer.scene().expect("running").0.tick.time_s;
    trainer.advance(0.2);
    assert!(trainer.scene().expect("running").0.tick.time_s > before_s);
}

/// Carries a block over a link with latency like people: move, wait, look. Returns the block's travel and the intended
/// travel, m.
fn carry_slowly(trainer: &mut Trainer, by_m: f64, wait_s: f64) -> (f64, f64) {
    let from = body(trainer, 0);
    let up = Vec2::new(0.0, 0.022);
    let over = Vec2::new(by_m, 0.0);
    drag(trainer, from + up, from, 1.0);
    trainer.advance(wait_s);
    trainer.pinch.button = true;
    trainer.advance(1.0 + 2.0 * wait_s);
    for (a, b) in [(from, from + up), (from + up, from + up + over)] {
        drag(trainer, a, b, 2.0);
        trainer.advance(wait_s);
    }
    (body(trainer, 0).x - from.x, by_m)
}

#[test]
fn on_a_model_the_hand_is_seen_at_once_and_the_far_world_as_a_ghost() {
    for round_trip_s in [0.15, 0.5] {
        let mut trainer = manual();
        trainer.set_delay(Delay::of(round_trip_s, true)).expect("a line");
        trainer.advance(0.5);
        let middle = |state: &State| 0.5 * (state.input.tip_in_world[0] + state.input.tip_in_world[1]);
        let start = middle(trainer.seen().expect("a model"));
        trainer.pinch.move_to(start + Vec2::new(0.01, 0.0));
        trainer.advance(0.5 * round_trip_s);
        let view = trainer.view().expect("a line");
        assert!(view.predicted && middle(&view.here).x > start.x + 2e-3, "{round_trip_s} s: here it moves");
        assert!((middle(&view.there) - start).norm() < 1e-4, "{round_trip_s} s: there it does not yet");
        let (went, should) = carry_slowly(&mut trainer, 0.02, 0.3);
        trainer.advance(round_trip_s);
        assert!((body(&trainer, 0).y + 0.125) > 0.015, "{round_trip_s} s: held at the far end");
        assert!((went - should).abs() < 4e-3, "{round_trip_s} s: carried {went} m");
        let weighed = trainer.view().and_then(|view| view.weighed).expect("it was carried");
        assert!((weighed.mass_kg * 9.81 - 0.343).abs() < 0.03, "{round_trip_s} s: {weighed:?}");
    }
}

#[test]
fn over_a_slow_line_the_picture_is_late_and_a_block_is_carried_all_the_same() {
    for round_trip_s in [0.15, 0.5] {
        let mut trainer = manual();
        trainer.set_delay(Delay::of(round_trip_s, false)).expect("a line");
        let hand = |state: &State| 0.5 * (state.input.tip_in_world[0] + state.input.tip_in_world[1]);
        trainer.advance(0.5);
        let (start, true_start) =
            (hand(trainer.seen().expect("a picture")), hand(&trainer.scene().expect("running").0.state));
        assert!((start - true_start).norm() < 1e-4, "both at rest");
        trainer.pinch.move_to(start + Vec2::new(0.01, 0.0));
        trainer.advance(0.9 * round_trip_s);
        let seen = hand(trainer.seen().expect("a picture"));
        let there = hand(&trainer.scene().expect("running").0.state);
        assert!((seen - start).norm() < 1e-4, "{round_trip_s} s: nothing is seen yet: {seen:?}");
        assert!((there - start).norm() > 1e-3, "{round_trip_s} s: the far hand has begun: {there:?}");
        trainer.advance(3.0);
        assert!((hand(trainer.seen().expect("a picture")) - start).x > 9e-3, "{round_trip_s} s: and arrives");
        let (went, should) = carry_slowly(&mut trainer, 0.02, 2.0 * round_trip_s + 0.5);
        assert!((went - should).abs() < 4e-3, "{round_trip_s} s: carried {went} m");
        let lifted = body(&trainer, 0).y + 0.125;
        assert!(lifted > 0.015, "{round_trip_s} s: still held, {lifted} m above the table");
    }
}

#[test]
fn impossible_lines_are_refused_and_none_changes_nothing() {
    let mut trainer = manual();
    let refused = trainer.set_delay(Delay { loss: 1.5, ..Delay::default() }).expect_err("no such line");
    assert!(refused.contains("loss") && trainer.delay() == Delay::default(), "{refused}");
    assert!(trainer.view().is_none() && trainer.seen() == trainer.scene().map(|(newest, _)| &newest.state));
    trainer.set_delay(Delay::of(0.15, false)).expect("a line");
    assert!(trainer.view().is_some());
    trainer.choose(WorldChoice::Crank).expect("another world at both ends");
    assert!(trainer.view().is_some_and(|view| view.here.bodies.is_empty()));
    trainer.set_delay(Delay::default()).expect("no line");
    assert!(trainer.view().is_none());
}
