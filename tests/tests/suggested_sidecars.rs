//! Sidecars that `info --suggest` writes.

use std::fmt::Write as _;
use tests::drawer::{File, drawer, is_the_drawer};

/// Runs `info --suggest`; its output.
fn suggest(file: &File) -> String {
    suggest_with(file, &[])
}

fn suggest_with(file: &File, flags: &[&str]) -> String {
    let mut command = std::process::Command::new(tests::touchstone());
    command.args(["info", "--suggest", "log.csv"]).args(flags).current_dir(file.0.path());
    let output = command.output().expect("it runs");
    assert!(output.status.success(), "{output:?}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Rows in another order keep their clock: the file is sorted, and no rate stands in for its times.
#[test]
fn rows_in_the_wrong_order_are_to_be_sorted() {
    let mut rows: Vec<String> =
        drawer(200, 100.0).iter().map(|[t, place, push]| format!("{t:.2},{place:.6},{push:.4}")).collect();
    rows.reverse();
    let sidecar = r#"{"task":"mechanism"}"#;
    let file = File::new(format!("t_s,q_m,f_N\n{}\n", rows.join("\n")), sidecar);
    let error = file.load().expect_err("refused");
    assert!(error.contains("the newest row stands first") && error.contains("sort the rows"), "{error}");
    suggest(&file);
    assert_eq!(std::fs::read_to_string(file.0.path().join("log.meta.json")).expect("a sidecar"), sidecar);
}

/// A unit that only the values tell is named as a guess.
#[test]
fn a_unit_by_the_values_is_said_to_be_a_guess() {
    let rows: Vec<String> =
        drawer(200, 100.0).iter().map(|[t, place, push]| format!("{t:.2},{:.3},{push:.4}", 1e3 * place)).collect();
    let said = suggest(&File::new(format!("Time (s),Position,Force (N)\n{}\n", rows.join("\n")), "{}"));
    assert!(said.contains("still open: `Position` states no unit; by its values it is mm"), "{said}");
}

/// A suggested sidecar leaves a known unit to the reader and asks for the factor of an unknown one; no factor is invented.
#[test]
fn a_suggested_sidecar_invents_no_factor() {
    let rows = |length: f64, force: f64| {
        let mut text = String::new();
        for [t, place, push] in drawer(1500, 100.0) {
            let _ = writeln!(text, "{t:.3},{:.9e},{:.9e}", place / length, push / force);
        }
        text
    };
    for (length, length_m, force, force_n) in [
        ("mm", 1e-3, "cN", 1e-2),
        ("yd", 0.9144, "kip", 4_448.221_615_260_5),
        ("mil", 2.54e-5, "daN", 10.0),
        ("steps", 1e-5, "N", 1.0),
        ("mm", 1e-3, "x1000 N", 1e3),
        ("1/10 mm", 1e-4, "%", 0.5),
    ] {
        let name = format!("{length}, {force}");
        let table = format!("Time (s),Position ({length}),Force ({force})\n{}", rows(length_m, force_n));
        let file = File::new(&table, r#"{"task":"mechanism"}"#);
        suggest(&file);
        let path = file.0.path().join("log.meta.json");
        let sidecar = std::fs::read_to_string(path).expect("a sidecar");
        let scale = serde_json::from_str::<serde_json::Value>(&sidecar).expect("JSON")["scale"].clone();
        let stated = scale.as_object().into_iter().flatten();
        assert!(stated.clone().all(|(_, factor)| factor.is_null()), "{name}: {sidecar}");
        // The user states the factors that are asked for.
        let known = [("q_m", length_m), ("f_N", force_n)];
        let filled = stated.fold(sidecar.clone(), |text, (asked, _)| {
            let factor = known.iter().find(|(name, _)| name == asked).map_or(1.0, |(_, factor)| *factor);
            text.replace(&format!("\"{asked}\": null"), &format!("\"{asked}\": {factor}"))
        });
        is_the_drawer(&name, &table, &filled);
    }
}

/// A table of the drawer: a header, and rows of time (s), position (mm) and force (N).
fn table(header: &str, row: impl Fn(usize, [f64; 3]) -> String) -> File {
    let rows = drawer(1500, 100.0).into_iter().enumerate();
    let text = rows.fold(header.to_owned() + "\n", |mut text, (at, [t, place, push])| {
        let _ = writeln!(text, "{}", row(at, [t, 1e3 * place, push]));
        text
    });
    File::new(text, r#"{"task":"mechanism"}"#)
}

/// The drawer from a file with the sidecar that `--suggest` writes; the output.
fn mended(name: &str, file: &File) -> String {
    let said = suggest(file);
    let read = |name: &str| std::fs::read_to_string(file.0.path().join(name)).expect("a file");
    is_the_drawer(name, read("log.csv"), &read("log.meta.json"));
    said
}

/// Stamps of whole seconds keep the rate of the rows between them.
#[test]
fn coarse_stamps_show_the_rate() {
    let file = table("Time (s),Position (mm),Force (N)", |at, [t, place, push]| {
        format!("{:.0},{place:.5},{push:.6}", (t + 0.37 + 1e-9 * at as f64).floor())
    });
    mended("whole seconds", &file);
}

/// The parts on both sides of a leap are read on their own.
#[test]
fn a_position_whose_zero_was_set_is_cut_there() {
    let file = table("Time (s),Position (mm),Force (N)", |at, [t, place, push]| {
        format!("{t:.3},{:.5},{push:.6}", if at < 700 { place } else { place + 431.7 })
    });
    mended("a zero that was set", &file);
}

/// The raw channel comes before a filtered one, and both are named.
#[test]
fn rival_columns_are_named() {
    let file = table("Time (s),Position (mm),Force filtered (N),Force raw (N)", |_, [t, place, push]| {
        format!("{t:.3},{place:.5},{:.6},{push:.6}", 0.8 * push)
    });
    let said = mended("two forces", &file);
    assert!(said.contains("`Force raw (N)` and `Force filtered (N)` may both be `f_N`"), "{said}");
}

/// One clock in two units is no clash of names.
#[test]
fn a_clock_in_two_units_is_one_clock() {
    let file = table("time_s,time_ms,Position (mm),Force (N)", |_, [t, place, push]| {
        format!("{t:.3},{:.0},{place:.5},{push:.6}", 1e3 * t)
    });
    mended("two units", &file);
}

/// Values that only the user knows are asked for: a factor of volts, and the rate of a log that counts its samples.
#[test]
fn unknown_factors_and_rates_are_asked_for() {
    let volts =
        table("Time (s),Position (mm),Load cell (V)", |_, [t, place, push]| format!("{t},{place:.5},{push:.6}"));
    let counted = table("Sample,Position (mm),Force (N)", |at, [_, place, push]| format!("{at},{place:.5},{push:.6}"));
    for (file, entry) in [(volts, r#""f_N": null"#), (counted, r#""rate_hz": null"#)] {
        assert!(suggest(&file).contains(entry), "{entry}");
    }
}

/// A rate or a period above the rows is suggested for a log without a clock.
#[test]
fn a_stated_rate_is_suggested() {
    for above in ["Sampling interval,10ms", "# Sample rate: 100 Hz", "wf_increment,0.01"] {
        let file =
            table(&format!("{above}\nPosition (mm),Force (N)"), |_, [_, place, push]| format!("{place:.5},{push:.6}"));
        mended(above, &file);
    }
}

/// The nanoseconds beside whole seconds are no clock of their own.
#[test]
fn a_fraction_of_a_second_is_no_clock() {
    let file = table("header.stamp.sec,header.stamp.nanosec,pos_mm,force_N", |_, [t, place, push]| {
        let (whole, part) = (1_744_902_008.0 + (t + 0.001).floor(), (t + 0.001).fract());
        format!("{whole:.0},{:.0},{place:.5},{push:.6}", 1e9 * part)
    });
    mended("seconds and nanoseconds", &file);
}

/// A few words among the numbers do not hide a column: the sidecar names them.
#[test]
fn words_for_missing_values_do_not_hide_a_force() {
    let file = table("Time (s),Position (mm),Force (N)", |at, [t, place, push]| match at % 200 {
        150 => format!("{t},{place:.5},#N/A"),
        170 => format!("{t},{place:.5},OVLD"),
        _ => format!("{t},{place:.5},{push:.6}"),
    });
    let said = mended("words", &file);
    assert!(said.contains("\"#N/A\",") && said.contains("\"OVLD\""), "{said}");
}

/// Set points have no unit, and no measured channel stands back behind them.
#[test]
fn set_points_are_no_units() {
    let file = table("time_s,q_mm,q_ref,f_cmd,f_N", |_, [t, place, push]| {
        format!("{t:.3},{place:.5},{:.5},{:.6},{push:.6}", 1.02 * place, 1.1 * push)
    });
    mended("set points", &file);
}

/// A velocity that contradicts its position by a factor of no unit is left to the user.
#[test]
fn a_contradiction_is_left_to_the_user() {
    let rates = drawer(1501, 100.0);
    let file = table("time_s,q_mm,dq_mm_s,f_N", |at, [t, place, push]| {
        format!("{t:.3},{place:.5},{:.5},{push:.6}", 1e3 * (rates[at + 1][1] - rates[at][1]) / 0.01 / 7.3)
    });
    let said = suggest(&file);
    assert!(said.contains("nothing to add") && said.contains("still open: q_m changes at 7.3"), "{said}");
}

/// The clock of an Arduino has the name of its unit.
#[test]
fn milliseconds_of_a_board_are_a_clock() {
    let file = table("millis,pos_mm,force_N", |_, [t, place, push]| format!("{:.0},{place:.5},{push:.6}", 1e3 * t));
    mended("millis", &file);
}

/// Seconds in a column that states milliseconds make a rate that no motion is recorded at.
#[test]
fn seconds_called_milliseconds_are_told() {
    for header in ["t_ms,q_m,f_N", "Time (ms),Position (m),Force (N)"] {
        let file = table(header, |_, [t, place, push]| format!("{t:.3},{:.9},{push:.6}", 1e-3 * place));
        mended(header, &file);
    }
}

/// Microseconds with fractions make a rate that no motion is recorded at.
#[test]
fn microseconds_with_fractions_are_told() {
    let file =
        table("t_s,q_m,f_N", |_, [t, place, push]| format!("{:.3},{:.9},{push:.6}", 1e6 * t + 0.37, 1e-3 * place));
    mended("microseconds", &file);
}

/// A speed with a fault is left out: the position shows it.
#[test]
fn a_faulty_speed_is_left_out() {
    let file = table("t_s,q_m,dq_m_s,f_N", |at, [t, place, push]| {
        format!("{t:.3},{:.9},{},{push:.6}", 1e-3 * place, if at == 40 { "NaN" } else { "0.1" })
    });
    mended("a speed", &file);
}

/// A share of a range is no torque: its factor is asked for.
#[test]
fn the_factor_of_a_percentage_is_asked_for() {
    let said = suggest(&table("t_s,q_mm,force_%", |_, [t, place, push]| format!("{t:.3},{place:.6},{push:.6}")));
    assert!(said.contains("\"f_N\": null"), "{said}");
}

/// A factor that only one of two runs needs is left to the user.
#[test]
fn a_factor_of_one_run_is_no_factor_of_the_file() {
    let file = table("run,t_s,q_m,f_N", |at, [t, place, push]| {
        let (run, metres) = if at < 750 { (1, 1e-3 * place) } else { (2, place) };
        format!("{run},{t:.3},{metres:.6},{push:.6}")
    });
    let said = suggest(&file);
    assert!(!said.contains("\"q_m\": 0.001") && said.contains("its unit looks wrong by 1000"), "{said}");
}

/// A file without a force says so.
#[test]
fn a_missing_force_is_told() {
    let said = suggest(&table("t_s,q_m,current_A", |_, [t, place, push]| format!("{t:.3},{place:.6},{push:.6}")));
    assert!(said.contains("no column is recognized as a force or torque") && said.contains("`current_A`"), "{said}");
}

/// A payload moves by its orientation.
#[test]
fn an_orientation_is_a_motion() {
    let header = "t_s,r11,r12,r13,r21,r22,r23,r31,r32,r33,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";
    let said = suggest(&table(header, |_, [t, ..]| {
        let (s, c) = t.sin_cos();
        format!("{t:.3},1,0,0,0,{c},{},0,{s},{c},0,{s:.3},{c:.3},0,0,0", -s)
    }));
    assert!(!said.contains("recognized"), "{said}");
    // Poses need no clock, and a frame in the names stays.
    let poses = table("qx,qy,qz,qw,fx_base_N,fy_base_N,fz_base_N", |_, [t, ..]| {
        let (s, c) = t.sin_cos();
        format!("{s:.6},0,0,{c:.6},0.1,0.2,-9.8")
    });
    let said = suggest(&poses);
    assert!(said.contains("there is nothing to add"), "{said}");
}

/// Runs whose rows take turns are told apart.
#[test]
fn runs_in_turns_are_runs() {
    let rows = drawer(1500, 100.0);
    let text = rows.windows(2).fold("run,t_s,q_m,f_N\n".to_owned(), |mut text, w| {
        let ([t, place, push], [_, other, pull]) = (w[0], w[1]);
        let _ = writeln!(text, "1,{t:.3},{place:.6},{push:.6}\n2,{t:.3},{other:.6},{pull:.6}");
        text
    });
    is_the_drawer("in turns", &text, r#"{"task":"mechanism"}"#);
}

/// A problem names the sidecar that the user gave.
#[test]
fn a_given_sidecar_is_named() {
    let file = table("t_s,q_m,f_N", |_, [t, place, push]| format!("{t:.3},{place:.6},{push:.6}"));
    std::fs::write(file.0.path().join("mine.json"), r#"{"rate_hz":-5}"#).expect("written");
    let said = suggest_with(&file, &["--meta", "mine.json"]);
    assert!(said.contains("mine.json") && !said.contains("log.meta.json"), "{said}");
}

/// The index of a data frame is a clock if its numbers are times.
#[test]
fn the_index_of_a_data_frame_is_suggested_as_a_clock() {
    for header in ["", "index", "Unnamed: 0"] {
        let file =
            table(&format!("{header},pos_mm,force_N"), |_, [t, place, push]| format!("{t:.3},{place:.5},{push:.6}"));
        mended(header, &file);
    }
    // Numbers of rows are no times, from wherever they count.
    let counted = table(",pos_mm,force_N", |at, [_, place, push]| format!("{},{place:.5},{push:.6}", 100 + at));
    assert!(suggest(&counted).contains(r#""rate_hz": null"#));
}

/// A motor and its load turn by different angles: both are named.
#[test]
fn a_motor_and_its_load_are_rivals() {
    let said =
        suggest(&table("Time (s),Motor position (rad),Load position (rad),Torque (Nm)", |_, [t, place, push]| {
            format!("{t:.3},{:.6},{:.6},{push:.6}", 0.05 * place, 1e-3 * place)
        }));
    assert!(said.contains("`Motor position (rad)` and `Load position (rad)` may both be `q_rad`"), "{said}");
}

/// Whole numbers may be counts: their factor is asked for. A channel that stands still is named.
#[test]
fn counts_and_dead_channels_are_told() {
    let said = suggest(&table("t_s,q_m,f_N", |_, [t, place, push]| format!("{t:.3},{:.0},{push:.6}", 1e2 * place)));
    assert!(said.contains(r#""q_m": null"#), "{said}");
    let said = suggest(&table("Time (s),Position (mm),Force (N)", |_, [t, place, _]| format!("{t:.3},{place:.5},0")));
    assert!(said.contains("`Force (N)` is 0 in every row"), "{said}");
}
