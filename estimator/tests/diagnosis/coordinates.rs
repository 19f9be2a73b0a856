//! Recordings of one mechanism that can, or cannot, be diagnosed and compared together.

use estimator::diagnose::{Findings, Options, diagnose, validate};
use haptics::recording::{Channel, Recording};

const RADIUS_M: f64 = 0.3;

/// A door that is opened and shut: inertia, Coulomb and viscous friction, and a spring that pulls from the closed
/// position.
fn door(name: &str, (begin_rad, swing_rad): (f64, f64), shifted_m: f64, phase: f64) -> Recording {
    let time: Vec<f64> = (0..6000).map(|i| f64::from(i) * 2e-3).collect();
    let noise = |i: usize, k: f64| ((i as f64 + phase) * k).sin() + ((i as f64 - phase) * 1.7 * k).cos();
    let (mut all, names) = (vec![Vec::new(); 4], ["x_m", "y_m", "fx_N", "fy_N"]);
    for (i, t) in time.iter().enumerate() {
        let w = 1.7;
        let angle = begin_rad + swing_rad * (1.0 - (w * t).cos());
        let (speed, acceleration) = (swing_rad * w * (w * t).sin(), swing_rad * w * w * (w * t).cos());
        let torque = 0.2 * acceleration + 0.3 * speed + 0.4 * speed.signum() + 1.5 * angle;
        let (sin, cos) = angle.sin_cos();
        let along_n = torque / RADIUS_M + 0.01 * noise(i, 12.9898);
        all[0].push(shifted_m + RADIUS_M * cos + 1e-6 * noise(i, 78.233));
        all[1].push(RADIUS_M * sin + 1e-6 * noise(i, 39.425));
        all[2].push(-along_n * sin + 0.5 * cos);
        all[3].push(along_n * cos + 0.5 * sin);
    }
    let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
    let channels = names.into_iter().zip(all).map(channel).collect();
    Recording { name: name.to_owned(), time_s: Some(time), channels, ..Recording::default() }
}

#[test]
fn a_slide_and_a_door_are_not_diagnosed_together() {
    let made = |column: &str, name: &str| {
        let path = door(name, (0.1, 0.5), 0.0, 1.0);
        let places = path.channels[0].values.clone();
        let force = path.channels[3].values.clone();
        let channel = |name: &str, values| Channel { name: name.to_owned(), unit: String::new(), values };
        let channels = vec![channel(column, places), channel(if column == "q_m" { "f_N" } else { "tau_Nm" }, force)];
        Recording { channels, ..path }
    };
    let both = [made("q_m", "slide"), made("q_rad", "door")];
    let said = diagnose(&both, &Options::default()).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(said.contains("door moves about an axis") && said.contains("move along a line"), "{said}");
}

fn asked(recording: &Recording) -> (Options, Findings) {
    let options = Options::default();
    let found = diagnose(std::slice::from_ref(recording), &options).expect("it can be diagnosed");
    (options, found)
}

#[test]
fn what_depends_on_the_place_holds_on_another_path_that_begins_elsewhere() {
    let (options, found) = asked(&door("one", (0.1, 0.5), 0.0, 0.0));
    assert!(found.causes.iter().any(|c| c.id == "return-spring"), "{:?}", found.causes);
    for (begin, swing) in [(0.6, 0.25), (1.1, -0.5)] {
        let others = [door("two", (begin, swing), 0.0, 0.4), door("three", (begin, swing), 0.0, 0.7)];
        let on = validate(&others, &options, &found).expect("figures");
        assert!(on.len() == 2 && on.iter().all(|v| v.interval[0] > 0.9), "{begin} {swing}: {on:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused_in_a_sentence() {
    let (options, found) = asked(&door("one", (0.1, 0.5), 0.0, 0.0));
    let mut moved = vec![door("moved", (0.1, 0.5), 0.05, 0.1)];
    let said = |recordings: &[Recording], found: &Findings| {
        validate(recordings, &options, found).expect_err("another frame").to_string()
    };
    assert!(said(&moved, &found).contains("moved does not keep to the path"));
    let angle = moved[0].channels[0].values.clone();
    moved[0].channels = ["q_rad", "tau_Nm"]
        .map(|name| Channel { name: name.to_owned(), unit: String::new(), values: angle.clone() })
        .to_vec();
    assert!(said(&moved, &found).contains("the column q_rad"));
    let mut clockless = door("still", (0.1, 0.5), 0.0, 0.0);
    clockless.time_s = None;
    let (_, pulled) = asked(&clockless);
    assert!(said(&[clockless], &pulled).contains("leave out --validate"));
}
