//! Needle, barrel and switch from end to end: performed, recorded through a sensor model, and played back through their worlds.

use estimator::simulate::simulate;
use haptics::device::Skill;
use haptics::recording::Task;
use haptics::servo::recorder::SensorModel;
use haptics::world::presets;
use tests::generate::perform;

/// What real sensors add (typical sensor model) once it has gone through pads of 2500 N/m, N: 15 µm of noise and 10 µm steps
/// are 40 mN, force noise another 10.
const SENSORS_N: f64 = 0.06;

#[test]
fn worlds_play_their_own_recordings_back() {
    let cases =
        [(Task::Needle, presets::needle()), (Task::Barrel, presets::barrel()), (Task::Switch, presets::switch())];
    for (task, world) in cases {
        for (sensor, most_n) in [(SensorModel::IDEAL, 0.03), (SensorModel::TYPICAL, SENSORS_N)] {
            // Every fifth of the fine steps: 1 kHz.
            let mut recording = perform(&world, 7, Skill::default(), 5, &sensor).recording;
            recording.meta.task = Some(task);
            let replayed = simulate(&world, &recording).expect("the world fits the recording");
            let channel = recording.channel("fx1_N").expect("forces were measured");
            let felt = channel.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            assert!(felt > 0.5, "{}: something was felt, {felt} N", task.name());
            for (name, rms) in &replayed.residual_rms {
                assert!(*rms < most_n, "{} {name}: {rms} N of {felt} N remain", task.name());
            }
        }
    }
}

#[test]
fn a_recording_is_not_played_through_a_world_without_its_object() {
    let mut recording = perform(&presets::switch(), 1, Skill::default(), 25, &SensorModel::TYPICAL).recording;
    recording.meta.task = Some(Task::Switch);
    let refused = simulate(&presets::table(), &recording).expect_err("there is no switch on a bare table");
    assert!(refused.to_string().contains("no switch"), "{refused}");
}
