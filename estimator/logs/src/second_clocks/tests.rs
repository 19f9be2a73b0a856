//! Tables with two clocks: pairs of time and value side by side.

use crate::load;
use haptics::recording::{RESAMPLED, Recording};
use std::fmt::Write as _;

fn position(t: f64) -> f64 {
    0.05 * (1.9 * t + 0.3).sin() + 0.03 * (4.4 * t + 1.1).sin()
}

/// A table of positions at 100 Hz beside forces at `rate_hz` from `start_s` on; the shorter pair ends in empty cells.
fn pairs(header: &str, rate_hz: f64, start_s: f64) -> String {
    let mut text = header.to_owned() + "\n";
    let count = (8.0 * rate_hz) as usize;
    for k in 0..count.max(1000) {
        let (t, s) = (0.01 * k as f64, k as f64 / rate_hz);
        let own = if k < 1000 { format!("{t:.3},{:.5}", 1e3 * position(t)) } else { ",".to_owned() };
        let other =
            if k < count { format!("{:.4},{:.6}", start_s + s, 100.0 * position(0.5 + s)) } else { ",".to_owned() };
        writeln!(text, "{own},{other}").expect("memory");
    }
    text
}

fn read(table: &str, sidecar: &str) -> Result<Recording, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("log.csv"), table).expect("written");
    std::fs::write(folder.path().join("log.meta.json"), sidecar).expect("written");
    let loaded = load(&folder.path().join("log.csv"), None).map_err(|error| error.to_string())?;
    let [one] = <[Recording; 1]>::try_from(loaded).expect("one recording");
    Ok(one)
}

const HEADER: &str = "time_position_s,position_mm,time_force_s,force_N";
const COLUMNS: &str = r#""columns": {"t_s": "time_position_s", "q_m": "position_mm", "f_N": "force_N"}"#;

/// The force is that of the position.
fn fits(recording: &Recording) {
    let (q, f) = (recording.channel("q_m").expect("a position"), recording.channel("f_N").expect("a force"));
    assert!(q.len() > 700, "{} rows", q.len());
    let worst = q.iter().zip(f).skip(5).map(|(q, f)| (f - 100.0 * q).abs()).fold(0.0, f64::max);
    assert!(worst < 0.05, "{worst} N");
}

