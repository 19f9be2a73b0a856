//! Diagnosis of a force/torque sensor with a load: of one set of poses, and of what changed between two.

#[path = "../estimation/tests/payload/generator.rs"]
mod generator;

use estimator::diagnose::{Diagnosis, Options, Verdict, diagnose};
use generator::{Form, Sensor, make};
use haptics::recording::{Recording, WrenchFrame};
use rand::{SeedableRng as _, rngs::StdRng};
use std::io::Write as _;
use std::path::Path;

fn drawn(seed: u64) -> Sensor {
    Sensor::drawn(&mut StdRng::seed_from_u64(seed ^ 0x5eed))
}

fn stated(form: Form, sensor: Sensor, seed: u64) -> Recording {
    let (mut recording, _) = make(form, sensor, seed);
    recording.meta.wrench_frame = Some(WrenchFrame::Sensor);
    recording
}

fn diagnosed(recordings: &[Recording]) -> Diagnosis {
    diagnose(recordings, &Options::default()).expect("a diagnosis").diagnosis
}

fn ids(diagnosis: &Diagnosis) -> Vec<&str> {
    diagnosis.causes.iter().map(|c| c.id.as_str()).collect()
}

#[test]
fn bias_and_weight_carry_the_reading_the_larger_one_first() {
    let sensor = Sensor { weight_n: 6.0, bias_n: [3.0, -4.0, 12.0], drift_n_s: [0.0; 3], ..drawn(1) };
    let found = diagnosed(&[stated(Form::Table(20), sensor, 1)]);
    assert_eq!((found.verdict, ids(&found)), (Verdict::Causes, vec!["force-bias", "mass-change"]));
    assert!(found.causes[0].gain.share_of_explainable > 0.9 && found.end.heldout_rms_n < 0.5, "{:?}", found.end);
    let slow = diagnosed(&[stated(Form::Slow(240.0), sensor, 3)]);
    assert_eq!(ids(&slow)[..2], ["force-bias", "mass-change"]);
    let heavy = Sensor { weight_n: 24.0, bias_n: [0.5, -0.6, 0.4], ..sensor };
    assert_eq!(ids(&diagnosed(&[stated(Form::Table(20), heavy, 2)]))[0], "mass-change");
}

#[test]
fn nothing_on_a_sensor_without_a_bias_is_nothing() {
    let mut named = 0;
    for seed in 100..160 {
        let [n, v] = [0.0, 0.0];
        let empty =
            Sensor { weight_n: n, bias_n: [v; 3], bias_nm: [v; 3], drift_n_s: [v; 3], wander_n: 0.0, ..drawn(seed) };
        for form in [Form::Table(8), Form::Table(30), Form::Holds(10)] {
            named += usize::from(diagnosed(&[stated(form, empty, seed)]).verdict != Verdict::None);
        }
    }
    assert!(named <= 7, "{named} of 180 empty sensors had a cause");
}

#[test]
fn of_two_sets_what_changed_is_named_and_nothing_else() {
    let mut right = [0; 4];
    let runs = 25;
    for seed in 200..200 + runs {
        let old = drawn(seed);
        let old = Sensor { wander_n: 0.0, drift_n_s: [0.0; 3], ..old };
        let moved = Sensor { bias_n: [old.bias_n[0] + 1.5, old.bias_n[1] - 1.0, old.bias_n[2]], ..old };
        let loaded = |sensor: Sensor| Sensor { weight_n: sensor.weight_n + 1.5, ..sensor };
        let cases: [(Sensor, &[&str]); 4] = [
            (old, &[]),
            (moved, &["force-bias"]),
            (loaded(old), &["mass-change"]),
            (loaded(moved), &["force-bias", "mass-change"]),
        ];
        for (k, (new, wanted)) in cases.into_iter().enumerate() {
            let sets = [stated(Form::Table(12), old, seed), stated(Form::Table(20), new, seed + 7000)];
            let found = diagnosed(&sets);
            let mut named = ids(&found);
            named.sort_unstable();
            let is_verdict = found.verdict == if wanted.is_empty() { Verdict::None } else { Verdict::Causes };
            right[k] += usize::from(named == wanted && is_verdict);
        }
    }
    println!("right of {runs}: nothing {}, bias {}, load {}, both {}", right[0], right[1], right[2], right[3]);
    assert!(right.iter().all(|count| *count >= 22), "{right:?}");
}

