//! Check of a Parquet file's footer before its library believes it: the library reserves room for as many columns as
//! the footer claims, and goes as deep as they are nested.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};

/// At the end of the file stand the footer's length and these letters.
const MAGIC: &[u8; 4] = b"PAR1";
const TAIL_BYTES: u64 = 8;
/// Structures and columns nested deeper than this are no log's.
const DEEPEST: usize = 64;
/// Field of the file's facts that lists the columns, and of a column that says how many it is made of.
const SCHEMA: i64 = 2;
const CHILDREN: i64 = 5;

/// Fault of the footer's claims, if there is one. A file without a footer is left to the library.
pub fn fault(file: &mut File, size: u64) -> std::io::Result<Option<String>> {
    if size < TAIL_BYTES {
        return Ok(None);
    }
    let mut tail = [0; TAIL_BYTES as usize];
    file.seek(SeekFrom::Start(size - TAIL_BYTES))?;
    file.read_exact(&mut tail)?;
    let [a, b, c, d, magic @ ..] = tail;
    let long = u64::from(u32::from_le_bytes([a, b, c, d]));
    if magic != *MAGIC || long > size - TAIL_BYTES {
        return Ok(None);
    }
    let mut footer = Vec::new();
    file.seek(SeekFrom::Start(size - TAIL_BYTES - long))?;
    file.take(long).read_to_end(&mut footer)?;
    Ok(claims(&footer).err())
}

/// Looks through the facts of a file, in Thrift's compact protocol.
fn claims(footer: &[u8]) -> Result<(), String> {
    let mut rest = Rest(footer);
    let mut columns = Vec::new();
    let mut id = 0;
    while let Some(kind) = rest.field(&mut id)? {
        if id != SCHEMA {
            rest.skip(kind, DEEPEST)?;
            continue;
        }
        let (count, member) = if kind == LIST { rest.list()? } else { (0, 0) };
        if member != STRUCT {
            return Err("columns that are none".to_owned());
        }
        for _ in 0..count {
            columns.push(rest.children()?);
        }
    }
    tree(&columns)
}

/// Checks that the columns, each with the number of its children, make one tree that is not too deep.
fn tree(columns: &[i64]) -> Result<(), String> {
    let mut open: Vec<i64> = Vec::new();
    for &children in columns {
        if !usize::try_from(children).is_ok_and(|parts| parts <= columns.len()) {
            return Err(format!("a group that claims {children} columns in a file of {}", columns.len()));
        }
        if let Some(left) = open.last_mut() {
            *left -= 1;
        }
        open.push(children);
        while open.last() == Some(&0) {
            open.pop();
        }
        if open.len() > DEEPEST {
            return Err(format!("columns within columns, more than {DEEPEST} deep"));
        }
    }
    Ok(())
}

