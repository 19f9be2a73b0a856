//! Logs that were cut off or spoiled anywhere, with sidecars that say strange things: a recording that can be fitted, or a sentence.

use crate::{Chaos, must_be_a_sentence, mutate};
use estimator::log;
use estimator::pipeline::{Options, analyse};
use haptics::recording::Recording;
use rand::RngExt as _;
use rand::rngs::StdRng;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use tests::workspace;

/// Spoiled files a lap.
const FILES: usize = 60;
/// Of those that load, so many are fitted a lap.
const FITS: usize = 4;
/// Samples of the logs that are spoiled: enough for a fit, few enough for many.
const SAMPLES: usize = 6_000;

/// A log as bytes, with its sidecar.
pub struct Good {
    pub ending: &'static str,
    pub bytes: Vec<u8>,
    pub meta: serde_json::Value,
}

/// A shorter form of a recording that comes with the program.
pub fn recording(name: &str) -> Recording {
    let path = workspace().join("assets/recordings").join(name).with_extension("csv");
    let whole = log::load(&path, None).expect("it comes with the program").remove(0);
    let end = SAMPLES.min(whole.len());
    let part = |values: &[f64]| values[..end].to_vec();
    Recording {
        time_s: whole.time_s.as_deref().map(part),
        channels: whole
            .channels
            .iter()
            .map(|c| haptics::recording::Channel { values: part(&c.values), ..c.clone() })
            .collect(),
        labels: whole.labels.as_ref().map(|labels| labels.slice(0..end)),
        ..whole.clone()
    }
}

/// Crank and blocks in every format, made once.
pub fn good() -> &'static [Good] {
    static GOOD: OnceLock<Vec<Good>> = OnceLock::new();
    GOOD.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut made = Vec::new();
        for name in ["crank", "stack"] {
            let recording = recording(name);
            let meta = serde_json::to_value(&recording.meta).expect("a sidecar");
            for ending in ["csv", "mcap", "parquet"] {
                let path = folder.path().join(name).with_extension(ending);
                log::write(std::slice::from_ref(&recording), &path, &[]).expect("writes");
                made.push(Good { ending, bytes: std::fs::read(&path).expect("there"), meta: meta.clone() });
            }
        }
        made
    })
}

/// Writes one of the good logs, spoiled, now and then its sidecar too.
pub fn spoil(folder: &Path, stem: &str, rng: &mut StdRng) -> PathBuf {
    let good = &good()[rng.random_range(0..good().len())];
    let path = folder.join(stem).with_extension(good.ending);
    let (log, sidecar) = match rng.random_range(0..3) {
        0 => (tests::spoiled::bytes(&good.bytes, rng), good.meta.to_string().into_bytes()),
        1 => (good.bytes.clone(), mutate::json(&good.meta, rng).to_string().into_bytes()),
        _ => (tests::spoiled::bytes(&good.bytes, rng), tests::spoiled::bytes(good.meta.to_string().as_bytes(), rng)),
    };
    std::fs::write(&path, log).expect("writes");
    std::fs::write(log::sidecar_path(&path), sidecar).expect("writes");
    path
}

pub fn cut_and_spoiled(chaos: &mut Chaos) {
    let folder = chaos.scratch();
    let mut fits = 0;
    for number in 0..FILES {
        let path = spoil(folder.path(), &format!("log-{number}"), &mut chaos.rng);
        chaos.count("spoiled logs", 1);
        match log::load(&path, None) {
            Err(error) => must_be_a_sentence(&error.to_string(), &path),
            Ok(recordings) => {
                chaos.count("spoiled logs that load", 1);
                let first = &recordings[0];
                let time_s = first.time_s.as_deref().unwrap_or(&[]);
                assert!(time_s.windows(2).all(|w| w[1] > w[0]), "time runs forwards: {path:?}");
                if fits < FITS && first.len() <= SAMPLES {
                    fits += 1;
                    match analyse(&recordings[..1], &Options::default()) {
                        Ok(_) => chaos.count("fits that answered", 1),
                        Err(error) => must_be_a_sentence(&error.to_string(), &path),
                    }
                }
            }
        }
    }
}
