//! Walks through the records of an MCAP file, chunk by chunk, in bounded memory.
//!
//! The record layouts come from the crate `mcap`; the walk is our own because untrusted lengths are checked here
//! against the size of the file, before anything is allocated for them.

use super::lengths;
use crate::errors::LogError;
use crate::watch::Watch;
use mcap::records::{ChunkHeader, Record, op};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Largest block that is unpacked in any case, bytes; beyond it, four times the size of the file.
const CHUNK_BYTES: u64 = 32 << 20;
/// Number of bytes from one report of the progress to the next; at each the caller may end the walk.
const WATCH_BYTES: u64 = 1 << 20;
/// Op code and length before every record.
pub(super) const PREFIX: usize = 9;

/// Item met by the walk. Everything else in a file (indices, attachments, statistics) is passed over.
pub enum Event<'a> {
    /// A schema, a channel or metadata.
    Record(Record<'a>),
    /// A message: channel, log time in ns, content.
    Message(u16, u64, &'a [u8]),
}

/// End of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// With its footer.
    Complete,
    /// In the middle; everything before was whole.
    CutOff(String),
}

/// Calls `take` for every event. A complaint of `take` ends the walk.
pub fn walk(
    path: &Path,
    size: u64,
    watch: &Watch<'_>,
    take: &mut dyn FnMut(Event<'_>) -> Result<(), LogError>,
) -> Result<End, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut file = BufReader::with_capacity(1 << 18, File::open(path).map_err(io)?);
    let mut walk = Walk { path, size, at: 0, unpacked: Vec::new() };
    let mut magic = [0; mcap::MAGIC.len()];
    if !fill(&mut file, &mut magic).map_err(io)? {
        return Ok(End::CutOff("it has no content".to_owned()));
    }
    if magic != *mcap::MAGIC {
        return Err(walk.damaged("its first bytes are not those of MCAP version 0"));
    }
    walk.at = magic.len() as u64;
    let mut body = Vec::new();
    let mut told = 0;
    loop {
        if walk.at >= told + WATCH_BYTES {
            told = walk.at;
            if watch.is_cancelled() {
                return Err(LogError::Cancelled { path: path.to_path_buf() });
            }
            (watch.progress)(walk.at as f64 / size.max(1) as f64);
        }
        let mut prefix = [0; PREFIX];
        if !fill(&mut file, &mut prefix).map_err(io)? {
            return Ok(End::CutOff(format!("after {} bytes, without its footer", walk.at)));
        }
        let (opcode, length) = split_prefix(prefix);
        if opcode == 0 {
            return Err(walk.damaged("a record of no kind"));
        }
        let left = size.saturating_sub(walk.at + PREFIX as u64);
        if length > left {
            return Ok(End::CutOff(format!("a record at byte {} needs {length} bytes and {left} follow", walk.at)));
        }
        if opcode == op::FOOTER {
            return walk.close(&mut file, length).map_err(io);
        }
        if is_wanted(opcode) {
            body.resize(length as usize, 0);
            if !fill(&mut file, &mut body).map_err(io)? {
                return Ok(End::CutOff(format!("within the record at byte {}", walk.at)));
            }
            walk.record(opcode, &body, take)?;
        } else {
            std::io::copy(&mut file.by_ref().take(length), &mut std::io::sink()).map_err(io)?;
        }
        walk.at += PREFIX as u64 + length;
    }
}

fn is_wanted(opcode: u8) -> bool {
    matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK | op::METADATA)
}

pub(super) fn split_prefix(prefix: [u8; PREFIX]) -> (u8, u64) {
    let [opcode, length @ ..] = prefix;
    (opcode, u64::from_le_bytes(length))
}

