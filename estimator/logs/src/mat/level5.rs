//! Variables of MATLAB files of level 5 (versions 5 to 7): elements with a tag each, variables packed with zlib.

use super::bytes::{Bytes, Kind, Order, Stop, damaged};
use super::value::{Unread, Value};
use std::rc::Rc;

/// Bytes of the header: text, offset of data of the program's own, version, and order of the bytes.
pub const HEADER: usize = 128;
/// Memory of one value with its numbers, its dimensions and its place in a column, bytes: a file has eight for an empty one.
pub const VALUE_BYTES: u64 = 160;
/// Depth to which values may nest.
const DEEPEST: usize = 24;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Bits of an array's flags: its class, and whether its numbers are complex.
const CLASS: u32 = 0xff;
const COMPLEX: u32 = 0x800;

/// Order of the bytes of a file with this header; none for another kind of file.
pub fn order(header: &[u8]) -> Option<Order> {
    match header.get(124..HEADER)? {
        [0, 1, b'I', b'M'] => Some(Order::Little),
        [1, 0, b'M', b'I'] => Some(Order::Big),
        _ => None,
    }
}

/// Reads the variables behind the header.
pub fn variables(bytes: &mut Bytes<'_>, take: &mut dyn FnMut(String, Value, u64)) -> Result<(), Stop> {
    while bytes.left > 0 {
        let (kind, size) = (bytes.word()?, u64::from(bytes.word()?));
        let found = match kind {
            COMPRESSED => bytes.unpacked(size, variable)?,
            MATRIX => Some(bytes.within(size, |bytes| matrix(bytes, 0))?),
            _ => {
                bytes.skip(size.min(bytes.left))?;
                None
            }
        };
        // An array without a name holds the content of objects.
        if let Some((name, value)) = found.filter(|(name, _)| !name.is_empty()) {
            take(name, value, bytes.left);
        }
    }
    Ok(())
}

/// The variable in a compressed element.
fn variable(bytes: &mut Bytes<'_>) -> Result<Option<(String, Value)>, Stop> {
    let (kind, size) = (bytes.word()?, u64::from(bytes.word()?));
    if kind != MATRIX {
        return Ok(None);
    }
    bytes.within(size, |bytes| matrix(bytes, 0)).map(Some)
}

/// Name and value of an array, which is `bytes.left` long.
fn matrix(bytes: &mut Bytes<'_>, depth: usize) -> Result<(String, Value), Stop> {
    bytes.charge(VALUE_BYTES)?;
    if bytes.left == 0 {
        return Ok((String::new(), Value::empty()));
    }
    if depth > DEEPEST {
        return Err(damaged(format!("values within values, more than {DEEPEST} deep")));
    }
    let flags = numbers(bytes)?.first().copied().unwrap_or(0.0) as u32;
    let class = flags & CLASS;
    if class == 17 {
        let (name, _system, class) = (text(bytes)?, text(bytes)?, text(bytes)?);
        return Ok((name, Value::Unread(Unread::Object(class))));
    }
    let dims: Vec<usize> = numbers(bytes)?.into_iter().map(|d| if d > 0.0 { d as usize } else { 0 }).collect();
    let name = text(bytes)?;
    let within = |stop: Stop| match stop {
        Stop::Damaged(why) if depth == 0 => damaged(format!("the variable `{name}`: {why}")),
        other => other,
    };
    let value = content(bytes, (class, flags & COMPLEX != 0), dims, depth).map_err(within)?;
    Ok((name, value))
}

/// Value of an array of this class behind its name; complex numbers are not read.
fn content(
    bytes: &mut Bytes<'_>,
    (class, is_complex): (u32, bool),
    dims: Vec<usize>,
    depth: usize,
) -> Result<Value, Stop> {
    let unread = |kind| Ok(Value::Unread(Unread::Kind(kind)));
    let count = dims.iter().try_fold(1_usize, |all, d| all.checked_mul(*d));
    let count = count.filter(|_| dims.len() >= 2).ok_or_else(|| damaged("its dimensions are none"))?;
    match class {
        1 => Ok(Value::Cells { items: values(bytes, count, depth)?, dims }),
        2 => structs(bytes, count, depth),
        3 => Ok(Value::Unread(Unread::Object(text(bytes)?))),
        4 => characters(bytes, &dims, count),
        5 => unread("a sparse matrix"),
        6..=15 if is_complex => unread("complex numbers"),
        6..=15 => {
            let values = numbers(bytes)?;
            if values.len() != count {
                return Err(damaged(format!("it has {} values where its dimensions claim {count}", values.len())));
            }
            Ok(Value::Numbers { dims, values })
        }
        16 => unread("a function handle"),
        _ => unread("values of a class that is not known"),
    }
}

fn values(bytes: &mut Bytes<'_>, count: usize, depth: usize) -> Result<Vec<Value>, Stop> {
    let mut items = Vec::new();
    for _ in 0..count {
        let (kind, size) = (bytes.word()?, u64::from(bytes.word()?));
        if kind != MATRIX {
            return Err(damaged("a cell or field without a value"));
        }
        items.push(bytes.within(size, |bytes| matrix(bytes, depth + 1))?.1);
    }
    Ok(items)
}