#[test]
fn a_column_is_put_on_the_clock_of_the_log() {
    for rate_hz in [100.0, 60.0, 500.0] {
        let table = pairs(HEADER, rate_hz, 0.5);
        for clock in ["f_N", "force_N"] {
            let sidecar = format!(r#"{{{COLUMNS}, "clocks": {{"{clock}": "time_force_s"}}}}"#);
            let one = read(&table, &sidecar).unwrap_or_else(|error| panic!("{rate_hz} Hz: {error}"));
            fits(&one);
            let said = one.warnings.iter().filter(|w| w.kind == RESAMPLED).collect::<Vec<_>>();
            assert!(said.len() == 1 && said[0].text.contains("of 1000 rows are kept"), "{said:?}");
            assert!(one.channel("time_force_s").is_none());
        }
    }
}

#[test]
fn a_second_clock_is_told_with_the_entry_that_settles_it() {
    for header in [HEADER, "t [s],position_mm,t2 time [s],force_N"] {
        let table = pairs(header, 100.0, 0.5);
        let one = read(&table, "{}").unwrap_or_else(|error| panic!("{header}: {error}"));
        let names: Vec<&str> = header.split(',').collect();
        assert!(one.time_s.is_some(), "{:?}", one.warnings);
        let doubt = one.warnings.iter().find(|w| w.suggested.is_some()).expect("a doubt");
        let entries = serde_json::Value::Object(doubt.suggested.clone().expect("entries"));
        assert_eq!(entries, serde_json::json!({ "clocks": { "force_N": names[2] } }), "{doubt:?}");
        let columns = format!(r#""columns": {{"t_s": "{}", "q_m": "position_mm", "f_N": "force_N"}}"#, names[0]);
        let sidecar = format!("{{{columns}, {}", entries.to_string().trim_start_matches('{'));
        let settled = read(&table, &sidecar).expect("reads");
        fits(&settled);
        assert!(settled.warnings.iter().all(|w| w.suggested.is_none()), "{:?}", settled.warnings);
    }
}

#[test]
fn clocks_that_start_apart_ask_for_an_offset() {
    let table = pairs(HEADER, 100.0, 300.5);
    let error = read(&table, &format!(r#"{{{COLUMNS}, "clocks": {{"f_N": "time_force_s"}}}}"#)).expect_err("apart");
    assert!(error.contains(r#""clocks": {"force_N":{"column":"time_force_s","offset_s":null}}"#), "{error}");
    let shifted = r#""clocks": {"f_N": {"column": "time_force_s", "offset_s": -300}}"#;
    fits(&read(&table, &format!("{{{COLUMNS}, {shifted}}}")).expect("reads"));
    let clockless = r#"{"columns": {"t_s": null, "f_N": "force_N"}, "clocks": {"f_N": "time_force_s"}}"#;
    let error = read(&table, clockless).expect_err("no clock");
    assert!(error.contains("needs the clock of the log"), "{error}");
    let absent = read(&table, &format!(r#"{{{COLUMNS}, "clocks": {{"f_N": "time_load_s"}}}}"#)).expect_err("absent");
    assert!(absent.contains("`time_load_s` is missing"), "{absent}");
}

#[test]
fn a_receive_time_and_a_parameter_are_no_second_clock() {
    let mut table = "t_s,receive_time_s,q_m,f_N,dead_time_s\n".to_owned();
    for k in 0..200 {
        let t = 0.01 * f64::from(k);
        writeln!(table, "{t},{},{},{},0.004", t + 0.003, position(t), t.sin()).expect("memory");
    }
    let one = read(&table, "{}").expect("reads");
    assert!(one.warnings.iter().all(|w| w.suggested.is_none()), "{:?}", one.warnings);
    assert_eq!(one.time_s.as_deref().map(|t| t[1]), Some(0.01));
    // Neither does a parameter become the time.
    let one = read("q_m,f_N,dead_time_s\n1,2,0.1\n2,3,0.1\n3,4,0.1\n", "{}").expect("reads");
    assert!(one.time_s.is_none());
}

#[test]
fn a_second_clock_needs_no_unit() {
    let table: String = (0..60).fold("Time - Pos,Pos (mm),Time - F,F (N)\n".to_owned(), |mut text, k| {
        let t = 0.01 * f64::from(k);
        let _ = writeln!(text, "{t:.4},{:.4},{:.4},{:.4}", 1e3 * position(t), t + 0.0021, position(t));
        text
    });
    let sidecar = r#"{"columns":{"t_s":"Time - Pos","q_m":"Pos (mm)","f_N":"F (N)"}}"#;
    let one = read(&table, sidecar).expect("reads");
    let said = one.warnings.iter().filter(|w| w.suggested.is_some()).collect::<Vec<_>>();
    assert!(said.len() == 1 && said[0].text.contains("`Time - F` is a second clock"), "{:?}", one.warnings);
}

#[test]
fn a_written_table_tells_that_there_were_several_clocks() {
    let sidecar = format!(r#"{{{COLUMNS}, "clocks": {{"f_N": "time_force_s"}}}}"#);
    let one = read(&pairs(HEADER, 100.0, 0.5), &sidecar).expect("reads");
    let folder = tempfile::tempdir().expect("a folder");
    for ending in ["csv", "mcap", "parquet"] {
        for (recording, is_several) in [(one.clone(), true), (read("t_s,q_m\n0,1\n1,2\n", "{}").expect("reads"), false)]
        {
            let path = folder.path().join(format!("written.{ending}"));
            crate::write(std::slice::from_ref(&recording), &path, &[]).expect("written");
            let again = load(&path, None).expect("reads back").remove(0);
            assert_eq!((again.has_several_clocks(), &again.channels), (is_several, &recording.channels), "{ending}");
        }
    }
}
