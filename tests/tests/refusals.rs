//! Recordings with which nothing can be compared: the reason is the true one, and it is not that there is nothing.

use estimator::diagnose::{Options, Verdict, diagnose};
use haptics::recording::{Channel, Recording};

fn recording(time_s: Option<Vec<f64>>, columns: &[(&str, Vec<f64>)]) -> Recording {
    let channels = columns.iter().map(|(name, values)| Channel {
        name: (*name).to_owned(),
        unit: name.rsplit('_').next().unwrap_or_default().to_owned(),
        values: values.clone(),
    });
    Recording { name: "log".to_owned(), time_s, channels: channels.collect(), ..Recording::default() }
}

/// Values of a function at whole numbers.
fn of(rows: u32, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..rows).map(|k| value(f64::from(k))).collect()
}

fn refused(recording: Recording) -> String {
    diagnose(&[recording], &Options::default()).map(|found| found.verdict).expect_err("nothing to compare").to_string()
}

#[test]
fn a_scribble_with_forces_is_no_line_and_lacks_no_column() {
    let scribble = [
        ("x_m", of(2000, |k| 0.1 * (0.013 * k).sin() + 0.05 * (0.031 * k).cos())),
        ("y_m", of(2000, |k| 0.1 * (0.017 * k).sin() - 0.04 * (0.041 * k).sin())),
        ("fx_N", of(2000, |k| (0.02 * k).sin())),
        ("fy_N", of(2000, |k| (0.03 * k).cos())),
    ];
    let said = refused(recording(Some(of(2000, |k| 0.005 * k)), &scribble));
    assert!(said.contains("not decided to be a line or a circle") && !said.contains("needs the column"), "{said}");
}

#[test]
fn a_few_poses_without_a_clock_are_not_nothing() {
    let places = [("x_m", of(6, |k| 0.1 * k * k)), ("y_m", of(6, |k| 0.2 * (3.0 * k).sin()))];
    let said = refused(recording(None, &places));
    assert!(said.contains("nothing can be compared"), "{said}");
}

#[test]
fn a_line_without_forces_cannot_tell() {
    let line = [("x_m", of(200, |k| 0.002 * k)), ("y_m", of(200, |k| 0.001 * k + 1e-5 * (7.3 * k).sin()))];
    let found = diagnose(&[recording(None, &line)], &Options::default()).expect("a line");
    assert_eq!(found.verdict, Verdict::Ambiguous, "{found:?}");
    assert!(found.not_excited.iter().any(|n| n.why.contains("no force was recorded")));
}
