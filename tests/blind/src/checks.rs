//! The generator and the scorer held against what is known without them.

use super::case::{make, make_followed};
use super::chance::Chance;
use super::draw::{self, Bench, Spec, Structure};
use super::effect::Effect;
use super::interval::Share;
use super::plan::Log;
use super::plant::Hidden;
use super::score::{Figures, Row, ask};
use super::sensor::quantised;
use super::sets::{Counts, Job, Set, StructureCounts, battery, structured};
use super::simulate::Setup;
use estimator::diagnose::{Diagnosis, Findings};

fn spec(bench: Bench, effects: Vec<(Effect, u32)>) -> Spec {
    Spec { rate_hz: 1000.0, seconds: 10.0, ..Spec::hiding(effects, 1.0, bench) }
}

fn setup(spec: &Spec, seed: u64) -> Setup {
    let mut chance = Chance::new(seed, 0);
    let arm = draw::arm(&mut chance);
    let sensor = draw::sensor(spec, &mut chance);
    draw::setup(spec, &sensor, &arm, seed)
}

#[test]
fn a_mass_on_a_spring_swings_as_on_paper_and_keeps_its_energy() {
    let spec = spec(Bench::Linear, vec![(Effect::Spring, 0)]);
    let mut setup = setup(&spec, 3);
    (setup.plant.dry_n, setup.plant.viscous, setup.plant.inertia_kg) = (0.0, 0.0, 1.3);
    setup.hold_s = [1e9, 1e9];
    setup.filter_hz = 1e6;
    let (rest, stiffness) = (0.4, 2.0);
    setup.hidden = vec![Hidden { effect: Effect::Spring, form: 0, size: stiffness, shape: [rest, 4.0, 0.0] }];
    let radius = setup.plant.radius_m;
    // Force per path over mass: the law's force is per radian.
    let omega = (stiffness / radius / setup.plant.inertia_kg).sqrt();
    for s in setup.run() {
        let expected = radius * rest * (1.0 - (omega * s.time_s).cos());
        assert!((s.tip_m[0] - expected).abs() < 2e-3 * radius * rest, "{} {} {expected}", s.time_s, s.tip_m[0]);
        let energy = 0.5 * setup.plant.inertia_kg * s.speed.powi(2)
            + 0.5 * stiffness / radius * (s.tip_m[0] - radius * rest).powi(2);
        let whole = 0.5 * stiffness * radius * rest * rest;
        assert!((energy / whole - 1.0).abs() < 2e-3, "{} {energy} {whole}", s.time_s);
    }
}

#[test]
fn the_work_of_the_hand_is_what_friction_takes_and_the_weight_gains() {
    let spec = spec(Bench::OneFinger, Vec::new());
    let mut setup = setup(&spec, 8);
    setup.filter_hz = 1e6;
    let samples = setup.run();
    let (mut work, mut lost) = (0.0, 0.0);
    for s in samples.iter().filter(|s| s.held) {
        work += (s.force_n[0] * s.tip_speed[0] + s.force_n[1] * s.tip_speed[1]) / setup.rate_hz;
        lost += (s.dry_n * s.speed.abs() + setup.plant.viscous * s.speed * s.speed) / setup.rate_hz;
    }
    let turned = |k: usize| samples[k].angle.sin();
    let gained = setup.plant.weight_n * setup.plant.radius_m * (turned(samples.len() - 1) - turned(0));
    assert!((work - lost - gained).abs() < 0.01 * lost, "{work} {lost} {gained}");
    // A person turns it: both ways, more than once round, pushing and pulling.
    let extent = |f: &dyn Fn(usize) -> f64| {
        (0..samples.len()).map(f).fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)))
    };
    let (low, high) = extent(&|k| samples[k].angle);
    assert!(high - low > std::f64::consts::TAU, "{low} {high}");
    for (low, high) in [extent(&|k| samples[k].speed), extent(&|k| samples[k].across_n)] {
        assert!(low < -0.02 && high > 0.02, "{low} {high}");
    }
}

