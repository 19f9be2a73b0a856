//! Loads or makes a log and times it: the Rust side of `benches/logs.py`.
//!
//! `load_log load FILE ROUNDS` prints the best and the median seconds of loading, and the seconds until the first curves could be
//! drawn in the last round; `load_log make FILE ROWS` writes twelve
//! channels in the format of the file's ending.

use estimator::log::preview::Preview;
use estimator::log::{self, Watch};
use haptics::recording::{Channel, Recording};
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["load", file, rounds] => load(Path::new(file), rounds.parse()?),
        ["make", file, rows] => Ok(log::write(&[recording(rows.parse()?)], Path::new(file), &[])?),
        _ => Err("usage: load_log load FILE ROUNDS | make FILE ROWS".into()),
    }
}

fn load(file: &Path, rounds: usize) -> Result<(), Box<dyn std::error::Error>> {
    let mut seconds = Vec::new();
    let (mut samples, mut first_s) = (0, f64::NAN);
    for _ in 0..rounds.max(1) {
        let (preview, first, never) = (Preview::default(), OnceLock::new(), AtomicBool::new(false));
        let start = Instant::now();
        let progress = |_: f64| {
            if first.get().is_none() && !preview.curves(1000).is_empty() {
                let _ = first.set(start.elapsed().as_secs_f64());
            }
        };
        let watch = Watch { progress: &progress, cancelled: &never, preview: Some(&preview) };
        let recordings = log::load_watched(file, None, &watch)?;
        first_s = first.get().copied().unwrap_or(f64::NAN);
        seconds.push(start.elapsed().as_secs_f64());
        samples = recordings.iter().map(Recording::len).sum();
    }
    seconds.sort_by(f64::total_cmp);
    println!("{} {} {samples} {first_s}", seconds[0], seconds[seconds.len() / 2]);
    Ok(())
}

/// Twelve channels at 1 kHz with all digits, as sensors with noise have them.
fn recording(rows: u32) -> Recording {
    let names = [
        "x1_m", "y1_m", "x2_m", "y2_m", "vx1_m_s", "vy1_m_s", "vx2_m_s", "vy2_m_s", "fx1_N", "fy1_N", "fx2_N", "fy2_N",
    ];
    let mut state = 1_u64;
    let mut noise = || {
        // A linear congruential generator (Knuth's MMIX constants): the same file everywhere.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let channel = |(k, name): (usize, &&str)| Channel {
        name: (*name).to_owned(),
        unit: name.split_once('_').map_or("", |(_, unit)| unit).to_owned(),
        values: (0..rows).map(|i| (f64::from(i) * 1e-3 * (k + 1) as f64).sin() + 1e-3 * noise()).collect(),
    };
    Recording {
        name: "benchmark".to_owned(),
        time_s: Some((0..rows).map(|i| f64::from(i) * 1e-3).collect()),
        channels: names.iter().enumerate().map(channel).collect(),
        ..Recording::default()
    }
}
