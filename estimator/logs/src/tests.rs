//! Every bad input of `spec/logs.md`, and inputs that must load.

use super::*;
use haptics::recording::Channel;
use proptest::prelude::*;
use std::fmt::Write as _;
use std::path::PathBuf;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).expect("writable");
        path
    }

    fn load(&self, content: impl AsRef<[u8]>) -> Result<Vec<Recording>, LogError> {
        load(&self.file("log.csv", content), None)
    }

    fn load_meta(&self, content: &str, meta: &str) -> Result<Vec<Recording>, LogError> {
        self.file("log.meta.json", meta);
        self.load(content)
    }
}

fn refusal(content: impl AsRef<[u8]>) -> String {
    let text = Folder::new().load(content).expect_err("must be refused").to_string();
    assert!(text.ends_with("log.csv") && !text.contains('\n'), "one sentence, the path last: {text}");
    text
}

#[test]
fn bad_tables_end_in_one_sentence_each() {
    assert!(refusal("").contains("empty"));
    assert!(refusal(" \n\n").contains("empty"));
    assert!(refusal("t_s,q_m\n").contains("no samples"));
    assert!(refusal("# only a comment\n").contains("no samples"));
    assert!(refusal(b"\xff\xfet\0_\0s\0").contains("no samples"));
    assert!(refusal([0x89, b'P', b'N', b'G', 0, 1, 2]).contains("binary"));
    assert!(refusal("Dear all,\nthe log is attached.\nYours\n").contains("has 1 cells and the header has 2"));
    assert!(refusal("notes\nhello\nworld\n").contains("no column holds numbers"));
    assert!(refusal("1,2\n3,4\n").contains("instead of column names"));
    assert!(refusal("t_s,q_m\n0,1\n1,2\n2\n").contains("row 3 (line 4) has 1 cells and the header has 2"));
    assert!(refusal("t_s,q_m\n0,1\n1,2,3\n").contains("row 2 (line 3) has 3 cells"));
    assert!(refusal("t_s,q_m,f_N\n0,1,2\n1,2,abc\n").contains("row 2 (line 3), column `f_N`: `abc` is not a number"));
    assert!(refusal("t_s,q_m,f_N\n0,1,\n").contains("row 1 (line 2), column `f_N`: the cell is empty"));
    assert!(refusal("t_s,q_m\n0,1\n1,NaN\n").contains("column `q_m`: `NaN` is not a finite number"));
    assert!(refusal("t_s,q_m\n0,1\n1,-inf\n").contains("not a finite number"));
    assert!(refusal("t_s,q_m\n0,1\n1,2\n0.5,3\n").contains("row 3 (line 4), column `t_s`: time goes backwards"));
    assert!(refusal("t_s,q_m\n0,1\n1,2\n1,3\n").contains("time stands still (1 s, then 1 s)"));
    assert!(refusal("t_s,fx1_stone\n0,1\n").contains("column `fx1_stone` has the unknown unit `stone`"));
    assert!(refusal("t_s,x_m\n0,1\n").contains("column `y_m` is missing"));
}

#[test]
fn bad_files_end_in_one_sentence_each() {
    let folder = Folder::new();
    let sentence = |path: &Path| load(path, None).expect_err("must be refused").to_string();
    assert!(sentence(folder.0.path()).contains("folder"));
    assert!(sentence(&folder.0.path().join("absent.csv")).contains("cannot be read"));
    let large = folder.0.path().join("large.csv");
    let file = std::fs::File::create(&large).expect("creates");
    file.set_len(5_000_000_000).expect("a sparse file");
    let text = sentence(&large);
    assert!(text.contains("4.7 GiB") && text.contains("at most 4.0 GiB"), "{text}");
}

#[test]
fn a_table_that_grows_while_it_is_read_is_refused() {
    let folder = Folder::new();
    let path = folder.0.path().join("log.csv");
    std::fs::write(&path, "t_s,q_m\n0,1\n1,2\n").expect("writable");
    // The size that was seen before reading: four bytes have come since.
    let error = load_sized(&path, &Meta::default(), 12, &Watch::none()).expect_err("refused").to_string();
    assert!(error.contains("changed from 12 to 16 bytes"), "{error}");
}

