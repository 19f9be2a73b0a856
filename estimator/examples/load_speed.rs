//! Loads a log again and again and says how long it took: `cargo run --release -p estimator --example load_speed FILE [N]`.

use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("name a log")?;
    let times: usize = arguments.next().map_or(Ok(1), |n| n.parse())?;
    let bytes = std::fs::metadata(&file)?.len();
    for _ in 0..times {
        let start = Instant::now();
        let recordings = estimator::log::load(Path::new(&file), None)?;
        let seconds = start.elapsed().as_secs_f64();
        let samples: usize = recordings.iter().map(haptics::recording::Recording::len).sum();
        println!("touchstone {seconds:.4} s, {:.0} MB/s, {samples} rows", bytes as f64 / 1e6 / seconds);
        for warning in recordings.iter().flat_map(|r| &r.warnings).take(5) {
            println!("  {}: {}", warning.kind, warning.text);
        }
    }
    Ok(())
}
