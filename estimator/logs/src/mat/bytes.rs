//! Bytes of a file or of a compressed variable, one after the other, with a bound on what they may become in memory.

use crate::pages;
use crate::watch::Watch;
use flate2::read::ZlibDecoder;
use std::io::{ErrorKind, Read};

/// Bytes that are decoded at a time; a multiple of every number's size.
const BLOCK_BYTES: usize = 1 << 13;
/// Most bytes that one packed byte unpacks to: two bits for 258 bytes (RFC 1951).
const MOST_UNPACKED: u64 = 1032;
/// Elements are padded to multiples of eight bytes.
const MOST_PADDING: u64 = 7;

/// Reason for ending before the last variable.
#[derive(Debug)]
pub enum Stop {
    /// The system refused.
    Io(std::io::Error),
    /// A fault of the file.
    Damaged(String),
    /// The caller has ended the read.
    Cancelled,
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Lowest byte first.
    Little,
    /// Highest byte first.
    Big,
}

/// Storage of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// Bytes of one number.
    pub fn size(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Appends the numbers in `bytes` to `to`.
    fn decode(self, bytes: &[u8], order: Order, to: &mut Vec<f64>) {
        match self {
            Self::I8 => each(bytes, order, to, |b| f64::from(i8::from_le_bytes(b))),
            Self::U8 => each(bytes, order, to, |b| f64::from(u8::from_le_bytes(b))),
            Self::I16 => each(bytes, order, to, |b| f64::from(i16::from_le_bytes(b))),
            Self::U16 => each(bytes, order, to, |b| f64::from(u16::from_le_bytes(b))),
            Self::I32 => each(bytes, order, to, |b| f64::from(i32::from_le_bytes(b))),
            Self::U32 => each(bytes, order, to, |b| f64::from(u32::from_le_bytes(b))),
            Self::I64 => each(bytes, order, to, |b| i64::from_le_bytes(b) as f64),
            Self::U64 => each(bytes, order, to, |b| u64::from_le_bytes(b) as f64),
            Self::F32 => each(bytes, order, to, |b| f64::from(f32::from_le_bytes(b))),
            Self::F64 => each(bytes, order, to, f64::from_le_bytes),
        }
    }
}

fn each<const N: usize>(bytes: &[u8], order: Order, to: &mut Vec<f64>, number: impl Fn([u8; N]) -> f64) {
    to.extend(bytes.as_chunks().0.iter().map(|raw: &[u8; N]| {
        let mut raw = *raw;
        if order == Order::Big {
            raw.reverse();
        }
        number(raw)
    }));
}

/// A source of bytes.
pub struct Bytes<'a> {
    from: &'a mut dyn Read,
    pub order: Order,
    /// Bytes left of the innermost element.
    pub left: u64,
    /// Bytes that values may still take in memory.
    pub room: &'a mut u64,
    pub watch: &'a Watch<'a>,
    /// True for the content of a compressed variable.
    is_packed: bool,
}

impl<'a> Bytes<'a> {
    /// The `left` bytes of a file.
    pub fn of_file(from: &'a mut dyn Read, order: Order, left: u64, room: &'a mut u64, watch: &'a Watch<'a>) -> Self {
        Self { from, order, left, room, watch, is_packed: false }
    }

