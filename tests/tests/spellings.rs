//! Tables as other programs spell them: each leads to the same samples.

use std::fmt::Write as _;
use tests::drawer::{File, Sample, drawer, is_the_drawer};

const MAPPED: &str =
    r#"{"task": "mechanism", "columns": {"t_s": "Time (s)", "q_m": "Position (um)", "f_N": "Force (mN)"}}"#;
const NAMES: [&str; 3] = ["Time (s)", "Position (um)", "Force (mN)"];

/// Cells in s, µm and mN.
fn cells([t, place, push]: &Sample) -> [String; 3] {
    [format!("{t:.2}"), format!("{:.3}", 1e6 * place), format!("{:.4}", 1e3 * push)]
}

/// A table of the drawer, each number as `spell` has it.
fn table(delimiter: &str, spell: impl Fn(&str) -> String) -> String {
    drawer(1500, 100.0).iter().fold(NAMES.join(delimiter) + "\n", |mut text, sample| {
        let _ = writeln!(text, "{}", cells(sample).map(|cell| spell(&cell)).join(delimiter));
        text
    })
}

/// A number with a mark between its thousands.
fn grouped(cell: &str, thousands: &str, decimal: &str) -> String {
    let (sign, digits) = cell.strip_prefix('-').map_or(("", cell), |digits| ("-", digits));
    let (whole, decimals) = digits.split_once('.').unwrap_or((digits, ""));
    let mut marked = String::new();
    for (at, digit) in whole.chars().enumerate() {
        marked += if at > 0 && (whole.len() - at).is_multiple_of(3) { thousands } else { "" };
        marked.push(digit);
    }
    if decimals.is_empty() { format!("{sign}{marked}") } else { format!("{sign}{marked}{decimal}{decimals}") }
}

#[test]
fn numbers_of_other_programs_are_read() {
    let semicolon = |spell: &dyn Fn(&str) -> String| table(";", spell);
    let quoted = |spell: &dyn Fn(&str) -> String| table(",", |cell| format!("\"{}\"", spell(cell)));
    let fortran = |cell: &str| format!("{:.9e}", cell.parse::<f64>().expect("a number")).replace("e-", "D-");
    let signed = |cell: &str| {
        let spelled = fortran(cell);
        if spelled.contains("D-") { spelled } else { spelled.replace('e', "D+") }
    };
    for (name, text) in [
        ("minus signs of typography", semicolon(&|cell| cell.replace('-', "\u{2212}"))),
        (
            "minus signs behind the number",
            semicolon(&|cell| match cell.strip_prefix('-') {
                Some(digits) => format!("{digits}-"),
                None => cell.to_owned(),
            }),
        ),
        (
            "brackets of accountants",
            semicolon(&|cell| match cell.strip_prefix('-') {
                Some(digits) => format!("({digits})"),
                None => cell.to_owned(),
            }),
        ),
        ("exponents of Fortran", semicolon(&signed)),
        ("decimal commas in quotes", quoted(&|cell| cell.replace('.', ","))),
        ("thousands in quotes", quoted(&|cell| grouped(cell, ",", "."))),
        ("thousands with commas", semicolon(&|cell| grouped(cell, ",", "."))),
        ("thousands with points", semicolon(&|cell| grouped(cell, ".", ","))),
        ("thousands with blanks", semicolon(&|cell| grouped(cell, "\u{a0}", ","))),
        ("thousands with apostrophes", semicolon(&|cell| grouped(cell, "'", "."))),
        ("formulas of a spreadsheet", table(",", |cell| format!("=\"{cell}\""))),
    ] {
        is_the_drawer(name, text, MAPPED);
    }
}

