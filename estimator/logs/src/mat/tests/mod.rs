//! Files of MATLAB as people save them: vectors, matrices, structures, runs, Simulink's logs, and values of other kinds.

mod hostile;
mod layouts;
mod writer;

use crate::{LogError, load_with_meta};
use haptics::recording::Recording;
use writer::{Form, V, column, level4, one, texts};

/// Recordings of a file with these bytes.
fn loaded(bytes: &[u8], meta: &str) -> Result<Vec<Recording>, LogError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // The content tells the format.
    let path = folder.path().join("log.data");
    std::fs::write(&path, bytes).expect("writes");
    load_with_meta(&path, &serde_json::from_str(meta).expect("a sidecar"))
}

/// The one recording of a file with these variables, in the plainest form.
fn log(variables: &[(&str, V)], meta: &str) -> Recording {
    let mut all = loaded(&Form::ALL[0].file(variables), meta).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(all.len(), 1);
    all.remove(0)
}

fn said(log: &Recording, words: &str) -> bool {
    log.warnings.iter().any(|w| w.text.contains(words))
}

fn names(log: &Recording) -> Vec<&str> {
    log.channels.iter().map(|c| c.name.as_str()).collect()
}

fn clock() -> Vec<f64> {
    (0..6).map(|i| 0.5 * f64::from(i)).collect()
}

const Q: [f64; 6] = [0.1, -0.2, 0.4, 0.3, 0.25, 0.7];
const F: [f64; 6] = [1.0, 2.5, -3.0, 4.0, 1e-9, 6.0];

#[test]
fn vectors_are_columns_in_every_version_and_order_of_bytes() {
    let row = V::Doubles(vec![1, 6], Q.to_vec());
    let variables = [
        ("t_s", column(&clock())),
        ("q_m", row),
        ("f_N", column(&F)),
        ("mass", column(&[2.0])),
        ("who", V::Chars(vec!["Ada"])),
    ];
    let mut files: Vec<Vec<u8>> = Form::ALL.map(|form| form.file(&variables)).to_vec();
    for big in [false, true] {
        let of = |name, values: &[f64]| level4(big, 0, name, values.len() as u32, 1, values);
        let who = level4(big, 1, "who", 1, 3, &[65.0, 100.0, 97.0]);
        files.push([of("t_s", &clock()), of("q_m", &Q), of("f_N", &F), of("mass", &[2.0]), who].concat());
    }
    for file in files {
        let log = loaded(&file, "{}").unwrap_or_else(|e| panic!("{e}")).remove(0);
        assert_eq!(log.time_s.as_deref(), Some(clock().as_slice()));
        assert_eq!((names(&log), log.channel("q_m")), (vec!["q_m", "f_N"], Some(Q.as_slice())));
        assert_eq!(log.channel("f_N"), Some(F.as_slice()));
        assert!(said(&log, "the table of 6 rows is read, variables of other lengths are not: `mass`, `who` (1 value)"));
    }
}

#[test]
fn every_class_of_number_is_read() {
    let large = (1_i64 << 53) + 1;
    for form in Form::ALL {
        let file = form.file(&[
            ("t_s", V::Bytes(vec![3, 1], vec![0, 1, 2])),
            ("a", V::Singles(vec![3, 1], vec![0.5, -1.25, 3.0])),
            ("b", V::Shorts(vec![3, 1], vec![-2, 300, -32768])),
            ("c", V::Longs(vec![3, 1], vec![large, -5, 7])),
            ("d", V::Logical(vec![3, 1], vec![0, 1, 1])),
            ("e", V::Shorts(vec![1, 2], vec![-2, 7])),
        ]);
        let log = loaded(&file, "{}").unwrap_or_else(|e| panic!("{e}")).remove(0);
        assert_eq!(log.time_s.as_deref(), Some([0.0, 1.0, 2.0].as_slice()));
        assert_eq!(log.channel("a"), Some([0.5, -1.25, 3.0].as_slice()));
        assert_eq!(log.channel("b"), Some([-2.0, 300.0, -32768.0].as_slice()));
        // As in Parquet: a number beyond 2^53 is rounded.
        assert_eq!(log.channel("c"), Some([9_007_199_254_740_992.0, -5.0, 7.0].as_slice()));
        assert_eq!(log.channel("d"), Some([0.0, 1.0, 1.0].as_slice()));
        assert!(said(&log, "`e` (2 values)"));
    }
}

#[test]
fn own_names_follow_the_rules_of_every_format() {
    let log = log(&[("Time_s", column(&clock())), ("q_mm", column(&Q)), ("fx_wrist_N", column(&F))], "{}");
    assert_eq!((log.time_s.as_deref(), names(&log)), (Some(clock().as_slice()), vec!["q_m", "fx_wrist_N"]));
    assert!(log.channel("q_m").is_some_and(|q| (q[0] - 1e-4).abs() < 1e-12));
    let foreign = [("t", column(&clock())), ("Kraft", column(&F)), ("x", column(&Q))];
    let meta = r#"{"columns": {"t_s": "t", "f_N": "Kraft", "q_m": "x"}, "sign": {"f_N": -1}}"#;
    let mapped = super::tests::log(&foreign, meta);
    assert_eq!(mapped.channel("f_N").map(|f| f[1]), Some(-2.5));
    let text = loaded(&Form::ALL[0].file(&foreign), "{}").expect_err("no unit").to_string();
    assert!(text.contains("the column `t` states no unit"), "{text}");
}