#[test]
fn nothing_is_hidden_in_a_null() {
    for (bench, log, rate_hz) in [
        (Bench::OneFinger, Log::Mixed, 20.0),
        (Bench::TwoFingers, Log::PullOnly, 250.0),
        (Bench::Linear, Log::OneWay, 1000.0),
        (Bench::Angular, Log::Slow, 100.0),
    ] {
        let spec = Spec { ratio: 0.0, log, rate_hz, seconds: 20.0, ..spec(bench, Vec::new()) };
        let (_, truth) = make(&spec, 40);
        let setup = setup(&spec, 40);
        let samples = setup.run();
        let moving = super::measure::moving(&samples, setup.hold_s);
        assert!(moving.iter().filter(|m| **m).count() > samples.len() / 3, "{}", bench.name());
        let left = samples.iter().zip(&moving).filter(|(_, m)| **m).map(|(s, _)| {
            let (sin, cos) = if bench.is_crank() { s.angle.sin_cos() } else { (-1.0, 0.0) };
            (cos * s.force_n[1] - sin * s.force_n[0] - s.base_n).powi(2)
        });
        let rms = (left.sum::<f64>() / samples.len() as f64).sqrt();
        assert!(rms < 0.05 * truth.noise_n, "{}: {rms} beside {}", bench.name(), truth.noise_n);
    }
}

#[test]
fn every_effect_gets_the_size_it_was_asked_for() {
    let mut chance = Chance::new(77, 1);
    let mut missed = Vec::new();
    for (effect, seed) in Effect::NAMED.into_iter().chain(Effect::NAMELESS).zip(900..) {
        let bench = if effect.on_crank() { Bench::OneFinger } else { Bench::Linear };
        let form = effect.forms_on(bench.is_crank()).end - 1;
        let ratio = chance.pick(&[0.25, 0.5, 1.0, 2.0]);
        let spec = Spec { ratio, rate_hz: 100.0, ..spec(bench, vec![(effect, form)]) };
        let (_, truth) = make(&spec, seed);
        if truth.missed() {
            missed.push(format!("{} at {ratio}: {:?}", effect.id(), truth.ratio));
        }
        assert!(truth.visible_inertia < 1.0, "{}: {}", effect.id(), truth.visible_inertia);
    }
    assert!(missed.len() <= 1, "{missed:?}");
}

#[test]
fn a_seed_repeats_a_case_and_columns_are_what_the_sidecar_says() {
    let spec = Spec { rate_hz: 100.0, ..spec(Bench::TwoFingers, vec![(Effect::Ripple, 1)]) };
    let ((a, truth), (b, _), (c, _)) = (make(&spec, 5), make(&spec, 5), make(&spec, 6));
    assert_eq!(a.recordings, b.recordings);
    assert_ne!(a.recordings[0].channels, c.recordings[0].channels);
    let recording = &a.recordings[0];
    assert_eq!((recording.len(), recording.channels.len()), (1000, 12));
    let hand = recording.meta.hand();
    let angle = |name: &str| recording.channel(name).expect(name)[0];
    for (finger, base) in hand.fingers.iter().zip(["1", "2"]) {
        let tip = finger.base_m.x
            + finger.link_m * (angle(&format!("qb{base}_rad")).cos() + angle(&format!("qt{base}_rad")).cos());
        assert!(tip.abs() < 0.1, "{tip}");
    }
    // The fingers are open before they hold, and as far apart as the handle is wide while they do.
    let apart = |row: usize| {
        let x = |finger: usize, ending: &str| {
            let angle = |link: &str| recording.channel(&format!("{link}{ending}_rad")).expect("an angle")[row];
            hand.fingers[finger].base_m.x + hand.fingers[finger].link_m * (angle("qb").cos() + angle("qt").cos())
        };
        x(1, "2") - x(0, "1")
    };
    assert!((apart(0) - 0.024).abs() < 3e-4 && (apart(500) - 0.016).abs() < 3e-4, "{} {}", apart(0), apart(500));
    assert_eq!(truth.ids(), ["position-ripple"]);
    assert!(!format!("{recording:?}").contains("ripple"));
}

