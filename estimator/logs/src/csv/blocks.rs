//! A file cut into blocks that end where a record ends.

use super::cells::record_end;
use memchr::{memchr, memrchr};
use std::io::{Read, Take};

/// Bytes a block has, about: fits the cache of a core, and is read in one go.
pub const BLOCK_BYTES: usize = 1 << 20;
/// A record longer than this is an open quote or no table.
const MAX_RECORD_BYTES: usize = 16 << 20;

/// Why there is no next block.
#[derive(Debug)]
pub enum Stop {
    /// The system refused.
    Io(std::io::Error),
    /// No end of a record within [`MAX_RECORD_BYTES`]; true when a quote was left open.
    Endless(bool),
}

/// Cuts the bytes of `source`.
#[derive(Debug)]
pub struct Blocks<R> {
    source: Take<R>,
    delimiter: u8,
    block_bytes: usize,
    /// Start of the record that the last block did not hold whole.
    rest: Vec<u8>,
    /// Blocks given so far.
    count: usize,
    ended: bool,
    /// Memory of blocks that have been parsed.
    spare: Vec<Vec<u8>>,
}

impl<R: Read> Blocks<R> {
    /// Blocks of about `block_bytes` from a source that stands behind the header.
    pub fn new(source: R, delimiter: u8, block_bytes: usize) -> Self {
        Self {
            source: source.take(0),
            delimiter,
            block_bytes,
            rest: Vec::new(),
            count: 0,
            ended: false,
            spare: Vec::new(),
        }
    }

    /// The next block and its number, counted from 0: whole records, the last of the file perhaps without its line end.
    pub fn next(&mut self) -> Result<Option<(usize, Vec<u8>)>, Stop> {
        if self.ended {
            return Ok(None);
        }
        let mut bytes = self.spare.pop().unwrap_or_default();
        bytes.clear();
        bytes.reserve(self.rest.len() + self.block_bytes + 1);
        bytes.append(&mut self.rest);
        loop {
            self.source.set_limit(self.block_bytes as u64);
            let read = self.source.read_to_end(&mut bytes).map_err(Stop::Io)?;
            if read < self.block_bytes {
                self.ended = true;
                break;
            }
            if let Some(end) = self.last_end(&bytes) {
                self.rest.extend_from_slice(&bytes[end..]);
                bytes.truncate(end);
                break;
            }
            if bytes.len() > MAX_RECORD_BYTES {
                self.ended = true;
                return Err(Stop::Endless(memchr(b'"', &bytes).is_some()));
            }
        }
        self.count += 1;
        Ok((!bytes.is_empty()).then_some((self.count - 1, bytes)))
    }

    /// Gives the memory of a block back.
    pub fn recycle(&mut self, bytes: Vec<u8>) {
        // Not that of a block with an overlong record.
        if bytes.capacity() <= 4 * self.block_bytes {
            self.spare.push(bytes);
        }
    }

    /// One past the line end of the last whole record.
    fn last_end(&self, bytes: &[u8]) -> Option<usize> {
        if memchr(b'"', bytes).is_none() {
            return memrchr(b'\n', bytes).map(|at| at + 1);
        }
        let mut end = 0;
        while let Some(at) = record_end(bytes, end, self.delimiter) {
            end = at + 1;
        }
        (end > 0).then_some(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(text: &str, block_bytes: usize) -> Vec<String> {
        let mut blocks = Blocks::new(text.as_bytes(), b',', block_bytes);
        let mut found = Vec::new();
        while let Some((index, bytes)) = blocks.next().expect("reads") {
            assert_eq!(index, found.len());
            found.push(String::from_utf8(bytes).expect("text"));
        }
        found
    }

    #[test]
    fn blocks_end_with_records_and_lose_nothing() {
        let text = "1,2\n3,\"4\n5\"\n\n# a \" quote\n6,7";
        for size in 1..40 {
            let blocks = cut(text, size);
            assert_eq!(blocks.concat(), text, "{size}");
            let (_, whole) = blocks.split_last().expect("blocks");
            assert!(whole.iter().all(|b| b.ends_with('\n') && b.matches("\"4").count() == b.matches("5\"").count()));
        }
        assert_eq!(cut(text, 4)[0], "1,2\n");
        assert!(cut("", 4).is_empty());
    }

    #[test]
    fn a_quote_that_never_closes_ends_the_reading() {
        let text = format!("\"{}", "1,2\n".repeat(MAX_RECORD_BYTES / 3));
        let mut blocks = Blocks::new(text.as_bytes(), b',', BLOCK_BYTES);
        assert!(matches!(blocks.next(), Err(Stop::Endless(true))));
    }
}
