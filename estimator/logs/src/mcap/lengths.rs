//! Check that the lengths inside a record lie within it, before the library reserves room for them.

use mcap::records::op;

/// One field of a record, as the specification of MCAP lists them.
#[derive(Clone, Copy)]
enum Field {
    /// Fixed number of bytes.
    Fixed(usize),
    /// Length in four bytes, then text, bytes, or a table of texts.
    Short,
    /// Length in eight bytes, then bytes.
    Long,
    /// Length in four bytes, then pairs of texts.
    Texts,
}

use Field::{Fixed, Long, Short, Texts};

/// The fields of the records that are read.
fn fields(opcode: u8) -> &'static [Field] {
    match opcode {
        // id; name, encoding, data
        op::SCHEMA => &[Fixed(2), Short, Short, Short],
        // id, schema; topic, encoding, metadata
        op::CHANNEL => &[Fixed(4), Short, Short, Texts],
        // start, end, size, checksum; compression, records
        op::CHUNK => &[Fixed(28), Short, Long],
        // name, metadata
        op::METADATA => &[Short, Texts],
        _ => &[],
    }
}

/// True if every length in the record lies within the rest of it.
pub fn fit(opcode: u8, body: &[u8]) -> bool {
    let mut rest = body;
    fields(opcode).iter().all(|&field| {
        let Some((inside, after)) = split(field, rest) else { return false };
        rest = after;
        !matches!(field, Texts) || all_texts(inside)
    })
}

fn all_texts(mut table: &[u8]) -> bool {
    while !table.is_empty() {
        let Some((_, rest)) = split(Short, table) else { return false };
        table = rest;
    }
    true
}

fn split(field: Field, bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, bytes) = match field {
        Fixed(length) => (length as u64, bytes),
        Short | Texts => bytes.split_first_chunk().map(|(n, rest)| (u64::from(u32::from_le_bytes(*n)), rest))?,
        Long => bytes.split_first_chunk().map(|(n, rest)| (u64::from_le_bytes(*n), rest))?,
    };
    bytes.split_at_checked(usize::try_from(length).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_beyond_the_record_are_seen() {
        let text = |t: &str| [&(t.len() as u32).to_le_bytes()[..], t.as_bytes()].concat();
        let channel = |claimed: u32| {
            let table = [text("a"), text("b")].concat();
            [vec![1, 0, 2, 0], text("topic"), text("json"), claimed.to_le_bytes().to_vec(), table].concat()
        };
        assert!(
            fit(op::CHANNEL, &channel(10)) && !fit(op::CHANNEL, &channel(11)) && !fit(op::CHANNEL, &channel(u32::MAX))
        );
        // A table that ends within a text.
        assert!(!fit(op::CHANNEL, &channel(9)));
        assert!(!fit(op::METADATA, &u32::MAX.to_le_bytes()) && !fit(op::CHUNK, &[0; 30]));
        assert!(fit(op::CHUNK, &[0; 40]) && fit(op::HEADER, &[]));
    }
}
