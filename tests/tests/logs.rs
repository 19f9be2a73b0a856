//! Quality checks of logs: nothing is said about clean recordings, and every fault is found with its span.

use estimator::log::quality;
use haptics::device::Skill;
use haptics::recording::{Recording, Span, Warning};
use haptics::servo::recorder::SensorModel;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::fmt::Write as _;
use tests::generate::{crank_world, perform, stacking_world};

/// Seeds of the false-alarm test: half of them stacks, half cranks.
const SEEDS: u64 = 100;
/// Fine steps of 0.2 ms to a sample: 5 kHz, 1 kHz, 100 Hz, 20 Hz.
const EVERY: [usize; 4] = [1, 5, 50, 250];

fn clean(seed: u64, every: usize, sensor: &SensorModel) -> Recording {
    let world = if seed.is_multiple_of(2) { stacking_world(seed).0 } else { crank_world(seed).0 };
    perform(&world, seed, Skill::expert(), every, sensor).recording
}

fn kinds(warnings: &[Warning]) -> Vec<&str> {
    warnings.iter().map(|w| w.kind.as_str()).collect()
}

#[test]
fn clean_recordings_at_any_rate_raise_no_warning() {
    let jobs: Vec<(u64, usize, bool)> = (12_000..12_000 + SEEDS)
        .flat_map(|seed| EVERY.map(|every| (seed, every, (seed / 2).is_multiple_of(4))))
        .collect();
    let said: Vec<String> = jobs
        .par_iter()
        .flat_map_iter(|&(seed, every, ideal)| {
            let sensor = if ideal { SensorModel::IDEAL } else { SensorModel::TYPICAL };
            let recording = clean(seed, every, &sensor);
            let found = quality(&recording);
            found.into_iter().map(move |w| format!("seed {seed}, every {every}, ideal {ideal}: {} {}", w.kind, w.text))
        })
        .collect();
    println!("{} warnings about {} clean recordings", said.len(), jobs.len());
    assert!(said.is_empty(), "{said:#?}");
}

/// One way to spoil a recording: what it is called, sizes from small to large, and what it does; it answers where.
struct Fault {
    name: &'static str,
    kind: &'static str,
    sizes: [f64; 4],
    /// Sizes from this one on must nearly always be found.
    sure_from: usize,
    spoil: fn(&mut Recording, f64, &mut StdRng) -> Option<(&'static str, Span)>,
}

fn values<'a>(recording: &'a mut Recording, name: &str) -> &'a mut Vec<f64> {
    &mut recording.channels.iter_mut().find(|c| c.name == name).expect("a channel").values
}

/// A place away from the ends, where finger 1 moves and pushes.
fn busy(recording: &Recording, length: usize, rng: &mut StdRng) -> Option<usize> {
    let n = recording.len();
    let x = recording.channel("vx1_m_s")?;
    let y = recording.channel("vy1_m_s")?;
    let f = recording.channel("fx1_N")?;
    let places: Vec<usize> = (50..n.checked_sub(length + 50)?)
        .filter(|&i| x[i].hypot(y[i]) > 0.01 && f[i].abs() > 0.2 && f[i + length / 2].abs() > 0.2)
        .collect();
    (!places.is_empty()).then(|| places[rng.random_range(0..places.len())])
}

