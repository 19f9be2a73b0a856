//! Properties that must hold in every format: the same bits back, the same rules of the sidecar, the format told by the
//! content.

use super::*;
use haptics::recording::Channel;
use proptest::prelude::*;
use std::path::PathBuf;

const FORMATS: &[&str] = if cfg!(feature = "parquet") { &["csv", "mcap", "parquet"] } else { &["csv", "mcap"] };

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Expected content after a round trip, warnings and name aside.
fn comparable(recordings: &[Recording]) -> Vec<Recording> {
    let mut all = recordings.to_vec();
    for recording in &mut all {
        recording.name.clear();
        recording.warnings.clear();
        recording.meta = sidecar::portable_meta(&recording.meta);
    }
    all
}

/// Equality of every bit: −0 is not 0.
fn bits(recordings: &[Recording]) -> Vec<Vec<u64>> {
    let of = |r: &Recording| {
        let columns = r.time_s.iter().chain(r.channels.iter().map(|c| &c.values));
        columns.flatten().map(|v| v.to_bits()).collect()
    };
    recordings.iter().map(of).collect()
}

fn sample(meta: &str) -> Recording {
    let channel = |name: &str, unit: &str, k: f64| Channel {
        name: name.into(),
        unit: unit.into(),
        values: (0..50).map(|i| (f64::from(i) * k).sin()).collect(),
    };
    Recording {
        name: "a".to_owned(),
        time_s: Some((0..50).map(|i| f64::from(i) * 0.01).collect()),
        channels: vec![channel("q_m", "m", 0.1), channel("f_N", "N", 0.3), channel("oil_degC", "degC", 0.2)],
        meta: serde_json::from_str(meta).expect("a sidecar"),
        ..Recording::default()
    }
}

fn finite() -> impl Strategy<Value = f64> {
    any::<f64>().prop_filter_map("finite", |v| v.is_finite().then_some(v))
}

fn trial(rows: usize, clock: bool, labelled: bool) -> impl Strategy<Value = Recording> {
    let names = ["q_m", "f_N", "oil_degC", "load percent", "/left.wrench.force.x", "ünits", "a-b"];
    let units = ["m", "N", "degC", "", "", "", ""];
    let channel = move |i: usize| {
        proptest::collection::vec(finite(), rows).prop_map(move |values| Channel {
            name: names[i].to_owned(),
            unit: units[i].to_owned(),
            values,
        })
    };
    let channels = (0..names.len()).map(channel).collect::<Vec<_>>();
    let steps = proptest::collection::vec(1e-9..10.0_f64, rows);
    let labels = proptest::collection::vec("[a-z0-9ä,;\"'#-]{0,9}", rows);
    (channels, steps, -1e6..1e6_f64, labels).prop_map(move |(channels, steps, start, labels)| {
        let mut t = start;
        let mut next = |step: &f64| {
            t = (t + step).max(t.next_up());
            t
        };
        Recording {
            time_s: clock.then(|| steps.iter().map(&mut next).collect()),
            channels,
            labels: labelled.then(|| labels.iter().collect()),
            ..Recording::default()
        }
    })
}

