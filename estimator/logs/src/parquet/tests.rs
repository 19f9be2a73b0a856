//! Files as other programs write them: lists, members, decimals, half floats, old times, and packings.

use crate::{LogError, load};
use haptics::recording::Recording;
use parquet::basic::Compression;
use parquet::data_type::{
    ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArrayType, FloatType, Int32Type, Int64Type, Int96,
    Int96Type,
};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::fs::File;
use std::path::PathBuf;
use std::sync::Arc;

/// A file that is written column by column.
struct Out {
    folder: tempfile::TempDir,
    writer: SerializedFileWriter<File>,
}

/// Values of a column with their levels.
type Levels<'a, T> = (&'a [T], Option<&'a [i16]>, Option<&'a [i16]>);

impl Out {
    fn new(schema: &str, compression: Compression) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = File::create(folder.path().join("log.parquet")).expect("creates");
        let schema = Arc::new(parse_message_type(schema).expect("a schema"));
        let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
        Self { folder, writer: SerializedFileWriter::new(file, schema, properties).expect("a writer") }
    }

    /// One block of columns.
    fn block(&mut self, columns: &[&dyn Fn(&mut parquet::file::writer::SerializedColumnWriter<'_>)]) {
        let mut group = self.writer.next_row_group().expect("a block");
        for column in columns {
            let mut writer = group.next_column().expect("a column").expect("one more");
            column(&mut writer);
            writer.close().expect("closes");
        }
        group.close().expect("closes");
    }

    fn end(self) -> (tempfile::TempDir, PathBuf) {
        self.writer.close().expect("closes");
        let path = self.folder.path().join("log.parquet");
        (self.folder, path)
    }

    fn load(self, meta: &str) -> Result<Recording, LogError> {
        let (_folder, path) = self.end();
        let meta = serde_json::from_str(meta).expect("a sidecar");
        crate::load_with_meta(&path, &meta).map(|mut r| r.remove(0))
    }
}

fn put<T: DataType>(
    (values, levels, repeats): Levels<'_, T::T>,
) -> impl Fn(&mut parquet::file::writer::SerializedColumnWriter<'_>) {
    move |writer| {
        writer.typed::<T>().write_batch(values, levels, repeats).expect("writes");
    }
}

fn said(log: &Recording, words: &str) -> bool {
    log.warnings.iter().any(|w| w.text.contains(words))
}

const STATE: &str = "message m {
    required double timestamp;
    optional group observation.state (LIST) { repeated group list { optional float element; } }
}";

