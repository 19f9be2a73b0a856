//! Variables of MATLAB files of level 4: a header of five whole numbers, the name, the numbers.

use super::bytes::{Bytes, Kind, Order, Stop, damaged};
use super::level5::{VALUE_BYTES, rows_of};
use super::value::{Unread, Value};

/// Bytes of a variable's header.
const HEADER: usize = 20;
/// Longest name of a variable, with the zero behind it: `namelengthmax` of MATLAB is 63.
const LONGEST_NAME: u32 = 64;

/// Header of one variable.
#[derive(Debug, PartialEq)]
struct Header {
    kind: Kind,
    content: u32,
    rows: u32,
    columns: u32,
    is_complex: bool,
    name: u32,
}

impl Header {
    /// The header that these whole numbers make; none if they make no header.
    fn of([code, rows, columns, imaginary, name]: [u32; 5], order: Order) -> Option<Self> {
        let machine = u32::from(order == Order::Big);
        let (of, reserved, kind, content) = (code / 1000, code / 100 % 10, code / 10 % 10, code % 10);
        let kind = match kind {
            0 => Kind::F64,
            1 => Kind::F32,
            2 => Kind::I32,
            3 => Kind::I16,
            4 => Kind::U16,
            5 => Kind::U8,
            _ => return None,
        };
        let is_one = of == machine && reserved == 0 && content <= 2 && imaginary <= 1;
        let fits = [rows, columns].iter().all(|n| i32::try_from(*n).is_ok()) && (2..=LONGEST_NAME).contains(&name);
        (is_one && fits).then_some(Self { kind, content, rows, columns, is_complex: imaginary == 1, name })
    }

    /// Bytes behind the name.
    fn size(&self) -> u64 {
        let parts = if self.is_complex { 2 } else { 1 };
        u64::from(self.rows).saturating_mul(u64::from(self.columns)).saturating_mul(self.kind.size() * parts)
    }
}

/// Order of the bytes of a file that begins with `start` and has `size` bytes; none unless the first variable is one.
pub fn order(start: &[u8], size: u64) -> Option<Order> {
    let words = start.get(..HEADER)?.as_chunks().0;
    [Order::Little, Order::Big].into_iter().find(|&order| {
        let word = |at: usize| {
            let raw: [u8; 4] = words.get(at).copied().unwrap_or_default();
            if order == Order::Big { u32::from_be_bytes(raw) } else { u32::from_le_bytes(raw) }
        };
        Header::of(std::array::from_fn(word), order).is_some_and(|header| {
            let name = start.get(HEADER..HEADER + header.name as usize).and_then(name_of);
            name.is_some() && header.size() <= size.saturating_sub(HEADER as u64 + u64::from(header.name))
        })
    })
}

/// A name as variables have it, with a zero at its end.
fn name_of(bytes: &[u8]) -> Option<String> {
    let name = std::str::from_utf8(bytes.strip_suffix(&[0])?).ok()?.trim_end_matches('\0');
    let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    is_name.then(|| name.to_owned())
}

/// Reads the variables of a file.
pub fn variables(bytes: &mut Bytes<'_>, take: &mut dyn FnMut(String, Value, u64)) -> Result<(), Stop> {
    let mut last = String::new();
    while bytes.left > 0 {
        let place = if last.is_empty() { "the first variable".to_owned() } else { format!("what follows `{last}`") };
        let words = [bytes.word()?, bytes.word()?, bytes.word()?, bytes.word()?, bytes.word()?];
        let header = Header::of(words, bytes.order).ok_or_else(|| damaged(format!("{place} is no variable")))?;
        let name = bytes.bytes(u64::from(header.name))?;
        let name = name_of(&name).ok_or_else(|| damaged(format!("{place} has no name")))?;
        let value = bytes.within(header.size(), |bytes| content(bytes, &header)).map_err(|stop| match stop {
            Stop::Damaged(why) => damaged(format!("the variable `{name}`: {why}")),
            other => other,
        })?;
        take(name.clone(), value, bytes.left);
        last = name;
    }
    Ok(())
}

fn content(bytes: &mut Bytes<'_>, header: &Header) -> Result<Value, Stop> {
    bytes.charge(VALUE_BYTES)?;
    match header {
        Header { content: 2, .. } => Ok(Value::Unread(Unread::Kind("a sparse matrix"))),
        Header { is_complex: true, .. } => Ok(Value::Unread(Unread::Kind("complex numbers"))),
        Header { kind, content, rows, columns, .. } => {
            let values = bytes.numbers(*kind, u64::from(*rows).saturating_mul(u64::from(*columns)))?;
            if *content == 0 {
                return Ok(Value::Numbers { dims: vec![*rows as usize, *columns as usize], values });
            }
            let letters: Vec<char> =
                values.iter().map(|&code| char::from_u32(code as u32).unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
            rows_of(bytes, *rows as usize, &letters)
        }
    }
}