fn structs(bytes: &mut Bytes<'_>, count: usize, depth: usize) -> Result<Value, Stop> {
    let width = numbers(bytes)?.first().copied().unwrap_or(0.0) as usize;
    let (_, all) = element(bytes)?;
    let names: Rc<[String]> = all.chunks(width.max(1)).map(until_zero).collect();
    let mut items = Vec::new();
    // Elements without fields take no bytes: their number is only a claim.
    for _ in 0..if names.is_empty() { 0 } else { count } {
        bytes.charge(size_of::<Vec<Value>>() as u64)?;
        items.push(values(bytes, names.len(), depth)?);
    }
    Ok(Value::Structs { names, items })
}

/// Rows of a character array.
fn characters(bytes: &mut Bytes<'_>, dims: &[usize], count: usize) -> Result<Value, Stop> {
    let (kind, raw) = element(bytes)?;
    let order = bytes.order;
    let letters: Vec<char> = match kind {
        4 | 17 => {
            let units = raw.as_chunks().0.iter().map(|&unit| match order {
                Order::Little => u16::from_le_bytes(unit),
                Order::Big => u16::from_be_bytes(unit),
            });
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
        }
        16 => String::from_utf8_lossy(&raw).chars().collect(),
        // One byte a character: Latin-1.
        1 | 2 => raw.iter().map(|&byte| char::from(byte)).collect(),
        _ => return Ok(Value::Unread(Unread::Kind("text in a code that is not known"))),
    };
    let rows = dims.first().copied().unwrap_or(0);
    if rows > 1 && count > 0 && letters.len() != count {
        return Err(damaged(format!("it has {} characters where its dimensions claim {count}", letters.len())));
    }
    bytes.charge(4 * letters.len() as u64)?;
    rows_of(bytes, rows, &letters)
}

/// Characters that stand column by column, as rows.
pub fn rows_of(bytes: &mut Bytes<'_>, rows: usize, letters: &[char]) -> Result<Value, Stop> {
    // Rows without characters are only a claim.
    let rows = rows.clamp(1, letters.len().max(1));
    bytes.charge((rows * size_of::<String>()) as u64)?;
    let row = |at: usize| letters.iter().skip(at).step_by(rows).collect::<String>();
    Ok(Value::Text((0..rows).map(|at| row(at).trim_end_matches([' ', '\0']).to_owned()).collect()))
}

/// Kind and bytes of an element; those of a small one stand in its tag.
fn element(bytes: &mut Bytes<'_>) -> Result<(u32, Vec<u8>), Stop> {
    let (kind, size) = tag(bytes)?;
    match size {
        Size::Small(size, data) => Ok((kind, data.get(..size).unwrap_or(&data).to_vec())),
        Size::Behind(size) => {
            let data = bytes.bytes(size)?;
            pad(bytes, size)?;
            Ok((kind, data))
        }
    }
}

/// Place of an element's bytes.
enum Size {
    /// So many bytes in the tag itself.
    Small(usize, [u8; 4]),
    /// So many bytes behind the tag.
    Behind(u64),
}

fn tag(bytes: &mut Bytes<'_>) -> Result<(u32, Size), Stop> {
    let first = bytes.word()?;
    if first >> 16 == 0 {
        return Ok((first, Size::Behind(u64::from(bytes.word()?))));
    }
    Ok((first & 0xffff, Size::Small((first >> 16) as usize, bytes.array()?)))
}

/// Elements begin at multiples of eight bytes.
fn pad(bytes: &mut Bytes<'_>, size: u64) -> Result<(), Stop> {
    bytes.skip((size.next_multiple_of(8) - size).min(bytes.left))
}

/// The numbers of an element.
fn numbers(bytes: &mut Bytes<'_>) -> Result<Vec<f64>, Stop> {
    let (code, size) = tag(bytes)?;
    let kind = match code {
        1 => Kind::I8,
        2 => Kind::U8,
        3 => Kind::I16,
        4 => Kind::U16,
        5 => Kind::I32,
        6 => Kind::U32,
        7 => Kind::F32,
        9 => Kind::F64,
        12 => Kind::I64,
        13 => Kind::U64,
        _ => return Err(damaged(format!("numbers of the unknown type {code}"))),
    };
    match size {
        Size::Small(size, data) => {
            let (mut data, mut room, order) = (data.as_slice(), 64, bytes.order);
            let mut small = Bytes::of_file(&mut data, order, 4, &mut room, bytes.watch);
            small.numbers(kind, size as u64 / kind.size())
        }
        Size::Behind(size) => {
            let found = bytes.numbers(kind, size / kind.size())?;
            bytes.skip(size % kind.size())?;
            pad(bytes, size)?;
            Ok(found)
        }
    }
}

fn text(bytes: &mut Bytes<'_>) -> Result<String, Stop> {
    Ok(until_zero(&element(bytes)?.1))
}

fn until_zero(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}
