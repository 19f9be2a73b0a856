//! Tables with more around their rows than a header: each is read to the numbers that were written.

use super::*;
use std::fmt::Write as _;

const MAPPED: &str = r#"{"columns": {"t_s": "Zeit [s]", "q_m": "Weg [um]", "f_N": "Kraft [mN]"}}"#;

/// Time (s), place (µm) and force (mN) of a row.
fn sample(row: usize) -> [f64; 3] {
    let at = 0.01 * row as f64;
    [at, (1e5 * (3.0 * at).sin()).round(), (5e3 * (5.0 * at).cos()).round()]
}

/// Rows of a table, written one after the other.
fn rows(count: usize, write: impl Fn([f64; 3]) -> String) -> String {
    (0..count).fold(String::new(), |text, row| text + &write(sample(row)) + "\n")
}

fn read(text: impl AsRef<[u8]>, sidecar: &str) -> Result<Recording, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).expect("writable");
    std::fs::write(sidecar_path(&path), sidecar).expect("writable");
    load(&path, None).map(|mut all| all.remove(0)).map_err(|error| error.to_string())
}

/// Reads a table, and checks every number of its rows.
fn holds(name: &str, text: impl AsRef<[u8]>, sidecar: &str, count: usize) -> Recording {
    let one = read(text, sidecar).unwrap_or_else(|error| panic!("{name}: {error}"));
    let time = one.time_s.clone().expect("a clock");
    assert_eq!(time.len(), count, "{name}");
    let [place, force] = ["q_m", "f_N"].map(|channel| one.channel(channel).expect(channel));
    for row in 0..count {
        let [t, q, f] = sample(row);
        let found = [time[row] - time[0] - t, place[row] - 1e-6 * q, force[row] - 1e-3 * f];
        assert!(found.iter().all(|error| error.abs() < 1e-9), "{name}, row {row}: {found:?}");
    }
    one
}

fn says(one: &Recording, words: &str) -> bool {
    one.warnings.iter().any(|warning| warning.text.contains(words))
}

/// A number with a point between its thousands.
fn grouped(value: f64) -> String {
    let (sign, whole) = (if value < 0.0 { "-" } else { "" }, value.abs());
    let (high, low) = ((whole / 1e3).floor(), whole % 1e3);
    if high > 0.0 { format!("{sign}{high}.{low:03}") } else { format!("{sign}{low}") }
}

/// A date, a version or a mean has points that are no marks of the table's numbers.
#[test]
fn the_rows_alone_show_the_decimal_mark() {
    let table = "Zeit [s];Weg [um];Kraft [mN]\n".to_owned()
        + &rows(120, |[t, q, f]| format!("{};{};{f}", format!("{t:.3}").replace('.', ","), grouped(q)));
    for above in ["", "Datum;14.03.2026\n\n", "Version;1.2\n", "Version;1.2;7\n"] {
        for below in ["", "\nMittel;2.5;3.7\n"] {
            let one = holds(above, above.to_owned() + &table + below, MAPPED, 120);
            assert!(says(&one, "points between digits stand between thousands"), "{above}: {:?}", one.warnings);
            assert!(!says(&one, "both are taken as decimal marks"), "{above}");
        }
    }
}

#[test]
fn rows_of_a_summary_are_no_samples() {
    let table = "t_s,q_um,f_mN\n".to_owned() + &rows(60, |[t, q, f]| format!("{t:.2},{q},{f}"));
    for (below, count) in [("Mean,0.001,0.02\nMax,0.12,5.4\nStd,1,2\n", 3), ("\n\nMin,1,2\n", 1)] {
        let one = holds(below, table.clone() + below, "{}", 60);
        assert!(says(&one, &format!("{count} line(s) of text behind the last row are not read")), "{:?}", one.warnings);
    }
    // A fault in the last row is none of a summary.
    for fault in ["x,1,2\n", "0.6o,1,2\n"] {
        assert!(read(table.clone() + fault, "{}").expect_err(fault).contains("is not a number"), "{fault}");
    }
}

