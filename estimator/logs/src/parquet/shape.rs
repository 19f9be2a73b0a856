//! Names of the columns that a file nests: `a.b` for a member, `state[0]` for an item of a list.

use parquet::basic::{ConvertedType, LogicalType, Repetition};
use parquet::schema::types::{ColumnDescriptor, SchemaDescriptor, Type};

/// Name and nesting of one column of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Name, up to the place in the list if there is one.
    pub name: String,
    /// A list: the rest of the name after the place, and the level from which there is an item.
    pub list: Option<(String, i16)>,
}

impl Shape {
    /// Name of the column of one item; of the column itself if it is no list.
    pub fn item(&self, place: usize) -> String {
        match &self.list {
            Some((after, _)) => format!("{}[{place}]{after}", self.name),
            None => self.name.clone(),
        }
    }
}

/// The nesting of a column, or the reason for not reading it.
pub fn of(schema: &SchemaDescriptor, column: &ColumnDescriptor) -> Result<Shape, &'static str> {
    let parts = column.path().parts();
    if column.max_rep_level() == 0 {
        return Ok(Shape { name: parts.join("."), list: None });
    }
    if column.max_rep_level() > 1 {
        return Err("it holds lists of lists");
    }
    let (mut node, mut level) = (schema.root_schema(), 0);
    for (depth, part) in parts.iter().enumerate() {
        if !node.is_group() {
            break;
        }
        let child = node.get_fields().iter().find(|field| field.name() == part).ok_or("its schema does not fit it")?;
        let parent = std::mem::replace(&mut node, child);
        let repetition = node.get_basic_info().repetition();
        level += i16::from(repetition != Repetition::REQUIRED);
        if repetition != Repetition::REPEATED {
            continue;
        }
        let (name, after) = match kind(parent) {
            Kind::Map => return Err("it holds a map"),
            Kind::List if depth > 0 => (depth, depth + 1 + usize::from(wraps_an_item(node, parent))),
            _ => (depth + 1, depth + 1),
        };
        let after: String = parts.iter().skip(after).flat_map(|part| [".", part.as_str()]).collect();
        return Ok(Shape { name: parts[..name].join("."), list: Some((after, level)) });
    }
    Err("its schema does not fit it")
}

enum Kind {
    List,
    Map,
    Other,
}

fn kind(group: &Type) -> Kind {
    let info = group.get_basic_info();
    match (info.logical_type_ref(), info.converted_type()) {
        (Some(LogicalType::Map), _) | (_, ConvertedType::MAP | ConvertedType::MAP_KEY_VALUE) => Kind::Map,
        (Some(LogicalType::List), _) | (_, ConvertedType::LIST) => Kind::List,
        _ => Kind::Other,
    }
}

/// True for the repeated group of a list of three levels; older writers have two (rules of the format's `LogicalTypes.md`).
fn wraps_an_item(repeated: &Type, list: &Type) -> bool {
    repeated.is_group()
        && repeated.get_fields().len() == 1
        && repeated.name() != "array"
        && repeated.name() != format!("{}_tuple", list.name())
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::schema::parser::parse_message_type;
    use std::sync::Arc;

    fn shapes(text: &str) -> Vec<Result<(String, bool), &'static str>> {
        let schema = SchemaDescriptor::new(Arc::new(parse_message_type(text).expect("a schema")));
        let shape = |column: &Arc<ColumnDescriptor>| of(&schema, column).map(|s| (s.item(1), s.list.is_some()));
        schema.columns().iter().map(shape).collect()
    }

    #[test]
    fn lists_of_two_and_three_levels_have_one_name() {
        let text = "message m {
            required double t;
            optional group state (LIST) { repeated group list { optional float element; } }
            required group old (LIST) { repeated double array; }
            optional group joints (LIST) { repeated group list { required group element { required double q; } } }
            repeated int32 bare;
            required group pose { required group position { required double x; } }
            optional group facts (MAP) { repeated group key_value { required binary key (UTF8); optional double value; } }
            optional group deep (LIST) { repeated group list { optional group element (LIST) {
                repeated group list { optional float element; } } } }
        }";
        let named = |name: &str, list: bool| Ok((name.to_owned(), list));
        let wanted = [
            named("t", false),
            named("state[1]", true),
            named("old[1]", true),
            named("joints[1].q", true),
            named("bare[1]", true),
            named("pose.position.x", false),
            Err("it holds a map"),
            Err("it holds a map"),
            Err("it holds lists of lists"),
        ];
        assert_eq!(shapes(text), wanted);
    }
}
