//! Diagnoses of real measurements. The data are not part of this repository; they are looked for in `../shared/data` beside the workspace,
//! and each test says so when they are absent.

use estimator::diagnose::{Cause, Findings, Options, diagnose};
use haptics::recording::{Recording, Span};
use tests::shared_recordings as load;

fn diagnosed(recordings: &[Recording]) -> Findings {
    let found = diagnose(recordings, &Options::default()).expect("it can be diagnosed");
    for cause in &found.causes {
        println!("{}: {:?}; {}", cause.id, cause.parameters, cause.evidence);
    }
    println!("{:?} {:?}", found.alternatives, found.warnings);
    found
}

fn cause<'a>(found: &'a Findings, id: &str) -> &'a Cause {
    found.causes.iter().find(|c| c.id == id).unwrap_or_else(|| panic!("{id} is named"))
}

/// Lengths are 2 % short (or the clock 1 % fast, which clocks are not), and what slows a slide does not follow its speed.
#[test]
fn tossed_cubes_are_diagnosed_as_short_lengths_and_dry_friction() {
    let meta = r#"{"columns":{"trial":"toss"},"up":"z","known":{"half_width_m":0.0524}}"#;
    let Some(recordings) = load("cube_toss/tosses.csv", meta) else { return };
    let half = recordings.len() / 2;
    for part in [&recordings[..], &recordings[..half], &recordings[half..]] {
        let found = diagnosed(part);
        let scale = cause(&found, "length-scale");
        assert!(
            (-0.03..-0.01).contains(&scale.parameters[0].value) && scale.gain.share_of_explainable > 0.7,
            "{scale:?}"
        );
        let dry = cause(&found, "load-friction");
        assert!((0.15..0.25).contains(&dry.parameters[0].value) && dry.gain.share_of_explainable > 0.8, "{dry:?}");
        // On all of them nothing follows the speed; the second half has a little that does, beside the dry friction.
        let dry_only = found.causes.iter().all(|c| !["viscous-friction", "quadratic-drag"].contains(&c.id.as_str()));
        assert!(dry_only || part.len() < recordings.len(), "{:?}", found.causes);
        // Not an elastic impact, and not one that takes everything.
        let lost = cause(&found, "velocity-loss");
        assert!((0.1..0.6).contains(&lost.parameters[0].value), "{lost:?}");
        assert!(found.alternatives.iter().any(|a| a.id == "channel-fault" && a.why.contains("clock")));
    }
}

const CABINET: &str = r#"{"columns":{"x_m":"tip_x_m","y_m":"tip_y_m","z_m":"tip_z_m","fx_N":"fx_wrist_sensor_N","fy_N":"fy_wrist_sensor_N","fz_N":"fz_wrist_sensor_N"}}"#;

/// The door opens at once and then falls open: the torque falls with the angle. The force by the joints' torques is not the sensor's.
#[test]
fn the_cabinet_s_torque_falls_with_the_angle_and_one_force_is_biased() {
    let Some(run) = load("cabinet_pull/kitchen_cabinet_run1.csv", CABINET) else { return };
    let found = diagnosed(&run);
    // Logged as the force on the hand.
    assert!(cause(&found, "axis-sign").evidence.contains("on the hand"));
    let place = found.causes.iter().find(|c| ["local-resistance", "return-spring"].contains(&c.id.as_str()));
    let place = place.expect("the torque goes with the angle");
    assert!(place.evidence.contains("from 2.") && place.gain.share_of_explainable > 0.7, "{place:?}");
    let bias = cause(&found, "force-bias");
    assert!(bias.evidence.contains("joint_estimate") && bias.parameters[0].value.abs() > 5.0, "{bias:?}");
    assert!(found.not_excited.iter().any(|n| n.id == "inertia" && n.why.contains("clock")));
}

/// Drawers slide: no circle, and nothing is made up out of a path without forces.
#[test]
fn drawers_are_no_circles() {
    let Some(trials) = load("articulated_paths/paths.csv", r#"{"select":{"mechanism":"drawer"}}"#) else { return };
    let found = diagnosed(&trials);
    assert!(found.baseline.model.starts_with("a line"), "{}", found.baseline.model);
    assert!(found.warnings.iter().any(|w| w.contains("a line (0 revolute")), "{:?}", found.warnings);
    assert!(found.causes.iter().all(|c| c.id == "channel-fault"), "{:?}", found.causes);
}

const DAVINCI: &str = r#"{"columns":{"trial":"run","q_rad":"spindle_angle_rad","q_out_rad":"jaw_side_angle_rad","tau_Nm":"spindle_torque_Nm"}SIGN}"#;

/// Lost motion between spindle and jaw, give under the jaw's load, Coulomb friction of the spindle. The jaw's encoder and the torque cell count
/// the other way as released; whether a sidecar says so or not, the same is found, and the torque's sign is named where it was left.
#[test]
fn the_surgical_tool_is_diagnosed_with_lost_motion_give_and_coulomb_friction() {
    for (sign, is_left) in [
        (r#","sign":{"q_out_rad":-1,"tau_Nm":-1}"#, false),
        (r#","sign":{"q_out_rad":-1}"#, true),
        (r#","sign":{"tau_Nm":-1}"#, false),
        ("", true),
    ] {
        let Some(recordings) = load("davinci_tool/tool_runs.csv", &DAVINCI.replace("SIGN", sign)) else { return };
        let runs: Vec<Recording> = recordings
            .iter()
            .map(|r| {
                let first = r.time_s.as_ref().expect("a clock").partition_point(|t| *t < 6.0);
                r.slice(Span { first, end: r.len() })
            })
            .collect();
        let found = diagnosed(&runs);
        let coulomb = cause(&found, "coulomb-friction");
        assert!(
            (0.02..0.08).contains(&coulomb.parameters[0].value) && coulomb.gain.share_of_explainable > 0.7,
            "{coulomb:?}"
        );
        let lost = cause(&found, "backlash");
        let gap = 2.0 * lost.parameters.iter().find(|p| p.name == "delta").expect("a gap").value;
        assert!((0.02..0.08).contains(&gap), "{gap}");
        assert!(cause(&found, "pad-compliance").parameters[0].value > 0.0);
        assert!(found.end.heldout_rms_n < 0.35 * found.baseline.heldout_rms_n, "{:?} {:?}", found.baseline, found.end);
        assert_eq!(found.causes.iter().any(|c| c.id == "axis-sign"), is_left, "{sign}");
    }
}
