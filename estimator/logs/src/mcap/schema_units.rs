//! Units that a schema states: a `"unit"` beside the type in a JSON schema, a comment behind a field of ROS 2.

use super::rosmsg::{Count, Definitions, Kind};
use super::topic::MAX_DEPTH;
use crate::written_units::{Written, in_header, parse};
use serde_json::Value as Json;
use std::collections::HashMap;

/// Text of the unit by the path of a field, in which `[]` stands for every item of a list.
pub type Units = HashMap<String, String>;

/// Keywords of a JSON schema that hold a unit. None is part of its standard.
const KEYWORDS: [&str; 4] = ["unit", "units", "x-unit", "x-units"];

/// Unit of a field; empty if the schema states none.
pub fn of<'a>(units: &'a Units, field: &str) -> &'a str {
    if units.is_empty() {
        return "";
    }
    let plain: String = field
        .split(']')
        .map(|part| part.split_once('[').map_or(part.to_owned(), |(name, _)| format!("{name}[]")))
        .collect();
    units.get(&plain).map_or("", String::as_str)
}

/// The units of a JSON schema.
pub fn of_json(schema: &[u8]) -> Units {
    let mut units = Units::new();
    if let Ok(schema) = serde_json::from_slice(schema) {
        walk_json(&schema, "", MAX_DEPTH, &mut units);
    }
    units
}

fn walk_json(schema: &Json, path: &str, depth: usize, units: &mut Units) {
    let Some(depth) = depth.checked_sub(1) else { return };
    let stated = KEYWORDS.iter().find_map(|keyword| schema.get(keyword)?.as_str());
    let described = || schema.get("description").and_then(Json::as_str).and_then(in_comment);
    if let Some(unit) = stated.or_else(described) {
        units.insert(path.to_owned(), unit.to_owned());
    }
    for (name, part) in schema.get("properties").and_then(Json::as_object).into_iter().flatten() {
        walk_json(part, &joined(path, name), depth, units);
    }
    if let Some(items) = schema.get("items") {
        // A unit beside a list is that of its items.
        if let Some(unit) = units.remove(path) {
            units.insert(format!("{path}[]"), unit);
        }
        walk_json(items, &format!("{path}[]"), depth, units);
    }
}

/// The units in the comments of a ROS 2 message.
pub fn of_ros(types: &Definitions) -> Units {
    let mut units = Units::new();
    walk_ros(types, &types.root, "", MAX_DEPTH, &mut units);
    units
}

fn walk_ros(types: &Definitions, message: &str, path: &str, depth: usize, units: &mut Units) {
    let Some(depth) = depth.checked_sub(1) else { return };
    for field in types.fields(message).unwrap_or_default() {
        let own = joined(path, &field.name);
        let own = if field.count == Count::One { own } else { format!("{own}[]") };
        match &field.kind {
            Kind::Primitive(_) => units.extend(in_comment(&field.comment).map(|unit| (own, unit.to_owned()))),
            Kind::Message(name) => walk_ros(types, name, &own, depth, units),
        }
    }
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

/// The known unit that a comment consists of, or names in brackets or behind *in*: `mm`, `force [kN]`, `load in kN`.
fn in_comment(comment: &str) -> Option<&str> {
    let is_known = |unit: &&str| matches!(parse(unit, &[]), Written::Known(..));
    Some(comment.trim()).filter(is_known).or_else(|| Some(in_header(comment, &[]).1).filter(is_known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_in_json_schemas() {
        let schema = br#"{"type":"object","properties":{
            "pos":{"type":"number","unit":"mm"},
            "load":{"type":"number","description":"load in kN"},
            "joints":{"type":"array","x-units":"deg","items":{"type":"number"}},
            "wrench":{"type":"object","properties":{"force":{"properties":{"x":{"units":"lbf"}}}}},
            "count":{"type":"integer","description":"number of the sample"}}}"#;
        let units = of_json(schema);
        let of = |field: &str| of(&units, field);
        assert_eq!([of("pos"), of("load"), of("joints[3]"), of("wrench.force.x")], ["mm", "kN", "deg", "lbf"]);
        assert_eq!([of("count"), of("other")], ["", ""]);
        assert!(of_json(b"{").is_empty());
    }

    #[test]
    fn units_stand_in_comments_of_ros_messages() {
        let text = "float64 place # mm\nfloat64[] forces # measured force [kN]\nint32 mode # 0 off, 1 on\na/Part part\n\
                    ===\nMSG: a/Part\nfloat64 angle # angle in deg\n";
        let units = of_ros(&Definitions::parse("a/msg/Sample", text).expect("parses"));
        let of = |field: &str| of(&units, field);
        assert_eq!([of("place"), of("forces[0]"), of("part.angle"), of("mode")], ["mm", "kN", "deg", ""]);
    }
}
