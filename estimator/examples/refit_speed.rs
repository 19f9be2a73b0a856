//! Times the whole chain on one log, and the refit of a prepared one: the Rust side of `benches/refit.py`.
//!
//! `refit_speed LOG ROUNDS` prints the samples, the seconds of a first analysis, and those of every refit.

use estimator::pipeline::{Options, Prepared, analyse_prepared};
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [log, rounds] = &arguments[..] else { return Err("usage: refit_speed LOG ROUNDS".into()) };
    let recordings = estimator::log::load(Path::new(log), None)?;
    let samples: usize = recordings.iter().map(haptics::recording::Recording::len).sum();
    let prepared = Prepared::default();
    let mut seconds = Vec::new();
    for _ in 0..=rounds.parse::<usize>()?.max(1) {
        let start = Instant::now();
        analyse_prepared(&recordings, &prepared, &Options::default())?;
        seconds.push(start.elapsed().as_secs_f64().to_string());
    }
    println!("{samples} {}", seconds.join(" "));
    Ok(())
}