/// A comma in a name divides no cells of a table whose rows have another delimiter.
#[test]
fn names_and_rows_share_their_delimiter() {
    let sidecar = r#"{"columns": {"t_s": "Zeit, s", "q_m": "Weg, um", "f_N": "Kraft, mN"}}"#;
    for delimiter in [";", "\t"] {
        let row = |[t, q, f]: [f64; 3]| format!("{t:.2}{delimiter}{q:.1}{delimiter}{f:.1}").replace('.', ",");
        let header = ["Zeit, s", "Weg, um", "Kraft, mN"].join(delimiter);
        holds(delimiter, format!("{header}\n{}", rows(60, row)), sidecar, 60);
    }
}

#[test]
fn units_of_speed_may_follow_a_blank() {
    for header in ["Speed mm/s", "Speed_mm/s", "Speed, mm/s"] {
        let text = format!("t_s\tq_m\t{header}\n") + &rows(30, |[t, q, f]| format!("{t:.2}\t{q}\t{f}"));
        let one = read(text, &format!(r#"{{"columns": {{"dq_m_s": "{header}"}}}}"#)).expect(header);
        let speed = one.channel("dq_m_s").expect("a speed");
        assert!((0..30).all(|row| (speed[row] - 1e-3 * sample(row)[2]).abs() < 1e-12), "{header}: {speed:?}");
    }
}

/// A unit that is not known, and one that contradicts the name, lead to the line of the sidecar that states its factor.
#[test]
fn a_row_of_units_stays_one_with_a_unit_that_is_not_known() {
    let table = |unit: &str| format!("t_s,q_m,f_mN\ns,{unit},mN\n") + &rows(30, |[t, q, f]| format!("{t:.2},{q},{f}"));
    let error = read(table("ell"), "{}").expect_err("refused");
    assert!(error.contains("`q_m` has the unknown unit `ell`") && error.contains(r#""scale": {"q_m": "#), "{error}");
    let error = read(table("um"), "{}").expect_err("refused");
    assert!(error.contains(r#""scale": {"q_m": 0.000001} for `um`, or 1 for m"#), "{error}");
    for unit in ["ell", "um"] {
        holds(unit, table(unit), r#"{"scale": {"q_m": 1e-6}}"#, 30);
    }
}

#[test]
fn dates_without_marks_are_times() {
    for (name, stamp) in [
        ("basic", (|s| format!("20260304T23595{s:.6}Z")) as fn(f64) -> String),
        ("colons", |s| format!("23:59:5{s:.6}").replace('.', ":")),
    ] {
        let text = "time,q_um,f_mN\n".to_owned() + &rows(90, |[t, q, f]| format!("{},{q},{f}", stamp(5.0 + t)));
        holds(name, text, r#"{"columns": {"t_s": "time"}}"#, 90);
    }
    // Nobody corrects every row.
    let text = "time,q_um,f_mN\n".to_owned() + &rows(90, |[t, q, f]| format!("4 III {t:.2},{q},{f}"));
    let error = read(text, r#"{"columns": {"t_s": "time"}}"#).expect_err("refused");
    assert!(error.contains("write times as seconds or as 2026-") && !error.contains("correct that cell"), "{error}");
}

/// A window of time beside the log is told with the log's span; the sidecar may be absent.
#[test]
fn a_window_without_samples_is_told_with_the_span() {
    let text = "t_s,q_um,f_mN\n".to_owned() + &rows(31, |[t, q, f]| format!("{t:.2},{q},{f}"));
    let error = read(text, r#"{"from_s": 200}"#).expect_err("refused");
    assert!(error.contains("--from-s") && error.contains("from 0 to 0.3 s") && !error.contains("malformed"), "{error}");
}

#[test]
fn rows_without_a_value_are_left_out() {
    let write = |[t, q, f]: [f64; 3]| {
        let force = if (17.0..20.0).contains(&(100.0 * t).round()) { String::new() } else { f.to_string() };
        format!("{t:.2},{q},{force}")
    };
    let one = read("t_s,q_um,f_mN\n".to_owned() + &rows(60, write), "{}").expect("reads");
    assert!(says(&one, "3 row(s) without a value of `f_mN`, from row 18 on, are left out"), "{:?}", one.warnings);
    let (time, force) = (one.time_s.as_ref().expect("a clock"), one.channel("f_N").expect("a force"));
    let kept: Vec<usize> = (0..60).filter(|row| !(17..20).contains(row)).collect();
    assert!(time.len() == 57 && kept.iter().zip(time).all(|(row, t)| (t - sample(*row)[0]).abs() < 1e-12));
    assert!(kept.iter().zip(force).all(|(row, f)| (f - 1e-3 * sample(*row)[2]).abs() < 1e-12));
    // Rows are the clock of a log without one.
    let text = "q_um,f_mN\n".to_owned() + &rows(60, |[t, q, f]| write([t, q, f])[5..].to_owned());
    assert!(read(text, r#"{"rate_hz": 100}"#).expect_err("refused").contains("the cell is empty"));
}

/// The columns that the sidecar maps show the table: below another one, and without names.
#[test]
fn the_sidecar_tells_the_table() {
    let body = rows(60, |[t, q, f]| format!("{t:.2},{:.6},{:.3}", 1e-6 * q, 1e-3 * f));
    let named = r#"{"columns": {"t_s": "time", "q_m": "pos", "f_N": "force"}}"#;
    let above = "Max,Min,Mean\n5.4,-5.4,0.01\n5.3,-5.2,0.02\n6,7,8\n\ntime,pos,force\n";
    holds("statistics", above.to_owned() + &body, named, 60);
    let by_place = r#"{"columns": {"t_s": "column 1", "q_m": "column 2", "f_N": "column 3"}}"#;
    holds("no header", &body, by_place, 60);
    let error = read(&body, "{}").expect_err("no names");
    assert!(error.contains(r#""columns": {"t_s": "column 1""#), "{error}");
}

#[test]
fn text_of_two_bytes_a_sign_needs_no_mark() {
    let mut text = "t_s,q_µm,f_mN\n".to_owned();
    let _ = write!(text, "{}", rows(60, |[t, q, f]| format!("{t:.2},{q},{f}")));
    for to_bytes in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
        holds("UTF-16", text.encode_utf16().flat_map(to_bytes).collect::<Vec<u8>>(), "{}", 60);
    }
}

/// A column that the log can do without refuses no file, unless the sidecar mentions it.
#[test]
fn spare_columns_refuse_no_file() {
    let table = |names: &str, more: &dyn Fn(usize) -> String| {
        let row = |at: usize| {
            let [t, q, f] = sample(at);
            format!("{t:.2},{q},{f},{}\n", more(at))
        };
        format!("t_s,q_um,f_mN,{names}\n{}", (0..60).map(row).collect::<String>())
    };
    let speed = table("dq_m_s", &|row| if row == 7 { "NaN".to_owned() } else { row.to_string() });
    let mapped = r#"{"columns": {"f_N": "f_mN"}}"#;
    let one = holds("a rate", &speed, mapped, 60);
    assert!(one.channel("dq_m_s").is_none() && says(&one, "`dq_m_s` is not used"), "{:?}", one.warnings);
    // Nobody said which columns are meant: the way out is shown.
    let error = read(&speed, "{}").expect_err("a known column");
    assert!(error.contains(r#"leave the column out: "columns": {"dq_m_s": null}"#), "{error}");
    holds("left out", &speed, r#"{"columns": {"dq_m_s": null}}"#, 60);
    assert!(read(&speed, r#"{"scale": {"dq_m_s": 2}}"#).expect_err("mentioned").contains("`NaN`"));
    let tool = |faulty: &'static str| {
        table("x_m,y_m", &move |row| if row < 3 { faulty.to_owned() } else { format!("{row},{row}") })
    };
    for faulty in [",", "NaN,1", "none,1"] {
        let one = holds(faulty, tool(faulty), &mapped.replace("{\"columns", "{\"task\": \"mechanism\", \"columns"), 60);
        assert!(says(&one, "`x_m`, `y_m` are not used"), "{faulty}: {:?}", one.warnings);
    }
    assert!(read(tool("NaN,1"), r#"{"task": "needle"}"#).expect_err("needed").contains("`NaN`"));
}
