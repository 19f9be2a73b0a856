//! Motion and force come in turns, each with its own clock, and the clock of the force is late: a fit takes the lag out.

use blind::{Bench, Counts, Set, battery};
use estimator::log;
use estimator::pipeline;
use haptics::recording::Recording;
use std::fmt::Write as _;

/// Seed on which nothing was chosen.
const SEED: u64 = 9_300_001;
/// Another one.
const FRESH: u64 = 9_300_002;
/// Longest lag, s.
const MOST_S: f64 = 0.1;
/// Error of the force by the lag, over its noise.
const OVER_NOISE: f64 = 15.0;

/// The log of a mechanism whose even rows hold the motion and whose odd rows hold the force, stamped late.
fn log(recording: &Recording, lag_s: f64) -> String {
    let times = recording.time_s.as_ref().expect("a clock");
    let channel = |names: [&'static str; 2]| {
        names.into_iter().find_map(|name| Some((name, recording.channel(name)?))).expect("a channel")
    };
    let ((position, q), (effort, f)) = (channel(["q_m", "q_rad"]), channel(["f_N", "tau_Nm"]));
    let stamps = times.iter().enumerate().map(|(k, t)| if k % 2 == 0 { (*t, k) } else { (t + lag_s, k) });
    let mut rows: Vec<(f64, usize)> = stamps.collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = format!("t_s,{position},{effort}\n");
    for (t, k) in rows {
        let _ = if k % 2 == 0 { writeln!(text, "{t:.7},{:.9},", q[k]) } else { writeln!(text, "{t:.7},,{:.9}", f[k]) };
    }
    text
}

