//! ROS 2 message definitions as they stand in an MCAP schema (`ros2msg`): the message, then the messages it contains,
//! each under a line of `=` and `MSG: package/Name`. Syntax: docs.ros.org, "About ROS 2 interfaces".

use std::collections::HashMap;

/// Longest definition that is read, bytes.
const LONGEST: usize = 1 << 20;

/// A type that stands for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// Truth value, one byte.
    Bool,
    /// `byte`, `char`, `uint8`.
    U8,
    /// `int8`.
    I8,
    /// `uint16`.
    U16,
    /// `int16`.
    I16,
    /// `uint32`.
    U32,
    /// `int32`.
    I32,
    /// `uint64`.
    U64,
    /// `int64`.
    I64,
    /// `float32`.
    F32,
    /// `float64`.
    F64,
    /// `string`.
    Text,
    /// `wstring`.
    WideText,
}

/// Kind of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A primitive.
    Primitive(Primitive),
    /// Another message, by its full name.
    Message(String),
}

/// One, so many, or any number of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// One.
    One,
    /// `[n]`.
    Fixed(usize),
    /// `[]` or `[<=n]`.
    Any,
}

/// One field of a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Content of the field.
    pub kind: Kind,
    /// Number of values.
    pub count: Count,
    /// Text behind it in its line.
    pub comment: String,
}

impl Field {
    fn new(name: String, kind: Kind, count: Count) -> Self {
        Self { name, kind, count, comment: String::new() }
    }
}

/// All messages of a schema, by full name `package/Name`.
#[derive(Debug, Default)]
pub struct Definitions {
    messages: HashMap<String, Vec<Field>>,
    /// The message that the schema is of.
    pub root: String,
}

impl Definitions {
    /// Parses the text of a schema for the message `root` (`package/msg/Name`).
    pub fn parse(root: &str, text: &str) -> Result<Self, String> {
        if text.len() > LONGEST {
            return Err("its schema is longer than a megabyte".to_owned());
        }
        let mut found = Self { root: short(root), ..Self::default() };
        let mut name = found.root.clone();
        let mut fields = Vec::new();
        for line in text.lines() {
            let (line, comment) = line.split_once('#').unwrap_or((line, ""));
            let line = line.trim();
            if line.len() > 2 && line.bytes().all(|b| b == b'=') {
                continue;
            }
            if let Some(next) = line.strip_prefix("MSG:") {
                found.messages.insert(std::mem::replace(&mut name, short(next.trim())), std::mem::take(&mut fields));
            } else if !line.is_empty()
                && let Some(field) = field(line, &name)?
            {
                fields.push(Field { comment: comment.trim().to_owned(), ..field });
            }
        }
        found.messages.insert(name, fields);
        found.add_time();
        Ok(found)
    }

    /// The fields of a message.
    pub fn fields(&self, name: &str) -> Option<&[Field]> {
        self.messages.get(name).map(Vec::as_slice)
    }

    /// Some writers leave the two built-in messages out.
    fn add_time(&mut self) {
        for (name, seconds) in [("Time", Primitive::I32), ("Duration", Primitive::I32)] {
            let part = |name: &str, kind| Field::new(name.to_owned(), Kind::Primitive(kind), Count::One);
            self.messages
                .entry(format!("builtin_interfaces/{name}"))
                .or_insert_with(|| vec![part("sec", seconds), part("nanosec", Primitive::U32)]);
        }
    }
}

/// `package/msg/Name` → `package/Name`.
fn short(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// One line; `None` for a constant.
fn field(line: &str, message: &str) -> Result<Option<Field>, String> {
    let unclear =
        || format!("its schema has the line `{}`, which is no field", line.chars().take(60).collect::<String>());
    let (kind, rest) = line.split_once(char::is_whitespace).ok_or_else(unclear)?;
    let rest = rest.trim();
    let name: String = rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    if rest[name.len()..].trim_start().starts_with('=') {
        return Ok(None);
    }
    if name.is_empty() {
        return Err(unclear());
    }
    let (kind, count) = match kind.split_once('[') {
        None => (kind, Count::One),
        Some((kind, "]")) => (kind, Count::Any),
        Some((kind, bound)) if bound.starts_with("<=") => (kind, Count::Any),
        Some((kind, size)) => {
            (kind, Count::Fixed(size.strip_suffix(']').and_then(|n| n.parse().ok()).ok_or_else(unclear)?))
        }
    };
    Ok(Some(Field::new(name, resolve(kind, message), count)))
}

fn resolve(kind: &str, message: &str) -> Kind {
    let bare = kind.split("<=").next().unwrap_or(kind);
    let primitive = match bare {
        "bool" => Primitive::Bool,
        "byte" | "char" | "uint8" => Primitive::U8,
        "int8" => Primitive::I8,
        "uint16" => Primitive::U16,
        "int16" => Primitive::I16,
        "uint32" => Primitive::U32,
        "int32" => Primitive::I32,
        "uint64" => Primitive::U64,
        "int64" => Primitive::I64,
        "float32" => Primitive::F32,
        "float64" => Primitive::F64,
        "string" => Primitive::Text,
        "wstring" => Primitive::WideText,
        "time" => return Kind::Message("builtin_interfaces/Time".to_owned()),
        "duration" => return Kind::Message("builtin_interfaces/Duration".to_owned()),
        "Header" => return Kind::Message("std_msgs/Header".to_owned()),
        other if other.contains('/') => return Kind::Message(short(other)),
        // Without a package: that of the message around it.
        other => {
            let package = message.split('/').next().unwrap_or("");
            return Kind::Message(format!("{package}/{other}"));
        }
    };
    Kind::Primitive(primitive)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_resolved() {
        let text = "# A wrench\nuint8 KIND=3\nstd_msgs/Header header\nWrench wrench # both\nfloat64[3] a\nstring<=5[<=2] b 'x'\n\
                    ================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
                    ===\nMSG: geometry_msgs/Wrench\nfloat64[] force\n";
        let all = Definitions::parse("geometry_msgs/msg/WrenchStamped", text).expect("parses");
        let fields = all.fields(&all.root).expect("the root");
        assert_eq!(fields.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["header", "wrench", "a", "b"]);
        assert_eq!(fields[1].kind, Kind::Message("geometry_msgs/Wrench".to_owned()));
        assert_eq!((fields[2].count, fields[3].count), (Count::Fixed(3), Count::Any));
        assert_eq!(fields[3].kind, Kind::Primitive(Primitive::Text));
        assert_eq!(all.fields("builtin_interfaces/Time").map(<[Field]>::len), Some(2));
        assert!(Definitions::parse("a/B", "float64\n").is_err() && Definitions::parse("a/B", "int8[x] y").is_err());
    }
}