#[test]
fn readings_are_noise_on_what_the_oracle_knows() {
    let spec = Spec { rate_hz: 100.0, seconds: 20.0, ..spec(Bench::OneFinger, vec![(Effect::Bias, 0)]) };
    let (case, truth) = make(&spec, 21);
    let fx = case.recordings[0].channel("fx_N").expect("a force");
    let errors: Vec<f64> = fx.iter().zip(&truth.noise_free_n).map(|(read, free)| read - free[0]).collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    assert!((rms / truth.noise_n - 1.0).abs() < 0.1, "{rms} {}", truth.noise_n);
    // The smallest difference between two readings is the resolution.
    let steps = fx.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|d| *d > 1e-9);
    let step = steps.fold(f64::MAX, f64::min);
    assert!(step < 0.6 * truth.noise_n && fx.iter().all(|v| (quantised(*v, step) - v).abs() < 1e-6), "{step}");
}

#[test]
fn a_second_recording_is_of_the_same_object_moved_otherwise() {
    let spec =
        Spec { rate_hz: 100.0, seconds: 20.0, log: Log::PullOnly, ..spec(Bench::OneFinger, vec![(Effect::Ripple, 0)]) };
    let ((one, first), (two, truth)) = (make(&spec, 12), make_followed(&spec, &[Log::Mixed], 12));
    assert_eq!(one.recordings[0], two.recordings[0]);
    assert_eq!((two.recordings.len(), truth.hidden[0].size), (2, first.hidden[0].size));
    assert_eq!(two.recordings[0].meta, two.recordings[1].meta);
    assert_ne!(two.recordings[0].channels, two.recordings[1].channels);
    // The first only pulls or only pushes, the second does both: outward is up at the top of the turn.
    let both_ways = |k: usize| {
        let recording = &two.recordings[k];
        let channel = |name: &str| recording.channel(name).expect("a channel of one finger");
        let mut outward = [0.0_f64; 2];
        let highest = channel("qt_rad").iter().copied().fold(f64::MIN, f64::max);
        for (angle, force) in channel("qt_rad").iter().zip(channel("fy_N")) {
            if highest - angle < 0.05 {
                outward = [outward[0].min(*force), outward[1].max(*force)];
            }
        }
        outward
    };
    let [pulled, mixed] = [both_ways(0), both_ways(1)];
    assert!(pulled[0].abs().min(pulled[1]) < 0.5, "{pulled:?}");
    assert!(mixed[1] - mixed[0] > 0.5, "{mixed:?}");
}

fn said(ids: &[&str], others: &[(&str, &str)], rms: [f64; 2]) -> Findings {
    let causes: Vec<_> = ids
        .iter()
        .map(|id| {
            serde_json::json!({"id": id, "kind": "plant", "parameters": [], "p_value": 0.0, "posterior": 0.9,
                "gain": {"heldout_rms_before": 0.0, "heldout_rms_after": 0.0, "share_of_explainable": 0.0,
                    "interval": [0.0, 0.0]}, "evidence": ""})
        })
        .collect();
    let alternatives: Vec<_> = others
        .iter()
        .map(|(id, place)| serde_json::json!({"id": id, "instead_of": place, "posterior": 0.1, "why": ""}))
        .collect();
    let verdict = if ids.is_empty() { "none" } else { "causes" };
    let diagnosis: Diagnosis = serde_json::from_value(serde_json::json!({
        "verdict": verdict,
        "baseline": {"model": "", "rms_N": 0.0, "heldout_rms_N": rms[0], "whiteness_p": 0.0},
        "noise_floor_N": 0.0, "causes": causes, "alternatives": alternatives, "not_excited": [],
        "next_experiment": null, "final": {"heldout_rms_N": rms[1], "whiteness_p": 0.0}
    }))
    .expect("a diagnosis");
    diagnosis.into()
}

