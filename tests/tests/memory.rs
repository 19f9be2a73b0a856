//! Loading takes no more than twice the file's size in memory, or twice that of the samples where a file packs them tighter than
//! eight bytes each. One test in a process of its own: it counts every allocation.

use haptics::recording::{Channel, Recording};
use peak_alloc::PeakAlloc;
use std::fmt::Write as _;
use std::path::Path;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const ROWS: usize = 300_000;
const CHANNELS: usize = 12;
/// Blocks in flight and tables of decompressors, whatever the size of the file, bytes.
const BASE: usize = 24 << 20;

fn recording() -> Recording {
    let channel = |k: usize| Channel {
        name: format!("a{k}"),
        unit: String::new(),
        values: (0..ROWS).map(|i| (i as f64 * 1e-3 * (k + 1) as f64).sin() + 1e-9 * i as f64).collect(),
    };
    Recording {
        name: "memory".to_owned(),
        time_s: Some((0..ROWS).map(|i| i as f64 * 1e-3).collect()),
        channels: (0..CHANNELS).map(channel).collect(),
        ..Recording::default()
    }
}

/// Makes the label of a sample.
type Label = fn(usize) -> String;

/// The label of a sample: some hundred samples of each.
fn states_of(sample: usize) -> &'static str {
    ["free-motion", "hold-object-above-ground", "turning", "hold-object-on-ground"][sample / 317 % 4]
}

/// Peak while loading, bytes, against the file's size and what the samples take.
fn check(path: &Path, table: &mut String) -> bool {
    let size = usize::try_from(std::fs::metadata(path).expect("written").len()).expect("fits");
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let loaded = estimator::log::load(path, None).expect("loads");
    let used = MEMORY.peak_usage() - before;
    let labels = loaded[0].labels.as_ref();
    assert!(labels.is_none_or(|l| l.len() == ROWS && (&l[700] == states_of(700) || &l[700] == "sample 0000700")));
    let samples: usize = loaded.iter().map(|r| 8 * r.len() * (r.channels.len() + 1)).sum();
    assert_eq!(samples, 8 * ROWS * (CHANNELS + 1), "{}", path.display());
    let mb = |bytes: usize| bytes as f64 * 1e-6;
    let _ = writeln!(
        table,
        "{:<16} file {:6.1} MB, samples {:6.1} MB, peak {:6.1} MB: {:.2} of the larger",
        path.file_name().expect("a name").to_string_lossy(),
        mb(size),
        mb(samples),
        mb(used),
        used as f64 / size.max(samples) as f64
    );
    used <= BASE + 2 * size.max(samples)
}

#[test]
fn loading_takes_at_most_twice_the_files_size() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut paths = Vec::new();
    let whole = recording();
    for name in ["digits.csv", "log.mcap", "log.parquet"] {
        let path = folder.path().join(name);
        estimator::log::write(std::slice::from_ref(&whole), &path, &[]).expect("writes");
        paths.push(path);
    }
    // A state for every sample as people name them, and a text of its own for every sample.
    let labelled: [(&str, Label); 2] =
        [("states", |i| states_of(i).to_owned()), ("ever-new", |i| format!("sample {i:07}"))];
    for (name, label) in labelled {
        let one = Recording { labels: Some((0..ROWS).map(label).collect()), ..whole.clone() };
        for ending in ["csv", "mcap", "parquet"] {
            let path = folder.path().join(format!("{name}.{ending}"));
            estimator::log::write(std::slice::from_ref(&one), &path, &[]).expect("writes");
            paths.push(path);
        }
    }
    drop(whole);
    // One digit a cell: the tightest table there is.
    let short = folder.path().join("short.csv");
    let header = (0..CHANNELS).fold("t_s".to_owned(), |all, k| all + &format!(",a{k}"));
    let mut text = header + "\n";
    for i in 0..ROWS {
        let _ = writeln!(text, "{i},1,2,3,4,5,6,7,8,9,0,1,2");
    }
    std::fs::write(&short, text).expect("writes");
    paths.push(short);
    let mut table = String::new();
    let kept: Vec<bool> = paths.iter().map(|path| check(path, &mut table)).collect();
    println!("{table}");
    assert!(kept.iter().all(|&k| k), "{table}");
}
