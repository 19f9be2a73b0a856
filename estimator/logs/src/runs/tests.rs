use super::*;
use crate::{LogError, load};
use haptics::recording::Recording;
use std::fmt::Write as _;

fn ramp(rows: usize, from: f64) -> Vec<f64> {
    (0..rows).map(|i| from + 0.01 * i as f64).collect()
}

fn read(table: &str, meta: &str) -> Result<Vec<Recording>, LogError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let log = folder.path().join("log.csv");
    std::fs::write(&log, table).expect("writable");
    std::fs::write(folder.path().join("log.meta.json"), meta).expect("writable");
    load(&log, None)
}

/// Rows `name,t_s,q_m` of runs: the value of the first column, the first time, and the number of rows of each.
fn table(name: &str, runs: &[(&str, f64, usize)]) -> String {
    let mut text = format!("{name},t_s,q_m,label\n");
    for (place, (value, from, rows)) in runs.iter().enumerate() {
        for (i, t) in ramp(*rows, *from).iter().enumerate() {
            let _ = writeln!(text, "{value},{t:.3},{},s{place}", (0.37 * i as f64 + place as f64).sin());
        }
    }
    text
}

fn shape(recordings: &[Recording]) -> Vec<(&str, usize)> {
    recordings.iter().map(|r| (r.trial.as_deref().unwrap_or(""), r.len())).collect()
}

#[test]
fn a_clock_that_starts_again_begins_a_run_and_a_glitch_does_not() {
    let twice = [ramp(100, 0.0), ramp(80, 0.003)].concat();
    assert_eq!(starts(&twice, &[]), [0, 100]);
    // A zero where a stamp was lost, a late packet, a short tail, and a counter that runs over.
    let mut lost = ramp(100, 0.0);
    lost[40] = 0.0;
    assert_eq!(starts(&lost, &[]), [0]);
    assert_eq!(starts(&[ramp(100, 0.0), ramp(60, 0.8)].concat(), &[]), [0]);
    assert_eq!(starts(&[ramp(100, 0.0), ramp(5, 0.0)].concat(), &[]), [0]);
    assert_eq!(starts(&[ramp(100, 0.0), ramp(50, 0.0)].concat(), &[1.0]), [0]);
}

#[test]
fn runs_are_told_by_their_column_or_by_their_clock() {
    let log = table("Run No", &[("a", 0.0, 60), ("b", 0.0, 50), ("c", 7.5, 40)]);
    let all = read(&log, "{}").expect("runs");
    assert_eq!(shape(&all), [("a", 60), ("b", 50), ("c", 40)]);
    assert_eq!((all[1].name.as_str(), &all[1].labels.as_ref().expect("labels")[0]), ("log.csv, trial b", "s1"));
    assert_eq!(shape(&read(&log, r#"{"select": {"trial": ["a", "c"]}}"#).expect("two")), [("a", 60), ("c", 40)]);
    assert_eq!(shape(&read(&log, r#"{"select": {"Run No": "b"}}"#).expect("one")), [("b", 50)]);
    // No column: the clock. The second of two trials of one number belongs to another session.
    let bare = table("load_N", &[("1", 0.0, 60), ("2", 0.001, 50)]);
    assert_eq!(shape(&read(&bare, "{}").expect("two runs")), [("1", 60), ("2", 50)]);
    assert_eq!(shape(&read(&bare, r#"{"select": {"trial": 2}}"#).expect("one")), [("2", 50)]);
    let sessions = table("trial", &[("1", 0.0, 60), ("2", 0.0, 50), ("1", 0.0, 40)]);
    assert_eq!(shape(&read(&sessions, "{}").expect("three")), [("1", 60), ("1 (2)", 40), ("2", 50)]);
    let error = read(&bare, r#"{"select": {"trial": 3}}"#).expect_err("no third run").to_string();
    assert!(error.contains("no row has trial = 3; the file has 1, 2"), "{error}");
}

#[test]
fn runs_that_were_broken_off_are_left_out_with_a_sentence() {
    let log = table("run", &[("1", 0.0, 300), ("2", 0.0, 12), ("3", 0.0, 280)]);
    let all = read(&log, "{}").expect("two runs");
    assert_eq!(shape(&all), [("1", 300), ("3", 280)]);
    let said = "runs that were broken off are left out: 2 (12 rows); \"select\": {\"trial\": …} reads one of them";
    assert!(all[0].warnings.iter().any(|warning| warning.text.ends_with(said)), "{:?}", all[0].warnings);
    assert_eq!(shape(&read(&log, r#"{"select": {"trial": "2"}}"#).expect("one")), [("2", 12)]);
    let short = table("run", &[("1", 0.0, 100), ("2", 0.0, 12)]);
    assert_eq!(shape(&read(&short, "{}").expect("both")), [("1", 100), ("2", 12)]);
}

#[test]
fn phases_of_one_run_stay_together_unless_it_is_asked_for() {
    let log = table("segment", &[("near", 0.0, 60), ("far", 0.6, 50), ("near", 1.1, 40)]);
    let all = read(&log, "{}").expect("one run");
    assert_eq!(shape(&all), [("", 150)]);
    let times = all[0].time_s.as_ref().expect("a clock");
    assert!(times.windows(2).all(|w| w[1] > w[0]) && all[0].warnings[0].text.contains("time goes on"));
    assert_eq!(&all[0].labels.as_ref().expect("labels")[149], "s2");
    assert_eq!(
        shape(&read(&log, r#"{"columns": {"trial": "segment"}}"#).expect("asked")),
        [("near", 100), ("far", 50)]
    );
}

#[test]
fn windows_of_time_cut_a_recording_and_say_when_they_are_empty() {
    let log = table("load_N", &[("1", 10.0, 100)]);
    let one = read(&log, r#"{"from_s": 10.2, "to_s": 10.3}"#).expect("a window");
    assert_eq!((shape(&one), one[0].name.as_str()), (vec![("", 11)], "log.csv"));
    let two = r#"{"windows": [{"to_s": 10.1}, {"from_s": 10.5}]}"#;
    let two = read(&log, two).expect("two windows");
    assert_eq!(shape(&two), [("up to 10.1 s", 11), ("from 10.5 s", 50)]);
    assert_eq!(two[1].name, "log.csv, from 10.5 s");
    let no = |meta: &str| read(&log, meta).expect_err(meta).to_string();
    assert!(no(r#"{"from_s": 20}"#).contains("from 20 s): the log runs from 10 to 10.99 s"));
    assert!(no(r#"{"from_s": 3, "to_s": 2}"#).contains("is empty"));
    assert!(no(r#"{"from_s": "now"}"#).contains("must be a number"));
    assert!(no(r#"{"windows": [{"since": 2}]}"#).contains("must be a list like"));
    let clockless = log.replace("t_s", "other");
    assert!(read(&clockless, r#"{"to_s": 2}"#).expect_err("no clock").to_string().contains("the log has no clock"));
}

#[test]
fn row_numbers_tell_the_runs_of_a_path_without_a_clock() {
    let mut log = "sample,x_m,y_m\n".to_owned();
    for i in 0..90 {
        let _ = writeln!(log, "{},{},{}", i % 45, (0.3 * f64::from(i)).sin(), (0.1 * f64::from(i)).cos());
    }
    assert_eq!(shape(&read(&log, "{}").expect("two paths")), [("1", 45), ("2", 45)]);
}