#[test]
fn text_is_a_column_or_a_label() {
    let label = texts(&["free", "free", "free", "hold", "hold", ""]);
    let phase = V::Chars(vec!["a", "bc", "d", "e", "f", "g"]);
    let read = log(&[("t_s", column(&clock())), ("q_m", column(&Q)), ("label", label), ("phase", phase)], "{}");
    let labels = read.labels.as_ref().expect("labels");
    assert_eq!([&labels[0], &labels[3], &labels[5]], ["free", "hold", ""]);
    assert!(said(&read, "the column `phase` holds text"));
    let selected = r#"{"select": {"phase": "bc"}}"#;
    let variables = [("q_m", column(&Q)), ("phase", V::Chars(vec!["a", "bc", "bc", "e", "ä", "g"]))];
    assert_eq!(log(&variables, selected).channel("q_m"), Some([-0.2, 0.4].as_slice()));
}

#[test]
fn dates_and_times_of_the_day_in_text_are_the_clock() {
    let q = column(&Q[..3]);
    let stamps = V::Chars(vec!["17-Apr-2026", "2", "3"]);
    assert!(log(&[("time", stamps), ("q_m", q.clone())], "{}").time_s.is_none(), "no stamps that are known");
    let stamps = V::Chars(vec!["2026-04-17 23:59:59.5", "2026-04-18 00:00:00", "2026-04-18 00:00:02"]);
    assert_eq!(log(&[("time", stamps), ("q_m", q.clone())], "{}").time_s, Some(vec![0.0, 0.5, 2.5]));
    let (days, times) = (texts(&["11/04/2026", "12/04/2026", "13/04/2026"]), texts(&["12:00", "12:00", "12:01"]));
    let read = log(&[("day", days), ("begun", times), ("q_m", q.clone())], "{}");
    assert_eq!(read.time_s, Some(vec![0.0, 86_400.0, 172_860.0]));
    let faulty = [("time", texts(&["12:00", "x", "12:01"])), ("q_m", q)];
    let text = loaded(&Form::ALL[0].file(&faulty), "{}").expect_err("no time").to_string();
    assert!(text.contains("row 2, column `time`: `x` is not a time like the others"), "{text}");
}

#[test]
fn values_of_other_kinds_are_named_and_left_out() {
    let log = log(
        &[
            ("t_s", column(&clock())),
            ("q_m", column(&Q)),
            ("z", V::Complex(F.to_vec())),
            ("s", V::Sparse),
            ("T", V::Object("timetable")),
            ("deep", one(vec![("name", V::Object("string"))])),
            ("wide", V::Doubles(vec![65, 80], vec![0.0; 65 * 80])),
            ("cube", V::Doubles(vec![2, 2, 2], vec![0.0; 8])),
            ("mixed", V::Cells(vec![2, 1], vec![V::Chars(vec!["a"]), column(&Q)])),
            ("grid", V::Cells(vec![2, 2], vec![column(&Q), column(&Q), column(&Q), column(&Q)])),
        ],
        "{}",
    );
    assert_eq!(names(&log), ["q_m"]);
    for words in [
        "the variable `z` is not read: complex numbers",
        "`s` is not read: a sparse matrix",
        "`T` is not read: a timetable, an object that only MATLAB can open; convert it there: T = timetable2table(T);",
        "`deep.name` is not read: a string",
        "`wide` is not read: more than 64 columns",
        "`cube` is not read: more than two dimensions",
        "`mixed` is not read: a cell array of text and numbers",
        "`grid` is not read: a cell array of rows and columns",
    ] {
        assert!(said(&log, words), "{words}: {:?}", log.warnings);
    }
}

#[test]
fn a_file_without_a_table_ends_in_one_sentence() {
    let refused = |variables: &[(&str, V)]| loaded(&Form::ALL[1].file(variables), "{}").expect_err("none").to_string();
    let text = refused(&[("T", V::Object("table")), ("n", column(&[3.0]))]);
    assert!(text.contains("S = table2struct(T, 'ToScalar', true); save('log.mat', '-struct', 'S', '-v7')"), "{text}");
    assert!(refused(&[("a", column(&[1.0]))]).contains("no variable is a vector of samples"));
    assert!(refused(&[]).contains("save vectors of equal length"));
    assert!(refused(&[("s", V::Chars(vec!["a", "b"]))]).contains("no variable is a vector of samples"));
    let unnamed = [&b"MATLAB 7.0 MAT-file"[..], &[b' '; 105], &[0, 2, b'I', b'M']].concat();
    for start in [&b"MATLAB 7.3 MAT-file, Platform: GLNXA64"[..], b"\x89HDF\r\n\x1a\n", &unnamed] {
        let text = loaded(&[start, &[0; 600]].concat(), "{}").expect_err("version 7.3").to_string();
        assert!(text.contains("save('file.mat', ..., '-v7')") && !text.contains('\n'), "{text}");
    }
}