#[test]
fn the_change_has_a_value_with_an_error() {
    let old = Sensor { wander_n: 0.0, drift_n_s: [0.0; 3], ..drawn(300) };
    let new = Sensor { weight_n: old.weight_n + 2.0, ..old };
    let found = diagnosed(&[stated(Form::Table(20), old, 300), stated(Form::Table(20), new, 301)]);
    let weight = found.causes[0].parameters.iter().find(|p| p.name == "weight_N").expect("a weight");
    assert!((weight.value - 2.0).abs() < 4.0 * weight.std_error && weight.std_error < 0.2, "{weight:?}");
}

#[test]
fn single_orientations_leave_bias_or_load_open() {
    let sensor = drawn(400);
    let one = |sensor: Sensor, seed| stated(Form::Table(1), sensor, seed);
    let found = diagnosed(&[one(sensor, 400)]);
    assert_eq!(found.verdict, Verdict::Ambiguous);
    assert_eq!((ids(&found), found.alternatives[0].id.as_str()), (vec!["force-bias"], "mass-change"));
    assert!(found.next_experiment.is_some_and(|next| next.motion.contains("90 degrees")));
    let heavier = Sensor { weight_n: sensor.weight_n + 3.0, ..sensor };
    assert_eq!(diagnosed(&[one(sensor, 400), one(heavier, 400)]).verdict, Verdict::Ambiguous);
}

#[test]
fn three_sets_are_refused_in_a_sentence() {
    let set = stated(Form::Table(5), drawn(500), 500);
    let error = diagnose(&[set.clone(), set.clone(), set], &Options::default()).expect_err("three sets").to_string();
    assert!(error.contains("compares two recordings"), "{error}");
}

#[test]
fn a_wrist_on_two_days() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/wrist_payload");
    if !folder.is_dir() {
        let _ = writeln!(std::io::stderr(), "skipped: {} is not here", folder.display());
        return;
    }
    let read = |name: &str| estimator::log::load(&folder.join(name), None).expect("a log").remove(0);
    let sets = [read("poses_day1.csv"), read("poses_day2.csv"), read("static_drift.csv")];
    let fit = |set: &Recording| {
        let options = estimator::pipeline::Options::default();
        estimator::pipeline::analyse(std::slice::from_ref(set), &options).expect("a fit").fit
    };
    let answers = [(10.804, [-2.136, -2.764, -13.077], 0.149), (12.150, [-3.457, -4.703, -16.677], 0.287)];
    for (set, (weight, bias, rms)) in sets.iter().zip(answers) {
        let fit = fit(set);
        assert!((fit.value("payload", "weight_N").expect("a weight") - weight).abs() < 6e-4);
        for (axis, wanted) in ["x", "y", "z"].into_iter().zip(bias) {
            let value = fit.value("sensor", &format!("force_bias_{axis}_N")).expect("a bias");
            assert!((value - wanted).abs() < 6e-4, "{axis}: {value}");
        }
        let quality = fit.quality.as_ref().expect("a residual");
        assert!((quality.rms - rms).abs() < 6e-4 && quality.heldout_rms > rms, "{quality:?}");
    }
    for fit in sets.iter().map(fit) {
        fit.parameters.iter().for_each(|p| println!("{} {:?} ± {:?}", p.full_name(), p.value, p.std_error));
        println!("{:?} {:?}", fit.quality, fit.warnings);
    }
    let alone = diagnosed(&sets[1..2]);
    assert_eq!(ids(&alone), ["force-bias", "mass-change"]);
    let both = diagnosed(&sets[..2]);
    assert_eq!((both.verdict, ids(&both)), (Verdict::Causes, vec!["force-bias", "mass-change"]));
    println!("{:#?}", both.causes);
}