const FAULTS: [Fault; 13] = [
    Fault {
        name: "gap, s",
        kind: "gap",
        sizes: [0.005, 0.012, 0.1, 1.0],
        sure_from: 2,
        spoil: |r, size, rng| {
            let samples = (size * r.rate_hz()?).round() as usize;
            let at = busy(r, samples, rng)?;
            r.time_s.as_mut()?.drain(at..at + samples);
            r.channels.iter_mut().for_each(|c| drop(c.values.drain(at..at + samples)));
            Some(("t_s", Span { first: at - 1, end: at + 1 }))
        },
    },
    Fault {
        name: "dropped samples",
        kind: "dropped-samples",
        sizes: [1.0, 2.0, 4.0, 8.0],
        sure_from: 0,
        spoil: |r, size, rng| {
            let samples = size as usize;
            let at = busy(r, samples, rng)?;
            r.time_s.as_mut()?.drain(at..at + samples);
            r.channels.iter_mut().for_each(|c| drop(c.values.drain(at..at + samples)));
            Some(("t_s", Span { first: at - 1, end: at + 1 }))
        },
    },
    Fault {
        name: "clock jump, s",
        kind: "clock-jump",
        sizes: [0.005, 0.02, 0.1, 3600.0],
        sure_from: 2,
        spoil: |r, size, rng| {
            let at = busy(r, 0, rng)?;
            r.time_s.as_mut()?[at..].iter_mut().for_each(|t| *t += size);
            Some(("t_s", Span { first: at - 1, end: at + 1 }))
        },
    },
    Fault {
        name: "repeated rows",
        kind: "duplicate-samples",
        sizes: [1.0, 2.0, 3.0, 5.0],
        sure_from: 0,
        spoil: |r, size, rng| {
            let samples = size as usize;
            let at = busy(r, samples, rng)?;
            for channel in &mut r.channels {
                let held = channel.values[at];
                channel.values[at + 1..=at + samples].fill(held);
            }
            Some(("", Span { first: at + 1, end: at + 1 + samples }))
        },
    },
    Fault {
        name: "stuck force, samples",
        kind: "stuck-channel",
        sizes: [10.0, 30.0, 100.0, 300.0],
        sure_from: 1,
        spoil: |r, size, rng| {
            let at = busy(r, size as usize, rng)?;
            let held = values(r, "fx1_N")[at];
            values(r, "fx1_N")[at..at + size as usize].fill(held);
            Some(("fx1_N", Span { first: at, end: at + size as usize }))
        },
    },
    Fault {
        name: "saturation, share of peak",
        kind: "saturation",
        sizes: [0.98, 0.9, 0.7, 0.5],
        sure_from: 2,
        spoil: |r, size, _| {
            let force = values(r, "fx1_N");
            let peak = force.iter().fold(0.0_f64, |a, v| a.max(v.abs())) * size;
            let first = force.iter().position(|v| v.abs() > peak)?;
            for v in force.iter_mut() {
                *v = v.clamp(-peak, peak);
            }
            Some(("fx1_N", Span { first, end: first + 1 }))
        },
    },
    Fault {
        name: "quantum of force, share of range",
        kind: "quantised",
        sizes: [0.01, 0.03, 0.1, 0.3],
        sure_from: 2,
        spoil: |r, size, _| {
            let range = spread(r.channel("fx1_N")?).max(spread(r.channel("fx2_N")?));
            let quantum = range * size;
            for v in values(r, "fx1_N").iter_mut() {
                *v = (*v / quantum).round() * quantum;
            }
            Some(("fx1_N", Span { first: 0, end: r.len() }))
        },
    },
    Fault {
        name: "copied channel, samples",
        kind: "copied-channel",
        sizes: [50.0, 150.0, 500.0, 2000.0],
        sure_from: 2,
        spoil: |r, size, rng| {
            let at = busy(r, size as usize, rng)?;
            let range = at..at + size as usize;
            let source = values(r, "fx1_N")[range.clone()].to_vec();
            values(r, "fx2_N")[range.clone()].copy_from_slice(&source);
            Some(("fx2_N", Span { first: range.start, end: range.end }))
        },
    },
    Fault {
        name: "scaled copy, factor",
        kind: "copied-channel",
        sizes: [-1.0, 0.3, 2.0, 40.0],
        sure_from: 0,
        spoil: |r, size, _| {
            let source: Vec<f64> = values(r, "fx1_N").iter().map(|v| 0.1 + size * v).collect();
            *values(r, "fx2_N") = source;
            Some(("fx2_N", Span { first: 0, end: r.len() }))
        },
    },
    Fault {
        name: "late copy, samples",
        kind: "copied-channel",
        sizes: [1.0, 10.0, 100.0, 190.0],
        sure_from: 0,
        spoil: |r, size, _| {
            let mut source = values(r, "fx1_N").clone();
            source.rotate_right(size as usize);
            *values(r, "fx2_N") = source;
            Some(("fx2_N", Span { first: size as usize, end: r.len() }))
        },
    },
    Fault {
        name: "force spike, N",
        kind: "outlier",
        sizes: [0.1, 0.5, 2.0, 20.0],
        sure_from: 2,
        spoil: |r, size, rng| {
            let at = busy(r, 0, rng)?;
            values(r, "fx1_N")[at] += size;
            Some(("fx1_N", Span { first: at, end: at + 1 }))
        },
    },
    Fault {
        name: "position spike, mm",
        kind: "outlier",
        sizes: [0.1, 0.5, 2.0, 20.0],
        sure_from: 2,
        spoil: |r, size, rng| {
            let at = busy(r, 0, rng)?;
            values(r, "x1_m")[at] += 1e-3 * size;
            Some(("x1_m", Span { first: at, end: at + 1 }))
        },
    },
    Fault {
        name: "unit of velocity, factor",
        kind: "unit",
        sizes: [0.001, 57.29578, 100.0, 1000.0],
        sure_from: 0,
        spoil: |r, size, _| {
            for v in values(r, "vx1_m_s").iter_mut() {
                *v *= size;
            }
            Some(("vx1_m_s", Span { first: 0, end: r.len() }))
        },
    },
];