#[test]
fn the_scorer_tells_right_from_nearly_right_and_from_wrong() {
    let job = |set: Set, effects: Vec<(Effect, u32)>| {
        let spec = Spec { rate_hz: 100.0, seconds: 10.0, ..spec(Bench::OneFinger, effects) };
        Job { set, spec, seed: 4 }
    };
    let eccentric = job(Set::Single, vec![(Effect::Eccentric, 0)]);
    let (case, truth) = eccentric.make();
    let n = truth.effect_rms[0];
    let row = |ids: &[&str], others: &[(&str, &str)]| {
        let rms = [(4.0 * n * n + n * n).sqrt(), 2.0 * n];
        Row::new(&eccentric, &case, &truth, Ok(said(ids, others, rms)), 0.1)
    };
    let right = row(&["eccentric-mass"], &[("gravity-tilt", "eccentric-mass")]);
    assert!(right.first_right() && right.set_right() && right.ambiguity_set().len() == 2 && right.spurious() == 0);
    assert!((right.gain_of_oracle() - 1.0).abs() < 1e-9);
    let equal = row(&["gravity-tilt"], &[]);
    assert!(!equal.first_right() && equal.first_right_or_equal() && !equal.set_right());
    assert!(
        !equal.all_right()
            && equal.all_right_or_equal()
            && equal.spurious() == 1
            && equal.spurious_beside_equals() == 0
    );
    let wrong = row(&["backlash", "stribeck"], &[("eccentric-mass", "stribeck")]);
    assert!(!wrong.all_right_or_equal() && wrong.spurious_beside_equals() == 2);
    assert!(!wrong.set_right() && wrong.spurious() == 2 && !wrong.first_right_or_equal());
    let silent = row(&[], &[]);
    assert!(!silent.alarmed() && silent.gain_of_oracle() == 0.0);

    let null = job(Set::Null, Vec::new());
    let (null_case, null_truth) = null.make();
    let alarm = Row::new(&null, &null_case, &null_truth, Ok(said(&["inertia"], &[], [1.0, 1.0])), 0.1);
    let figures = Figures::of(&[right, equal, wrong, silent, alarm]);
    assert_eq!(figures.first_all, Share { hits: 1, of: 4 });
    assert_eq!(figures.first_or_equal, Share { hits: 2, of: 4 });
    assert_eq!(figures.in_set, Share { hits: 1, of: 3 });
    assert_eq!(figures.false_alarms, Share { hits: 1, of: 1 });
    assert_eq!(figures.precision, Share { hits: 2, of: 5 });
}

#[test]
fn a_battery_is_asked_in_order_and_panics_count_as_errors() {
    let counts = Counts { nulls: 2, per_effect: 0, pairs: 1, per_nameless: 0, hard: 1 };
    let mut jobs = battery(counts, 9);
    for job in &mut jobs {
        (job.spec.rate_hz, job.spec.seconds) = (20.0, 5.0);
    }
    (jobs[0].spec.bench, jobs[1].spec.bench) = (Bench::Linear, Bench::Angular);
    let rows = ask(&jobs, &|recordings, _| {
        assert!(recordings[0].channel("f_N").is_none(), "no mechanisms today");
        Ok(said(&[], &[], [0.0, 0.0]))
    });
    assert_eq!(rows.iter().map(|r| r.seed).collect::<Vec<_>>(), jobs.iter().map(|j| j.seed).collect::<Vec<_>>());
    let text = super::report(&rows);
    assert!(text.contains("false alarms, 20 Hz"), "{text}");
    for (row, job) in rows.iter().zip(&jobs) {
        assert_eq!(row.answer.is_err(), job.spec.bench == Bench::Linear);
    }
}