fn recordings() -> impl Strategy<Value = Vec<Recording>> {
    (1_usize..40, any::<bool>(), any::<bool>(), any::<bool>()).prop_flat_map(|(rows, clock, labelled, trials)| {
        let one = trial(rows, clock, labelled);
        let names = proptest::collection::btree_set("[a-z0-9,\"ö]{1,6}", 1..4);
        (proptest::collection::vec(one, if trials { 1..4 } else { 1..2 }), names).prop_map(move |(mut all, names)| {
            if trials {
                all.truncate(names.len());
                for (recording, name) in all.iter_mut().zip(names) {
                    recording.trial = Some(name);
                }
            }
            for recording in &mut all {
                recording.meta.known.insert("mass_kg".to_owned(), 0.1 + 0.2);
                recording.meta.other.insert("who".to_owned(), "K \"x\"".into());
            }
            all
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_recording_comes_back_to_the_bit(recordings in recordings()) {
        let folder = folder();
        for format in FORMATS {
            let path = folder.path().join(format!("{format}.{format}"));
            write(&recordings, &path, &[]).expect("writes");
            let back = load(&path, None).unwrap_or_else(|e| panic!("{format}: {e}"));
            prop_assert_eq!(comparable(&back), comparable(&recordings), "{}", format);
            prop_assert_eq!(bits(&back), bits(&recordings), "{}", format);
        }
    }

    /// The answer is a recording or a sentence, whatever follows the first bytes of a format.
    #[test]
    fn nothing_panics(start in 0..3_usize, bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        let folder = folder();
        let path = folder.path().join("log");
        let magic: &[u8] = [&b"\x89MCAP0\r\n"[..], b"PAR1", b""][start];
        std::fs::write(&path, [magic, &bytes, if start == 1 { b"PAR1" } else { b"" }].concat()).expect("writes");
        let _ = load(&path, None);
    }
}

#[test]
fn the_content_tells_the_format_whatever_the_name() {
    let folder = folder();
    let recording = sample("{}");
    for format in FORMATS {
        for ending in FORMATS {
            let (path, lie) =
                (folder.path().join(format!("x.{format}")), folder.path().join(format!("{format}-as.{ending}")));
            write(std::slice::from_ref(&recording), &path, &[]).expect("writes");
            std::fs::rename(&path, &lie).expect("renames");
            assert_eq!(bits(&load(&lie, None).expect("loads")), bits(std::slice::from_ref(&recording)));
            assert_eq!(headers(&lie).expect("headers"), ["t_s", "q_m", "f_N", "oil_degC"]);
        }
    }
}

#[test]
fn the_rules_of_the_sidecar_hold_in_every_format() {
    let folder = folder();
    let mut one = sample("{}");
    one.trial = Some("1".to_owned());
    let mut two = one.clone();
    two.trial = Some("2".to_owned());
    two.channels[0].values.reverse();
    let meta: Meta = serde_json::from_str(
        r#"{"columns": {"x_m": "q_m", "y_m": "oil_degC"}, "scale": {"f_N": 2, "y_m": 3}, "sign": {"f_N": -1}, "select": {"trial": 2}}"#,
    )
    .expect("a sidecar");
    for format in FORMATS {
        let path: PathBuf = folder.path().join(format!("x.{format}"));
        write(&[one.clone(), two.clone()], &path, &[]).expect("writes");
        let logs = load_with_meta(&path, &meta).expect("loads");
        assert_eq!((logs.len(), logs[0].trial.as_deref()), (1, Some("2")), "{format}");
        assert_eq!(logs[0].channel("x_m"), Some(two.channels[0].values.as_slice()), "{format}");
        let force: Vec<f64> = one.channels[1].values.iter().map(|v| v * -2.0).collect();
        assert_eq!(logs[0].channel("f_N"), Some(force.as_slice()), "{format}");
        assert!(logs[0].channel("y_m").is_some());
        // The force of trial 2 is that of trial 1: found although only one is selected.
        assert!(logs[0].warnings.iter().any(|w| w.kind == "copied-channel"), "{format}: {:?}", logs[0].warnings);
        let wrong = |json: &str| {
            let meta: Meta = serde_json::from_str(json).expect("a sidecar");
            load_with_meta(&path, &meta).expect_err("refused").to_string()
        };
        assert!(wrong(r#"{"columns": {"q_m": "pos"}}"#).contains("the column `pos` is missing"), "{format}");
        assert!(wrong(r#"{"select": {"trial": "9"}}"#).contains("no row has trial = 9; the file has 1, 2"), "{format}");
        assert!(wrong(r#"{"columns": {"f_N": "q_m"}}"#).contains("measures something else"), "{format}");
    }
}

#[test]
fn a_carried_sidecar_holds_and_a_stray_one_is_named() {
    let folder = folder();
    let recording = sample(r#"{"task": "mechanism", "known": {"mass_kg": 2}, "sign": {"f_N": -1}}"#);
    for format in FORMATS.iter().filter(|f| **f != "csv") {
        let path = folder.path().join(format!("x.{format}"));
        write(std::slice::from_ref(&recording), &path, &[]).expect("writes");
        let back = load(&path, None).expect("loads").remove(0);
        assert_eq!(back.meta, sidecar::portable_meta(&recording.meta));
        assert!(back.warnings.iter().all(|w| w.kind != "sidecar"));
        // Beside it lies the sidecar of a CSV with the same stem: its sign is applied already.
        let beside = folder.path().join("x.meta.json");
        std::fs::write(&beside, r#"{"sign": {"f_N": -1}}"#).expect("writes");
        let back = load(&path, None).expect("loads").remove(0);
        assert_eq!(back.channel("f_N"), recording.channel("f_N"));
        assert!(back.warnings.iter().any(|w| w.text.contains("carries its own sidecar")), "{:?}", back.warnings);
        let named = load(&path, Some(&beside)).expect("loads").remove(0);
        assert_eq!(named.channel("f_N").map(|f| -f[1]), recording.channel("f_N").map(|f| f[1]));
        std::fs::remove_file(beside).expect("removes");
    }
}

#[test]
fn messages_in_json_come_back_to_the_same_bits() {
    let folder = folder();
    let path = folder.path().join("x.mcap");
    let mut recording = sample(r#"{"task": "mechanism"}"#);
    recording.channels[0].values[..5].copy_from_slice(&[-0.0, 5e-324, f64::MAX, 0.1 + 0.2, -1e-300]);
    let two = ["a, \"b\"", "2"].map(|trial| Recording { trial: Some(trial.to_owned()), ..recording.clone() });
    write_encoded(&two, &path, &[], Encoding::Json).expect("writes");
    let back = load(&path, None).expect("loads");
    assert_eq!((bits(&back), comparable(&back)), (bits(&two), comparable(&two)));
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let folder = folder();
    let mut recording = sample("{}");
    let said = |r: &[Recording], name: &str| write(r, &folder.path().join(name), &[]).expect_err(name).to_string();
    assert!(said(std::slice::from_ref(&recording), "x.xlsx").contains("ending names no format"));
    assert!(said(&[recording.clone(), recording.clone()], "x.csv").contains("trials"));
    recording.channels[1].values[3] = f64::NAN;
    assert!(said(std::slice::from_ref(&recording), "x.mcap").contains("row 4 of `f_N` is NaN"));
}

#[cfg(feature = "parquet")]
#[test]
fn a_broken_parquet_file_is_one_sentence() {
    let folder = folder();
    let path = folder.path().join("x.parquet");
    write(&[sample("{}")], &path, &[]).expect("writes");
    let whole = std::fs::read(&path).expect("reads");
    for length in (4..whole.len()).step_by(23) {
        std::fs::write(&path, &whole[..length]).expect("writes");
        let text = load(&path, None).expect_err("cut").to_string();
        assert!(text.contains("Parquet file is damaged") && !text.contains('\n'), "{text}");
    }
    for at in 0..whole.len() {
        let mut broken = whole.clone();
        broken[at] ^= 1 << (at % 8);
        std::fs::write(&path, &broken).expect("writes");
        match load(&path, None) {
            // Unread parts (statistics, places of pages) may be off; the parts that are read are as written.
            Ok(read) => {
                assert_eq!(bits(&read), bits(std::slice::from_ref(&sample("{}"))), "{at}");
                assert_eq!(comparable(&read), comparable(std::slice::from_ref(&sample("{}"))), "{at}");
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{at}: {error}"),
        }
    }
}

/// A file of another program, whose pages have checksums.
#[cfg(feature = "parquet")]
#[test]
fn a_flipped_bit_in_a_page_with_a_checksum_is_told() {
    let mut whole = include_bytes!("../../../tests/corpus/parquet/page-checksums.parquet").to_vec();
    let folder = folder();
    let path = folder.path().join("x.parquet");
    std::fs::write(&path, &whole).expect("writes");
    let read = load(&path, None).expect("it is whole");
    // Neither least nor largest: those stand among the statistics, too.
    let second = read[0].channel("q_m").expect("a channel")[1];
    let place = whole.windows(8).position(|bytes| bytes == second.to_le_bytes()).expect("it is not packed");
    whole[place] ^= 1;
    std::fs::write(&path, &whole).expect("writes");
    let said = load(&path, None).expect_err("another number").to_string();
    assert!(said.contains("the column `q_m`") && said.contains("damaged"), "{said}");
}

#[test]
fn a_stream_that_is_cut_opens_up_to_its_last_block() {
    let folder = folder();
    let path = folder.path().join("live.mcap");
    let meta: Meta = serde_json::from_str(r#"{"task": "crank"}"#).expect("a sidecar");
    let mut stream =
        McapStream::create(&path, &["x1_m", "y1_m", "x2_m", "y2_m"].map(str::to_owned), &meta, &[]).expect("creates");
    let mut ends = Vec::new();
    for i in 0..1000 {
        let t = f64::from(i) * 1e-3;
        stream.push(t, &[t, 2.0 * t, 3.0, 4.0]).expect("pushes");
        if i % 100 == 99 {
            stream.flush().expect("flushes");
            ends.push(std::fs::metadata(&path).expect("there").len());
        }
    }
    assert!(stream.push(0.5, &[0.0; 4]).is_err() && stream.push(2.0, &[0.0]).is_err());
    assert!(stream.push(2.0, &[f64::NAN, 0.0, 0.0, 0.0]).is_err());
    stream.finish().expect("finishes");
    let whole = std::fs::read(&path).expect("reads");
    let log = load(&path, None).expect("loads").remove(0);
    assert_eq!(log.len(), 1000);
    assert!(log.warnings.iter().all(|w| w.kind != "cut-off"));
    for (block, end) in ends.iter().enumerate() {
        for cut in [0, 1, 9, 40] {
            let length = (*end as usize + cut).min(whole.len() - 9);
            std::fs::write(&path, &whole[..length]).expect("writes");
            let log = load(&path, None).unwrap_or_else(|e| panic!("{length}: {e}")).remove(0);
            assert_eq!(log.len(), 100 * (block + 1), "cut {cut} bytes after block {block}");
            assert_eq!(log.meta.task, meta.task);
            assert!(log.warnings.iter().any(|w| w.kind == "cut-off"), "{:?}", log.warnings);
        }
    }
    // A flipped bit in a whole block is no cut: it is damage.
    let mut broken = whole[..ends[5] as usize].to_vec();
    broken[(ends[2] + 60) as usize] ^= 4;
    std::fs::write(&path, broken).expect("writes");
    assert!(load(&path, None).expect_err("damaged").to_string().contains("damaged"));
}

#[test]
fn a_stream_with_labels_and_facts_that_come_last_reads_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("live.mcap");
    let early: Meta = serde_json::from_str(r#"{"task": "crank", "servo": {"ticks": 0}}"#).expect("a sidecar");
    let late: Meta = serde_json::from_str(r#"{"task": "crank", "servo": {"ticks": 3}}"#).expect("a sidecar");
    let mut stream = McapStream::create_labelled(&path, &["q_m".to_owned()], &early, &[]).expect("creates");
    assert!(stream.push(0.0, &[1.0]).is_err(), "a label is missing");
    for (row, label) in ["free-motion", "turning", ""].into_iter().enumerate() {
        stream.push_labelled(row as f64, &[-0.5], label).expect("pushes");
    }
    stream.flush().expect("flushes");
    assert_eq!(stream.bytes(), std::fs::metadata(&path).expect("there").len());
    let cut = load(&path, None).expect("loads").remove(0);
    assert_eq!(cut.meta, early);
    stream.finish_with(&late).expect("finishes");
    let whole = load(&path, None).expect("loads").remove(0);
    assert_eq!(whole.meta, late);
    assert!(whole.warnings.iter().all(|w| w.kind != "cut-off"));
    for log in [cut, whole] {
        assert_eq!(log.labels, Some(["free-motion", "turning", ""].iter().collect()));
        assert_eq!(log.channel("q_m"), Some([-0.5; 3].as_slice()));
    }
    let taken = ["label".to_owned()];
    assert!(McapStream::create_labelled(&path, &taken, &early, &[]).is_err(), "one column too many of that name");
}

/// Every reader shows its rows before it is done, and all of them in the end.
#[test]
fn a_preview_grows_while_a_log_is_read() {
    const ROWS: usize = 120_000;
    let wave: Vec<f64> = (0..ROWS).map(|i| (i as f64 * 1e-4).sin()).collect();
    let recording = Recording {
        time_s: Some((0..ROWS).map(|i| i as f64 * 1e-3).collect()),
        channels: vec![Channel { name: "q_m".to_owned(), unit: "m".to_owned(), values: wave }],
        ..Recording::default()
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    for &name in FORMATS {
        let path = folder.path().join("log").with_extension(name);
        write(std::slice::from_ref(&recording), &path, &[]).expect("writes");
        let (preview, seen) = (preview::Preview::default(), std::sync::Mutex::new(Vec::new()));
        let cancelled = std::sync::atomic::AtomicBool::new(false);
        let look =
            |_: f64| seen.lock().expect("one at a time").push(preview.curves(200).first().map_or(0, |c| c.samples));
        load_watched(&path, None, &Watch { progress: &look, cancelled: &cancelled, preview: Some(&preview) })
            .expect("loads");
        let curves = preview.curves(200);
        let curve = curves.iter().find(|c| c.name.ends_with("q_m")).expect("the channel");
        assert!(curve.samples > ROWS - 10_000 && !curve.by_row, "{name}: {}", curve.samples);
        let (at, band) = curve.points[curve.points.len() / 2];
        assert!((band.low..=band.high).contains(&(at * 0.1).sin()), "{name}: {at} {band:?}");
        let seen = seen.into_inner().expect("done");
        let partial = seen.iter().any(|&n| n > 0 && n < curve.samples);
        assert!(partial || name == "parquet", "{name}: {seen:?}");
    }
}

#[test]
fn nobody_is_told_to_sort_or_correct_a_container() {
    let folder = folder();
    let mut recording = sample("{}");
    recording.channels[2].name = "clock_s".to_owned();
    recording.channels[2].values[7] = recording.channels[2].values[6];
    recording.labels = Some((0..50).map(|_| "wide").collect());
    for format in FORMATS {
        let path = folder.path().join(format!("x.{format}"));
        write(std::slice::from_ref(&recording), &path, &[]).expect("writes");
        // A column of words has no cell to correct.
        for (json, is_one_row) in
            [(r#"{"columns": {"t_s": "clock_s"}}"#, true), (r#"{"columns": {"f_N": "label"}}"#, false)]
        {
            let meta: Meta = serde_json::from_str(json).expect("a sidecar");
            let text = load_with_meta(&path, &meta).expect_err("refused").to_string();
            let edits = text.contains("remove the repeated row") || text.contains("correct that cell");
            assert!(edits == (*format == "csv" && is_one_row) && text.contains("row "), "{format}: {text}");
        }
    }
}
