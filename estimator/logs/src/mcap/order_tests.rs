//! Joints that change places, messages that come twice, publishers that share a topic, and clocks that stand still.

use super::tests::{Out, names};
use haptics::recording::Recording;

const TASK: &str = r#"{"columns": {"q_rad": "/joints.position[elbow]", "tau_Nm": "/joints.effort[elbow]"}}"#;
const BY_PLACE: &str = r#"{"columns": {"q_rad": "/joints.position[0]", "tau_Nm": "/joints.effort[0]"}}"#;

/// A joint state in JSON, stamped every millisecond; the elbow stands at `row`, everything else below zero.
fn state(row: u64, joints: &[&str]) -> String {
    let value = |joint: &&str| if *joint == "elbow" { row.to_string() } else { format!("-{row}.5") };
    let values: Vec<String> = joints.iter().map(value).collect();
    format!(
        r#"{{"header": {{"stamp": {{"sec": 7, "nanosec": {}}}, "frame_id": "base"}}, "name": {joints:?}, "position": [{list}], "effort": [{list}]}}"#,
        row * 1_000_000,
        list = values.join(",")
    )
}

fn said(log: &Recording, words: &str) -> bool {
    log.warnings.iter().any(|w| w.text.contains(words))
}

fn angles(log: &Recording) -> Vec<f64> {
    log.channel("q_rad").expect("mapped").to_vec()
}

/// Two joints, which change places in the middle if `moves`.
fn two_joints(moves: bool) -> Out {
    let mut out = Out::new(None);
    let topic = out.json("/joints");
    for row in 0..40 {
        let order = if moves && row >= 20 { ["wrist", "elbow"] } else { ["elbow", "wrist"] };
        out.put(topic, 1_000 + row * 1_000_000, state(row, &order).as_bytes());
    }
    out
}

#[test]
fn a_joint_is_followed_by_its_name() {
    let log = two_joints(true).load(TASK).expect("loads");
    assert_eq!(angles(&log), (0..40).map(f64::from).collect::<Vec<_>>());
    assert!(said(&log, "change their order once, first in message 21"), "{:?}", log.warnings);
    assert!(names(&log).contains(&"/joints.position[wrist]"), "{:?}", names(&log));
}

