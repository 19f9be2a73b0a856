//! Random tables whose contents the generator knows: the same rows, lines, bits and sentences for every division of work.

use super::super::plan;
use super::super::table::Group;
use super::sniff::dialect;
use super::*;
use proptest::prelude::*;
use rand::rngs::StdRng;
use rand::seq::IndexedRandom as _;
use rand::{RngExt, SeedableRng};
use std::sync::atomic::AtomicUsize;

/// Notation of a table.
struct Style {
    delimiter: char,
    line_end: &'static str,
    decimal_comma: bool,
    mark: bool,
    quoted: bool,
}

/// A table and its expected content.
struct Drawn {
    text: String,
    meta: String,
    /// Kept rows: trial, the three numbers, label, row, line.
    rows: Vec<(String, [f64; 3], String, usize, u64)>,
    /// The sentence's beginning, where the table has a fault.
    fault: Option<String>,
}

fn cell(text: &str, style: &Style, rng: &mut StdRng) -> String {
    let must = text.contains([style.delimiter, '\n', '"']) || text.starts_with('#');
    let text = if must || style.quoted && rng.random_bool(0.3) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    };
    if rng.random_bool(0.1) { format!(" {text} ") } else { text }
}

fn drawn(seed: u64, faulty: bool) -> Drawn {
    let mut rng = StdRng::seed_from_u64(seed);
    let delimiter = *[',', ';', '\t'].choose(&mut rng).expect("three");
    let style = Style {
        delimiter,
        line_end: if rng.random_bool(0.3) { "\r\n" } else { "\n" },
        decimal_comma: delimiter != ',' && rng.random_bool(0.5),
        mark: rng.random_bool(0.3),
        quoted: rng.random_bool(0.5),
    };
    let (trials, labels, notes) = (rng.random_bool(0.5), rng.random_bool(0.5), rng.random_bool(0.5));
    let select = notes && rng.random_bool(0.4);
    let mut names = vec!["t_s", "q_m", "f_N"];
    names.extend(trials.then_some("trial"));
    names.extend(labels.then_some("label"));
    names.extend(notes.then_some("note"));
    let mut out = Drawn { text: String::new(), meta: "{}".to_owned(), rows: Vec::new(), fault: None };
    if select {
        out.meta = r#"{"select":{"note":"keep"}}"#.to_owned();
    }
    if style.mark {
        out.text.push('\u{feff}');
    }
    let mut line = 1;
    decorate(&mut out.text, &mut line, &style, &mut rng);
    let header: Vec<String> = names.iter().map(|n| cell(n, &style, &mut rng)).collect();
    out.text += &(header.join(&delimiter.to_string()) + style.line_end);
    line += 1;
    let count = rng.random_range(1..60);
    let fault_at = faulty.then(|| rng.random_range(0..count));
    for row in 0..count {
        decorate(&mut out.text, &mut line, &style, &mut rng);
        let values: [f64; 3] = std::array::from_fn(|_| number_drawn(&mut rng));
        let trial = ["a", "b, c", "d\"e"].choose(&mut rng).expect("some");
        let label = ["free", "two\nlines", "#hash", ""].choose(&mut rng).expect("some");
        let note = if rng.random_bool(0.7) { "keep" } else { "drop" };
        let mut cells: Vec<String> = values
            .iter()
            .map(|v| if style.decimal_comma { format!("{v:?}").replace('.', ",") } else { format!("{v:?}") })
            .collect();
        cells.extend(trials.then(|| (*trial).to_owned()));
        cells.extend(labels.then(|| (*label).to_owned()));
        cells.extend(notes.then(|| note.to_owned()));
        let kept = !select || note == "keep";
        let place = format!("row {} (line {line})", row + 1);
        if fault_at == Some(row) && rng.random_bool(0.5) {
            cells.pop();
            out.fault = Some(format!("{place} has {} cells and the header has {}", cells.len(), names.len()));
        } else if fault_at == Some(row) && kept {
            let (bad, words) =
                [("x", "`x` is not a number"), ("NaN", "`NaN` is not a finite number")][rng.random_range(0..2)];
            bad.clone_into(&mut cells[2]);
            out.fault = Some(format!("{place}, column `f_N`: {words}"));
        }
        let written: Vec<String> = cells.iter().map(|c| cell(c, &style, &mut rng)).collect();
        let record = written.join(&delimiter.to_string());
        out.text += &record;
        if row + 1 < count || rng.random_bool(0.5) {
            out.text += style.line_end;
        }
        if out.fault.is_none() && kept {
            let trial = if trials { (*trial).to_owned() } else { String::new() };
            let label = if labels { (*label).to_owned() } else { String::new() };
            out.rows.push((trial, values, label, row + 1, line));
        }
        line += 1 + record.matches('\n').count() as u64;
    }
    if out.fault.is_none() && out.rows.is_empty() {
        out.fault = Some("no row has note = keep; the file has drop".to_owned());
    }
    out
}

fn number_drawn(rng: &mut StdRng) -> f64 {
    match rng.random_range(0..3) {
        0 => f64::from(rng.random_range(-100_i32..100)),
        1 => rng.random_range(-1.0..1.0),
        _ => rng.random_range(-1.0..1.0) * 10_f64.powi(rng.random_range(-300..300)),
    }
}

