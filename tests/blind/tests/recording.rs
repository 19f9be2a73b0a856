//! Faults of a recording and what else it holds, put into recordings of the blind generator: channels with the wrong sign, a force that is late
//! by many samples, a temperature, ripples of many periods, laws that are known; and what the answer must say of motions that show less.
//!
//! `TOUCHSTONE_SEED=20400 cargo test -p blind --test recording` repeats a day.

use blind::{Bench, Case, Effect, Log, Spec, make, score};
use estimator::diagnose::{Cause, Findings, Verdict, diagnose};
use haptics::recording::{Channel, Recording};
use std::f64::consts::TAU;
use std::time::{SystemTime, UNIX_EPOCH};

fn seed() -> u64 {
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    let seed = std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or_else(today);
    println!("TOUCHSTONE_SEED={seed}");
    seed
}

/// A recording with nothing hidden in it.
fn plain(bench: Bench, log: Log, seed: u64) -> Case {
    with(bench, log, vec![], seed)
}

fn with(bench: Bench, log: Log, effects: Vec<(Effect, u32)>, seed: u64) -> Case {
    make(&Spec { log, rate_hz: 500.0, seconds: 25.0, ..Spec::hiding(effects, 2.0, bench) }, seed).0
}

fn values<'a>(recording: &'a mut Recording, name: &str) -> &'a mut Vec<f64> {
    let channel = recording.channels.iter_mut().find(|c| c.name == name);
    &mut channel.unwrap_or_else(|| panic!("there is no {name}")).values
}

fn column(recording: &Recording, name: &str) -> Vec<f64> {
    recording.channel(name).unwrap_or_else(|| panic!("there is no {name}")).to_vec()
}

fn answer(case: &Case) -> Findings {
    diagnose(&case.recordings, &score::options(case)).expect("it can be diagnosed")
}

fn named<'a>(found: &'a Findings, id: &str) -> &'a Cause {
    let said: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).collect();
    found.causes.iter().find(|c| c.id == id).unwrap_or_else(|| panic!("{id} was not named but {said:?}"))
}

fn is_alone(found: &Findings, id: &str) {
    named(found, id);
    assert_eq!(found.causes.len(), 1, "beside {id}: {:?}", found.causes.iter().map(|c| &c.id).collect::<Vec<_>>());
}

#[test]
fn a_channel_with_the_wrong_sign_is_named_and_put_right() {
    let seed = seed();
    let of = [
        (Bench::Linear, vec!["f_N"]),
        (Bench::Angular, vec!["tau_Nm"]),
        (Bench::TwoFingers, vec!["fx1_N"]),
        (Bench::TwoFingers, vec!["fy2_N"]),
        (Bench::OneFinger, vec!["qt_rad"]),
    ];
    for (bench, mirrored) in of {
        let mut case = plain(bench, Log::Mixed, seed);
        assert_eq!(answer(&case).verdict, Verdict::None, "{}: as it was", bench.name());
        for name in &mirrored {
            for value in values(&mut case.recordings[0], name) {
                *value = -*value;
            }
        }
        let found = answer(&case);
        is_alone(&found, "axis-sign");
        let which = &found.causes[0].parameters[0].name;
        assert!(which.contains(mirrored[0]), "{mirrored:?} was called {which}");
    }
}

#[test]
fn a_force_that_is_late_by_many_samples_is_put_back_by_all_of_it() {
    let seed = seed();
    for (k, samples) in [10_usize, 20, 30].into_iter().enumerate() {
        let mut case = plain(Bench::OneFinger, Log::Mixed, seed + k as u64);
        let recording = &mut case.recordings[0];
        for name in ["fx_N", "fy_N"] {
            let values = values(recording, name);
            let before = values.clone();
            (0..values.len()).for_each(|i| values[i] = before[i.saturating_sub(samples)]);
        }
        let found = answer(&case);
        is_alone(&found, "time-delay");
        let (tau, late_s) = (&found.causes[0].parameters[0], samples as f64 / 500.0);
        // The clocks of the generator's instruments may differ by half a millisecond themselves.
        assert!((tau.value - late_s).abs() < 1.5e-3, "{late_s} s came out as {tau:?}");
    }
}

#[test]
fn a_mechanisms_force_that_is_late_by_many_samples_is_put_back_too() {
    let mut case = plain(Bench::Linear, Log::Mixed, seed());
    let samples = 20;
    let values = values(&mut case.recordings[0], "f_N");
    let before = values.clone();
    (0..values.len()).for_each(|i| values[i] = before[i.saturating_sub(samples)]);
    let found = answer(&case);
    let (tau, late_s) = (&named(&found, "time-delay").parameters[0], samples as f64 / 500.0);
    assert!((tau.value - late_s).abs() < 3e-3, "{late_s} s came out as {tau:?}");
}

