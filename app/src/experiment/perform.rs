//! Performance of an experiment by the scripted operator on a simulated object.

use super::sensing::see_through;
use crate::experiment::simulated::SIMULATED;
use crate::experiment::timetable::Timetable;
use estimator::diagnose::{Experiment, SensorFault};
use estimator::segment::SystemState;
use haptics::device::{Device as _, ScriptedOperator, Skill};
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::State;
use std::collections::BTreeMap;

/// Servo period, s.
const DT_S: f64 = 1e-3;
/// Number of ticks per recorded sample: 200 samples per second.
const EVERY: usize = 5;
/// Interval between checks for cancellation, ticks.
const LOOKS: usize = 500;

/// Simulated recording; `None` if `goes_on` (which receives the completed share) returns false. `about` names the
/// simulated object; `noise_n` is the noise of one force sample, N.
pub fn perform(
    table: &Timetable,
    asked: &Experiment,
    about: &str,
    (fault, noise_n): (&SensorFault, f64),
    seed: u64,
    goes_on: &dyn Fn(f64) -> bool,
) -> Option<Recording> {
    let (world, state) = (table.world.clone(), State::resting(&table.world));
    let operator = ScriptedOperator::on_route(&state, table.route.clone(), Skill::default(), seed);
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world, state), Box::new(operator), limits);
    let total = (table.duration_s() / DT_S).ceil();
    let mut ticks = Vec::with_capacity(total as usize + 2);
    while !servo.finished() {
        ticks.push(servo.tick(DT_S));
        if ticks.len() % LOOKS == 0 && !goes_on(ticks.len() as f64 / total) {
            return None;
        }
    }
    servo.make_safe();
    let sensor = SensorModel { force_noise_n: noise_n, ..SensorModel::TYPICAL };
    let name = format!("simulated, {about}");
    let mut recording = to_recording(&name, &table.world, &ticks, EVERY, &sensor, seed);
    let carried = ticks.iter().find(|tick| tick.label == SystemState::HoldAboveGround.name());
    see_through(&mut recording, fault, carried.map_or(0.0, |tick| tick.time_s));
    if table.world.membrane.is_some() {
        recording.meta.task = Some(Task::Needle);
    } else if table.world.switch.is_some() {
        recording.meta.task = Some(Task::Switch);
    }
    recording.meta.other.insert(SIMULATED.to_owned(), about.into());
    recording.meta.known.extend(what_is_known(asked));
    Some(recording)
}

/// Values of an experiment known in advance, for the sidecar: the added weight.
pub fn what_is_known(asked: &Experiment) -> BTreeMap<String, f64> {
    let weight = (asked.added_weight_n > 0.0).then(|| ("added_weight_N".to_owned(), asked.added_weight_n));
    weight.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::timetable::tests::asked;
    use super::*;
    use haptics::Vec2;
    use haptics::world::presets;

    #[test]
    fn the_recording_says_that_it_is_simulated_and_holds_the_motion_that_was_asked_for() {
        let world = presets::crank();
        let asked = Experiment { seconds: 4.0, ..asked("sweep-across") };
        let table = Timetable::new(&world, &asked, "turn to and fro").expect("it can be done");
        let fault = SensorFault { offset_n: [Vec2::new(0.15, 0.0); 2], ..SensorFault::default() };
        let recording = perform(&table, &asked, "a crank", (&fault, 0.005), 1, &|_| true).expect("not ended");
        assert_eq!(crate::experiment::simulated::simulated_object(&recording), Some("a crank"));
        assert!(recording.name.starts_with("simulated"));
        let mean = |names: [&str; 2], until: usize| {
            let of = |name: &str| recording.channel(name).expect("a channel")[..until].iter().sum::<f64>();
            (of(names[0]) + of(names[1])) / until as f64
        };
        // A second without contact: only the fault is visible.
        assert!((mean(["fx1_N", "fx2_N"], 180) - 0.3).abs() < 0.01);
        let crank = world.crank.as_ref().expect("a crank");
        let (x1, x2) = (recording.channel("x1_m").expect("x"), recording.channel("x2_m").expect("x"));
        let middle = |i: usize| 0.5 * (x1[i] + x2[i]) - crank.center_m.x;
        let reach = (0..x1.len()).map(|i| middle(i).abs()).fold(0.0, f64::max);
        assert!((reach - crank.radius_m).abs() < 1.5e-3, "{reach}");
        assert!(perform(&table, &asked, "a crank", (&fault, 0.005), 1, &|share| share < 0.4).is_none());
    }
}