/// Comments and empty lines, sometimes.
fn decorate(text: &mut String, line: &mut u64, style: &Style, rng: &mut StdRng) {
    while rng.random_bool(0.1) {
        *text += ["# a comment, with \"one quote;", "", "   "].choose(rng).expect("some");
        *text += style.line_end;
        *line += 1;
    }
}

fn read_as(drawn: &Drawn, split: Split) -> Result<Table, LogError> {
    let bytes = drawn.text.as_bytes();
    let path = Path::new("log.csv");
    let dialect = dialect(bytes, None, path)?;
    let meta = serde_json::from_str(&drawn.meta).expect("a sidecar");
    let plan = plan::plan(&dialect.headers, &[], &meta, path)?;
    let rest = bytes.get(dialect.start as usize..).unwrap_or_default();
    Reading::new(rest, path, &dialect, &plan, bytes.len() as u64, Watch::none(), split).run()
}

fn check(drawn: &Drawn, split: Split) {
    let result = read_as(drawn, split);
    let shown = format!("{split:?}\n{}", drawn.text);
    if let Some(fault) = &drawn.fault {
        let text = result.expect_err("must be refused").to_string();
        assert!(text.starts_with(fault), "{text}\n{fault}\n{shown}");
        return;
    }
    let table = result.unwrap_or_else(|e| panic!("{e}\n{shown}"));
    let mut order: Vec<&str> = Vec::new();
    for (trial, ..) in &drawn.rows {
        if !order.contains(&trial.as_str()) {
            order.push(trial);
        }
    }
    let groups: Vec<&str> = table.groups.iter().map(|(t, _)| t.as_deref().unwrap_or_default()).collect();
    assert_eq!(groups, order, "{shown}");
    for (trial, group) in &table.groups {
        let trial = trial.as_deref().unwrap_or_default();
        let rows: Vec<_> = drawn.rows.iter().filter(|r| r.0 == trial).collect();
        check_group(group, &rows, &shown);
    }
}

fn check_group(group: &Group, rows: &[&(String, [f64; 3], String, usize, u64)], shown: &str) {
    assert_eq!(group.rows(), rows.len(), "{shown}");
    for (i, (_, values, label, row, line)) in rows.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            assert_eq!(group.columns[column][i].to_bits(), value.to_bits(), "{shown}");
        }
        assert_eq!(group.place(i), (*row, *line), "{shown}");
        if let Some(found) = group.labels.get(i) {
            assert_eq!(found, label, "{shown}");
        }
    }
}

proptest! {
    #[test]
    fn every_division_of_the_work_reads_the_same(seed in any::<u64>(), threads in 1..4_usize, block_bytes in 1..300_usize, faulty in any::<bool>()) {
        let drawn = drawn(seed, faulty);
        check(&drawn, Split { threads: 1, block_bytes: 1 << 20 });
        check(&drawn, Split { threads, block_bytes });
    }
}

#[test]
fn progress_rises_to_one_and_a_cancelled_read_leaves_nothing() {
    let rows: Vec<String> = (0..5000).map(|i| format!("{i},{}\n", f64::from(i) * 0.1)).collect();
    let text = format!("t_s,q_m\n{}", rows.concat());
    let path = Path::new("log.csv");
    let dialect = dialect(text.as_bytes(), None, path).expect("a table");
    let plan = plan::plan(&dialect.headers, &[], &haptics::recording::Meta::default(), path).expect("plans");
    let run = |watch: Watch<'_>| {
        let rest = &text.as_bytes()[dialect.start as usize..];
        let split = Split { threads: 2, block_bytes: 1000 };
        Reading::new(rest, path, &dialect, &plan, text.len() as u64, watch, split).run()
    };
    let told = Mutex::new(Vec::new());
    let cancelled = AtomicBool::new(false);
    run(Watch { progress: &|share| lock(&told).push(share), cancelled: &cancelled, preview: None }).expect("reads");
    let told = told.into_inner().expect("whole");
    assert!(told.len() > 20 && told.is_sorted() && told.last().is_some_and(|&s| s > 0.99 && s <= 1.0), "{told:?}");

    let calls = AtomicUsize::new(0);
    let after_three = |_| {
        if calls.fetch_add(1, Ordering::Relaxed) == 2 {
            cancelled.store(true, Ordering::Relaxed);
        }
    };
    let error = run(Watch { progress: &after_three, cancelled: &cancelled, preview: None }).expect_err("cancelled");
    assert!(matches!(error, LogError::Cancelled { .. }) && calls.load(Ordering::Relaxed) < 10, "{error}");
}

#[test]
fn a_header_may_hold_line_ends_in_quotes_and_stand_behind_blank_lines() {
    let path = Path::new("log.csv");
    let found = dialect(b"\n  \n# x\n\"t\n_s\", \"q_m\" \r\n0,1\n", None, path).expect("a table");
    assert_eq!((found.headers, found.start, found.line), (vec!["t\n_s".to_owned(), "q_m".to_owned()], 24, 6));
    assert!(
        dialect(b"t_s,q_m\r0,1\r1,2\r", None, path)
            .expect_err("old line ends")
            .to_string()
            .contains("carriage returns")
    );
}