#[test]
fn a_sensor_that_is_turned_in_its_mount_is_one_of_the_answers() {
    let mut case = plain(Bench::OneFinger, Log::Mixed, seed());
    let recording = &mut case.recordings[0];
    let (x, y) = (column(recording, "fx_N"), column(recording, "fy_N"));
    let (sin, cos) = 0.08_f64.sin_cos();
    *values(recording, "fx_N") = x.iter().zip(&y).map(|(x, y)| cos * x - sin * y).collect();
    *values(recording, "fy_N") = x.iter().zip(&y).map(|(x, y)| sin * x + cos * y).collect();
    let found = answer(&case);
    let causes = found.causes.iter().map(|c| c.id.as_str());
    let said: Vec<&str> = causes.chain(found.alternatives.iter().map(|a| a.id.as_str())).collect();
    assert!(said.contains(&"force-cross-axis"), "{said:?}");
}

#[test]
fn what_shows_where_the_object_stands_is_worth_something_there() {
    let found = answer(&with(Bench::OneFinger, Log::Mixed, vec![(Effect::Hysteresis, 0)], seed()));
    let gain = &named(&found, "hysteresis").gain;
    assert!(gain.share_of_explainable > 0.1, "{gain:?}");
    assert!(gain.heldout_rms_after < gain.heldout_rms_before, "{gain:?}");
}

#[test]
fn a_force_that_follows_another_channel_is_named_by_it() {
    let mut case = plain(Bench::Linear, Log::Mixed, seed());
    let recording = &mut case.recordings[0];
    let time_s = recording.time_s.clone().expect("a clock");
    let warm: Vec<f64> = time_s.iter().map(|t| 24.0 + 2.0 * (0.5 * t).sin() + (1.1 * t).cos()).collect();
    let force = values(recording, "f_N");
    let size = (force.iter().map(|f| f * f).sum::<f64>() / force.len() as f64).sqrt();
    force.iter_mut().zip(&warm).for_each(|(f, w)| *f += 0.2 * size * (w - 24.0));
    recording.channels.push(Channel { name: "temperature_degC".to_owned(), unit: "degC".to_owned(), values: warm });
    let found = answer(&case);
    let cause = named(&found, "other:temperature_degC");
    assert!(cause.standing.is_some() && cause.posterior > 0.95, "{cause:?}");
    let amplitude = &cause.parameters[0];
    assert!((amplitude.value - 0.2 * size).abs() < 5.0 * amplitude.std_error, "{size}: {amplitude:?}");
    assert_eq!(amplitude.unit, "N/degC");
}

#[test]
fn what_slowly_changes_beside_the_motion_is_a_suspect_and_none_where_it_changes_nothing() {
    let mut case = plain(Bench::Linear, Log::Mixed, seed());
    let recording = &mut case.recordings[0];
    let time_s = recording.time_s.clone().expect("a clock");
    let warm = |t: f64| 24.0 + 3.0 * (0.5 * t).sin();
    recording.channels.push(Channel {
        name: "temperature_degC".to_owned(),
        unit: "degC".to_owned(),
        values: time_s.iter().map(|t| warm(*t)).collect(),
    });
    assert_eq!(answer(&case).verdict, Verdict::None, "a temperature alone is no cause");
    let plain = answer(&case).plain;
    let friction = plain.iter().find(|e| e.law().id() == "coulomb-friction").expect("dry friction").values[0];
    let recording = &mut case.recordings[0];
    let place = column(recording, "q_m");
    let rate = |i: usize| {
        let (a, b) = (i.saturating_sub(5), (i + 5).min(place.len() - 1));
        (place[b] - place[a]) / (time_s[b] - time_s[a])
    };
    let force = values(recording, "f_N");
    for (i, (f, t)) in force.iter_mut().zip(&time_s).enumerate() {
        *f -= 0.05 * friction * (warm(*t) - 24.0) * (rate(i) / 1e-3).tanh();
    }
    let found = answer(&case);
    is_alone(&found, "friction-change");
    let change = &found.causes[0].parameters[0];
    assert!(change.name.contains("temperature_degC") && change.unit == "1/degC", "{change:?}");
    assert!((change.value + 0.05).abs() < 5.0 * change.std_error + 0.004, "{change:?}");
    assert!(found.causes[0].evidence.contains("temperature_degC"), "{}", found.causes[0].evidence);
}

