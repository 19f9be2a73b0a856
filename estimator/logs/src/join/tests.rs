//! Files of one run, read as one recording.

use crate::{JOINED, load, sidecar_path, write};
use haptics::recording::{Recording, Warning};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Seconds of the force's clock less those of the log's.
const AHEAD_S: f64 = 2.5;

fn position(t: f64) -> f64 {
    0.05 * (1.9 * t + 0.3).sin() + 0.03 * (4.41 * t + 1.1).sin() + 0.02 * (0.77 * t * t / 10.0).sin()
}

/// A folder with a log of positions at 100 Hz, and forces at 500 Hz on another clock.
struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Self {
        let files = Self(tempfile::tempdir().expect("a folder"));
        files.table("log.csv", "t_s,q_m,sync", (0..1000).map(|k| 0.01 * f64::from(k)), |t| {
            format!("{:.6},{}", position(t), u8::from((3.0..3.5).contains(&t)))
        });
        files.table("force.csv", "t_s,f_N,sync", (0..5000).map(|k| AHEAD_S + 0.002 * f64::from(k)), |t| {
            let t = t - AHEAD_S;
            format!("{:.6},{}", 100.0 * position(t), u8::from((3.0..3.5).contains(&t)))
        });
        files
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn table(&self, name: &str, header: &str, times: impl Iterator<Item = f64>, cells: impl Fn(f64) -> String) {
        let mut text = header.to_owned() + "\n";
        times.for_each(|t| writeln!(text, "{t:.4},{}", cells(t)).expect("memory"));
        std::fs::write(self.path(name), text).expect("written");
    }

    /// The log with this sidecar.
    fn load(&self, sidecar: &str) -> Result<Recording, String> {
        std::fs::write(self.path("log.meta.json"), sidecar).expect("written");
        let loaded = load(&self.path("log.csv"), None).map_err(|error| error.to_string())?;
        let [one] = <[Recording; 1]>::try_from(loaded).expect("one recording");
        Ok(one)
    }
}

fn joined(recording: &Recording) -> Vec<&Warning> {
    recording.warnings.iter().filter(|w| w.kind == JOINED).collect()
}

/// The force is that of the position, beside the ends.
fn fits(recording: &Recording, within: f64) {
    let (q, f) = (recording.channel("q_m").expect("a position"), recording.channel("f_N").expect("a force"));
    let worst = q.iter().zip(f).skip(5).map(|(q, f)| (f - 100.0 * q).abs()).fold(0.0, f64::max);
    assert!(worst < within, "{worst} N");
}

