//! Messages in protobuf, with the descriptors that the file carries.
//!
//! The descriptors are resolved by `prost-reflect`; the wire is read by our own few lines straight into the columns, many
//! times as fast as through dynamic messages. Wire format: protobuf.dev/programming-guides/encoding.

use super::topic::{MAX_DEPTH, MAX_FIELDS, MAX_ITEMS, Topic};
use prost_reflect::{Cardinality, DescriptorPool, FieldDescriptor, Kind, MessageDescriptor};
use std::collections::HashSet;

/// Destination of a field's value.
enum Node {
    /// A number in this column.
    Number(Kind, usize),
    /// A text in this column.
    Text(usize),
    /// A message of its own.
    Message(Box<Shape>),
    /// A list: its path, the kind of its items, and the items met so far.
    List(String, Kind, Vec<Node>),
    /// Bytes, maps: not read.
    Skip,
}

/// The fields of one message at one place in the tree.
pub struct Shape {
    /// By number.
    fields: Vec<(u32, Node)>,
    /// Columns that are 0 when the message says nothing (fields without presence).
    zeros: Vec<usize>,
    blanks: Vec<usize>,
    path: String,
    depth: usize,
}

/// Resolves the message type `name` in a serialised `FileDescriptorSet` and makes its columns in `topic`.
pub fn prepare(name: &str, schema: &[u8], topic: &mut Topic) -> Result<Shape, String> {
    let pool = DescriptorPool::decode(schema).map_err(|e| format!("its schema cannot be read: {e}"))?;
    let message = pool.get_message_by_name(name).ok_or_else(|| format!("its schema has no message `{name}`"))?;
    Shape::new(&message, String::new(), topic, 0)
}

/// Puts one message into the current row of `topic`.
pub fn decode(shape: &mut Shape, data: &[u8], topic: &mut Topic) -> Result<(), String> {
    shape.read(data, topic)?;
    shape.fill(topic);
    Ok(())
}

impl Shape {
    fn new(message: &MessageDescriptor, path: String, topic: &mut Topic, depth: usize) -> Result<Self, String> {
        let mut shape = Self { fields: Vec::new(), zeros: Vec::new(), blanks: Vec::new(), path, depth };
        let mut fields: Vec<FieldDescriptor> = message.fields().collect();
        fields.sort_by_key(FieldDescriptor::number);
        // Messages without any number in them cost time too, where a schema nests them wildly.
        topic.nodes += 1 + fields.len();
        if topic.nodes > 4 * MAX_FIELDS {
            return Err(format!("it has more than {MAX_FIELDS} different fields"));
        }
        for field in fields {
            let path = join(&shape.path, field.name());
            let node = shape.field(&field, path, topic)?;
            shape.fields.push((field.number(), node));
        }
        Ok(shape)
    }

    fn field(&mut self, field: &FieldDescriptor, path: String, topic: &mut Topic) -> Result<Node, String> {
        if field.is_map() {
            return Ok(Node::Skip);
        }
        if field.cardinality() == Cardinality::Repeated {
            return Ok(Node::List(path, field.kind(), Vec::new()));
        }
        let node = node(field.kind(), path, topic, self.depth)?;
        if !field.supports_presence() {
            match node {
                Node::Number(_, column) => self.zeros.push(column),
                Node::Text(column) => self.blanks.push(column),
                _ => {}
            }
        }
        Ok(node)
    }

    fn read(&mut self, mut data: &[u8], topic: &mut Topic) -> Result<(), String> {
        while !data.is_empty() {
            let key = varint(&mut data)?;
            let number = u32::try_from(key >> 3).map_err(|_| "a field number is too large".to_owned())?;
            let value = Wire::take((key & 7) as u8, &mut data)?;
            let Ok(at) = self.fields.binary_search_by_key(&number, |&(n, _)| n) else { continue };
            self.fields[at].1.take(&value, topic, self.depth)?;
        }
        Ok(())
    }