    /// Reads what the next `size` bytes unpack to.
    pub fn unpacked<T>(&mut self, size: u64, read: impl FnOnce(&mut Bytes<'_>) -> Result<T, Stop>) -> Result<T, Stop> {
        self.take(size)?;
        let mut inflated = ZlibDecoder::new((&mut *self.from).take(size));
        let (order, left) = (self.order, size.saturating_mul(MOST_UNPACKED));
        let (room, watch) = (&mut *self.room, self.watch);
        let value = read(&mut Bytes { from: &mut inflated, order, left, room, watch, is_packed: true })?;
        // The checksum stands at the end, behind no more than padding.
        let end = std::io::copy(&mut (&mut inflated).take(MOST_PADDING + 1), &mut std::io::sink());
        if end.map_err(|_| damaged("a compressed variable does not fit its checksum"))? > MOST_PADDING {
            return Err(damaged("a compressed variable is longer than it says"));
        }
        std::io::copy(&mut inflated.into_inner(), &mut std::io::sink()).map_err(Stop::Io)?;
        Ok(value)
    }

    fn take(&mut self, size: u64) -> Result<(), Stop> {
        let left = self.left.checked_sub(size);
        self.left = left.ok_or_else(|| damaged(format!("{size} bytes are claimed where {} are left", self.left)))?;
        Ok(())
    }

    fn failed(&self, error: std::io::Error) -> Stop {
        match error.kind() {
            ErrorKind::UnexpectedEof => damaged("it ends in the middle"),
            _ if self.is_packed => damaged("a compressed variable cannot be unpacked"),
            _ => Stop::Io(error),
        }
    }

    /// Says that the values take so many bytes of memory.
    pub fn charge(&mut self, bytes: u64) -> Result<(), Stop> {
        let left = self.room.checked_sub(bytes);
        *self.room = left.ok_or_else(|| damaged("it unpacks to more values than a file of its size holds"))?;
        if self.watch.is_cancelled() { Err(Stop::Cancelled) } else { Ok(()) }
    }

    /// The next bytes, a few.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], Stop> {
        self.take(N as u64)?;
        let mut bytes = [0; N];
        self.from.read_exact(&mut bytes).map_err(|e| self.failed(e))?;
        Ok(bytes)
    }

    /// A whole number of four bytes.
    pub fn word(&mut self) -> Result<u32, Stop> {
        let bytes = self.array()?;
        Ok(match self.order {
            Order::Little => u32::from_le_bytes(bytes),
            Order::Big => u32::from_be_bytes(bytes),
        })
    }

    /// The next `size` bytes.
    pub fn bytes(&mut self, size: u64) -> Result<Vec<u8>, Stop> {
        self.take(size)?;
        self.charge(size)?;
        let mut bytes = Vec::new();
        (&mut *self.from).take(size).read_to_end(&mut bytes).map_err(|e| self.failed(e))?;
        if bytes.len() as u64 == size { Ok(bytes) } else { Err(damaged("it ends in the middle")) }
    }

    /// Passes the next `size` bytes.
    pub fn skip(&mut self, size: u64) -> Result<(), Stop> {
        self.take(size)?;
        let passed = std::io::copy(&mut (&mut *self.from).take(size), &mut std::io::sink());
        let passed = passed.map_err(|e| self.failed(e))?;
        if passed == size { Ok(()) } else { Err(damaged("it ends in the middle")) }
    }

    /// The next `count` numbers.
    pub fn numbers(&mut self, kind: Kind, count: u64) -> Result<Vec<f64>, Stop> {
        let mut size = count.saturating_mul(kind.size());
        self.take(size)?;
        self.charge(count.saturating_mul(8))?;
        let mut values = Vec::new();
        // The element is no longer than the file, or than what so many packed bytes can hold.
        pages::reserve_exact(&mut values, count as usize);
        let mut block = [0; BLOCK_BYTES];
        while size > 0 {
            let part = &mut block[..size.min(BLOCK_BYTES as u64) as usize];
            self.from.read_exact(part).map_err(|e| self.failed(e))?;
            kind.decode(part, self.order, &mut values);
            size -= part.len() as u64;
        }
        Ok(values)
    }

    /// Reads an element of `size` bytes; what `read` leaves of it is passed.
    pub fn within<T>(&mut self, size: u64, read: impl FnOnce(&mut Self) -> Result<T, Stop>) -> Result<T, Stop> {
        self.take(size)?;
        let outer = std::mem::replace(&mut self.left, size);
        let value = read(self)?;
        self.skip(self.left)?;
        self.left = outer;
        Ok(value)
    }
}

/// A fault of the file.
pub fn damaged(why: impl Into<String>) -> Stop {
    Stop::Damaged(why.into())
}
