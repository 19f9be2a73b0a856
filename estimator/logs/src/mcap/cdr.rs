//! ROS 2 messages in CDR, as their `ros2msg` schema lays them out.
//!
//! Plain CDR version 1 (OMG DDSI-RTPS 10.2): four bytes of header, the second of which tells the byte order, then every
//! primitive aligned to its own size from the end of the header. A string has its length with the closing zero before
//! it.

use super::rosmsg::{Count, Definitions, Field, Kind, Primitive};
use super::topic::{MAX_DEPTH, MAX_ITEMS, Topic};
use std::fmt::Write as _;

/// Number of empty items that are followed: lists may nest without holding anything.
const MAX_EMPTY_ITEMS: usize = 10_000;

/// Puts one message into the current row of `topic`.
pub fn decode(types: &Definitions, data: &[u8], topic: &mut Topic, path: &mut String) -> Result<(), String> {
    let Some((&[_, kind, _, _], body)) = data.split_first_chunk::<4>() else { return Err(cut()) };
    if kind > 1 {
        return Err(format!("its encapsulation {kind} is not plain CDR"));
    }
    path.clear();
    let mut reader = Reader { body, at: 0, little: kind == 1, types, topic, path, items: 0 };
    reader.message(&types.root, 0, true)
}

fn cut() -> String {
    "it ends within a field".to_owned()
}

struct Reader<'a> {
    body: &'a [u8],
    at: usize,
    little: bool,
    types: &'a Definitions,
    topic: &'a mut Topic,
    path: &'a mut String,
    /// Items met, for the limit on lists of nothing.
    items: usize,
}

