//! Load of a force/torque sensor: weight, centre of mass, bias, drift, and what changed between two sets.

mod generator;

use estimation::pipeline::{Options, analyse};
use foundation::estimate::Fit;
use generator::{Form, Sensor, Truth, make};
use haptics::recording::{Recording, Task, WrenchFrame};
use rand::{SeedableRng as _, rngs::StdRng};
use std::collections::BTreeMap;

fn fit(recording: &Recording) -> Fit {
    let analysis = analyse(std::slice::from_ref(recording), &Options::default()).expect("a fit");
    assert_eq!(analysis.task, Task::Payload);
    analysis.fit
}

/// Errors of all parameters in standard errors.
fn scores(fit: &Fit, truth: &Truth) -> BTreeMap<&'static str, f64> {
    let mut all = BTreeMap::new();
    let mut add = |kind: &'static str, object: &str, name: &str, wanted: f64| {
        let p = fit.parameter(object, name).unwrap_or_else(|| panic!("{name} is listed"));
        if let (Some(value), Some(error)) = (p.value, p.std_error) {
            all.entry(kind).or_insert((value - wanted) / error);
        }
    };
    add("weight", "payload", "weight_N", truth.sensor.weight_n);
    add("com x", "payload", "com_x_m", truth.sensor.com_m[0]);
    add("com z", "payload", "com_z_m", truth.sensor.com_m[2]);
    add("bias x", "sensor", "force_bias_x_N", truth.bias_n[0]);
    add("bias z", "sensor", "force_bias_z_N", truth.bias_n[2]);
    add("torque bias y", "sensor", "torque_bias_y_Nm", truth.sensor.bias_nm[1]);
    if fit.parameter("sensor", "force_drift_x_N_s").is_some() {
        add("drift x", "sensor", "force_drift_x_N_s", truth.drift_n_s[0]);
    }
    all
}

/// Share of 95 % intervals that hold, by kind of parameter.
fn coverage(form: Form, seeds: std::ops::Range<u64>) -> BTreeMap<&'static str, (usize, usize)> {
    let mut counts = BTreeMap::new();
    for seed in seeds {
        let sensor = Sensor::drawn(&mut StdRng::seed_from_u64(seed ^ 0x5eed));
        let (mut recording, truth) = make(form, sensor, seed);
        recording.meta.wrench_frame = Some(WrenchFrame::Sensor);
        for (kind, score) in scores(&fit(&recording), &truth) {
            let (held, all) = counts.entry(kind).or_insert((0, 0));
            *held += usize::from(score.abs() < 1.96);
            *all += 1;
        }
    }
    counts
}

#[test]
fn intervals_hold() {
    let runs = std::env::var("TOUCHSTONE_COVERAGE").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    let first = std::env::var("TOUCHSTONE_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(1);
    for form in [
        Form::Table(5),
        Form::Table(7),
        Form::Table(30),
        Form::Table(100),
        Form::Holds(6),
        Form::Holds(12),
        Form::Slow(240.0),
    ] {
        for (kind, (held, all)) in coverage(form, first..first + runs) {
            println!("{form:?} {kind}: {:.3} of {all}", held as f64 / all as f64);
        }
    }
}