#[test]
fn a_list_is_one_column_an_item() {
    let mut out = Out::new(STATE, Compression::SNAPPY);
    for start in [0.0_f32, 2.0] {
        let time = [f64::from(start), f64::from(start) + 1.0];
        let values = [start, start + 10.0, start + 1.0, start + 11.0];
        let state = put::<FloatType>((&values, Some(&[3; 4]), Some(&[0, 1, 0, 1])));
        out.block(&[&put::<DoubleType>((&time, None, None)), &state]);
    }
    let log = out.load(r#"{"columns": {"t_s": "timestamp", "q_rad": "observation.state[1]"}}"#).expect("loads");
    assert_eq!(log.channel("q_rad"), Some([10.0, 11.0, 12.0, 13.0].as_slice()));
    assert_eq!(log.channel("observation.state[0]"), Some([0.0, 1.0, 2.0, 3.0].as_slice()));
}

#[test]
fn lists_that_differ_in_length_are_named_and_long_ones_left_out() {
    let mut out = Out::new(STATE, Compression::UNCOMPRESSED);
    // [5], [6, null], none at all, [], [7, 8].
    let values = [5.0_f32, 6.0, 7.0, 8.0];
    let state = put::<FloatType>((&values, Some(&[3, 3, 2, 0, 1, 3, 3]), Some(&[0, 0, 1, 0, 0, 0, 1])));
    out.block(&[&put::<DoubleType>((&[0.0, 1.0, 2.0, 3.0, 4.0], None, None)), &state]);
    let (_folder, path) = out.end();
    let size = std::fs::metadata(&path).expect("there").len();
    let (raw, _, notes) = super::read(&path, size, &crate::Watch::none()).expect("reads");
    assert_eq!(raw.headers, ["timestamp", "observation.state[0]", "observation.state[1]"]);
    let cells = |column: usize| (0..5).map(|row| raw.columns[column].text(row)).collect::<Vec<_>>();
    assert_eq!(cells(1), ["5", "6", "", "", "7"]);
    assert_eq!(cells(2), ["", "", "", "", "8"]);
    assert!(notes.iter().any(|w| w.text.contains("holds lists of 0 to 2 items")), "{notes:?}");

    let mut out = Out::new(STATE, Compression::UNCOMPRESSED);
    let (values, mut repeats) = ([1.0_f32; 65], [1; 65]);
    repeats[0] = 0;
    let state = put::<FloatType>((&values, Some(&[3; 65]), Some(&repeats)));
    out.block(&[&put::<DoubleType>((&[0.0], None, None)), &state]);
    let log = out.load("{}").expect("loads");
    assert!(said(&log, "`observation.state` is not read: it holds lists of 65 items"), "{:?}", log.warnings);
}

#[test]
fn kinds_of_numbers_that_other_programs_write() {
    let schema = "message m {
        required int96 stamp;
        required fixed_len_byte_array(2) f_N (FLOAT16);
        required int32 q_m (DECIMAL(9, 2));
        required group pose { required double z; }
        required group facts (MAP) { repeated group key_value { required binary key (UTF8); required double value; } }
    }";
    let mut out = Out::new(schema, Compression::UNCOMPRESSED);
    // Julian day 2 440 588 is 1970-01-01; the second row is after midnight.
    let late = 86_399_999_000_000_u64;
    let stamps = [(late, 2_460_000), (1_000_000, 2_460_001)]
        .map(|(ns, day)| Int96::from(vec![(ns & 0xffff_ffff) as u32, (ns >> 32) as u32, day]));
    let halves = [[0x00, 0x3c], [0x00, 0xc0]].map(|bytes: [u8; 2]| ByteArray::from(bytes.to_vec()).into());
    out.block(&[
        &put::<Int96Type>((&stamps, None, None)),
        &put::<FixedLenByteArrayType>((&halves, None, None)),
        &put::<Int32Type>((&[125, -50], None, None)),
        &put::<DoubleType>((&[3.0, 4.0], None, None)),
        &put::<ByteArrayType>((&[ByteArray::from("a"), ByteArray::from("a")], Some(&[1; 2]), Some(&[0; 2]))),
        &put::<DoubleType>((&[1.0, 2.0], Some(&[1; 2]), Some(&[0; 2]))),
    ]);
    let log = out.load(r#"{"columns": {"t_s": "stamp"}}"#).expect("loads");
    assert_eq!(log.time_s, Some(vec![0.0, 0.002]));
    assert_eq!(log.channel("f_N"), Some([1.0, -2.0].as_slice()));
    assert_eq!(log.channel("q_m"), Some([1.25, -0.5].as_slice()));
    assert_eq!(log.channel("pose.z"), Some([3.0, 4.0].as_slice()));
    assert!(said(&log, "`facts.key_value.value` is not read: it holds a map"), "{:?}", log.warnings);
}

/// The type of a time states its unit, whatever its name says.
#[test]
fn times_of_the_day_are_seconds() {
    let schema =
        "message m { required int64 stamp_ms (TIME_MICROS); required int32 other (TIME_MILLIS); required double q_m; }";
    let mut out = Out::new(schema, Compression::UNCOMPRESSED);
    out.block(&[
        &put::<Int64Type>((&[5_000_000, 5_010_000], None, None)),
        &put::<Int32Type>((&[7, 9], None, None)),
        &put::<DoubleType>((&[1.0, 2.0], None, None)),
    ]);
    let log = out.load(r#"{"columns": {"t_s": "stamp_ms"}}"#).expect("loads");
    assert_eq!(log.time_s, Some(vec![5.0, 5.01]));
    assert_eq!(log.channel("other_s"), Some([0.007, 0.009].as_slice()));
}

#[test]
fn brotli_is_read_and_a_packing_that_is_not_is_no_damage() {
    let schema = "message m { required double t_s; required double q_m; }";
    let time: Vec<f64> = (0..100).map(f64::from).collect();
    let mut out = Out::new(schema, Compression::BROTLI(parquet::basic::BrotliLevel::default()));
    out.block(&[&put::<DoubleType>((&time, None, None)), &put::<DoubleType>((&time, None, None))]);
    let (_folder, path) = out.end();
    let log = load(&path, None).expect("loads").remove(0);
    assert_eq!(log.channel("q_m"), Some(time.as_slice()));
    // The codec of a column in the footer: field 4 after the path `t_s`, `q_m`. Brotli is 4, LZO 3; 9 is none.
    let whole = std::fs::read(&path).expect("reads");
    for (codec, words) in [(3_u8, "compressed with lzo"), (9, "compressed with codec 9")] {
        let mut other = whole.clone();
        let mut at = 0;
        for name in [b"t_s", b"q_m"] {
            let place = other.windows(5).rposition(|w| w[..3] == *name && w[3] == 0x15).expect("a column's facts");
            at = place + 4;
            assert_eq!(other[at], 2 * 4, "brotli, as a number with its sign in the last bit");
            other[at] = 2 * codec;
        }
        assert!(at > 0);
        std::fs::write(&path, &other).expect("writes");
        let text = load(&path, None).expect_err("not read").to_string();
        assert!(text.contains(words) && text.contains("write it with zstd or snappy"), "{text}");
        assert!(!text.contains("damaged"), "{text}");
    }
}

#[test]
fn units_in_the_metadata_are_those_of_the_columns() {
    for (key, value) in [
        ("units", r#"{"time":"s","position":"mm","force":"kN"}"#),
        ("PANDAS_ATTRS", r#"{"units":{"time":"s","position":"mm","force":"kN"}}"#),
    ] {
        let schema = "message s { required double time; required double position; required double force; }";
        let mut out = Out::new(schema, Compression::UNCOMPRESSED);
        let entry = parquet::file::metadata::KeyValue::new(key.to_owned(), value.to_owned());
        out.writer.append_key_value_metadata(entry);
        let column = |values: &'static [f64]| {
            move |writer: &mut parquet::file::writer::SerializedColumnWriter<'_>| {
                writer.typed::<DoubleType>().write_batch(values, None, None).expect("written");
            }
        };
        out.block(&[&column(&[0.0, 0.1, 0.2]), &column(&[5.0, 6.0, 7.0]), &column(&[1.0, 2.0, 3.0])]);
        out.writer.close().expect("closes");
        let log = out.folder.path().join("log.parquet");
        let sidecar = r#"{"columns":{"t_s":"time","q_m":"position","f_N":"force"}}"#;
        std::fs::write(crate::sidecar_path(&log), sidecar).expect("writable");
        let read = load(&log, None).expect("read").remove(0);
        assert_eq!((read.channel("q_m").expect("q")[1], read.channel("f_N").expect("f")[1]), (0.006, 2000.0), "{key}");
    }
}

#[test]
fn rows_with_a_value_that_is_stated_to_be_missing_are_left_out() {
    let read = |pushed: &[f64], meta: &str| {
        let schema = "message m { required double t_s; required double q_m; required double f_N; }";
        let mut out = Out::new(schema, Compression::SNAPPY);
        let column = |values| put::<DoubleType>((values, None, None));
        out.block(&[&column(&[0.0, 0.1, 0.2, 0.3]), &column(&[1.0, 2.0, 4.0, 3.0]), &column(pushed)]);
        out.load(meta).map_err(|error| error.to_string())
    };
    let refused = read(&[5.0, f64::NAN, 6.0, 7.0], "{}").expect_err("no number");
    assert!(refused.contains("\"missing\": [\"NaN\"] in the sidecar"), "{refused}");
    let log = read(&[5.0, f64::NAN, 6.0, 7.0], r#"{"missing": ["NaN"]}"#).expect("loads");
    assert_eq!(log.channel("q_m"), Some(&[1.0, 4.0, 3.0][..]));
    assert!(said(&log, "1 row(s) without a value of `f_N` are left out"), "{:?}", log.warnings);
    let refused = read(&[f64::NAN; 4], r#"{"missing": ["NaN"]}"#).expect_err("no value at all");
    assert!(refused.contains("no row holds a value"), "{refused}");
}

/// pandas keeps an index without a name as `__index_level_0__`.
#[test]
fn the_index_of_a_data_frame_is_a_clock() {
    let schema = "message m {
        required double q_m;
        required int64 __index_level_0__ (TIMESTAMP_MICROS);
    }";
    let mut out = Out::new(schema, Compression::SNAPPY);
    let stamps = [1_744_902_008_000_000_i64, 1_744_902_008_005_000, 1_744_902_008_010_000];
    let stamps = put::<Int64Type>((&stamps, None, None));
    out.block(&[&put::<DoubleType>((&[1.0, 2.0, 4.0], None, None)), &stamps]);
    let log = out.load(r#"{"columns": {"t_s": "index_s"}}"#).expect("loads");
    let time = log.time_s.as_ref().expect("a clock");
    assert!((time[2] - time[0] - 0.01).abs() < 1e-9 && log.channel("q_m") == Some(&[1.0, 2.0, 4.0]));
}