fn spread(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted[sorted.len() * 19 / 20] - sorted[sorted.len() / 20]
}

fn found(warnings: &[Warning], kind: &str, column: &str, span: Span) -> bool {
    warnings.iter().any(|w| {
        let here = w.spans.iter().any(|s| s.first <= span.end && span.first <= s.end);
        w.kind == kind && here && (column.is_empty() || w.column.as_deref() == Some(column))
    })
}

/// Prints detection rate against size of the fault. Faults of a size that spoils results are found nineteen times in twenty.
#[test]
fn injected_faults_are_found_with_their_spans() {
    let recordings: Vec<(u64, Recording)> =
        (700..740).map(|seed| (seed, clean(seed, 5, &SensorModel::TYPICAL))).collect();
    let mut table = String::new();
    let mut missed = Vec::new();
    for fault in &FAULTS {
        let _ = write!(table, "{:<34}", fault.name);
        for (k, &size) in fault.sizes.iter().enumerate() {
            let tried: Vec<bool> = recordings
                .par_iter()
                .filter_map(|(seed, recording)| {
                    let mut spoilt = recording.clone();
                    let mut rng = StdRng::seed_from_u64(seed * 1000 + k as u64);
                    let (column, span) = (fault.spoil)(&mut spoilt, size, &mut rng)?;
                    Some(found(&quality(&spoilt), fault.kind, column, span))
                })
                .collect();
            let hits = tried.iter().filter(|&&hit| hit).count();
            let _ = write!(table, "  {size:>8}: {hits:>2}/{:<2}", tried.len());
            if k >= fault.sure_from && (20 * hits < 19 * tried.len() || tried.len() < 10) {
                missed.push(format!("{} of {size}: {hits} of {}", fault.name, tried.len()));
            }
        }
        table.push('\n');
    }
    println!("{table}");
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn positions_and_forces_in_the_wrong_unit_are_named() {
    for seed in 800..810 {
        let recording = clean(seed, 5, &SensorModel::TYPICAL);
        for (stems, factor) in
            [(["x", "y"], 1000.0), (["x", "y"], 0.001), (["fx", "fy"], 1000.0), (["fx", "fy"], 0.001)]
        {
            let mut wrong = recording.clone();
            for channel in &mut wrong.channels {
                if stems.iter().any(|s| channel.name.starts_with(s)) {
                    channel.values.iter_mut().for_each(|v| *v *= factor);
                }
            }
            let found = quality(&wrong);
            assert!(kinds(&found).contains(&"unit"), "seed {seed}, {stems:?} times {factor}: {found:?}");
        }
    }
}

/// Inputs that fuzzing starts from and what it has found: a recording or one sentence, never a panic.
#[test]
fn the_corpus_of_odd_inputs_ends_in_recordings_or_sentences() {
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("log.csv");
    let mut seen = 0;
    // By content: the name says CSV for every one of them.
    for kind in ["log", "mat", "mcap", "parquet"] {
        for entry in std::fs::read_dir(corpus.join(kind)).expect("the corpus") {
            std::fs::copy(entry.expect("an entry").path(), &path).expect("writable");
            seen += usize::from(sentence(&path));
        }
    }
    std::fs::write(&path, "trial,t_s,q_rad,force_N\n1,0,1,2\n1,1,2,3\n").expect("writable");
    for entry in std::fs::read_dir(corpus.join("sidecar")).expect("the corpus") {
        std::fs::copy(entry.expect("an entry").path(), folder.path().join("log.meta.json")).expect("writable");
        seen += usize::from(sentence(&path));
    }
    assert!(seen >= 10, "the corpus must hold refusals too: {seen}");
}

/// True when the log is refused.
fn sentence(path: &std::path::Path) -> bool {
    match estimator::log::load(path, None) {
        Ok(recordings) => {
            assert!(recordings.iter().all(|r| !r.channels.is_empty()));
            false
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.len() > 20, "{text}");
            true
        }
    }
}
