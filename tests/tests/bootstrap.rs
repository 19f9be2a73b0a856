//! Errors by resampling beside those by covariance, for what is no regression over one long motion: widths, heights, needles, switches
//! and barrels. Two ways to one error agree within what few independent stretches allow.

use estimator::pipeline::{Options, analyse};
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::SensorModel;
use haptics::world::{World, presets};
use tests::generate::{crank_world, perform, stacking_world};
use tests::handling::{barrel_world, handle};

/// One way may say this many times what the other says.
const ALIKE: f64 = 3.0;

fn performed(world: &World, task: Task, seed: u64) -> Recording {
    let mut recording = perform(world, seed, Skill::default(), 5, &SensorModel::TYPICAL).recording;
    recording.meta.task = Some(task);
    recording
}

/// Both errors of every parameter that is named must be there, and alike.
fn judge(recording: &Recording, names: &[&str]) {
    let fit = analyse(std::slice::from_ref(recording), &Options::default()).expect("fits").fit;
    for name in names {
        let found =
            fit.parameters.iter().find(|p| p.full_name() == *name).unwrap_or_else(|| panic!("{name} is listed"));
        let (covariance, drawn) = found.std_error.zip(found.bootstrap_error).unwrap_or_else(|| panic!("{found:?}"));
        println!("{}: {name} {:.2} times as large by resampling", recording.name, drawn / covariance);
        assert!((1.0 / ALIKE..ALIKE).contains(&(drawn / covariance)), "{}: {found:?}", recording.name);
    }
}

#[test]
fn widths_and_heights_of_blocks_are_resampled_within_holds_and_rests() {
    let names = ["block-1.width_m", "block-2.width_m", "block-1.height_m", "block-2.height_m", "pad.stiffness_N_m"];
    for seed in [41_000, 41_001] {
        judge(&performed(&stacking_world(seed).0, Task::BlockStack, seed), &names);
    }
}

#[test]
fn needles_and_switches_are_resampled_in_blocks_of_time() {
    let needle = ["stiffness_N_m", "surface_position_m", "puncture_force_N", "shaft_friction_N", "weight_N"];
    let needle = needle.map(|name| format!("needle.{name}"));
    let switch = [
        "peak_force_N",
        "rise_N_m",
        "fall_N_m",
        "return_snap_position_m",
        "left_end_position_m",
        "travel_m",
        "friction_N",
        "knob_width_m",
    ];
    let switch = switch.map(|name| format!("switch.{name}"));
    for seed in [42_000, 42_001] {
        judge(&performed(&presets::needle(), Task::Needle, seed), &needle.each_ref().map(String::as_str));
        judge(&performed(&presets::switch(), Task::Switch, seed), &switch.each_ref().map(String::as_str));
    }
}

/// The circle of a crank, the give of its pads: out of the radius residual.
#[test]
fn circles_and_the_pads_on_them_are_resampled() {
    let names = ["crank.radius_m", "crank.center_x_m", "crank.center_y_m", "pad.shear_stiffness_N_m"];
    for seed in [45_000, 45_001, 45_002] {
        judge(&performed(&crank_world(seed).0, Task::Crank, seed), &names);
    }
}

/// What pulls at a barrel is resampled as one: its weight, what changes it, and the cable.
#[test]
fn barrels_and_their_cables_are_resampled() {
    let names = ["barrel.weight_N", "barrel.leak_kg_s"];
    let cable = ["stiffness_N_m", "direction_rad", "taut_x_m", "anchor_x_m", "anchor_y_m", "length_m"];
    let cable = cable.map(|name| format!("cable.{name}"));
    let mut tied = 0;
    for seed in 44_000..44_006 {
        let recording = handle(&barrel_world(seed), seed, &[SensorModel::TYPICAL]).recordings.remove(0);
        judge(&recording, &names);
        let fit = analyse(std::slice::from_ref(&recording), &Options::default()).expect("fits").fit;
        if fit.parameter("cable", "length_m").is_some_and(|p| p.identified) {
            judge(&recording, &cable.each_ref().map(String::as_str));
            tied += 1;
        }
    }
    assert!(tied > 0, "no cable was seen in six recordings");
}

/// The give of a barrel's sides shows in one squeeze: every draw must have it, or its error has no bound.
#[test]
fn a_single_squeeze_is_in_every_draw() {
    for seed in [930_000, 930_003, 43_000] {
        let recording = handle(&barrel_world(seed), seed, &[SensorModel::TYPICAL]).recordings.remove(0);
        judge(&recording, &["barrel.width_m", "barrel.grip_stiffness_N_m"]);
    }
}
