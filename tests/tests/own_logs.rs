//! Files as engineers have them: every habit of units, clocks and layouts leads to the same drawer, or to a sentence.
//!
//! The drawer is 1.5 kg with 4 N s/m and 2 N of dry friction. A hand moves it along a sum of waves, whose derivatives are
//! exact; no formula is the estimator's.

use estimator::pipeline::{Options, analyse};
use haptics::recording::Recording;
use rand::rngs::StdRng;
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use std::fmt::Write as _;
use tests::drawer::{File, Sample, drawer, is_the_drawer};

/// A table with these names and cells.
fn table(header: &str, samples: &[Sample], row: impl Fn(&Sample) -> String) -> String {
    samples.iter().fold(header.to_owned() + "\n", |mut text, sample| {
        text += &row(sample);
        text.push('\n');
        text
    })
}

const LINE: &str = r#"{"task": "mechanism"}"#;

fn mapped(time: &str, position: &str, force: &str) -> String {
    format!(r#"{{"task": "mechanism", "columns": {{"t_s": "{time}", "q_m": "{position}", "f_N": "{force}"}}}}"#)
}

#[test]
fn units_are_read_wherever_they_stand() {
    let samples = drawer(700, 100.0);
    let cells = |[t, q, f]: &Sample, [a, b, c]: [f64; 3]| format!("{:.6},{:.6},{:.7}", t / a, q / b, f / c);
    for (time, position, force, factors) in [
        ("Time [s]", "Extension [mm]", "Load [N]", [1.0, 1e-3, 1.0]),
        ("Time (s)", "Extension (mm)", "Load (kN)", [1.0, 1e-3, 1e3]),
        ("time/ms", "position/cm", "force/mN", [1e-3, 1e-2, 1e-3]),
        ("time_s", "position_mm", "load_g", [1.0, 1e-3, 9.806_65e-3]),
        ("Zeit in s", "Weg in inch", "Kraft in lbf", [1.0, 0.0254, 4.448_221_615_260_5]),
        ("t min", "pos.um", "load kgf", [60.0, 1e-6, 9.806_65]),
    ] {
        let text = table(&format!("{time},{position},{force}"), &samples, |s| cells(s, factors));
        is_the_drawer(force, text, &mapped(time, position, force));
    }
    let degrees = table("time_s,angle_deg,torque_Ncm", &samples, |s| cells(s, [1.0, 1f64.to_radians(), 1e-2]));
    let sidecar =
        r#"{"task": "mechanism", "columns": {"t_s": "time_s", "q_rad": "angle_deg", "tau_Nm": "torque_Ncm"}}"#;
    is_the_drawer("torque_Ncm", degrees, sidecar);
    let below = table("Time,Extension,Load\n(sec),(mm),(N)", &samples, |s| cells(s, [1.0, 1e-3, 1.0]));
    is_the_drawer("a row of units", below, &mapped("Time", "Extension", "Load"));
}

#[test]
fn an_unknown_unit_is_refused_with_the_line_that_mends_it() {
    for (force, unit) in [("load_counts", "counts"), ("Load [stone]", "stone"), ("Load (raw)", "raw")] {
        let text = format!("t_s,q_m,{force}\n0,1,2\n1,2,3\n2,3,4\n");
        let error = File::new(text, &mapped("t_s", "q_m", force)).load().expect_err(force);
        assert!(error.contains(&format!("`{force}`")) && error.contains(&format!("unit `{unit}`")), "{error}");
        assert!(error.contains(r#""scale": {"f_N": "#), "{error}");
    }
    // A stated factor is the conversion, whatever the name says.
    let text = "t_s,q_m,load_g\n0,1,2\n1,2,3\n2,3,4\n";
    let sidecar = r#"{"columns": {"f_N": "load_g"}, "scale": {"f_N": 2.0}}"#;
    let one = File::new(text, sidecar).load().expect("loads").remove(0);
    assert_eq!(one.channel("f_N"), Some(&[4.0, 6.0, 8.0][..]));
}

#[test]
fn clocks_are_read_as_loggers_write_them() {
    let samples = drawer(700, 100.0);
    let with = |time: &dyn Fn(usize) -> String| {
        let rows = samples.iter().enumerate().map(|(k, [_, q, f])| format!("{},{q:.6},{f:.6}\n", time(k)));
        rows.collect::<String>()
    };
    let stamp = |k: usize| format!("2025-04-17T17:{:02}:{:05.2}", k / 6000, (k % 6000) as f64 / 100.0);
    let epoch = |k: usize| format!("{}", 1_731_588_341_118_527_889_u64 + 10_000_000 * k as u64);
    let midnight = |k: usize| {
        let s = (86_397.0 + k as f64 / 100.0) % 86_400.0;
        format!("{:02}:{:02}:{:05.2}", (s / 3600.0) as u64, (s / 60.0) as u64 % 60, s % 60.0)
    };
    let wraps = |k: usize| format!("{}", (4_290_967_296_u64 + 10_000 * k as u64) % 4_294_967_296);
    for (name, text) in [
        ("ISO", format!("time,q_m,f_N\n{}", with(&stamp))),
        ("nanoseconds", format!("timestamp_ns,q_m,f_N\n{}", with(&epoch))),
        ("a time of the day", format!("time,q_m,f_N\n{}", with(&midnight))),
        ("a counter that runs over", format!("t_us,q_m,f_N\n{}", with(&wraps))),
    ] {
        let one = is_the_drawer(name, text, LINE);
        let time = one.time_s.expect("a clock");
        assert!((time[699] - time[0] - 6.99).abs() < 1e-6, "{name}: {}", time[699] - time[0]);
    }
    let unnamed = format!("stamp,q_m,f_N\n{}", with(&epoch));
    let one = is_the_drawer("nanoseconds without a unit", unnamed, r#"{"columns": {"t_s": "stamp"}}"#);
    assert!(one.warnings.iter().any(|w| w.text.contains("nanoseconds since 1970")), "{:?}", one.warnings);
    let coarse = format!("t_s,q_m,f_N\n{}", with(&|k| format!("{}", (k / 5) as f64 * 0.05)));
    let error = File::new(&coarse, r#"{"rate_hz": 100}"#).load().expect_err("no clock");
    assert!(error.contains(r#""columns": {"t_s": null}"#) && !error.contains("sort"), "{error}");
    is_the_drawer("no clock", coarse, r#"{"rate_hz": 100, "columns": {"t_s": null}}"#);
}

#[test]
fn tables_are_read_as_instruments_export_them() {
    let samples = drawer(700, 100.0);
    let plain = |delimiter: &'static str| move |[t, q, f]: &Sample| format!("{t:.3}{delimiter}{q:.6}{delimiter}{f:.6}");
    let comma = |s: &Sample| plain(";")(s).replace('.', ",");
    let thousands = |[t, q, f]: &Sample| {
        let (sign, whole) = (if *f < 0.0 { "-" } else { "" }, (1e3 * f).abs().round() as u64);
        let grouped = if whole < 1000 { whole.to_string() } else { format!("{}.{:03}", whole / 1000, whole % 1000) };
        format!("{t:.3};{q:.6};").replace('.', ",") + sign + &grouped
    };
    let facts = "Specimen label,\"A7\"\nStart Date,13/11/2018 5:14 PM\n\n";
    let latin: Vec<u8> =
        table("t_s;q_m;f_N;Temperatur [°C]", &samples, |s| comma(s) + ";20,5").chars().map(|c| c as u8).collect();
    let utf16: Vec<u8> = "\u{feff}"
        .encode_utf16()
        .chain(table("t_s;q_m;f_N", &samples, comma).encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let tables: [(&str, Vec<u8>, &str); 9] = [
        ("facts above", (facts.to_owned() + &table("t_s,q_m,f_N", &samples, plain(","))).into_bytes(), LINE),
        ("blanks", table("t_s  q_m  f_N", &samples, plain("   ")).into_bytes(), LINE),
        ("sep=;", ("sep=;\n".to_owned() + &table("t_s;q_m;f_N", &samples, comma)).into_bytes(), LINE),
        (
            "a summary below",
            (table("t_s,q_m,f_N", &samples, plain(",")) + "\nEnd of test,17:01:00\nMax load,12.3,N\n").into_bytes(),
            LINE,
        ),
        ("points between thousands", table("t_s;q_m;f_mN", &samples, thousands).into_bytes(), LINE),
        ("Latin-1", latin, LINE),
        ("UTF-16", utf16, LINE),
        (
            "words where nothing is asked",
            table("t_s,q_m,f_N,grip_mm", &samples, |s| plain(",")(s) + if s[0] < 1.0 { ",3.1" } else { ",NA" })
                .into_bytes(),
            LINE,
        ),
        (
            "a name twice",
            table("t_s,a,a,q_m,f_N", &samples, |[t, q, f]| format!("{t:.3},1,2,{q:.6},{f:.6}")).into_bytes(),
            LINE,
        ),
    ];
    for (name, text, sidecar) in tables {
        is_the_drawer(name, text, sidecar);
    }
    let other = table("t_s,q_m,f_N,joint_rad,joint_Nm", &samples, |[t, q, f]| {
        format!("{t:.3},{:.6},5,{q:.6},{f:.6}", 0.3 * t.sin())
    });
    is_the_drawer("two pairs", other, r#"{"columns": {"q_rad": "joint_rad", "tau_Nm": "joint_Nm"}}"#);
}

#[test]
fn text_of_labview_is_a_table() {
    let samples = drawer(700, 100.0);
    let head = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t700\t700\t\nY_Unit_Label\tmm\tNewtons\t\nX0\t0,0E+0\t0,0E+0\t\nDelta_X\t1,0E-2\t1,0E-2\t\n***End_of_Header***\t\t\t\n";
    let rows = table("X_Value\tPosition\tForce\tComment", &samples, |[_, q, f]| {
        format!("\t{:.5}\t{f:.6}", 1e3 * q).replace('.', ",")
    });
    is_the_drawer("lvm", head.to_owned() + &rows, r#"{"columns": {"q_m": "Position", "f_N": "Force"}}"#);
    // Names with units, and no labels of units.
    let bare = head
        .lines()
        .filter(|line| !line.starts_with("Y_Unit_Label"))
        .fold(String::new(), |all, line| all + line + "\n");
    let named = rows.replacen("Position\tForce", "Position (mm)\tForce (N)", 1);
    let sidecar = r#"{"columns": {"q_m": "Position (mm)", "f_N": "Force (N)"}}"#;
    is_the_drawer("lvm without labels", bare + &named, sidecar);
    // Each channel has a clock; the second one is twice as fast and starts 0.2 s later.
    let fast = drawer(1400, 200.0);
    let head = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tMulti\n***End_of_Header***\t\n\t\nChannels\t2\t\t\t\nSamples\t700\t\t1360\t\nDate\t2026/11/01\t\t2026/11/01\t\nTime\t10:00:00.0\t\t10:00:00.2\t\nY_Unit_Label\tmm\t\tN\t\n***End_of_Header***\t\t\t\t\nX_Value\tPosition\tX_Value\tForce\tComment\n";
    let rows = |[first_s, second_s]: [f64; 2]| {
        let row = |(k, [t, _, force]): (usize, &Sample)| {
            let first =
                samples.get(k).map_or("\t".to_owned(), |[t, q, _]| format!("{:.3}\t{:.4}", first_s + t, 1e3 * q));
            format!("{first}\t{:.3}\t{force:.6}\t\n", second_s + t)
        };
        fast[40..].iter().enumerate().map(row).collect::<String>()
    };
    let absolute = head.replace("X_Columns", "Time_Pref\tAbsolute\nX_Columns");
    for text in [head.to_owned() + &rows([0.0, -0.2]), absolute + &rows([3.845e9, 3.845e9])] {
        let read = is_the_drawer("two clocks", text, r#"{"columns": {"q_m": "Position", "f_N": "Force"}}"#);
        assert!(read.warnings.iter().any(|w| w.kind == "resampled" && w.text.contains("Force")), "{:?}", read.warnings);
    }
}

#[test]
fn slower_columns_and_held_samples_count_once() {
    let samples = drawer(3500, 500.0);
    let every = |k: usize, by: usize| k / by * by;
    let sparse = samples.iter().enumerate().fold("t_s,q_m,f_N\n".to_owned(), |mut text, (k, [t, q, f])| {
        let force = if k % 5 == 2 { format!("{f:.6}") } else { String::new() };
        let _ = writeln!(text, "{t:.3},{q:.6},{force}");
        text
    });
    let one = is_the_drawer("a slower force", sparse, LINE);
    assert!((one.len() as f64 - 700.0).abs() < 10.0, "{} rows", one.len());
    let held = samples.iter().enumerate().fold("t_s,q_m,f_N\n".to_owned(), |mut text, (k, [t, _, f])| {
        let _ = writeln!(text, "{t:.3},{:.6},{f:.6}", samples[every(k, 5)][1]);
        text
    });
    let one = is_the_drawer("held positions", held, LINE);
    assert!(one.warnings.iter().any(|w| w.kind == "held-samples"), "{:?}", one.warnings);
    let bursts = samples.iter().enumerate().fold("t_s,q_m,f_N\n".to_owned(), |mut text, (k, [_, q, f])| {
        let stamp = 0.016 * (k / 8 + 1) as f64 + 1e-5 * (k % 8) as f64;
        let _ = writeln!(text, "{stamp:.5},{q:.6},{f:.6}");
        text
    });
    is_the_drawer("bursts", bursts, LINE);
    let junk = samples.iter().enumerate().fold("t_s,q_m,f_N\n".to_owned(), |mut text, (k, [t, q, f])| {
        let more = if k * 7919 % 61 == 5 { 40.0 } else { 0.0 };
        let _ = writeln!(text, "{t:.3},{q:.6},{:.6}", f + more);
        text
    });
    is_the_drawer("junk", junk, LINE);
}

/// A unit and the SI value of one; not a number for a unit that nobody knows.
type Spelled = (&'static str, f64);

const LENGTHS: [Spelled; 9] = [
    ("m", 1.0),
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("um", 1e-6),
    ("µm", 1e-6),
    ("inch", 0.0254),
    ("MM", 1e-3),
    ("parsec", f64::NAN),
    ("counts", f64::NAN),
];
const FORCES: [Spelled; 9] = [
    ("N", 1.0),
    ("mN", 1e-3),
    ("kN", 1e3),
    ("gf", 9.806_65e-3),
    ("kgf", 9.806_65),
    ("lbf", 4.448_221_615_260_5),
    ("Newton", 1.0),
    ("stone", f64::NAN),
    ("raw", f64::NAN),
];
const TIMES: [Spelled; 5] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("sec", 1.0), ("min", 60.0)];
/// Delimiters, with true for decimal commas.
const DELIMITERS: [(&str, bool); 5] = [(",", false), (";", false), (";", true), ("\t", false), ("\t", true)];
const MARKS: [fn(&str, &str) -> String; 4] = [
    |name, unit| format!("{name} [{unit}]"),
    |name, unit| format!("{name} ({unit})"),
    |name, unit| format!("{name}_{unit}"),
    |name, unit| format!("{name} in {unit}"),
];

/// One way to write the same samples.
struct Variant {
    text: String,
    is_latin: bool,
    sidecar: String,
    units: [Spelled; 3],
}

impl Variant {
    fn drawn(seed: u64, samples: &[Sample]) -> Self {
        let mut rng = StdRng::seed_from_u64(7_800_001 + seed);
        let units = [TIMES.choose(&mut rng), LENGTHS.choose(&mut rng), FORCES.choose(&mut rng)];
        let units = units.map(|unit| *unit.expect("one"));
        let mark = MARKS.choose(&mut rng).expect("one");
        let names = [mark("Zeit", units[0].0), mark("Weg", units[1].0), mark("Kraft", units[2].0)];
        let mut order = [0, 1, 2];
        order.swap(0, rng.random_range(0..3));
        let (delimiter, comma) = *DELIMITERS.choose(&mut rng).expect("one");
        let one = |k: usize| if units[k].1.is_nan() { 1.0 } else { units[k].1 };
        let row = |sample: &Sample| {
            let cells = order.map(|k| match seed % 3 {
                0 => format!("{:.9e}", sample[k] / one(k)),
                _ => format!("{:.9}", sample[k] / one(k)),
            });
            let text = cells.join(delimiter);
            if comma { text.replace('.', ",") } else { text }
        };
        let mut text = table(&order.map(|k| names[k].clone()).join(delimiter), samples, row);
        if rng.random_bool(0.3) {
            text = format!("Operator{delimiter}K\nDate{delimiter}today\n\n{text}");
        }
        if rng.random_bool(0.3) {
            text = text.replace('\n', "\r\n");
        }
        let sidecar = mapped(&names[0], &names[1], &names[2]);
        Self { text, is_latin: rng.random_bool(0.3), sidecar, units }
    }

    fn load(&self) -> Result<Vec<Recording>, String> {
        let latin = || self.text.chars().map(|c| u8::try_from(c).unwrap_or(b'?')).collect();
        let bytes: Vec<u8> = if self.is_latin { latin() } else { self.text.clone().into_bytes() };
        File::new(bytes, &self.sidecar).load()
    }

    fn has_known_units(&self) -> bool {
        self.units.iter().all(|unit| unit.1.is_finite())
    }

    /// True if a recording has these samples, but for their rounding.
    fn is_read_rightly(&self, one: &Recording, samples: &[Sample]) -> bool {
        let close = |values: Option<&[f64]>, k: usize| {
            let off = |(v, s): (&f64, &Sample)| (v - s[k]).abs() < 1e-8 * self.units[k].1.max(1.0);
            values.is_some_and(|values| values.len() == samples.len() && values.iter().zip(samples).all(off))
        };
        close(one.channel("q_m"), 1) && close(one.channel("f_N"), 2) && close(one.time_s.as_deref(), 0)
    }
}

/// Writes the same samples with any units, separators, headers, encodings and order.
#[test]
fn of_two_thousand_variants_none_gives_a_wrong_number_in_silence() {
    let samples = drawer(40, 100.0);
    let (mut read, mut refused, mut doubted) = (0, 0, 0);
    for seed in 0..2000 {
        let variant = Variant::drawn(seed, &samples);
        let shown: String = format!("{seed}: {}\n{}", variant.sidecar, variant.text).chars().take(500).collect();
        match variant.load() {
            Err(why) => {
                assert!(!variant.has_known_units(), "{why}\n{shown}");
                refused += 1;
            }
            Ok(found) if found[0].warnings.iter().any(|w| w.text.contains("states no known unit")) => {
                assert!(!variant.has_known_units(), "{shown}");
                doubted += 1;
            }
            Ok(found) => {
                assert!(variant.has_known_units(), "an unknown unit is read: {shown}");
                assert!(variant.is_read_rightly(&found[0], &samples), "{shown}");
                read += 1;
            }
        }
    }
    println!("{read} read, {refused} refused, {doubted} doubted");
    assert!(read > 1000, "{read} read, {refused} refused, {doubted} doubted");
}

#[test]
fn units_may_stand_above_the_names() {
    let samples = drawer(1500, 100.0);
    let row = |[t, place, push]: &Sample| format!("{t:.3},{:.6},{:.7}", 1e3 * place, 1e-3 * push);
    let sidecar = r#"{"task":"mechanism","columns":{"t_s":"Time","q_m":"Position","f_N":"Force"}}"#;
    let read = is_the_drawer("units above", table("s,mm,kN\nTime,Position,Force", &samples, row), sidecar);
    assert!(read.warnings.iter().all(|w| !w.text.contains("not read")), "{:?}", read.warnings);
}

/// Runs of one object have one mass. Runs of two objects have a common one that says how far they lie apart.
#[test]
fn runs_of_two_objects_disagree() {
    let run = |number: usize, load: f64| {
        drawer(1500, 100.0)[100 * number..].iter().fold(String::new(), |mut text, [t, place, push]| {
            let _ = writeln!(text, "{number},{t:.2},{place:.6},{:.5}", load * push);
            text
        })
    };
    let fitted = |load: f64| {
        let text = format!("run,t_s,q_m,f_N\n{}{}{}", run(0, 1.0), run(1, 1.0), run(2, load));
        let recordings = File::new(text, r#"{"task":"mechanism"}"#).load().expect("read");
        analyse(&recordings, &Options::default()).expect("a fit").fit
    };
    let disagree = |fit: &estimator::estimate::Fit| {
        fit.warnings.iter().any(|said| said.contains("disagree about mechanism mass_kg"))
    };
    assert!(!disagree(&fitted(1.0)));
    let two = fitted(2.0);
    let mass = two.parameter("mechanism", "mass_kg").expect("a mass");
    assert!(disagree(&two) && mass.std_error.expect("an error") > 0.2, "{mass:?}");
}
