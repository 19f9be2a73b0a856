//! Times a diagnosis and prints it: `diagnose_speed LOG [BASELINE]`.

use estimator::diagnose::{Options, diagnose};
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(log) = arguments.first() else { return Err("usage: diagnose_speed LOG [BASELINE]".into()) };
    let recordings = estimator::log::load(Path::new(log), None)?;
    let options = Options { baseline: arguments.get(1).cloned(), ..Options::default() };
    let start = Instant::now();
    let diagnosis = diagnose(&recordings, &options)?;
    eprintln!("{:.3} s", start.elapsed().as_secs_f64());
    println!("{}", serde_json::to_string_pretty(&diagnosis.diagnosis)?);
    Ok(())
}