impl<'a> Reader<'a> {
    fn message(&mut self, name: &str, depth: usize, keep: bool) -> Result<(), String> {
        let types = self.types;
        let fields = types.fields(name).ok_or_else(|| format!("its schema does not define `{name}`"))?;
        if depth > MAX_DEPTH {
            return Err(format!("it nests deeper than {MAX_DEPTH} messages"));
        }
        if fields.is_empty() {
            return self.skip(1); // ROS puts a byte where a message has no field
        }
        let length = self.path.len();
        for field in fields {
            if length > 0 {
                self.path.push('.');
            }
            self.path.push_str(&field.name);
            self.field(field, depth, keep)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn field(&mut self, field: &Field, depth: usize, keep: bool) -> Result<(), String> {
        let count = match field.count {
            Count::One => return self.item(&field.kind, depth, keep),
            Count::Fixed(n) => n,
            Count::Any => u32::from_ne_bytes(self.ordered::<4>()?) as usize,
        };
        // Bytes and other long lists of primitives are stepped over at once.
        if let Kind::Primitive(primitive) = field.kind
            && let Some(size) = primitive.size()
            && count > MAX_ITEMS
        {
            self.topic.long_lists = true;
            self.align(size);
            return self.skip(count.checked_mul(size).ok_or_else(cut)?);
        }
        let length = self.path.len();
        for index in 0..count {
            let kept = keep && index < MAX_ITEMS;
            self.topic.long_lists |= keep && !kept;
            if kept {
                let _ = write!(self.path, "[{index}]"); // writing into a string cannot fail
            }
            self.item(&field.kind, depth, kept)?;
            self.path.truncate(length);
        }
        Ok(())
    }

    fn item(&mut self, kind: &Kind, depth: usize, keep: bool) -> Result<(), String> {
        self.items += 1;
        if self.items > self.body.len() + MAX_EMPTY_ITEMS {
            return Err("it has more items than bytes".to_owned());
        }
        let primitive = match kind {
            Kind::Message(name) => return self.message(name, depth + 1, keep),
            Kind::Primitive(primitive) => *primitive,
        };
        if matches!(primitive, Primitive::Text | Primitive::WideText) {
            return self.text(primitive == Primitive::WideText, keep);
        }
        let value = self.number(primitive)?;
        if keep {
            let column = self.topic.column(self.path, false)?;
            self.topic.number(column, value);
        }
        Ok(())
    }

    fn number(&mut self, primitive: Primitive) -> Result<f64, String> {
        Ok(match primitive {
            Primitive::Bool => f64::from(u8::from(u8::from_ne_bytes(self.ordered()?) != 0)),
            Primitive::U8 => f64::from(u8::from_ne_bytes(self.ordered()?)),
            Primitive::I8 => f64::from(i8::from_ne_bytes(self.ordered()?)),
            Primitive::U16 => f64::from(u16::from_ne_bytes(self.ordered()?)),
            Primitive::I16 => f64::from(i16::from_ne_bytes(self.ordered()?)),
            Primitive::U32 => f64::from(u32::from_ne_bytes(self.ordered()?)),
            Primitive::I32 => f64::from(i32::from_ne_bytes(self.ordered()?)),
            Primitive::U64 => u64::from_ne_bytes(self.ordered()?) as f64,
            Primitive::I64 => i64::from_ne_bytes(self.ordered()?) as f64,
            Primitive::F32 => f64::from(f32::from_ne_bytes(self.ordered()?)),
            Primitive::F64 => f64::from_ne_bytes(self.ordered()?),
            Primitive::Text | Primitive::WideText => return Err(cut()),
        })
    }

    fn text(&mut self, wide: bool, keep: bool) -> Result<(), String> {
        let length = u32::from_ne_bytes(self.ordered::<4>()?) as usize;
        if wide {
            return self.skip(length.checked_mul(2).ok_or_else(cut)?);
        }
        let bytes = self.bytes(length)?;
        if keep {
            let bytes = bytes.strip_suffix(b"\0").unwrap_or(bytes);
            let text = std::str::from_utf8(bytes).map_err(|_| "a text is not UTF-8".to_owned())?;
            let column = self.topic.column(self.path, true)?;
            self.topic.text(column, text);
        }
        Ok(())
    }

    fn align(&mut self, size: usize) {
        self.at = self.at.next_multiple_of(size);
    }

    fn skip(&mut self, count: usize) -> Result<(), String> {
        self.bytes(count).map(drop)
    }

    fn bytes(&mut self, count: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(count).ok_or_else(cut)?;
        let bytes = self.body.get(self.at..end).ok_or_else(cut)?;
        self.at = end;
        Ok(bytes)
    }

    /// The next primitive, aligned, in the byte order of this machine.
    fn ordered<const N: usize>(&mut self) -> Result<[u8; N], String> {
        self.align(N);
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.bytes(N)?);
        if self.little != cfg!(target_endian = "little") {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Primitive {
    /// Bytes; `None` for text.
    fn size(self) -> Option<usize> {
        match self {
            Self::Bool | Self::U8 | Self::I8 => Some(1),
            Self::U16 | Self::I16 => Some(2),
            Self::U32 | Self::I32 | Self::F32 => Some(4),
            Self::U64 | Self::I64 | Self::F64 => Some(8),
            Self::Text | Self::WideText => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WRENCH: &str = "std_msgs/Header header\nuint8 a\nfloat64 b\nfloat32[] c\n===\nMSG: std_msgs/Header\n\
                          builtin_interfaces/Time stamp\nstring frame_id\n";

    fn message() -> Vec<u8> {
        let mut body = Vec::new();
        body.extend(7_i32.to_le_bytes());
        body.extend(500_u32.to_le_bytes());
        body.extend(3_u32.to_le_bytes());
        body.extend(b"ab\0"); // 15 bytes
        body.push(9); // 16
        body.extend(2.5_f64.to_le_bytes()); // 24
        body.extend(2_u32.to_le_bytes());
        body.extend(1.0_f32.to_le_bytes());
        body.extend((-1.0_f32).to_le_bytes());
        [&[0, 1, 0, 0], body.as_slice()].concat()
    }

    fn read(data: &[u8]) -> Result<Topic, String> {
        let types = Definitions::parse("x/msg/W", WRENCH).expect("parses");
        let mut topic = Topic::default();
        topic.begin(0, 0);
        decode(&types, data, &mut topic, &mut String::new())?;
        topic.end();
        Ok(topic)
    }

    #[test]
    fn a_message_is_read_with_its_alignment() {
        let topic = read(&message()).expect("decodes");
        let expected = ["header.stamp.sec", "header.stamp.nanosec", "header.frame_id", "a", "b", "c[0]", "c[1]"];
        assert_eq!(topic.fields, expected);
        let cells: Vec<String> = topic.columns.iter().map(|c| c.text(0)).collect();
        assert_eq!(cells, ["7", "500", "ab", "9", "2.5", "1", "-1"]);
    }

    #[test]
    fn no_cut_is_read_beyond() {
        let whole = message();
        for length in 0..whole.len() {
            assert!(read(&whole[..length]).is_err(), "{length}");
        }
        let mut absurd = whole;
        absurd[28..32].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read(&absurd).is_err());
    }
}
