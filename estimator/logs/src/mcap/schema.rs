//! The protobuf message that a row of ours is, with its descriptor and its encoding.

use crate::rows::Value;
use prost_reflect::prost::{Message as _, encoding};
use prost_reflect::prost_types::field_descriptor_proto::{Label, Type};
use prost_reflect::prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeMap;

/// Full name of the message.
pub const MESSAGE: &str = "touchstone.Sample";

/// The columns of a file that we write.
pub struct RowSchema {
    /// Serialised `FileDescriptorSet`.
    pub descriptor: Vec<u8>,
    /// Column name by the field's name.
    pub columns: BTreeMap<String, String>,
}

impl RowSchema {
    /// A message with one field a column: (name, true for text).
    pub fn new(columns: &[(String, bool)]) -> Self {
        let mut by_field = BTreeMap::new();
        let mut fields = Vec::new();
        for (index, (column, text)) in columns.iter().enumerate() {
            let mut name = identifier(column);
            while by_field.contains_key(&name) {
                name.push('_');
            }
            fields.push(FieldDescriptorProto {
                name: Some(name.clone()),
                number: Some(number(index).cast_signed()),
                label: Some(Label::Optional.into()),
                r#type: Some(if *text { Type::String } else { Type::Double }.into()),
                // The lower camel case that protobuf would make of it loses the unit.
                json_name: Some(name.clone()),
                ..FieldDescriptorProto::default()
            });
            by_field.insert(name, column.clone());
        }
        let message = DescriptorProto { name: Some("Sample".to_owned()), field: fields, ..DescriptorProto::default() };
        let file = FileDescriptorProto {
            name: Some("touchstone.proto".to_owned()),
            package: Some("touchstone".to_owned()),
            message_type: vec![message],
            syntax: Some("proto3".to_owned()),
            ..FileDescriptorProto::default()
        };
        Self { descriptor: FileDescriptorSet { file: vec![file] }.encode_to_vec(), columns: by_field }
    }
}

/// Field number of a column: from 1, without the range that protobuf keeps for itself.
fn number(index: usize) -> u32 {
    let number = index as u32 + 1;
    if number < 19_000 { number } else { number + 1_000 }
}

/// Appends the value of a column to a message. Zeros are written too: −0 is not nothing.
pub fn put(index: usize, value: &Value<'_>, message: &mut Vec<u8>) {
    match value {
        Value::Number(value) => encoding::double::encode(number(index), value, message),
        Value::Text(text) => encoding::string::encode(number(index), &(*text).to_owned(), message),
    }
}

/// JSON Schema of a row: (name, true for text) of each column.
pub fn of_json(columns: &[(String, bool)]) -> Vec<u8> {
    let kind = |is_text: bool| json!({ "type": if is_text { "string" } else { "number" } });
    let properties: Map<String, Json> = columns.iter().map(|(name, is_text)| (name.clone(), kind(*is_text))).collect();
    json!({ "type": "object", "title": MESSAGE, "properties": properties }).to_string().into_bytes()
}

/// Appends a row as an object of JSON. Every number has the shortest form that reads back to the same bits.
pub fn put_json<'v>(names: &[String], values: impl Iterator<Item = Value<'v>>, message: &mut Vec<u8>) {
    let member = |(name, value): (&String, Value<'_>)| {
        let value = match value {
            Value::Number(number) => json!(number),
            Value::Text(text) => json!(text),
        };
        (name.clone(), value)
    };
    let row: Map<String, Json> = names.iter().zip(values).map(member).collect();
    message.extend_from_slice(Json::Object(row).to_string().as_bytes());
}

/// A column's name as an identifier of protobuf.
fn identifier(column: &str) -> String {
    let mut name: String = column.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name.insert_str(0, "c_");
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers_and_stay_apart() {
        let columns = ["t_s", "fx1_N", "/left.wrench.force.x", "a b", "a-b", "2x"].map(|c| (c.to_owned(), false));
        let schema = RowSchema::new(&columns);
        let fields: Vec<&str> = schema.columns.keys().map(String::as_str).collect();
        assert_eq!(fields, ["a_b", "a_b_", "c_2x", "c__left_wrench_force_x", "fx1_N", "t_s"]);
        assert_eq!(schema.columns["a_b_"], "a-b");
        assert_eq!((number(0), number(18_998), number(18_999)), (1, 18_999, 20_000));
    }
}