    /// Adds the values that the message left out because they are zero.
    fn fill(&self, topic: &mut Topic) {
        for &column in &self.zeros {
            topic.number(column, 0.0);
        }
        for &column in &self.blanks {
            topic.text(column, "");
        }
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

fn node(kind: Kind, path: String, topic: &mut Topic, depth: usize) -> Result<Node, String> {
    Ok(match kind {
        Kind::String => Node::Text(topic.column(&path, true)?),
        Kind::Message(message) if depth < MAX_DEPTH => {
            if holds_itself(&message) {
                return Ok(Node::Skip);
            }
            Node::Message(Box::new(Shape::new(&message, path, topic, depth + 1)?))
        }
        Kind::Bytes | Kind::Message(_) => Node::Skip,
        number => Node::Number(number, topic.column(&path, false)?),
    })
}

/// True for a message that has its own kind somewhere within: it has no fixed set of columns.
fn holds_itself(message: &MessageDescriptor) -> bool {
    let inner = |m: &MessageDescriptor| -> Vec<MessageDescriptor> {
        m.fields().filter_map(|f| if let Kind::Message(m) = f.kind() { Some(m) } else { None }).collect()
    };
    let mut seen: HashSet<String> = HashSet::new();
    let mut open = inner(message);
    while let Some(next) = open.pop() {
        if next == *message {
            return true;
        }
        if seen.insert(next.full_name().to_owned()) {
            open.extend(inner(&next));
        }
    }
    false
}

impl Node {
    fn take(&mut self, value: &Wire<'_>, topic: &mut Topic, depth: usize) -> Result<(), String> {
        match self {
            Self::Number(kind, column) => topic.number(*column, value.number(kind)?),
            Self::Text(column) => topic.text(*column, value.text()?),
            Self::Message(shape) => {
                let Wire::Bytes(data) = value else { return Err(mismatch()) };
                shape.read(data, topic)?;
                shape.fill(topic);
            }
            Self::List(path, kind, items) => list(path, kind, items, value, topic, depth)?,
            Self::Skip => {}
        }
        Ok(())
    }
}

/// One or, packed, several items of a list.
fn list(
    path: &str,
    kind: &Kind,
    items: &mut Vec<Node>,
    value: &Wire<'_>,
    topic: &mut Topic,
    depth: usize,
) -> Result<(), String> {
    let packed = !matches!(kind, Kind::String | Kind::Bytes | Kind::Message(_));
    match value {
        Wire::Bytes(data) if packed => {
            let mut data = *data;
            let mut index = 0;
            while !data.is_empty() {
                let item = Wire::take(wire_type(kind), &mut data)?;
                put(path, kind, items, index, &item, topic, depth)?;
                index += 1;
            }
            Ok(())
        }
        // Items one by one: the first that has no cell in this row yet.
        item => {
            let rows = topic.log_ns.len();
            let filled = |node: &Node| match node {
                Node::Number(_, column) | Node::Text(column) => topic.columns[*column].len() >= rows,
                Node::Message(shape) => shape.met(topic, rows),
                _ => true,
            };
            let index = items.iter().take_while(|n| filled(n)).count();
            put(path, kind, items, index, item, topic, depth)
        }
    }
}

impl Shape {
    /// True when the current row has any cell of this message.
    fn met(&self, topic: &Topic, rows: usize) -> bool {
        self.fields.iter().any(|(_, node)| match node {
            Node::Number(_, column) | Node::Text(column) => topic.columns[*column].len() >= rows,
            Node::Message(shape) => shape.met(topic, rows),
            _ => false,
        })
    }
}

fn put(
    path: &str,
    kind: &Kind,
    items: &mut Vec<Node>,
    index: usize,
    value: &Wire<'_>,
    topic: &mut Topic,
    depth: usize,
) -> Result<(), String> {
    if index >= MAX_ITEMS {
        topic.long_lists = true;
        return Ok(());
    }
    if index == items.len() {
        items.push(node(kind.clone(), format!("{path}[{index}]"), topic, depth + 1)?);
    }
    items[index].take(value, topic, depth + 1)
}

/// A value as it stands on the wire.
enum Wire<'a> {
    Varint(u64),
    Fixed64([u8; 8]),
    Fixed32([u8; 4]),
    Bytes(&'a [u8]),
}

fn mismatch() -> String {
    "a field is not of the kind that the schema says".to_owned()
}

fn cut() -> String {
    "it ends within a field".to_owned()
}

impl<'a> Wire<'a> {
    fn take(wire_type: u8, data: &mut &'a [u8]) -> Result<Self, String> {
        match wire_type {
            0 => Ok(Self::Varint(varint(data)?)),
            1 => {
                let (value, rest) = data.split_first_chunk::<8>().ok_or_else(cut)?;
                *data = rest;
                Ok(Self::Fixed64(*value))
            }
            2 => {
                let length = usize::try_from(varint(data)?).map_err(|_| cut())?;
                let (value, rest) = data.split_at_checked(length).ok_or_else(cut)?;
                *data = rest;
                Ok(Self::Bytes(value))
            }
            5 => {
                let (value, rest) = data.split_first_chunk::<4>().ok_or_else(cut)?;
                *data = rest;
                Ok(Self::Fixed32(*value))
            }
            _ => Err("a field is of a kind that protobuf does not have".to_owned()),
        }
    }

    fn number(&self, kind: &Kind) -> Result<f64, String> {
        Ok(match (kind, self) {
            (Kind::Double, Self::Fixed64(b)) => f64::from_le_bytes(*b),
            (Kind::Float, Self::Fixed32(b)) => f64::from(f32::from_le_bytes(*b)),
            (Kind::Fixed64, Self::Fixed64(b)) => u64::from_le_bytes(*b) as f64,
            (Kind::Sfixed64, Self::Fixed64(b)) => i64::from_le_bytes(*b) as f64,
            (Kind::Fixed32, Self::Fixed32(b)) => f64::from(u32::from_le_bytes(*b)),
            (Kind::Sfixed32, Self::Fixed32(b)) => f64::from(i32::from_le_bytes(*b)),
            (Kind::Int32 | Kind::Enum(_), Self::Varint(v)) => f64::from(*v as i32),
            (Kind::Int64, Self::Varint(v)) => (*v).cast_signed() as f64,
            (Kind::Uint32, Self::Varint(v)) => f64::from(*v as u32),
            (Kind::Uint64, Self::Varint(v)) => *v as f64,
            (Kind::Bool, Self::Varint(v)) => f64::from(u8::from(*v != 0)),
            (Kind::Sint32 | Kind::Sint64, Self::Varint(v)) => ((v >> 1).cast_signed() ^ -(v & 1).cast_signed()) as f64,
            _ => return Err(mismatch()),
        })
    }

    fn text(&self) -> Result<&'a str, String> {
        let Self::Bytes(bytes) = self else { return Err(mismatch()) };
        std::str::from_utf8(bytes).map_err(|_| "a text is not UTF-8".to_owned())
    }
}

fn wire_type(kind: &Kind) -> u8 {
    match kind {
        Kind::Double | Kind::Fixed64 | Kind::Sfixed64 => 1,
        Kind::Float | Kind::Fixed32 | Kind::Sfixed32 => 5,
        Kind::String | Kind::Bytes | Kind::Message(_) => 2,
        _ => 0,
    }
}

fn varint(data: &mut &[u8]) -> Result<u64, String> {
    let mut value = 0;
    for (index, &byte) in data.iter().take(10).enumerate() {
        value |= u64::from(byte & 0x7f) << (7 * index);
        if byte < 0x80 {
            *data = &data[index + 1..];
            return Ok(value);
        }
    }
    Err(cut())
}