/// Whole numbers, of which those above 999 have a mark: nothing else tells thousands from decimals.
#[test]
fn whole_numbers_below_a_thousand_tell_thousands_from_decimals() {
    for mark in [".", ","] {
        let rows = drawer(1500, 100.0).iter().fold("t_ms;q_um;f_mN\n".to_owned(), |mut text, [t, place, push]| {
            let cells = [1e3 * t, 1e6 * place, 1e3 * push].map(|value| grouped(&format!("{value:.0}"), mark, ""));
            let _ = writeln!(text, "{}", cells.join(";"));
            text
        });
        let read = is_the_drawer(mark, rows, r#"{"task": "mechanism"}"#);
        assert!(read.warnings.iter().any(|w| w.text.contains("stand between thousands")), "{:?}", read.warnings);
    }
}

/// Commas in quotes before three digits, in too few rows to tell: they are thousands, and a note says so.
#[test]
fn few_commas_in_quotes_are_thousands_with_a_note() {
    let rows = (0..20).map(|k| format!("{k},\"1,{:03}\"\n", 7 * k)).collect::<Vec<_>>().concat();
    let read = File::new(format!("sample,q_um\n{rows}"), "{}").load().expect("a table");
    assert!((read[0].channel("q_m").expect("a position")[0] - 1e-3).abs() < 1e-12);
    assert!(read[0].warnings.iter().any(|w| w.text.contains("stand between thousands")), "{:?}", read[0].warnings);
}

#[test]
fn layouts_of_other_programs_are_read() {
    let same = |cell: &str| cell.to_owned();
    let comma = table(",", same);
    let rows = |text: &str| text.split_once('\n').expect("names").1.to_owned();
    let numbered = |text: String| {
        let mut lines = text.lines();
        let names = lines.next().unwrap_or_default().to_owned() + "\n";
        lines.enumerate().fold(names, |mut text, (at, line)| {
            let _ = writeln!(text, "{},{line}", at + 1);
            text
        })
    };
    let bars = format!("| {} |\n", comma.trim_end().replace(',', " | ").replace('\n', " |\n| "));
    let (first, last) = comma.split_at(comma.len() / 2 + comma[comma.len() / 2..].find('\n').expect("a line") + 1);
    let blanks = rows(&comma).replace(',', "  ");
    let mut reserved = comma.clone().into_bytes();
    reserved.resize(reserved.len() + 100_000, 0);
    is_the_drawer("zeros that a logger reserved", reserved, MAPPED);
    for (name, text) in [
        ("bars", comma.replace(',', "|")),
        ("a table of Markdown", bars.replacen('\n', "\n|---|---|---|\n", 1)),
        ("a rule below the names", table("\t", same).replacen('\n', "\n----\t----\t----\n", 1)),
        ("numbers of rows, as R writes them", numbered(comma.clone())),
        ("a comment of names", format!("# {}\n{}", NAMES.join(","), rows(&comma))),
        ("a comment of names above blanks", format!("# {}\n{blanks}", NAMES.join("  "))),
        ("names in a comment of MATLAB", format!("% {comma}")),
        ("names divided by tabs above blanks", format!("{}\n{blanks}", NAMES.join("\t"))),
        ("names divided by blanks", format!("{}\n{blanks}", NAMES.join("    "))),
        ("a repeated header", format!("{first}{}\n{last}", NAMES.join(","))),
        ("files one behind the other", format!("{first}\u{feff}{}\n{last}", NAMES.join(","))),
    ] {
        is_the_drawer(name, text, MAPPED);
    }
}

#[test]
fn lines_of_serial_monitors_are_read() {
    let samples = drawer(1500, 100.0);
    let lines = |line: &dyn Fn(&Sample) -> String| samples.iter().map(|s| line(s) + "\n").collect::<Vec<_>>().concat();
    let clock = |t: f64| format!("14:{:02}:{:06.3}", t as u32 / 60, t % 60.0);
    let labelled = lines(&|[t, place, push]| format!("t_s:{t:.2}\tq_um:{:.3}\tf_mN:{:.4}", 1e6 * place, 1e3 * push));
    is_the_drawer("labels", format!("boot ok\n{labelled}"), r#"{"task": "mechanism"}"#);
    let row = |[_, place, push]: &Sample| format!("{:.3},{:.4}", 1e6 * place, 1e3 * push);
    let arrows = lines(&|s| format!("{} -> {}", clock(s[0]), row(s)));
    let brackets = lines(&|s| format!("[2026-10-25 {}] {}", clock(s[0]), row(s)));
    for (name, text) in [
        ("arrows", format!("14:00:00.000 -> Position (um),Force (mN)\n{arrows}")),
        ("brackets", format!("[2026-10-25 14:00:00.000] Position (um),Force (mN)\n{brackets}")),
    ] {
        is_the_drawer(name, text, &MAPPED.replace("Time (s)", "Time"));
    }
}

/// Campbell Scientific's loggers: station, names, units, kind of each value; Origin: names, units, remarks.
#[test]
fn rows_between_the_units_and_the_numbers_are_remarks() {
    let rows = |head: &str| format!("{head}\n{}", table(",", str::to_owned).split_once('\n').expect("names").1);
    let mapped = r#"{"task": "mechanism", "columns": {"t_s": "Time", "q_m": "Position", "f_N": "Force"}}"#;
    is_the_drawer("remarks", rows("Time,Position,Force\ns,um,mN\nraw,raw,tared"), mapped);
    let head = "\"TOA5\",\"A\",\"CR1000X\"\nTime,Position,Force\n\"TS\",\"um\",\"mN\"\n\"\",Smp,Smp\n";
    let text = drawer(1500, 100.0).iter().fold(head.to_owned(), |mut text, sample| {
        let [_, place, push] = cells(sample);
        let (minute, second) = (sample[0] as u32 / 60, sample[0] % 60.0);
        let _ = writeln!(text, "\"2026-10-25 14:{minute:02}:{second:05.2}\",{place},{push}");
        text
    });
    is_the_drawer("TOA5", text, mapped);
}

/// Files with other columns, one behind the other, are no table.
#[test]
fn other_names_between_the_rows_begin_a_second_table() {
    let comma = table(",", str::to_owned);
    let swapped = comma.replacen("Position (um),Force (mN)", "Force (mN),Position (um)", 1);
    let error = File::new(comma + &swapped, MAPPED).load().expect_err("two tables");
    assert!(error.contains("row 1501 (line 1502) holds other column names: a second table begins there"), "{error}");
}

/// Blocks of one channel each, one below the other: no row has both.
#[test]
fn channels_one_below_the_other_are_refused() {
    let rows = drawer(400, 100.0);
    let places = rows.iter().map(|[t, place, _]| format!("{t:.2},{place:.6},\n"));
    let forces = rows.iter().map(|[t, _, push]| format!("{t:.2},,{push:.6}\n"));
    let later = rows.iter().map(|[t, _, push]| format!("{:.2},,{push:.6}\n", t + 10.0));
    let at_once = [places.clone().chain(forces.clone()).collect::<Vec<_>>(), forces.chain(places.clone()).collect()];
    for blocks in at_once.into_iter().chain([places.chain(later).collect()]) {
        let error = File::new("t_s,q_m,f_N\n".to_owned() + &blocks.concat(), "{}").load().expect_err("no common row");
        assert!(error.contains("has no value in this column"), "{error}");
    }
}

/// Days of a spreadsheet, and counters of 16 bits.
#[test]
fn days_and_overrun_counters_are_told() {
    let text = drawer(1500, 100.0).iter().fold("time_s,q_um,f_mN\n".to_owned(), |mut text, [t, place, push]| {
        let count = (1e6 * place).round().rem_euclid(65_536.0);
        let _ = writeln!(text, "{:.12},{count},{:.4}", 46_000.25 + t / 86_400.0, 1e3 * push);
        text
    });
    let read = is_the_drawer("days", text, r#"{"task": "mechanism"}"#);
    for said in ["counts days since 1900", "runs over the end of its counter"] {
        assert!(read.warnings.iter().any(|w| w.text.contains(said)), "{:?}", read.warnings);
    }
}

/// A table below `header`: `time` writes the cells of a time, and `q_m` and `f_N` follow.
fn below(header: &str, time: impl Fn(f64) -> String) -> String {
    drawer(1500, 100.0).iter().fold(format!("{header},q_m,f_N\n"), |mut text, [t, place, push]| {
        let _ = writeln!(text, "{},{place:.6},{push:.5}", time(*t));
        text
    })
}

/// Whole seconds and their fraction in two columns are one clock.
#[test]
fn seconds_and_their_fraction_are_one_clock() {
    let pairs = [("header.stamp.sec,header.stamp.nanosec", 1e-9), ("tv_sec,tv_usec", 1e-6), ("secs,msecs", 1e-3)];
    for (names, unit_s) in pairs {
        let now = |t: f64| (1_744_900_000.0 + t.floor(), (t.fract() / unit_s).round());
        let text = below(names, |t| format!("{:.0},{:.0}", now(t + 0.001).0, now(t + 0.001).1));
        is_the_drawer(names, text, r#"{"task":"mechanism"}"#);
    }
    // Numbers that never pass through the second are of another unit, or count samples.
    for of in [|t: f64| (1e3 * t.fract()).round(), |t: f64| (100.0 * t.fract()).round()] {
        let text = below("sec,usec", |t| format!("{:.0},{:.0}", (t + 0.001).floor(), of(t + 0.001)));
        let refused = File::new(text, r#"{"task":"mechanism"}"#).load().expect_err("no such fraction");
        assert!(refused.contains("time stands still"), "{refused}");
    }
    let stamps = below("Date,Time,ms", |t| format!("2026-04-17,15:00:{:02.0},{:.0}", t.floor(), (1e3 * t) % 1e3));
    is_the_drawer("stamps and milliseconds", stamps, r#"{"task":"mechanism"}"#);
}

/// A column without a name has one by its place, and stamps in it are a clock.
#[test]
fn the_index_of_a_data_frame_is_a_clock() {
    let stamps = below("", |t| format!("2025-04-17 17:00:{t:06.3}+02:00"));
    is_the_drawer("stamps", stamps, r#"{"task":"mechanism"}"#);
    let levels = below(",stage,cell\n,position,force\ntime_s", |t| format!("{t:.3}")).replacen(",q_m,f_N", ",,", 1);
    let mapped = r#"{"task":"mechanism","columns":{"q_m":"stage.position","f_N":"cell.force"}}"#;
    is_the_drawer("two levels", levels, mapped);
    let numbers = below("", |t| format!("{t:.3}"));
    is_the_drawer("numbers", numbers, r#"{"task":"mechanism","columns":{"t_s":"column 1"}}"#);
}

/// A long table has a row for each number; the signals stand one after the other, or in turns.
#[test]
fn long_tables_are_read() {
    let names = ["q_m", "f_N"];
    let row = |t: f64, signal: usize, value: f64| format!("2026-04-17T15:00:{t:06.3}Z,{value:.6},{}\n", names[signal]);
    let (mut turns, mut stacked) = ("_time,_value,_field\n".to_owned(), [String::new(), String::new()]);
    for [t, place, push] in drawer(1500, 100.0) {
        for (signal, value) in [place, push].into_iter().enumerate() {
            turns += &row(t, signal, value);
            stacked[signal] += &row(t, signal, value);
        }
    }
    is_the_drawer("in turns", turns, r#"{"task":"mechanism"}"#);
    let device = |row: &String| row.replace("Z,", "Z,stage,");
    let tagged = stacked.iter().map(device).collect::<String>() + &stacked.concat().replace("Z,", "Z,other,");
    let mapped = r#"{"task":"mechanism","columns":{"q_m":"stage.q_m","f_N":"stage.f_N"}}"#;
    is_the_drawer("two devices", format!("_time,host,_value,_field\n{tagged}"), mapped);
    let kept = stacked[1].split_inclusive('\n').enumerate().filter(|(at, _)| at % 500 != 7);
    let gappy: String = kept.map(|(_, line)| line).collect();
    let gappy = format!("_time,_value,_field\n{}{gappy}", stacked[0]);
    is_the_drawer("without some values", gappy, r#"{"task":"mechanism"}"#);
    is_the_drawer("stacked", format!("_time,_value,_field\n{}", stacked.concat()), r#"{"task":"mechanism"}"#);
}

/// A second clock of the same name is doubted, and each can be mapped by its place.
#[test]
fn clocks_of_one_name_are_told_apart() {
    let rows = drawer(3000, 200.0);
    let text = rows.windows(2).step_by(2).fold("Time (s),q_m,Time (s),f_N\n".to_owned(), |mut text, pair| {
        let _ = writeln!(text, "{:.3},{:.6},{:.3},{:.5}", pair[0][0], pair[0][1], pair[1][0], pair[1][2]);
        text
    });
    let doubted = File::new(&text, r#"{"task":"mechanism"}"#).load().expect("read");
    let warnings = &doubted[0].warnings;
    assert!(warnings.iter().any(|w| w.text.contains("`column 3` is a second clock")), "{warnings:?}");
    is_the_drawer("two clocks", text, r#"{"task":"mechanism","clocks":{"f_N":"column 3"}}"#);
}

/// A unit may stand before a name, in quotes, or in a comment above the names.
#[test]
fn units_in_other_places_are_read() {
    let table = |header: &str| {
        drawer(1500, 100.0).iter().fold(header.to_owned() + "\n", |mut text, [t, place, push]| {
            let _ = writeln!(text, "{t:.3},{:.5},{:.9}", 1e3 * place, 1e-3 * push);
            text
        })
    };
    for header in [
        "[s] Time,[mm] Position,[kN] Force",
        "Time 's',Position 'mm',Force 'kN'",
        "# Units: s, mm, kN\nTime,Position,Force",
        "# Position in mm, force in kN\nTime (s),Position,Force",
    ] {
        let names: Vec<&str> = header.lines().last().expect("names").split(',').collect();
        let columns = format!(r#"{{"t_s":"{}","q_m":"{}","f_N":"{}"}}"#, names[0], names[1], names[2]);
        is_the_drawer(header, table(header), &format!(r#"{{"task":"mechanism","columns":{columns}}}"#));
    }
    let stated = table("Scale factor,1,0.01,0.1\nTime (s),Position (mm),Force (kN)");
    let mapped = r#"{"columns":{"t_s":"Time (s)","q_m":"Position (mm)","f_N":"Force (kN)"}}"#;
    let read = File::new(stated, mapped).load().expect("read");
    assert!(read[0].warnings.iter().any(|w| w.text.contains("`Scale factor,1,0.01,0.1` above the names")));
    let mapped = r#"{"columns":{"t_s":"Time","q_m":"Position (mm)","f_N":"Force (kN)"}}"#;
    let read = File::new(table("Time,Position (mm),Force (kN)"), mapped).load().expect("read");
    assert!(read[0].warnings.iter().any(|w| w.text.contains("`Time` states no unit: its times are taken as seconds")));
}

/// Dashboards and spreadsheets write a unit behind each number. One that measures something else is refused.
#[test]
fn units_behind_numbers_are_those_of_their_column() {
    let table = |delimiter: &str, comma: bool| {
        let header = ["Time", "Position", "Force"].join(delimiter) + "\n";
        drawer(1500, 100.0).iter().fold(header, |mut text, [t, place, push]| {
            let row = format!("{t:.2} s|{:.3} mm|{:.4}mN", 1e3 * place, 1e3 * push).replace('|', delimiter);
            let _ = writeln!(text, "{}", if comma { row.replace('.', ",") } else { row });
            text
        })
    };
    let mapped = r#"{"task": "mechanism", "columns": {"t_s": "Time", "q_m": "Position", "f_N": "Force"}}"#;
    for (delimiter, comma) in [(",", false), (";", true), ("\t", false)] {
        is_the_drawer(delimiter, table(delimiter, comma), mapped);
    }
    let scaled = |[t, place, push]: [f64; 3]| {
        if place.abs() < 0.01 {
            format!("{t:.2} s,{:.3} mm,{push:.4} N\n", 1e3 * place)
        } else {
            format!("{t:.2} s,{:.4} cm,{:.4} mN\n", 1e2 * place, 1e3 * push)
        }
    };
    let scaled: String = drawer(1500, 100.0).into_iter().map(scaled).collect();
    is_the_drawer("units by size", format!("Time,Position,Force\n{scaled}"), mapped);
    let whole = table(",", false);
    let (first, second) = whole.split_at(whole.len() / 2);
    let mixed = first.to_owned() + &second.replace(" mm", " N");
    let refused = File::new(mixed, mapped).load().expect_err("two quantities");
    assert!(refused.contains("holds a unit, which belongs into the name of the column"), "{refused}");
}

/// Facts of an oscilloscope above the names have a number for each channel.
#[test]
fn facts_with_numbers_above_the_names_are_no_rows() {
    let facts = "Model,MDO3024\nSample Interval,1e-2\n\nVertical Offset,0,0\nVertical Scale,1,1\nVertical Position,0,0\n,,\nLabel,pos,force\n";
    let table = format!("{facts}{}", table(",", str::to_owned));
    is_the_drawer("an oscilloscope", table, MAPPED);
}

/// A factor behind a unit may be taken out or put in: it is asked for.
#[test]
fn a_factor_behind_a_unit_is_asked_for() {
    for force in ["Force (N x10)", "Force [N*10]", "Force (N) x10"] {
        let text = format!("Time (s),Position (mm),{force}\n0,1,2\n0.01,2,3\n0.02,3,4\n");
        let mapped = format!(r#"{{"columns":{{"t_s":"Time (s)","q_m":"Position (mm)","f_N":"{force}"}}}}"#);
        let refused = File::new(text, &mapped).load().expect_err("two meanings");
        assert!(refused.contains("\"scale\": {\"f_N\": SI value of 1}"), "{force}: {refused}");
    }
}

/// Lines of facts between the names and the rows begin no second table, and a cell with a unit is none of it.
#[test]
fn text_above_the_rows_is_no_second_table() {
    let rows = (0..30).fold(String::new(), |mut text, k| {
        let t = 0.01 * f64::from(k);
        let _ = writeln!(text, "{t},{k},{t},{k}");
        text
    });
    let facts = "Name,q_m,Name,f_N\nData-Type,REAL64,Data-Type,REAL64\nScaleFactor,1,ScaleFactor,1\n";
    let refused = File::new(format!("{facts}{rows}"), "{}").load().expect_err("facts");
    assert!(refused.contains("leave one line of column names right above the numbers"), "{refused}");
    let units = "t_s,q_m,f_N\n0.000 s,1.5 mm,2 N\n0.010 s,1.6 mm,2 N\n0.020 s,1.7 mm,2 N\n";
    let refused = File::new(units, "{}").load().expect_err("a name in metres above millimetres");
    assert!(refused.contains("the name of the column `q_m` says m and its stated unit is `mm`"), "{refused}");
    let decided = File::new(units, r#"{"scale": {"q_m": 0.001}}"#).load().expect("a scale decides");
    let place = decided[0].channel("q_m").expect("a position");
    assert!((place[2] - 0.0017).abs() < 1e-12, "{place:?}");
}
