//! Forces that a crank's world predicts for a motion: nothing of them may be the measured force in disguise.

use crate::calibrate;
use crate::identify::crank;
use crate::segment::resting::tests::{HELD_S, recording};
use crate::simulate::prediction::Simulation;
use crate::simulate::simulate;
use haptics::Vec2;
use haptics::recording::{Recording, Task};
use haptics::world::World;

const NOISE_N: f64 = 0.02;

fn world(of: &Recording) -> World {
    let (fit, segmentation) = crank::fit(of, None).expect("a crank");
    calibrate::world(Task::Crank, std::slice::from_ref(of), &fit, &[Some(segmentation)])
}

/// Predicted and measured forces of a channel in the middle of the first free second, and while the handle is held.
fn ranges(of: &Recording) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
    let time_s = of.time_s.as_ref().expect("timed");
    let at = |t: f64| time_s.partition_point(|s| *s < t);
    // Before the hand begins to move: its way to the handle crosses the circle.
    (at(0.05)..at(0.35), at(HELD_S.0 + 0.5)..at(HELD_S.1 - 0.5))
}

fn predicted<'a>(simulation: &'a Simulation, name: &str) -> &'a [f64] {
    &simulation.predicted.iter().find(|c| c.name == name).expect("predicted").values
}

#[test]
fn a_free_finger_feels_nothing_but_what_its_sensor_reads() {
    for (seed, bias) in [(21, Vec2::zeros()), (22, Vec2::new(0.15, 0.0))] {
        let log = recording(seed, NOISE_N, bias);
        let found = simulate(&world(&log), &log).expect("simulated");
        for (name, bias) in [("fx_N", bias.x), ("fy_N", bias.y)] {
            let free = &predicted(&found, name)[ranges(&log).0];
            assert!(free.iter().all(|f| (f - bias).abs() < 0.01), "{name}: {:?} instead of {bias}", &free[..3]);
        }
        assert_eq!(found.bias_n.iter().any(|(name, _)| name == "fx_N"), bias.x != 0.0, "{:?}", found.bias_n);
        assert!(found.inputs.iter().any(|i| i.contains("the operator's own")), "{:?}", found.inputs);
    }
}

#[test]
fn what_is_predicted_along_the_circle_misses_by_about_the_noise() {
    let log = recording(23, NOISE_N, Vec2::zeros());
    let right = world(&log);
    let along = |world: &World| {
        let found = simulate(world, &log).expect("simulated");
        let part = found.part.expect("a part");
        assert!(part.samples > 1000, "{}", part.samples);
        part.rms_n.expect("measured")
    };
    let rms_n = along(&right);
    assert!((0.2 * NOISE_N..2.0 * NOISE_N).contains(&rms_n), "{rms_n}");
    // A crank that weighs nothing is seen to be another one.
    let mut light = right;
    light.crank.as_mut().expect("a crank").effects.retain(|e| e.law().id() != "weight");
    assert!(along(&light) > 3.0 * rms_n);
}

#[test]
fn a_recording_without_forces_is_held_where_it_is_on_the_circle() {
    let log = recording(24, NOISE_N, Vec2::zeros());
    let world = world(&log);
    let mut zero = log.clone();
    zero.channels.iter_mut().filter(|c| c.name.starts_with('f')).for_each(|c| c.values.fill(0.0));
    let mut none = log.clone();
    none.channels.retain(|c| !c.name.starts_with('f'));
    let (free, held) = ranges(&log);
    for blind in [&zero, &none] {
        let found = simulate(&world, blind).expect("simulated");
        let (x, y) = (predicted(&found, "fx_N"), predicted(&found, "fy_N"));
        assert!(free.clone().all(|i| x[i] == 0.0 && y[i] == 0.0));
        let pushed = held.clone().filter(|i| x[*i].hypot(y[*i]) > 0.05).count();
        assert!(pushed > held.len() / 2, "{pushed} of {}", held.len());
        assert!(found.part.as_ref().is_some_and(|p| p.rms_n.is_none() && p.samples > 1000), "{:?}", found.part);
        assert!(found.inputs.iter().any(|i| i.contains("no force was recorded")), "{:?}", found.inputs);
    }
}