#[test]
fn mapping_errors_name_the_column() {
    let folder = Folder::new();
    let table = "time_s,position_m,mechanism\n0,1,door\n1,2,door\n";
    let text = |meta: &str| folder.load_meta(table, meta).expect_err("refused").to_string();
    assert!(text(r#"{"columns":{"q_m":"pos"}}"#).contains("the column `pos` is missing"));
    assert!(text(r#"{"columns":{"f_N":"position_m"}}"#).contains("measures something else"));
    assert!(text(r#"{"columns":{"q_m":"mechanism"}}"#).contains("row 1 (line 2), column `mechanism`: `door`"));
    assert!(text(r#"{"select":{"mechanism":"drawer"}}"#).contains("no row has mechanism = drawer; the file has door"));
    assert!(text(r#"{"select":{"trial":"1"}}"#).contains("no row has trial = 1; the file has one run"));
    assert!(text("{").contains("sidecar is malformed"));
}

#[test]
fn units_scale_and_sign_are_applied() {
    let folder = Folder::new();
    let table = "t_ms,x1_mm,y1_cm,x2_um,y2_m,fx1_gf,fy1_mN,fx2_N,fy2_N,vx1_cm_s,qb1_deg,qt1_deg,qb2_deg,qt2_deg,oil_degC\n\
                 0,1,1,1,1,1,1,1,1,1,180,1,1,1,20\n5,1,1,1,1,1,1,1,1,1,180,1,1,1,21\n";
    let meta = r#"{"scale":{"fx2_N":2},"sign":{"fx2_N":-1}}"#;
    let log = folder.load_meta(table, meta).expect("loads").remove(0);
    let first = |name: &str| log.channel(name).unwrap_or_else(|| panic!("{name}"))[0];
    assert_eq!(log.time_s.as_deref(), Some(&[0.0, 0.005][..]));
    assert_eq!([first("x1_m"), first("y1_m"), first("x2_m"), first("y2_m")], [1e-3, 1e-2, 1e-6, 1.0]);
    assert_eq!([first("fx1_N"), first("fy1_N"), first("fx2_N")], [9.806_65e-3, 1e-3, -2.0]);
    assert_eq!([first("vx1_m_s"), first("oil_degC")], [1e-2, 20.0]);
    assert!((first("qb1_rad") - std::f64::consts::PI).abs() < 1e-15);
    assert_eq!(log.channels.iter().find(|c| c.name == "fx1_N").map(|c| c.unit.as_str()), Some("N"));
}

#[test]
fn dialects_and_decorations_are_accepted() {
    let folder = Folder::new();
    for table in [
        "\u{feff}t_s,q_m\n0,1.5\n0.5,2\n",
        "# made by K\n\"t_s\",\"q_m\"\r\n0,1.5\r\n# pause\r\n0.5,2\r\n\r\n",
        "t_s;q_m\n0;1,5\n0,5;2\n",
        "t_s\tq_m\n0\t1.5\n0.5\t2\n",
        " t_s , q_m \n 0 , 1.5 \n 0.5 , +2e0 ",
    ] {
        let log = folder.load(table).unwrap_or_else(|e| panic!("{table:?}: {e}")).remove(0);
        assert_eq!(log.time_s.as_deref(), Some(&[0.0, 0.5][..]), "{table:?}");
        assert_eq!(log.channel("q_m"), Some(&[1.5, 2.0][..]), "{table:?}");
    }
}

#[test]
fn trials_labels_and_selection_split_the_table() {
    let folder = Folder::new();
    let table = "mechanism,run,t_s,x_m,y_m,label\n\
                 door,00,0,1,2,free\ndoor,00,1,1,3,free\ndoor,01,0,5,5,turning\ndrawer,00,0,x,y,z\n";
    let meta = r#"{"columns":{"trial":"run"},"select":{"mechanism":"door"}}"#;
    let logs = folder.load_meta(table, meta).expect("loads");
    assert_eq!(logs.iter().map(|l| l.trial.clone().expect("a trial")).collect::<Vec<_>>(), ["00", "01"]);
    assert_eq!(logs[1].name, "log.csv, trial 01");
    assert_eq!(logs[1].channel("x_m"), Some(&[5.0][..]));
    assert_eq!(logs[0].labels, Some(["free"; 2].iter().collect()));
    let one = r#"{"columns":{"trial":"run"},"select":{"mechanism":"door","trial":1}}"#;
    assert_eq!(folder.load_meta(table, one).expect("loads").len(), 1);
}

#[test]
fn without_a_clock_the_rate_or_a_warning() {
    let folder = Folder::new();
    let table = "x_m,y_m\n0,1\n1,2\n";
    let log = folder.load_meta(table, r#"{"rate_hz": 20}"#).expect("loads").remove(0);
    assert_eq!(log.time_s.as_deref(), Some(&[0.0, 0.05][..]));
    let log = folder.load_meta(table, "{}").expect("loads").remove(0);
    assert!(log.time_s.is_none() && log.len() == 2);
    assert_eq!(log.warnings.iter().map(|w| w.kind.as_str()).collect::<Vec<_>>(), ["no-clock"]);
}

#[test]
fn text_columns_are_left_out_with_a_word() {
    let log = Folder::new().load("t_s,q_m,comment\n0,1,ok\n1,2,fine\n").expect("loads").remove(0);
    assert_eq!(log.channels.len(), 1);
    assert_eq!(log.warnings[0].kind, "text-column");
}

#[test]
fn a_channel_copied_from_another_trial_is_found_also_when_only_one_is_selected() {
    let folder = Folder::new();
    let mut table = "run,t_s,q_rad,tau_Nm\n".to_owned();
    for run in 0..3 {
        for i in 0..100 {
            let torque = (f64::from(i) * if run == 2 { 0.3 } else { 0.3 + 0.01 * f64::from(run) }).sin();
            let angle = f64::from(i * (run + 1)) * 0.01 + f64::from(run);
            let _ = writeln!(table, "{run},{},{angle},{torque}", f64::from(i) * 0.01);
        }
    }
    let meta = r#"{"columns":{"trial":"run"},"select":{"run":2}}"#;
    let log = folder.load_meta(&table, meta).expect("loads").remove(0);
    let copied: Vec<_> = log.warnings.iter().filter(|w| w.kind == "copied-channel").collect();
    assert_eq!(copied.len(), 1, "{:?}", log.warnings);
    assert!(copied[0].column.as_deref() == Some("tau_Nm") && copied[0].text.contains("trial 0"));
    let all = folder.load_meta(&table, r#"{"columns":{"trial":"run"}}"#).expect("loads");
    assert!(all[1].warnings.is_empty() && all[0].warnings.len() == 1);
    // The same runs, told by their clock.
    let lines = table.lines().map(|line| line.split_once(',').map_or("", |(_, rest)| rest));
    let apart = Folder::new().load(lines.collect::<Vec<_>>().join("\n")).expect("loads");
    let said = |log: &Recording| log.warnings.iter().filter(|w| w.kind == "copied-channel").count();
    assert_eq!(apart.iter().map(said).collect::<Vec<_>>(), [1, 0, 1]);
}

#[test]
fn a_recording_is_written_and_reads_back_to_the_same_bits() {
    let folder = Folder::new();
    let values = vec![0.1 + 0.2, -1e-300, 1.0 / 3.0, f64::MAX, 5e-324, 12_345.678_9];
    let channel = |name: &str, unit: &str| Channel { name: name.into(), unit: unit.into(), values: values.clone() };
    let mut meta: Meta = serde_json::from_str(r#"{"known":{"mass_kg":1.5},"scale":{"f_N":3}}"#).expect("a sidecar");
    let recording = Recording {
        name: "out.csv".to_owned(),
        trial: Some("a, \"b\"".to_owned()),
        time_s: Some((0..6).map(|i| f64::from(i) / 3.0).collect()),
        channels: vec![channel("q_m", "m"), channel("f_N", "N"), channel("oil_degC", "degC")],
        labels: Some(["free-motion"; 6].iter().collect()),
        meta: meta.clone(),
        warnings: Vec::new(),
    };
    let path = folder.0.path().join("out.csv");
    write_csv(&recording, &path).expect("writes");
    write_meta(&recording, &path).expect("writes");
    let mut back = load(&path, None).expect("reads").remove(0);
    meta.scale.clear();
    assert_eq!(back.meta, meta);
    back.meta = recording.meta.clone();
    back.warnings.clear();
    assert_eq!(back, recording);
}

proptest! {
    /// The answer is a recording or a sentence, whatever the bytes are.
    #[test]
    fn nothing_panics(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = Folder::new().load(bytes);
    }

    /// Nor does a table-like text, with a sidecar-like sidecar.
    #[test]
    fn no_table_panics(text in "(t_s|q_m|,|;|\n|\"|#|1|-|e|\\.|trial){0,80}", meta in "[{}\":,a-z_0-9]{0,30}") {
        let folder = Folder::new();
        folder.file("log.meta.json", meta);
        let _ = folder.load(text);
    }
}

#[test]
fn ticks_of_windows_and_of_dotnet_are_of_a_hundred_nanoseconds() {
    for (first, epoch) in [(133_600_000_000_000_000_u64, "1601"), (638_970_336_000_000_000, "year 1")] {
        let rows: Vec<String> = (0..50).map(|k| format!("{},{},1", first + 50_000 * k, k)).collect();
        let folder = tempfile::tempdir().expect("a temporary folder");
        let log = folder.path().join("log.csv");
        std::fs::write(&log, format!("Ticks,q_m,f_N\n{}\n", rows.join("\n"))).expect("writable");
        std::fs::write(sidecar_path(&log), r#"{"columns":{"t_s":"Ticks"}}"#).expect("writable");
        let one = load(&log, None).expect("reads").remove(0);
        assert!((one.rate_hz().expect("a rate") - 200.0).abs() < 1.0, "{:?}", one.rate_hz());
        assert!(one.warnings.iter().any(|w| w.text.contains(epoch)), "{:?}", one.warnings);
    }
}

#[test]
fn a_delimiter_behind_every_row_begins_no_cell() {
    let folder = Folder::new();
    let one = load(&folder.file("log.csv", "t_s,q_m\n0,1,\n0.1,2,\n0.2,3,\n"), None).expect("reads").remove(0);
    assert_eq!(one.channel("q_m"), Some(&[1.0, 2.0, 3.0][..]));
    let error = load(&folder.file("other.csv", "t_s,q_m\n0,1,5\n0.1,2,6\n0.2,3,7\n"), None).expect_err("refused");
    assert!(error.to_string().contains("has 3 cells and the header has 2"), "{error}");
}
