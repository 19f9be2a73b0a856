//! Clocks of dates and times of the day, in one column or in two.

use crate::{LogError, load};
use haptics::recording::Recording;

/// Loads a table whose rows are these texts, each with a number behind it.
fn read(header: &str, rows: &[&str]) -> Result<Recording, LogError> {
    let rows: Vec<String> = rows.iter().enumerate().map(|(i, row)| format!("{row};{}.5", i * i)).collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("log.csv");
    std::fs::write(&path, format!("{header};q_mm\n{}\n", rows.join("\n"))).expect("writes");
    load(&path, None).map(|mut all| all.remove(0))
}

/// Times of a table that loads, s, and its warnings.
fn clock(header: &str, rows: &[&str]) -> (Vec<f64>, Vec<String>) {
    let log = read(header, rows).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(log.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["q_m"]);
    let warnings = log.warnings.into_iter().map(|warning| warning.text).collect();
    (log.time_s.unwrap_or_default(), warnings)
}

fn said(warnings: &[String], words: &str) -> bool {
    warnings.iter().any(|text| text.contains(words))
}

#[test]
fn dates_and_times_of_the_day_in_two_columns_are_one_clock() {
    let rows = ["17.04.2026;23:59:58,5", "17.04.2026;23:59:59", "18.04.2026;00:00:01", "20.04.2026;00:00:01"];
    // Two days lie between the last rows: only the dates show them.
    let wanted = vec![0.0, 0.5, 2.5, 2.5 + 2.0 * 86_400.0];
    for header in ["Datum;Uhrzeit", "day;Time", "Date;begun"] {
        let (time_s, warnings) = clock(header, &rows);
        assert_eq!(time_s, wanted, "{header}");
        assert!(said(&warnings, "holds the dates of the times in"), "{warnings:?}");
    }
    let turned = ["23:59:58,5;17.04.2026", "23:59:59;17.04.2026", "00:00:01;18.04.2026", "00:00:01;20.04.2026"];
    assert_eq!(clock("time;date", &turned).0, wanted);
    let noon = ["4/17/2026;11:59:59 AM", "4/17/2026;12:00:00 PM", "4/17/2026;12:00:02 PM"];
    assert_eq!(clock("Date;Time", &noon).0, [0.0, 1.0, 3.0]);
}

#[test]
fn a_time_of_the_day_that_falls_back_goes_on_on_the_next_day() {
    let (time_s, warnings) = clock("time", &["23:59:58", "23:59:59", "00:00:07", "23:00:00", "01:00:00"]);
    assert_eq!(time_s, [0.0, 1.0, 9.0, 82_802.0, 90_002.0]);
    assert!(said(&warnings, "the column `time` passes midnight 2 time(s), first in row 3"), "{warnings:?}");
    let back =
        read("time", &["12:00:00", "12:00:01", "11:00:00"]).expect_err("an hour back is no midnight").to_string();
    assert!(back.contains("time goes backwards"), "{back}");
    let back = read("time", &["2026-04-17 23:00:00", "2026-04-17 01:00:00"]).expect_err("the date says so").to_string();
    assert!(back.contains("time goes backwards"), "{back}");
}

#[test]
fn a_day_above_twelve_anywhere_settles_the_order() {
    // December 4 to 13 if the month came first, which no month 13 allows.
    let (time_s, warnings) = clock("Date;Time", &["11/04/2026;12:00", "12/04/2026;12:00", "13/04/2026;12:00"]);
    assert_eq!((time_s, said(&warnings, "3/4 is read")), (vec![0.0, 86_400.0, 172_800.0], false), "{warnings:?}");
    let (time_s, warnings) = clock("time", &["04/11/2026 12:00", "04/12/2026 12:00", "04/13/2026 12:00"]);
    assert_eq!((time_s, said(&warnings, "3/4 is read")), (vec![0.0, 86_400.0, 172_800.0], false), "{warnings:?}");
    let (time_s, warnings) = clock("time", &["03/04/2026 12:00", "03/05/2026 12:00"]);
    assert_eq!((time_s, said(&warnings, "3/4 is read as March 4")), (vec![0.0, 86_400.0], true), "{warnings:?}");
    // On one day the order changes nothing.
    let (time_s, warnings) = clock("Date;Time", &["03/04/2026;12:00:00", "03/04/2026;12:00:01"]);
    assert_eq!((time_s, said(&warnings, "3/4 is read")), (vec![0.0, 1.0], false));
    let both =
        read("time", &["04/03/2026 12:00", "04/13/2026 12:00", "13/04/2026 12:01"]).expect_err("both").to_string();
    assert!(both.contains("is not a time like the others"), "{both}");
}

#[test]
fn a_date_that_is_none_is_named() {
    let text = read("Date;Time", &["2026-04-17;12:00:00", "2026-04-17;12:00:01", ";12:00:02"]).expect_err("no date");
    assert!(
        text.to_string().contains("row 3 (line 4), column `Time`: `12:00:02` is not a time like the others"),
        "{text}"
    );
    // Dates alone are no clock.
    let log = read("Date", &["2026-04-17", "2026-04-18"]).unwrap_or_else(|e| panic!("{e}"));
    assert!(log.time_s.is_none());
}

#[test]
fn months_by_name_and_minutes_with_seconds_are_read() {
    assert_eq!(clock("Time", &["02-Jan-2026 09:05:08.5", "02-Jan-2026 09:05:09"]).0, [0.0, 0.5]);
    assert_eq!(clock("Zeit", &["28-Dez-2026 09:05:08", "28-Dez-2026 09:05:09"]).0, [0.0, 1.0]);
    let (times_s, _) = clock("Time", &["58:55.000", "58:55.250"]);
    assert!((times_s[1] - times_s[0] - 0.25).abs() < 1e-9, "{times_s:?}");
}