#[test]
fn a_place_is_refused_where_names_change_and_means_the_joint_where_they_do_not() {
    let text = two_joints(true).load(BY_PLACE).expect_err("two joints in one column").to_string();
    for words in ["`/joints.effort[0]`", "map it by its name", "`/joints.effort[elbow]` or `/joints.effort[wrist]`"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let log = two_joints(false).load(BY_PLACE).expect("loads");
    assert_eq!(angles(&log), (0..40).map(f64::from).collect::<Vec<_>>());
}

#[test]
fn a_message_that_is_stored_twice_counts_once() {
    let mut out = Out::new(None);
    let topic = out.json("/joints");
    for row in 0..40_u64 {
        for copy in 0..2 {
            out.put(topic, row * 1_000_000 + copy * 7, state(row, &["elbow", "wrist"]).as_bytes());
        }
    }
    let log = out.load(TASK).expect("loads");
    assert_eq!(log.len(), 40);
    assert!(said(&log, "40 of 80 messages are stored twice"), "{:?}", log.warnings);
}

#[test]
fn one_stamp_that_repeats_costs_one_row() {
    let mut out = Out::new(None);
    let topic = out.json("/joints");
    for row in 0..200 {
        let mut text = state(row, &["elbow", "wrist"]);
        if row == 90 {
            text = text.replace(&format!(r#""nanosec": {}"#, 90_000_000), &format!(r#""nanosec": {}"#, 89_000_000));
        }
        out.put(topic, row * 1_000_000 + row % 3 * 400_000, text.as_bytes());
    }
    let log = out.load(TASK).expect("loads");
    let time = log.time_s.clone().expect("a clock");
    assert_eq!((log.len(), time[89], time[90], time[198]), (199, 0.089, 0.091, 0.199));
    assert!(said(&log, "1 of 200 messages is left out") && said(&log, "message 91"), "{:?}", log.warnings);
    assert!(said(&log, "the time is the stamp"), "{:?}", log.warnings);
}

#[test]
fn stamps_that_stand_still_are_named_and_the_log_time_counts() {
    let mut out = Out::new(None);
    let topic = out.json("/joints");
    for row in 0..40 {
        out.put(topic, row * 2_000_000, state(0, &["elbow", "wrist"]).replace("[0,", &format!("[{row},")).as_bytes());
    }
    let log = out.load(TASK).expect("loads");
    assert_eq!(log.time_s.as_ref().map(|t| t[39]), Some(0.078));
    assert!(said(&log, "the stamp in the messages stands still and is not used"), "{:?}", log.warnings);
}

#[test]
fn a_rate_stands_for_log_times_that_are_all_zero() {
    let out = |other: bool| {
        let mut out = Out::new(None);
        let topic = out.json("/log");
        let extra = other.then(|| out.json("/room"));
        for row in 0..40 {
            out.put(topic, 0, format!(r#"{{"q_m": {}, "f_N": 1}}"#, row / 2).as_bytes());
            if let Some(extra) = extra {
                out.put(extra, 0, br#"{"oil_degC": 20}"#);
            }
        }
        out
    };
    for other in [false, true] {
        let log = out(other).load(r#"{"rate_hz": 100}"#).expect("loads");
        assert_eq!((log.len(), log.time_s.as_ref().map(|t| t[39])), (40, Some(0.39)), "held values are no copies");
        assert!(said(&log, "the time is made from the sidecar's rate_hz"), "{:?}", log.warnings);
    }
    let text = out(false).load("{}").expect_err("no clock").to_string();
    assert!(text.contains("the log time stands still in /log") && text.contains("rate_hz"), "{text}");
    assert!(!text.contains("sort"), "{text}");
}

#[test]
fn publishers_of_different_joints_are_sources_of_their_own() {
    let mut out = Out::new(None);
    let topic = out.json("/joints");
    for row in 0..200 {
        out.put(topic, row * 1_000_000, state(row, &["elbow", "wrist"]).as_bytes());
        if row % 3 == 0 {
            out.put(topic, row * 1_000_000 + 5, state(row, &["jaw"]).as_bytes());
        }
    }
    let log = out.load(TASK).expect("loads");
    let time = log.time_s.clone().expect("a clock");
    // The jaw ends one message earlier, and nothing is extrapolated.
    assert_eq!((log.len(), time[1], angles(&log)[50]), (199, 0.001, 50.0));
    assert!(names(&log).contains(&"/joints.position[jaw]"), "{:?}", names(&log));
    assert!(said(&log, "2 kinds of messages"), "{:?}", log.warnings);
}

#[test]
fn a_topic_may_carry_positions_and_forces_in_turn() {
    let mut out = Out::new(None);
    let topic = out.json("/log");
    for row in 0..100_u64 {
        let value = if row % 2 == 0 { format!(r#""place_m": {row}"#) } else { format!(r#""f_N": {row}"#) };
        out.put(topic, row, format!(r#"{{"t_s": {}, {value}}}"#, row as f64 * 0.01).as_bytes());
    }
    let log = out.load(r#"{"columns": {"q_m": "place_m"}}"#).expect("loads");
    // Both rise by one a row; the first position has no force before it.
    let (place, force) = (log.channel("q_m").expect("mapped"), log.channel("f_N").expect("there"));
    assert_eq!((log.len(), place[0]), (49, 2.0));
    assert!(place.iter().zip(force).all(|(a, b)| (a - b).abs() < 1e-9), "{force:?}");
}

#[test]
fn of_publishers_that_talk_at_the_same_time_the_one_with_most_messages_is_read() {
    let mut out = Out::new(None);
    let (one, two) = (out.json("/joints"), out.channel("/joints", "json", ("y", "jsonschema", b"{}")));
    for row in 0..40 {
        out.put(one, row * 1_000_000, state(row, &["elbow", "wrist"]).as_bytes());
        if row % 2 == 0 {
            out.put(two, row * 1_000_000 + 9, state(900 - row, &["elbow", "wrist"]).as_bytes());
        }
    }
    let log = out.load(TASK).expect("loads");
    assert_eq!(angles(&log), (0..40).map(f64::from).collect::<Vec<_>>());
    assert!(said(&log, "2 publishers") && said(&log, "20 of 60 messages are left out"), "{:?}", log.warnings);
}

/// Two topics of numbers: a position every 4 ms, and a force every 2 ms whose log time is given in nanoseconds.
fn pushed(log_ns: impl Fn(u64) -> u64, unit: &str) -> Out {
    let mut out = Out::new(None);
    let (place, force) = (out.json("/pos"), out.json("/ft"));
    let mut messages: Vec<(u64, u16, String)> =
        (0..500).map(|k| (k * 4_000_000, place, format!(r#"{{"value": {k}}}"#))).collect();
    messages.extend((0..1000).map(|k| (log_ns(k), force, format!(r#"{{"value": {}{unit}}}"#, 0.5 * k as f64))));
    messages.sort_by_key(|(log_ns, ..)| *log_ns);
    for (log_ns, topic, text) in &messages {
        out.put(*topic, 1_000_000_000 + log_ns, text.as_bytes());
    }
    out
}

const PUSHED: &str = r#"{"columns": {"q_m": "/pos.value", "f_N": "/ft.value"}}"#;

#[test]
fn a_topic_in_bursts_is_spread_before_it_meets_the_others() {
    // Packets of ten, every 20 ms; in one log their times repeat.
    for within_ns in [15_000, 0] {
        let log = pushed(|k| (k / 10 + 1) * 20_000_000 + (k % 10) * within_ns, "").load(PUSHED).expect("loads");
        assert!(said(&log, "the topic /ft: the stamps come in bursts of 10 samples"), "{:?}", log.warnings);
        let (q, f) = (log.channel("q_m").expect("mapped"), log.channel("f_N").expect("mapped"));
        // The force is late by one packet, and a line otherwise; the low-pass rings at its ends.
        let off = q.iter().zip(f).skip(40).take(400).map(|(q, f)| (f - (q - 5.0)).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{off}");
    }
}

#[test]
fn messages_that_nearly_coincide_make_no_spikes() {
    let late = |k: u64| k * 2_000_000 + if k % 7 == 3 { 1_999_000 } else { 0 };
    let log = pushed(late, "").load(PUSHED).expect("loads");
    let f = log.channel("f_N").expect("mapped");
    assert!(f.windows(2).all(|w| (w[1] - w[0]).abs() < 3.0), "{f:?}");
}

#[test]
fn a_unit_beside_a_value_is_used() {
    let log = pushed(|k| k * 2_000_000, r#", "unit": "kN""#).load(PUSHED).expect("loads");
    let (q, f) = (log.channel("q_m").expect("mapped"), log.channel("f_N").expect("mapped"));
    // The low-pass rings at its ends.
    assert!(q.iter().zip(f).skip(40).take(400).all(|(q, f)| (f - 1e3 * q).abs() < 1e-3), "{:?}", &f[..60]);
    assert!(!said(&log, "unit` holds text"), "{:?}", log.warnings);
}

#[test]
fn a_unit_in_the_schema_is_used() {
    let schema = br#"{"properties": {"pos": {"type": "number", "unit": "mm"}, "load": {"description": "load in kN"}}}"#;
    let mut out = Out::new(None);
    let topic = out.channel("/press", "json", ("Press", "jsonschema", schema));
    for row in 0..60 {
        out.put(topic, row * 4_000_000, format!(r#"{{"pos": {row}, "load": {row}}}"#).as_bytes());
    }
    let log = out.load(r#"{"columns": {"q_m": "pos", "f_N": "load"}}"#).expect("loads");
    let last = |name: &str| log.channel(name).and_then(<[f64]>::last).copied().expect("a value");
    assert!((last("q_m") - 0.059).abs() < 1e-12 && (last("f_N") - 59_000.0).abs() < 1e-6);
}

#[test]
fn a_number_that_counts_since_1970_is_a_stamp() {
    for (name, unit_ns) in [("timestamp", 1_000_000_u64), ("timestamp_us", 1_000), ("stamp", 1_000_000_000)] {
        let mut out = Out::new(None);
        let topic = out.json("/pos");
        for row in 0..60 {
            let stamp = (1_750_000_000_000_000_000 + row * 4_000_000) as f64 / unit_ns as f64;
            // The log is late now and then.
            let log_ns = 9_000_000_000 + row * 4_000_000 + (row % 3) * 1_500_000;
            out.put(topic, log_ns, format!(r#"{{"{name}": {stamp:?}, "value": {row}}}"#).as_bytes());
        }
        let log = out.load(r#"{"columns": {"q_m": "value"}}"#).expect("loads");
        let time = log.time_s.as_ref().expect("a clock");
        let off = time.iter().enumerate().map(|(row, t)| (t - 0.004 * row as f64).abs()).fold(0.0, f64::max);
        // A double holds seconds since 1970 to a quarter of a microsecond.
        assert!(off < 5e-7 && said(&log, "the time is the stamp in the messages"), "{name}: {off}, {:?}", log.warnings);
        assert_eq!(names(&log), ["q_m"]);
    }
}