#[test]
fn ripples_of_many_periods_are_found_with_their_length_and_its_error() {
    let seed = seed();
    for periods in [15.0, 24.0, 36.0] {
        let mut case = plain(Bench::Angular, Log::Slow, seed);
        let recording = &mut case.recordings[0];
        let angle = column(recording, "q_rad");
        let length = TAU / periods;
        let torque = values(recording, "tau_Nm");
        let size = torque.iter().map(|t| t * t).sum::<f64>().sqrt() / (torque.len() as f64).sqrt();
        for (torque, angle) in torque.iter_mut().zip(&angle) {
            *torque += 0.3 * size * (TAU * angle / length).cos();
        }
        let found = answer(&case);
        let cause = named(&found, "position-ripple");
        let lambda = cause.parameters.iter().find(|p| p.name == "lambda").expect("its length");
        assert!(lambda.std_error > 0.0, "an error of a searched value: {lambda:?}");
        assert!((lambda.value - length).abs() < 0.02 * length, "{periods}: {length} came out as {lambda:?}");
    }
}

#[test]
fn laws_that_are_known_tell_the_gain_of_the_sensor() {
    let mut case = plain(Bench::Linear, Log::Mixed, seed());
    let plain = answer(&case).plain;
    let of = |id: &str| plain.iter().find(|e| e.law().id() == id).map_or(0.0, |e| e.values[0]);
    let recording = &mut case.recordings[0];
    for (name, law) in
        [("mass_kg", "inertia"), ("viscous_N_s_m", "viscous-friction"), ("coulomb_N", "coulomb-friction")]
    {
        recording.meta.known.insert(name.to_owned(), of(law));
    }
    for force in values(recording, "f_N") {
        *force *= 1.3;
    }
    let found = answer(&case);
    let gain = named(&found, "force-gain").parameters[0].clone();
    assert!((gain.value - 0.3).abs() < 0.03, "{gain:?}");
    assert_eq!(found.causes[0].id, "force-gain");
}

#[test]
fn without_anything_known_a_gain_and_a_scale_were_not_excited() {
    let found = answer(&plain(Bench::OneFinger, Log::Mixed, seed()));
    for id in ["force-gain", "length-scale"] {
        let hidden = found.not_excited.iter().find(|n| n.id == id);
        assert!(hidden.is_some_and(|n| n.why.contains("known")), "{id}: {:?}", found.not_excited);
    }
}

#[test]
fn a_known_radius_tells_the_scale_of_the_lengths() {
    let mut case = plain(Bench::OneFinger, Log::Mixed, seed());
    let mut with_known = |radius_m: f64| {
        case.recordings[0].meta.known.insert("radius_m".to_owned(), radius_m);
        answer(&case)
    };
    let epsilon = |found: &Findings| named(found, "length-scale").parameters[0].clone();
    let silly_m = 0.3;
    let radius_m = silly_m * (1.0 + epsilon(&with_known(silly_m)).value);
    assert_eq!(with_known(radius_m).verdict, Verdict::None, "its own radius");
    let found = with_known(radius_m / 1.03);
    is_alone(&found, "length-scale");
    assert!((epsilon(&found).value - 0.03).abs() < 1e-4, "{:?}", epsilon(&found));
}

#[test]
fn without_reversals_what_is_lost_there_was_not_excited() {
    let seed = seed();
    for bench in [Bench::OneFinger, Bench::TwoFingers] {
        let found = answer(&plain(bench, Log::OneWay, seed));
        let backlash = found.not_excited.iter().find(|n| n.id == "backlash");
        assert!(backlash.is_some_and(|n| n.why.contains("reversal")), "{}: {:?}", bench.name(), found.not_excited);
        let mixed = answer(&plain(bench, Log::Mixed, seed));
        assert!(mixed.not_excited.iter().all(|n| n.id != "backlash"), "{:?}", mixed.not_excited);
    }
}

#[test]
fn what_has_no_name_says_how_large_it_is_and_nothing_is_both_open_and_hidden() {
    let seed = seed();
    let mut flagged = 0;
    for k in 0..3 {
        let found = answer(&with(Bench::OneFinger, Log::Mixed, vec![(Effect::PositionViscous, 0)], seed + k));
        if let Some(error) = found.model_error.as_ref().filter(|_| found.verdict == Verdict::Unexplained) {
            flagged += 1;
            assert!(error.rms_n > 0.0 && error.share > 0.0 && error.evidence > 0.0, "{error:?}");
            assert!(error.over.iter().any(|o| o.variable.contains("position")), "{:?}", error.over);
        }
        let open = |id: &str| found.alternatives.iter().any(|a| a.id == id);
        assert!(found.not_excited.iter().all(|n| !open(&n.id)), "{:?}", found.not_excited);
    }
    assert!(flagged > 0, "viscous friction that depends on the angle has no name");
}