/// A structure of the form `form` at `ratio` times the noise, and nothing else.
fn structured_spec(effect: Effect, form: u32, ratio: f64) -> Spec {
    let bench = Bench::OneFinger;
    let structure = Some(Structure { effect, form, ratio });
    Spec { ratio: 0.0, structure, rate_hz: 100.0, seconds: 12.0, ..spec(bench, Vec::new()) }
}

#[test]
fn every_structure_gets_the_size_it_was_asked_for_and_varies() {
    for (effect, seed) in Effect::STRUCTURES.into_iter().zip(40..) {
        for bench in [Bench::OneFinger, Bench::Linear] {
            if bench == Bench::Linear && !effect.on_mechanism(false) {
                continue;
            }
            let (form, ratio) = (effect.forms() - 1, if seed % 2 == 0 { 1.0 } else { 2.0 });
            let (_, truth) = make(&Spec { bench, ..structured_spec(effect, form, ratio) }, seed);
            assert!(!truth.missed(), "{} at {ratio}: {:?}", effect.id(), truth.ratio);
            assert_eq!((truth.ids(), truth.wanted_ratio.clone()), (vec![effect.id()], vec![ratio]));
            let values: Vec<f64> = truth.effect.iter().map(|(_, n)| *n).collect();
            let (low, high) = (super::interval::quantile(&values, 0.02), super::interval::quantile(&values, 0.98));
            assert!(high - low > ratio * truth.noise_n, "{}: {low} {high}", effect.id());
        }
    }
}

#[test]
fn a_structure_beside_an_effect_has_a_size_of_its_own() {
    for (family, seed) in [Effect::AngleField, Effect::SensorWander, Effect::FrictionWander].into_iter().zip(60..) {
        let spec = Spec { effects: vec![(Effect::Drag, 0)], ratio: 2.0, ..structured_spec(family, 0, 1.0) };
        let (_, truth) = make(&spec, seed);
        assert_eq!(truth.ids(), ["quadratic-drag", family.id()]);
        assert!(!truth.missed() && truth.wanted_ratio == [2.0, 1.0], "{:?}", truth.ratio);
    }
}

#[test]
fn a_structure_leaves_object_hand_and_noise_as_they_were() {
    let with = setup(&structured_spec(Effect::SpeedField, 0, 1.0), 9);
    let without = setup(&Spec { structure: None, ..structured_spec(Effect::SpeedField, 0, 1.0) }, 9);
    assert_eq!(format!("{:?}", with.plant), format!("{:?}", without.plant));
    assert_eq!(format!("{:?}{:?}", with.habits, with.plan), format!("{:?}{:?}", without.habits, without.plan));
    assert!(without.hidden.is_empty() && with.hidden.len() == 1);
    // A fault that only a sensor tells does not change the motion either.
    let samples = setup(&structured_spec(Effect::Hum, 0, 1.0), 9).run();
    let clean = without.run();
    assert!(samples.iter().zip(&clean).all(|(a, b)| a.tip_m == b.tip_m && a.force_n == b.force_n));
}

#[test]
fn recordings_with_structure_cover_every_family_and_a_seed_repeats_them() {
    let counts = StructureCounts { cranks: [3, 1], long_cranks: [1, 1], mechanisms: [2, 1] };
    let jobs = structured(counts, 5);
    assert_eq!(jobs.len(), 12 * 4 + 4 * 2 + 10 * 3);
    for (job, again) in jobs.iter().zip(structured(counts, 5)) {
        assert_eq!(format!("{job:?}"), format!("{again:?}"));
        let family = job.spec.structure.expect("a structure").effect;
        match job.set {
            Set::Structured => assert!(job.spec.effects.is_empty()),
            Set::Beside => {
                assert!(!super::tolerated::tolerated(family).contains(&job.spec.effects[0].0.id()), "{job:?}");
            }
            other => panic!("{other:?}"),
        }
    }
    let long = |job: &&Job| job.spec.seconds > 40.0;
    assert!(jobs.iter().filter(long).all(|job| job.spec.bench.is_crank()));
}