/// Fills `buffer`, or says that the file is shorter.
pub(super) fn fill(file: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<bool> {
    match file.read_exact(buffer) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

struct Walk<'a> {
    path: &'a Path,
    size: u64,
    /// Byte at which the current record starts.
    at: u64,
    unpacked: Vec<u8>,
}

impl Walk<'_> {
    fn damaged(&self, why: &str) -> LogError {
        let why = format!("{why}, at byte {}", self.at);
        LogError::Damaged { format: "MCAP", why, path: self.path.to_path_buf() }
    }

    /// The footer and the magic bytes after it.
    fn close(&self, file: &mut impl Read, length: u64) -> std::io::Result<End> {
        std::io::copy(&mut file.take(length), &mut std::io::sink())?;
        let mut magic = [0; mcap::MAGIC.len()];
        let whole = fill(file, &mut magic)? && magic == *mcap::MAGIC;
        Ok(if whole { End::Complete } else { End::CutOff(format!("within the footer at byte {}", self.at)) })
    }

    fn record(
        &mut self,
        opcode: u8,
        body: &[u8],
        take: &mut dyn FnMut(Event<'_>) -> Result<(), LogError>,
    ) -> Result<(), LogError> {
        if opcode == op::MESSAGE {
            return self.message(body, take);
        }
        match self.parsed(opcode, body)? {
            Record::Chunk { header, data } => {
                let mut unpacked = std::mem::take(&mut self.unpacked);
                let records = self.unpack(&header, &data, &mut unpacked)?;
                self.chunk(records, take)?;
                self.unpacked = unpacked;
                Ok(())
            }
            record => take(Event::Record(record)),
        }
    }

    /// A record as the library sees it, once its lengths have been found to lie within it: the library reserves room
    /// for them.
    fn parsed<'b>(&self, opcode: u8, body: &'b [u8]) -> Result<Record<'b>, LogError> {
        if !lengths::fit(opcode, body) {
            return Err(self.damaged("a record with a text or a table longer than itself"));
        }
        mcap::parse_record(opcode, body).map_err(|e| self.damaged(&one_line(&e)))
    }

    fn message(&self, body: &[u8], take: &mut dyn FnMut(Event<'_>) -> Result<(), LogError>) -> Result<(), LogError> {
        // Channel, sequence, log time, publish time: 2 + 4 + 8 + 8 bytes, little endian.
        let Some((head, data)) = body.split_first_chunk::<22>() else {
            return Err(self.damaged("a message shorter than its header"));
        };
        let channel = u16::from_le_bytes([head[0], head[1]]);
        let mut time = [0; 8];
        time.copy_from_slice(&head[6..14]);
        take(Event::Message(channel, u64::from_le_bytes(time), data))
    }

    /// The records of a chunk, in `unpacked` or where they stand, after their checksum.
    fn unpack<'b>(&self, header: &ChunkHeader, data: &'b [u8], into: &'b mut Vec<u8>) -> Result<&'b [u8], LogError> {
        let claimed = header.uncompressed_size;
        if claimed > CHUNK_BYTES.max(4 * self.size) {
            return Err(self.damaged(&format!("a block that claims to unpack to {claimed} bytes")));
        }
        let failed = |error: std::io::Error| self.damaged(&format!("a block that cannot be unpacked ({error})"));
        let records: &[u8] = match header.compression.as_str() {
            "" => data,
            "zstd" => {
                into.clear();
                // As much as there is, not as much as is claimed.
                let decoder = zstd::Decoder::with_buffer(data).map_err(failed)?;
                decoder.take(claimed + 1).read_to_end(into).map_err(failed)?;
                into
            }
            "lz4" => {
                into.clear();
                let decoder = lz4::Decoder::new(data).map_err(failed)?;
                decoder.take(claimed + 1).read_to_end(into).map_err(failed)?;
                into
            }
            other => {
                let (codec, path) = (format!("`{other}`"), self.path.to_path_buf());
                return Err(LogError::Packed { format: "MCAP", codec, instead: "zstd or lz4", path });
            }
        };
        if records.len() as u64 != claimed {
            return Err(self.damaged(&format!("a block of {} bytes that claims {claimed}", records.len())));
        }
        if header.uncompressed_crc != 0 && crc32fast::hash(records) != header.uncompressed_crc {
            return Err(self.damaged("a block whose checksum does not fit its content"));
        }
        Ok(records)
    }

    fn chunk(
        &self,
        mut records: &[u8],
        take: &mut dyn FnMut(Event<'_>) -> Result<(), LogError>,
    ) -> Result<(), LogError> {
        while !records.is_empty() {
            let Some((prefix, rest)) = records.split_first_chunk::<PREFIX>() else {
                return Err(self.damaged("a block that ends within a record"));
            };
            let (opcode, length) = split_prefix(*prefix);
            if length > rest.len() as u64 {
                return Err(self.damaged("a block that ends within a record"));
            }
            let (body, rest) = rest.split_at(length as usize);
            match opcode {
                op::MESSAGE => self.message(body, take)?,
                op::SCHEMA | op::CHANNEL => {
                    take(Event::Record(self.parsed(opcode, body)?))?;
                }
                _ => {}
            }
            records = rest;
        }
        Ok(())
    }
}

/// The first line of an error of the library: some draw pictures of the place.
pub fn one_line(error: &impl std::fmt::Display) -> String {
    let text = error.to_string();
    let line = text.lines().map(str::trim).find(|l| !l.is_empty()).unwrap_or("malformed");
    line.chars().take(120).collect()
}