#[test]
fn a_file_is_joined_by_statement_by_channel_and_by_name() {
    let files = Files::new();
    let stated = files.load(r#"{"join": [{"file": "force.csv", "offset_s": -2.5}]}"#).expect("joined");
    fits(&stated, 0.01);
    let said = joined(&stated);
    assert!(said.len() == 1 && said[0].text.contains("-2.5 s are added") && said[0].text.contains("1000 of 1000 rows"));
    let by = files.load(r#"{"join": [{"file": "force.csv", "by": ["q_m", "f_N"]}]}"#).expect("joined");
    fits(&by, 0.01);
    assert!(joined(&by)[0].text.contains("`q_m` with its `f_N`"), "{:?}", joined(&by));
    // The channel of both is found. An edge is known to a sample.
    let found = files.load(r#"{"join": [{"file": "force.csv"}]}"#).expect("joined");
    fits(&found, 0.2);
    assert!(
        joined(&found)[0].text.contains("`sync`")
            && joined(&found)[0].text.contains("± 0.006")
            && joined(&found)[0].text.contains("95 %"),
        "{found:?}"
    );
    let other = |recording: &Recording| recording.channels.iter().filter(|c| c.name == "sync").count();
    assert_eq!((other(&found), other(&stated)), (1, 1));
}

#[test]
fn rows_outside_the_file_and_in_its_gaps_are_left_out() {
    let files = Files::new();
    let times = (500..4000).map(|k| 0.002 * f64::from(k)).filter(|t| !(3.0..4.0).contains(t));
    files.table("force.csv", "t_s,f_N", times, |t| format!("{:.6}", 100.0 * position(t)));
    let one = files.load(r#"{"join": [{"file": "force.csv", "offset_s": 0}]}"#).expect("joined");
    fits(&one, 0.2);
    let time = one.time_s.as_deref().expect("a clock");
    assert!(time.iter().all(|t| (1.0..8.0).contains(t) && !(3.01..3.99).contains(t)), "{time:?}");
    assert!(joined(&one)[0].text.contains("of 1000 rows"));
    assert!(one.channels.iter().all(|c| c.values.len() == time.len()));
}

#[test]
fn dated_clocks_are_taken_as_they_stand_with_a_word() {
    let files = Files::new();
    let day = |t: f64| format!("2026-04-17T10:00:{t:06.3}Z");
    let mut log = "timestamp,q_m\n".to_owned();
    (0..1000).for_each(|k| {
        let t = 0.01 * f64::from(k);
        writeln!(log, "{},{:.6}", day(10.0 + t), position(t)).expect("memory");
    });
    std::fs::write(files.path("log.csv"), log).expect("written");
    // Seconds since 1970 of the same moments, from a later start.
    let mut force = "t_s,f_N\n".to_owned();
    (500..5000).for_each(|k| {
        let t = 0.002 * f64::from(k);
        writeln!(force, "{:.3},{:.6}", 1_776_420_010.0 + t, 100.0 * position(t)).expect("memory");
    });
    std::fs::write(files.path("force.csv"), force).expect("written");
    let one = files.load(r#"{"join": [{"file": "force.csv"}]}"#).expect("joined");
    fits(&one, 0.01);
    assert!(joined(&one)[0].text.contains("unknown") && one.time_s.as_deref().expect("a clock")[0] >= 0.99);
}

#[test]
fn what_cannot_be_joined_is_refused_in_words() {
    let files = Files::new();
    let no = |sidecar: &str| {
        let error = files.load(sidecar).expect_err(sidecar);
        assert!(!error.contains('\n'), "{error}");
        error
    };
    let says = |sidecar: &str, words: &str| {
        let error = no(sidecar);
        assert!(error.contains(words), "{words}: {error}");
    };
    says(r#"{"join": [{"file": "absent.csv"}]}"#, "absent.csv");
    says(r#"{"join": [{"file": "log.csv"}]}"#, "the log itself");
    says(r#"{"join": [{"file": "force.csv", "offset": 1}]}"#, "join is a list and must be a list like");
    says(r#"{"join": [{"file": "force.csv", "by": "trigger"}]}"#, "`trigger`, which is no channel of the log");
    says(r#"{"join": [{"file": "force.csv", "offset_s": 90}]}"#, "state another offset_s");
    let force = "f_N\n1\n2\n3\n";
    std::fs::write(files.path("clockless.csv"), force).expect("written");
    says(r#"{"join": [{"file": "clockless.csv", "offset_s": 0}]}"#, "\"rate_hz\" in its sidecar");
    let runs = "t_s,f_N,trial\n0,1,1\n1,2,1\n0,1,2\n1,2,2\n";
    std::fs::write(files.path("runs.csv"), runs).expect("written");
    says(r#"{"join": [{"file": "runs.csv"}]}"#, "holds 2 recordings; choose one with \"select\"");
    std::fs::write(files.path("force.meta.json"), r#"{"join": [{"file": "log.csv"}]}"#).expect("written");
    says(r#"{"join": [{"file": "force.csv", "offset_s": 0}]}"#, "its sidecar joins files itself");
    std::fs::remove_file(files.path("force.meta.json")).expect("removed");
    files.table("other.csv", "t_s,f_N", (0..500).map(|k| 0.01 * f64::from(k)), |t| t.to_string());
    says(r#"{"join": [{"file": "other.csv"}]}"#, "\"join\": [{\"file\": \"other.csv\", \"offset_s\": 0}]");
    files.table("sine.csv", "t_s,q_m,f_N", (0..1000).map(|k| 0.01 * f64::from(k)), |t| {
        format!("{:.6},{:.3}", (5.0 * t).sin(), t)
    });
    std::fs::copy(files.path("sine.csv"), files.path("log.csv")).expect("copied");
    files.table("other.csv", "t_s,q_m,level", (0..1000).map(|k| 0.01 * f64::from(k)), |t| {
        format!("{:.6},{t}", (5.0 * t + 1.0).sin())
    });
    says(r#"{"join": [{"file": "other.csv"}]}"#, "repeats itself: offsets of ");
}

#[test]
fn a_joined_recording_is_written_as_one_file() {
    let files = Files::new();
    let one =
        files.load(r#"{"task": "mechanism", "join": [{"file": "force.csv", "offset_s": -2.5}]}"#).expect("joined");
    let out = files.path("whole.csv");
    write(std::slice::from_ref(&one), &out, &[]).expect("written");
    let sidecar = std::fs::read_to_string(sidecar_path(&out)).expect("a sidecar");
    assert!(sidecar.contains("mechanism") && !sidecar.contains("join"), "{sidecar}");
    let back = load(Path::new(&out), None).expect("reads").remove(0);
    assert_eq!((back.channel("f_N"), back.time_s.as_deref()), (one.channel("f_N"), one.time_s.as_deref()));
}
