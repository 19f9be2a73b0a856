//! Refusals and doubts about statements of a sidecar.

use super::*;
use haptics::recording::Channel;

fn meta(json: &str) -> Meta {
    serde_json::from_str(json).expect("a sidecar")
}

fn recording(columns: &[&str], json: &str) -> Recording {
    let channel = |name: &&str| {
        let unit = units::split(name).map_or(String::new(), |(_, u)| u.si.to_owned());
        Channel { name: (*name).to_owned(), unit, values: vec![0.0, 1.0, 2.0] }
    };
    Recording {
        time_s: Some(vec![0.0, 0.01, 0.02]),
        channels: columns.iter().map(channel).collect(),
        meta: meta(json),
        ..Recording::default()
    }
}

#[test]
fn nonsense_is_refused_by_name() {
    for (json, words) in [
        (r#"{"gravity_m_s2": 0}"#, "gravity_m_s2 is 0"),
        (r#"{"gravity_m_s2": -9.81}"#, "\"up\": \"none\""),
        (r#"{"up": "sideways"}"#, "up is \"sideways\""),
        (r#"{"known": {"mass_kg": -2}}"#, "known mass_kg is -2"),
        (r#"{"known": {"coulomb_N": -1}}"#, "0 or more"),
        (r#"{"hand": {"link_m": 0}}"#, "link_m of hand is 0"),
    ] {
        let text = complaint(&meta(json)).unwrap_or_else(|| panic!("{json} must be refused"));
        assert!(text.contains(words), "{text}");
    }
    let fine = r#"{"gravity_m_s2": 1.62, "up": "-z", "known": {"offset_N": -3, "weight_N": 0, "com_m": 0.2}}"#;
    assert_eq!(complaint(&meta(fine)), None);
}

#[test]
fn a_wrong_type_is_told_in_plain_words() {
    for (json, words) in [
        (r#"{"rate_hz": "fast"}"#, "rate_hz is the text \"fast\" and must be a number"),
        (r#"{"known": {"mass_kg": [1]}}"#, "known of mass_kg is a list and must be a number"),
        (r#"{"hand": {"base1_m": 3}}"#, "hand of base1_m is 3 and must be two numbers in brackets"),
        (r#"{"columns": ["t_s"]}"#, "columns is a list and must be an object in braces"),
        (r#"{"task": "juggling"}"#, "task is the text \"juggling\" and must be one of block-stack"),
        (r"[1, 2]", "it holds a list"),
    ] {
        let value: Value = serde_json::from_str(json).expect("JSON");
        let text = wrong_type(&value).unwrap_or_else(|| panic!("{json} must be refused"));
        assert!(text.contains(words), "{text}");
    }
    let fine = r#"{"rate_hz": null, "select": {"trial": 1, "who": "K"}, "operator": [1], "up": "y"}"#;
    assert_eq!(wrong_type(&serde_json::from_str(fine).expect("JSON")), None);
}

#[test]
fn an_axis_that_would_be_ignored_is_refused() {
    let up = |columns: &[&str], json: &str| up_not_honoured(&recording(columns, json));
    assert!(up(&["x1_m"], r#"{"up": "x"}"#).is_some_and(|t| t.contains("y up")));
    assert!(up(&["x1_m"], r#"{"task": "block-stack", "up": "none"}"#).is_some());
    assert!(up(&["x1_m"], r#"{"task": "barrel", "up": "-x"}"#).is_some_and(|t| t.contains("barrels")));
    assert!(up(&["x1_m"], r#"{"task": "crank", "up": "none"}"#).is_some_and(|t| t.contains("weight_N")));
    assert_eq!(up(&["x1_m"], r#"{"task": "crank", "up": "-y"}"#), None);
    assert_eq!(up(&["q_rad"], r#"{"up": "none"}"#), None);
    assert_eq!(up(&["x_m", "y_m", "z_m"], r#"{"up": "z"}"#), None);
    assert!(up(&["x_m", "y_m", "z_m"], r#"{"task": "needle", "up": "z"}"#).is_some_and(|t| t.contains("needles")));
}

#[test]
fn doubts_name_what_they_are_about() {
    let said = |columns: &[&str], json: &str| -> Vec<String> {
        doubts(&recording(columns, json)).into_iter().map(|w| w.text).collect()
    };
    assert!(said(&["q_m"], r#"{"rate_hz": 100, "known": {"mass_kg": 1}}"#).is_empty());
    let found = said(&["q_m"], r#"{"rate_hz": 5000, "foo": 1, "known": {"masss_kg": 1}}"#);
    assert!(found.len() == 3 && found[0].contains("`foo`") && found[1].contains("`masss_kg`"), "{found:?}");
    assert!(found[2].contains("rate_hz is 5000") && found[2].contains("100.0000 Hz"), "{found:?}");
    let found = said(&["qb1_rad", "qt1_rad"], "{}");
    assert!(found.len() == 1 && found[0].contains("80 mm") && found[0].contains("-40"), "{found:?}");
    let hand = r#"{"hand": {"link_m": 0.1, "base_m": [0, 0]}}"#;
    assert!(said(&["qb_rad", "qt_rad"], hand).is_empty());
}
