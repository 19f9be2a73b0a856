//! Files as other programs write them, and files that are broken.

use super::schema::RowSchema;
use crate::{LogError, load, load_with_meta};
use ::mcap::{Compression, WriteOptions, Writer, records::MessageHeader};
use haptics::recording::{Meta, Recording};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

const JOINT_STATE: &str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n\
    ================================================================================\nMSG: std_msgs/Header\n\
    builtin_interfaces/Time stamp\nstring frame_id\n\
    ================================================================================\nMSG: builtin_interfaces/Time\n\
    int32 sec\nuint32 nanosec\n";
const WRENCH_STAMPED: &str = "std_msgs/Header header\nWrench wrench\n\
    ================================================================================\nMSG: geometry_msgs/Wrench\n\
    Vector3  force\nVector3  torque\n\
    ================================================================================\nMSG: geometry_msgs/Vector3\n\
    float64 x\nfloat64 y\nfloat64 z\n\
    ================================================================================\nMSG: std_msgs/Header\n\
    builtin_interfaces/Time stamp\nstring frame_id\n";

pub(super) struct Out {
    folder: tempfile::TempDir,
    writer: Writer<BufWriter<File>>,
}

impl Out {
    pub(super) fn new(compression: Option<Compression>) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = BufWriter::new(File::create(folder.path().join("log.mcap")).expect("creates"));
        let writer = WriteOptions::new().compression(compression).chunk_size(Some(4096)).create(file).expect("an MCAP");
        Self { folder, writer }
    }

    pub(super) fn channel(&mut self, topic: &str, encoding: &str, schema: (&str, &str, &[u8])) -> u16 {
        let (name, kind, data) = schema;
        let id = if kind.is_empty() { 0 } else { self.writer.add_schema(name, kind, data).expect("a schema") };
        self.writer.add_channel(id, topic, encoding, &BTreeMap::new()).expect("a channel")
    }

    pub(super) fn json(&mut self, topic: &str) -> u16 {
        self.channel(topic, "json", ("x", "jsonschema", br#"{"type":"object"}"#))
    }

    pub(super) fn put(&mut self, channel_id: u16, log_time: u64, data: &[u8]) {
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        self.writer.write_to_known_channel(&header, data).expect("a message");
    }

    fn end(mut self) -> (tempfile::TempDir, PathBuf) {
        self.writer.finish().expect("finishes");
        drop(self.writer);
        let path = self.folder.path().join("log.mcap");
        (self.folder, path)
    }

    pub(super) fn load(self, meta: &str) -> Result<Recording, LogError> {
        let (_folder, path) = self.end();
        let meta: Meta = serde_json::from_str(meta).expect("a sidecar");
        load_with_meta(&path, &meta).map(|mut r| r.remove(0))
    }
}

pub(super) fn names(recording: &Recording) -> Vec<&str> {
    recording.channels.iter().map(|c| c.name.as_str()).collect()
}

/// A CDR message: a stamp, a frame, then whatever `body` appends (aligned by itself to 8).
pub(super) struct Cdr(Vec<u8>);

impl Cdr {
    fn stamped(ns: u64) -> Self {
        let mut cdr = Self(Vec::new());
        cdr.0.extend(((ns / 1_000_000_000) as i32).to_le_bytes());
        cdr.0.extend(((ns % 1_000_000_000) as u32).to_le_bytes());
        cdr.text("base");
        cdr
    }

    fn align(&mut self, size: usize) {
        self.0.resize(self.0.len().next_multiple_of(size), 0);
    }

    fn text(&mut self, text: &str) {
        self.align(4);
        self.0.extend((text.len() as u32 + 1).to_le_bytes());
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn count(&mut self, n: usize) {
        self.align(4);
        self.0.extend((n as u32).to_le_bytes());
    }

    fn number(&mut self, value: f64) {
        self.align(8);
        self.0.extend(value.to_le_bytes());
    }

    fn done(self) -> Vec<u8> {
        [&[0, 1, 0, 0], self.0.as_slice()].concat()
    }
}

#[test]
fn a_flat_json_topic_is_a_table_in_every_compression() {
    for compression in [None, Some(Compression::Lz4), Some(Compression::Zstd)] {
        let mut out = Out::new(compression);
        let topic = out.json("/log");
        for i in 0..500_u64 {
            let text = format!(r#"{{"t_s": {}, "q_mm": {i}, "f_N": -0.5, "label": "free"}}"#, i as f64 * 0.01);
            out.put(topic, i * 1000, text.as_bytes());
        }
        let log = out.load("{}").expect("loads");
        assert_eq!((log.len(), names(&log)), (500, vec!["q_m", "f_N"]));
        assert_eq!(log.channel("q_m").map(|q| q[499]), Some(0.499));
        assert_eq!(log.time_s.as_ref().map(|t| t[499]), Some(4.99));
        assert_eq!(log.labels.as_ref().map(|l| &l[3]), Some("free"));
    }
}

#[test]
fn the_log_time_is_the_clock_where_there_is_no_other_and_it_is_said() {
    let mut out = Out::new(None);
    let topic = out.json("/tip");
    for i in 0..10_u64 {
        out.put(topic, 1_700_000_000_000_000_000 + i * 2_000_000, br#"{"pose": {"x": 0.25, "y": 1}}"#);
    }
    let log = out.load(r#"{"columns": {"x_m": "/tip.pose.x", "y_m": "/tip.pose.y"}}"#).expect("loads");
    assert_eq!(log.time_s.as_ref().map(|t| (t[0], t[9])), Some((0.0, 0.018)));
    assert_eq!(log.channel("x_m").map(|x| x[3]), Some(0.25));
    assert!(log.warnings.iter().any(|w| w.text.contains("log time of /tip")), "{:?}", log.warnings);
}

#[test]
fn ros_topics_with_two_clocks_come_onto_that_of_the_motion() {
    let mut out = Out::new(Some(Compression::Zstd));
    let joints = out.channel("/joint_states", "cdr", ("sensor_msgs/msg/JointState", "ros2msg", JOINT_STATE.as_bytes()));
    let wrench = out.channel("/left", "cdr", ("geometry_msgs/msg/WrenchStamped", "ros2msg", WRENCH_STAMPED.as_bytes()));
    let start = 1_700_000_000_000_000_000_u64;
    let wave = |t: f64| (std::f64::consts::TAU * 2.0 * t).sin();
    for i in 0..4000_u64 {
        let (ns, t) = (i * 500_000, i as f64 * 5e-4);
        let mut message = Cdr::stamped(start + ns);
        for v in [wave(t), 2.0 * t, 0.0, 0.0, 0.0, 0.0] {
            message.number(v);
        }
        out.put(wrench, start + ns + 3_000_000, &message.done());
    }
    for i in 0..2600_u64 {
        let ns = 100_000_000 + i * 666_667;
        let mut message = Cdr::stamped(start + ns);
        message.count(2);
        message.text("shoulder");
        message.text("elbow");
        message.count(2);
        message.number(wave(ns as f64 * 1e-9));
        message.number(0.5);
        message.count(0);
        message.count(0);
        out.put(joints, start + ns + 1_000_000, &message.done());
    }
    let meta = r#"{"columns": {"q_rad": "/joint_states.position[shoulder]", "tau_Nm": "/left.wrench.force.x"}}"#;
    let log = out.load(meta).expect("loads");
    let time = log.time_s.clone().expect("a clock");
    assert_eq!(time[0], 0.1, "stamps count from the first one of all topics");
    assert_eq!(log.len(), 2600);
    let (angle, torque) = (log.channel("q_rad").expect("there"), log.channel("tau_Nm").expect("there"));
    let worst = angle.iter().zip(torque).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-3, "the same wave on both topics: {worst}");
    assert!(names(&log).contains(&"/joint_states.position[elbow]"), "{:?}", names(&log));
    let said = log.warnings.iter().find(|w| w.kind == "resampled").expect("said");
    assert!(
        said.text.contains("stamp") && said.text.contains("low-pass at 600") && said.text.contains("/left"),
        "{}",
        said.text
    );
}

#[test]
fn what_is_not_needed_gives_way() {
    let mut out = Out::new(None);
    let motion = out.json("/motion");
    let (late, odd) = (out.json("/late"), out.channel("/image", "jpeg", ("", "", b"")));
    for i in 0..100_u64 {
        out.put(motion, i * 1_000_000, br#"{"x_m": 1, "y_m": 2}"#);
        if i > 50 {
            out.put(late, i * 1_000_000 + 7, br#"{"oil_degC": 20}"#);
        }
    }
    out.put(odd, 5, b"x");
    let log = out.load("{}").expect("loads");
    assert_eq!((log.len(), names(&log)), (100, vec!["x_m", "y_m"]));
    for words in ["/late is not used", "/image is not read"] {
        assert!(log.warnings.iter().any(|w| w.text.contains(words)), "{words}: {:?}", log.warnings);
    }
}

#[test]
fn nested_lists_and_defaults_of_protobuf() {
    use prost_reflect::prost::Message as _;
    use prost_reflect::prost_types::field_descriptor_proto::{Label, Type};
    use prost_reflect::prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};
    let field = |name: &str, number: i32, kind: Type, list: bool, of: Option<&str>| FieldDescriptorProto {
        name: Some(name.to_owned()),
        number: Some(number),
        label: Some(if list { Label::Repeated } else { Label::Optional }.into()),
        r#type: Some(kind.into()),
        type_name: of.map(str::to_owned),
        ..FieldDescriptorProto::default()
    };
    let message = |name: &str, fields: Vec<FieldDescriptorProto>| DescriptorProto {
        name: Some(name.to_owned()),
        field: fields,
        ..DescriptorProto::default()
    };
    let file = FileDescriptorProto {
        name: Some("a.proto".to_owned()),
        package: Some("a".to_owned()),
        syntax: Some("proto3".to_owned()),
        message_type: vec![
            message("V", vec![field("x", 1, Type::Double, false, None), field("n", 2, Type::Sint32, false, None)]),
            message(
                "M",
                vec![
                    field("v", 1, Type::Message, false, Some(".a.V")),
                    field("list", 2, Type::Float, true, None),
                    field("each", 3, Type::Message, true, Some(".a.V")),
                    field("me", 4, Type::Message, false, Some(".a.M")),
                    field("word", 5, Type::String, false, None),
                ],
            ),
        ],
        ..FileDescriptorProto::default()
    };
    let set = FileDescriptorSet { file: vec![file] }.encode_to_vec();
    let mut out = Out::new(None);
    let topic = out.channel("/m", "protobuf", ("a.M", "protobuf", &set));
    // v { n: -2 }, list [1.5, 2] packed, each [ {x: 3}, {x: 4} ]
    let mut data = vec![0x0a, 2, 0x10, 3, 0x12, 8];
    data.extend(1.5_f32.to_le_bytes());
    data.extend(2.0_f32.to_le_bytes());
    for x in [3.0_f64, 4.0] {
        data.extend([0x1a, 9, 0x09]);
        data.extend(x.to_le_bytes());
    }
    for i in 0..3 {
        out.put(topic, i * 1_000_000, &data);
    }
    let log = out.load("{}").expect("loads");
    let value = |name: &str| log.channel(name).unwrap_or_else(|| panic!("{name} in {:?}", names(&log)))[1];
    assert_eq!([value("/m.v.x"), value("/m.v.n")], [0.0, -2.0], "an absent number is zero");
    assert_eq!([value("/m.list[0]"), value("/m.list[1]")], [1.5, 2.0]);
    assert_eq!([value("/m.each[0].x"), value("/m.each[1].x"), value("/m.each[1].n")], [3.0, 4.0, 0.0]);
    // Cut anywhere within a field, it is damaged; between fields it is a shorter message.
    for length in [1, 3, 5, 7, 15, 20] {
        let mut out = Out::new(None);
        let topic = out.channel("/m", "protobuf", ("a.M", "protobuf", &set));
        out.put(topic, 0, &data[..length]);
        let text = out.load("{}").expect_err("cut").to_string();
        assert!(text.contains("message 1 of /m"), "{length}: {text}");
    }
}

/// A sound file of two chunks, and how many bytes it has.
fn sound() -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let mut out = Out::new(Some(Compression::Lz4));
    let schema = RowSchema::new(&[("t_s".to_owned(), false), ("q_m".to_owned(), false)]);
    let topic = out.channel("/log", "protobuf", ("touchstone.Sample", "protobuf", &schema.descriptor));
    for i in 0..400_u64 {
        let mut data = vec![0x09];
        data.extend((i as f64).to_le_bytes());
        data.push(0x11);
        data.extend((i as f64).sin().to_le_bytes());
        out.put(topic, i * 1_000_000, &data);
    }
    let (folder, path) = out.end();
    let bytes = std::fs::read(&path).expect("reads");
    (folder, path, bytes)
}

fn refusal(path: &Path, bytes: &[u8]) -> String {
    std::fs::write(path, bytes).expect("writes");
    let text = load(path, None).expect_err("must be refused").to_string();
    assert!(text.ends_with("log.mcap") && !text.contains('\n'), "one sentence, the path last: {text}");
    text
}

#[test]
fn a_cut_file_is_refused_wherever_it_is_cut() {
    let (_folder, path, bytes) = sound();
    assert_eq!(load(&path, None).expect("whole").remove(0).len(), 400);
    // Shorter than the first bytes of the format it is no MCAP at all.
    for length in (5..bytes.len()).step_by(17).chain([8, bytes.len() - 1]) {
        let text = refusal(&path, &bytes[..length]);
        assert!(text.contains("ends in the middle"), "{length} of {}: {text}", bytes.len());
    }
}

#[test]
fn no_flipped_bit_panics_or_goes_unseen_in_a_block() {
    let (_folder, path, bytes) = sound();
    let mut refused = 0;
    for at in 0..bytes.len() {
        let mut broken = bytes.clone();
        broken[at] ^= 1 << (at % 8);
        std::fs::write(&path, &broken).expect("writes");
        match load(&path, None) {
            Ok(_) => {}
            Err(error) => {
                refused += 1;
                assert!(!error.to_string().contains('\n'), "{at}: {error}");
            }
        }
    }
    // Parts that may change unseen: indices, statistics, names without a checksum.
    assert!(2 * refused > bytes.len(), "{refused} of {} flips were seen", bytes.len());
}

#[test]
fn absurd_lengths_are_refused_before_anything_is_reserved() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("log.mcap");
    let record = |op: u8, body: &[u8]| {
        let mut bytes = vec![op];
        bytes.extend((body.len() as u64).to_le_bytes());
        bytes.extend(body);
        bytes
    };
    let chunk = |claimed: u64, compression: &str, data: &[u8]| {
        let mut body = [0_u64.to_le_bytes(), 0_u64.to_le_bytes(), claimed.to_le_bytes()].concat();
        body.extend(0_u32.to_le_bytes());
        body.extend((compression.len() as u32).to_le_bytes());
        body.extend(compression.as_bytes());
        body.extend((data.len() as u64).to_le_bytes());
        body.extend(data);
        record(6, &body)
    };
    let file = |rest: &[u8]| [::mcap::MAGIC, &record(1, &[0; 8]), rest].concat();
    assert!(refusal(&path, &file(&chunk(1 << 60, "zstd", b"x"))).contains("claims to unpack"));
    assert!(refusal(&path, &file(&chunk(100, "zstd", b"xyz"))).contains("cannot be unpacked"));
    assert!(refusal(&path, &file(&chunk(100, "lz4", b"xyz"))).contains("damaged"));
    assert!(refusal(&path, &file(&chunk(1, "rot13", b"x"))).contains("`rot13`"));
    assert!(refusal(&path, &file(&chunk(5, "", b"x"))).contains("claims 5"));
    let bomb = zstd::bulk::compress(&vec![0; 200 << 20], 3).expect("packs");
    assert!(refusal(&path, &file(&chunk(200 << 20, "zstd", &bomb))).contains("damaged"));
    let mut huge = vec![6];
    huge.extend(u64::MAX.to_le_bytes());
    assert!(refusal(&path, &file(&huge)).contains("ends in the middle"));
    // Within an uncompressed block: a record that is longer than the block.
    let mut inner = vec![5];
    inner.extend(1_000_u64.to_le_bytes());
    assert!(refusal(&path, &file(&chunk(9, "", &inner))).contains("ends within a record"));
    assert!(refusal(&path, b"\x89MCAP1\r\n").contains("version 0"));
}

#[test]
fn a_file_without_anything_readable_says_so() {
    let out = Out::new(None);
    assert!(out.load("{}").expect_err("no topics").to_string().contains("no topics"));
    let mut out = Out::new(None);
    let topic = out.channel("/image", "jpeg", ("", "", b""));
    out.put(topic, 0, b"x");
    assert!(out.load("{}").expect_err("an image").to_string().contains("/image is not read"));
    let mut out = Out::new(None);
    out.json("/log");
    assert!(out.load("{}").expect_err("no messages").to_string().contains("no samples"));
    let mut out = Out::new(None);
    let topic = out.json("/log");
    for _ in 0..3 {
        out.put(topic, 7, br#"{"q_m": 1}"#);
    }
    assert!(out.load("{}").expect_err("one time").to_string().contains("time stands still"));
}

#[test]
fn missing_and_odd_values_follow_the_rules_of_tables() {
    let table = |rows: &[&str]| {
        let mut out = Out::new(None);
        let topic = out.json("/log");
        for (i, row) in rows.iter().enumerate() {
            out.put(topic, i as u64, row.as_bytes());
        }
        out.load("{}").map_err(|e| e.to_string())
    };
    let text = table(&[r#"{"t_s":0,"q_m":1}"#, r#"{"t_s":1}"#]).expect_err("q_m is missing");
    assert!(text.contains("row 2, column `q_m`: there is no value"), "{text}");
    let text = table(&[r#"{"t_s":0,"q_m":1}"#, r#"{"t_s":1,"q_m":"wide"}"#]).expect_err("text");
    assert!(text.contains("row 2, column `q_m`: `wide` is not a number"), "{text}");
    let text = table(&[r#"{"t_s":0,"fx1_stone":1}"#]).expect_err("a unit");
    assert!(text.contains("unknown unit `stone`"), "{text}");
    let log = table(&[r#"{"t_s":0,"q_m":1,"note":"a"}"#, r#"{"t_s":1,"q_m":2,"oil_degC":3}"#]).expect("loads");
    assert_eq!(names(&log), ["q_m"]);
    assert_eq!(log.warnings.iter().filter(|w| w.kind == "text-column").count(), 2, "{:?}", log.warnings);
}
