//! Decodes a sequence and times it: the Rust side of `benches/hmm.py`.
//!
//! `hmm_speed FOLDER ROUNDS`: reads `start`, `transition`, `means`, `covariances` (little-endian f64) and `values` of `FOLDER`, with the
//! numbers of states and channels and `full` or `diagonal` in `shape`; writes the path into `path` and prints the log probability and the
//! seconds of every round.

use estimator::hmm::{Chain, Covariance, Gaussian, Model};
use std::path::Path;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, rounds] = &arguments[..] else { return Err("usage: hmm_speed FOLDER ROUNDS".into()) };
    let folder = Path::new(folder);
    let shape = std::fs::read_to_string(folder.join("shape"))?;
    let [states, channels, kind] = shape.split_whitespace().collect::<Vec<_>>()[..] else {
        return Err("shape needs states, channels and the kind".into());
    };
    let model = model(folder, states.parse()?, channels.parse()?, kind == "full")?;
    let values = numbers(&folder.join("values"))?;
    let mut answer = (Vec::new(), f64::NAN);
    let mut seconds = Vec::new();
    for _ in 0..rounds.parse::<usize>()?.max(1) {
        let start = Instant::now();
        answer = model.decode(&model.chain, &values, 1.0)?;
        seconds.push(start.elapsed().as_secs_f64().to_string());
    }
    std::fs::write(folder.join("path"), &answer.0)?;
    println!("{} {}", answer.1, seconds.join(" "));
    Ok(())
}

fn numbers(file: &Path) -> Result<Vec<f64>> {
    Ok(std::fs::read(file)?.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

fn model(folder: &Path, states: usize, channels: usize, full: bool) -> Result<Model> {
    let read = |name: &str| numbers(&folder.join(name));
    let (means, spreads) = (read("means")?, read("covariances")?);
    let emissions = (0..states)
        .map(|s| {
            let mean = means[s * channels..(s + 1) * channels].to_vec();
            let spread = if full {
                let of_state = &spreads[s * channels * channels..(s + 1) * channels * channels];
                Covariance::Full(nalgebra::DMatrix::from_row_slice(channels, channels, of_state))
            } else {
                Covariance::Diagonal(spreads[s * channels..(s + 1) * channels].to_vec())
            };
            Gaussian::new(mean, spread, &vec![1e-9; channels])
        })
        .collect();
    Ok(Model::new(Chain::new(read("start")?, read("transition")?)?, emissions)?)
}
