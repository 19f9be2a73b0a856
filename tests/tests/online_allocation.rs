//! A sample of the estimator beside the servo allocates nothing: grasps, changes, holes and bad numbers included.

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use estimator::online::{Online, Settings};
use haptics::device::{Command, Device, ScriptedOperator, Skill};
use haptics::recording::Task;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{Rows, SensorModel};
use haptics::world::{Input, State, World, presets, step};

#[global_allocator]
static GUARD: AllocDisabler = AllocDisabler;

const DT: f64 = 1e-3;

/// The task of a world as the sensors see it.
fn samples(world: &World) -> Vec<(f64, [f64; 12])> {
    let mut state = State::resting(world);
    let mut operator = ScriptedOperator::new(world, &state, Skill::default(), 5);
    let mut rows = Rows::new(SensorModel::TYPICAL, 5);
    let mut samples = Vec::new();
    while !operator.finished() {
        let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, DT);
        let input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
        step(world, &mut state, &input, DT);
        let tick = TickRecord { time_s: state.time_s, input, tip_force_n: state.tip_force_n, ..TickRecord::default() };
        samples.push((state.time_s, rows.row(&tick)));
    }
    samples
}

#[test]
fn a_sample_allocates_nothing() {
    for (task, world) in [(Task::BlockStack, presets::stacking()), (Task::Crank, presets::crank())] {
        let once = samples(&world);
        let length_s = once[once.len() - 1].0 + 1.0;
        let settings = Settings { memory_s: 20.0, ..Settings::default() };
        let mut online = Online::new(task, DT, settings).expect("a task with estimates");
        assert_no_alloc(|| {
            // Again and again: more objects than are kept apart, full stores, holes in between; forces that jump in one of them.
            for round in 0..10_u32 {
                for (time_s, sample) in &once {
                    let mut sample = *sample;
                    if round == 7 && *time_s > 0.5 * length_s {
                        sample[9] += 0.05;
                    }
                    online.push(time_s + f64::from(round) * length_s, &sample);
                }
                online.push(f64::NAN, &once[0].1);
                online.push(0.0, &[f64::INFINITY; 12]);
            }
        });
        let report = online.report();
        assert!(report.parameters.iter().any(|p| p.identified), "{task:?}: something was measured");
    }
}