/// The log of a mechanism whose force comes some rows late, on one clock.
fn late_force(recording: &Recording, rows: usize) -> String {
    let times = recording.time_s.as_ref().expect("a clock");
    let pair = |names: [&'static str; 2]| names.into_iter().find_map(|name| Some((name, recording.channel(name)?)));
    let ((position, q), (effort, f)) =
        (pair(["q_m", "q_rad"]).expect("a motion"), pair(["f_N", "tau_Nm"]).expect("a force"));
    (rows..times.len()).fold(format!("t_s,{position},{effort}\n"), |mut text, k| {
        let _ = writeln!(text, "{:.7},{:.9},{:.9}", times[k], q[k], f[k - rows]);
        text
    })
}

/// Values with their standard errors, and sentences about a lag.
type Fitted = (Vec<(String, f64, f64)>, Vec<String>);

/// The fit of a log, with a sidecar.
fn fitted(folder: &std::path::Path, text: &str, sidecar: &str) -> Fitted {
    fit_of(&loaded(folder, text, sidecar))
}

/// The recordings of a log, with a sidecar.
fn loaded(folder: &std::path::Path, text: &str, sidecar: &str) -> Vec<Recording> {
    let file = folder.join("log.csv");
    std::fs::write(&file, text).expect("a file");
    std::fs::write(folder.join("log.meta.json"), sidecar).expect("a file");
    log::load(&file, None).expect("a log")
}

/// Values of a fit that are known, and its sentences about a lag.
fn fit_of(recordings: &[Recording]) -> Fitted {
    let fit = pipeline::analyse(recordings, &pipeline::Options::default()).expect("a fit").fit;
    let known = fit.parameters.iter().filter_map(|p| Some((p.name.clone(), p.value?, p.std_error?))).collect();
    let is_about_lag = |said: &String| said.contains("clocks of their own") || said.contains("tells a delay");
    (known, fit.warnings.into_iter().filter(is_about_lag).collect())
}

/// Root mean square of the rate of the force, N/s or N m/s.
fn rate(recording: &Recording) -> f64 {
    let times = recording.time_s.as_ref().expect("a clock");
    let force = recording.channel("f_N").or_else(|| recording.channel("tau_Nm")).expect("a force");
    // Over some samples, so that the noise does not count.
    let over = 20.min(force.len() / 20);
    let slopes: Vec<f64> =
        (over..force.len()).map(|k| (force[k] - force[k - over]) / (times[k] - times[k - over])).collect();
    (slopes.iter().map(|s| s * s).sum::<f64>() / slopes.len() as f64).sqrt()
}

#[test]
fn a_fit_takes_out_the_lag_of_a_force_with_a_clock_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut all, mut told, mut off, mut values, mut report) = (0, 0, 0, 0, Vec::new());
    for job in battery(Counts::FAST, SEED).into_iter().filter(|job| job.set == Set::Null) {
        let (case, truth) = job.make();
        if !matches!(case.bench, Bench::Linear | Bench::Angular) {
            continue;
        }
        let recording = &case.recordings[0];
        let lag_s = (OVER_NOISE * truth.noise_n / rate(recording)).min(MOST_S);
        let (before, quiet) = fitted(folder.path(), &log(recording, 0.0), r#"{"task":"mechanism"}"#);
        assert!(quiet.is_empty(), "{}: {quiet:?}", job.seed);
        let late = log(recording, lag_s);
        let (after, said) = fitted(folder.path(), &late, r#"{"task":"mechanism"}"#);
        let far: Vec<_> = before
            .iter()
            .filter(|(name, value, error)| {
                !after.iter().any(|other| other.0 == *name && (other.1 - value).abs() <= 2.0 * error.max(other.2))
            })
            .collect();
        report.push(format!("{} {:?} {lag_s:.4} s: {said:?}\n  {far:?}\n  {after:?}", job.seed, case.bench));
        all += 1;
        if said.len() == 1 && said[0].contains("takes the lag out") {
            told += 1;
            values += before.len();
            off += far.len();
            let (_, left) = fitted(folder.path(), &late, r#"{"task":"mechanism","as_recorded":["clock-offset"]}"#);
            assert!(left.len() == 1 && left[0].contains("left in, as the sidecar says"), "{left:?}");
        }
    }
    println!("{}\n{told} of {all}, {off} of {values} off", report.join("\n"));
    assert!(all >= 4 && 4 * told >= 3 * all && 10 * off <= values, "{told} of {all}, {off} of {values} off");
}

/// A written table has one clock; its sidecar tells that there were several.
#[test]
fn a_converted_file_gives_the_fit_of_the_original() {
    let folder = tempfile::tempdir().expect("a folder");
    let jobs = battery(Counts::FAST, SEED).into_iter().filter(|job| job.set == Set::Null);
    let linear = jobs.map(|job| job.make().0).find(|case| case.bench == Bench::Linear).expect("a case");
    let read = loaded(folder.path(), &log(&linear.recordings[0], 0.04), r#"{"task":"mechanism"}"#);
    assert!(read[0].has_several_clocks(), "{:?}", read[0].warnings);
    let (values, said) = fit_of(&read);
    let is_taken_out = |said: &[String]| said.len() == 1 && said[0].contains("takes the lag out");
    assert!(is_taken_out(&said), "{said:?}");
    for ending in ["csv", "mcap", "parquet"] {
        let written = folder.path().join(format!("written.{ending}"));
        log::write(&read, &written, &[]).expect("written");
        let (again, said) = fit_of(&log::load(&written, None).expect("reads back"));
        assert!(is_taken_out(&said), "{ending}: {said:?}");
        let is_same = |(a, b): (&(String, f64, f64), &(String, f64, f64))| (a.1 - b.1).abs() <= 0.01 * a.2;
        assert!(values.iter().zip(&again).all(is_same), "{ending}: {values:?}, {again:?}");
    }
}

/// On one clock a lag stays in and is told: only the diagnosis tells a delay from other causes.
#[test]
fn a_fit_tells_the_lag_of_a_force_on_one_clock() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut all, mut told, mut others, mut report) = (0, 0, 0, Vec::new());
    for job in battery(Counts::FAST, FRESH) {
        let (case, truth) = job.make();
        let recording = &case.recordings[0];
        if !matches!(case.bench, Bench::Linear | Bench::Angular) || recording.rate_hz().is_none() {
            continue;
        }
        let (_, said) = fitted(folder.path(), &late_force(recording, 0), r#"{"task":"mechanism"}"#);
        report.push(format!("{} {:?} {:?}: {said:?}", job.seed, case.bench, job.set));
        if job.set != Set::Null {
            others += said.len();
            continue;
        }
        assert!(said.is_empty(), "{}: {said:?}", job.seed);
        let lag_s = (OVER_NOISE * truth.noise_n / rate(recording)).min(0.4 * MOST_S);
        let rows = (lag_s * recording.rate_hz().expect("a rate")).ceil().max(2.0);
        let (_, said) = fitted(folder.path(), &late_force(recording, rows as usize), r#"{"task":"mechanism"}"#);
        report.push(format!("  {lag_s:.4} s: {said:?}"));
        all += 1;
        told += usize::from(said.len() == 1 && said[0].contains("later than the motion"));
    }
    println!("{}\n{told} of {all} told, {others} beside other causes", report.join("\n"));
    assert!(all >= 3 && 4 * told >= 3 * all, "{told} of {all} told");
}