const TRUE: u8 = 1;
const FALSE: u8 = 2;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// Unread rest of the footer.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn cut() -> String {
        "a footer that ends early".to_owned()
    }

    fn byte(&mut self) -> Result<u8, String> {
        let (first, rest) = self.0.split_first().ok_or_else(Self::cut)?;
        self.0 = rest;
        Ok(*first)
    }

    fn pass(&mut self, count: u64) -> Result<(), String> {
        let count = usize::try_from(count).map_err(|_| Self::cut())?;
        self.0 = self.0.get(count..).ok_or_else(Self::cut)?;
        Ok(())
    }

    fn varint(&mut self) -> Result<u64, String> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err("a number without an end in its footer".to_owned())
    }

    /// A whole number with its sign in the last bit.
    fn whole(&mut self) -> Result<i64, String> {
        let coded = self.varint()?;
        Ok((coded >> 1).cast_signed() ^ -(coded & 1).cast_signed())
    }

    /// The kind of the next field, whose number follows `id`; none at the end of the structure.
    fn field(&mut self, id: &mut i64) -> Result<Option<u8>, String> {
        let head = self.byte()?;
        if head == 0 {
            return Ok(None);
        }
        *id = if head >> 4 == 0 { self.whole()? } else { id.saturating_add(i64::from(head >> 4)) };
        Ok(Some(head & 0x0f))
    }

    /// Length and kind of a list: each of its members has a byte at least.
    fn list(&mut self) -> Result<(u64, u8), String> {
        let head = self.byte()?;
        let count = if head >> 4 == 15 { self.varint()? } else { u64::from(head >> 4) };
        if count > self.0.len() as u64 {
            return Err(format!("a list that claims {count} members in {} bytes", self.0.len()));
        }
        Ok((count, head & 0x0f))
    }

    /// The number of columns that a column says it is made of.
    fn children(&mut self) -> Result<i64, String> {
        let (mut id, mut children) = (0, 0);
        while let Some(kind) = self.field(&mut id)? {
            match (id, kind) {
                (CHILDREN, 5) => children = self.whole()?,
                // The library takes whatever stands there for a number.
                (CHILDREN, _) => return Err("a group whose number of columns is none".to_owned()),
                _ => self.skip(kind, DEEPEST)?,
            }
        }
        Ok(children)
    }

    /// Passes by a value of a field.
    fn skip(&mut self, kind: u8, deeper: usize) -> Result<(), String> {
        let deeper = deeper.checked_sub(1).ok_or_else(|| "a footer that is nested too deep".to_owned())?;
        match kind {
            TRUE | FALSE => Ok(()),
            3 => self.pass(1),
            4..=6 => self.varint().map(drop),
            7 => self.pass(8),
            8 => {
                let long = self.varint()?;
                self.pass(long)
            }
            LIST | 10 => {
                let (count, kind) = self.list()?;
                (0..count).try_for_each(|_| self.member(kind, deeper))
            }
            11 => {
                let count = self.varint()?;
                let kinds = if count > 0 { self.byte()? } else { 0 };
                (0..count).try_for_each(|_| {
                    self.member(kinds >> 4, deeper)?;
                    self.member(kinds & 0x0f, deeper)
                })
            }
            STRUCT => {
                let mut id = 0;
                while let Some(kind) = self.field(&mut id)? {
                    self.skip(kind, deeper)?;
                }
                Ok(())
            }
            13 => self.pass(16),
            _ => Err(format!("a footer with a value of the unknown kind {kind}")),
        }
    }

    /// A member of a list or a map: there a yes or no takes a byte.
    fn member(&mut self, kind: u8, deeper: usize) -> Result<(), String> {
        if matches!(kind, TRUE | FALSE) { self.pass(1) } else { self.skip(kind, deeper) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column: the number of its parts, and a name.
    fn column(parts: u8) -> Vec<u8> {
        vec![0x48, 1, b'n', 0x15, 2 * parts, 0]
    }

    /// The facts of a file with these columns, and nothing else.
    fn facts(columns: &[Vec<u8>]) -> Vec<u8> {
        let count = columns.len();
        let mut made = vec![0x29, 0xfc, (count & 0x7f) as u8 | 0x80, (count >> 7) as u8];
        made.extend(columns.concat());
        made.push(0);
        made
    }

    #[test]
    fn columns_make_a_tree_of_what_is_there() {
        let flat = facts(&[column(2), column(0), column(0)]);
        assert_eq!(claims(&flat), Ok(()));
        let said = claims(&facts(&[column(60), column(0)])).expect_err("two are there");
        assert_eq!(said, "a group that claims 60 columns in a file of 2");
        assert_eq!(claims(&flat[..flat.len() - 3]), Err("a footer that ends early".to_owned()));
        let said = claims(&[0x29, 0xfc, 0xff, 0xff, 0x03]).expect_err("nothing is there");
        assert_eq!(said, "a list that claims 65535 members in 0 bytes");
    }

    #[test]
    fn nothing_is_nested_without_an_end() {
        let nested = |deep: usize| facts(&[vec![column(1); deep], vec![column(0)]].concat());
        assert_eq!(claims(&nested(60)), Ok(()));
        assert!(claims(&nested(5000)).expect_err("too deep").contains("more than 64 deep"));
        // A structure in a structure in a structure …
        assert!(claims(&[0x1c; 5000]).expect_err("too deep").contains("nested too deep"));
    }

    #[test]
    fn the_files_of_the_corpus_are_what_they_were() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus/parquet");
        for (name, wanted) in [
            ("small.parquet", None),
            ("text.parquet", None),
            ("page-checksums.parquet", None),
            ("many-children.parquet", Some("number of columns is none")),
        ] {
            let mut file = File::open(folder.join(name)).expect("it is there");
            let size = file.metadata().expect("a size").len();
            let said = fault(&mut file, size).expect("it can be read");
            assert!(said.as_deref().is_some() == wanted.is_some(), "{name}: {said:?}");
            assert!(
                wanted.is_none_or(|wanted| said.as_ref().is_some_and(|said| said.contains(wanted))),
                "{name}: {said:?}"
            );
        }
    }
}
