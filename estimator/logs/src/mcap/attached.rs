//! Files that travel in an MCAP file: the world and the device of a training recording.

use super::records::{PREFIX, fill, split_prefix};
use crate::errors::LogError;
use mcap::records::op;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

/// Largest attachment that is read, bytes: a world takes thousands.
const MOST_BYTES: u64 = 16 << 20;

/// Attachment with a name; `None` if there is none, the file is no MCAP file, or it breaks off before.
///
/// # Errors
/// The file cannot be read.
pub fn attached(path: &Path, name: &str) -> Result<Option<Vec<u8>>, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut file = BufReader::with_capacity(1 << 16, File::open(path).map_err(io)?);
    let mut magic = [0; mcap::MAGIC.len()];
    if !fill(&mut file, &mut magic).map_err(io)? || magic != *mcap::MAGIC {
        return Ok(None);
    }
    let mut prefix = [0; PREFIX];
    while fill(&mut file, &mut prefix).map_err(io)? {
        let (opcode, length) = split_prefix(prefix);
        if opcode == op::FOOTER {
            return Ok(None);
        }
        if opcode == op::ATTACHMENT && length <= MOST_BYTES {
            let mut body = Vec::new();
            file.by_ref().take(length).read_to_end(&mut body).map_err(io)?;
            if let Some((_, data)) = split(&body).filter(|(found, _)| *found == name.as_bytes()) {
                return Ok(Some(data.to_vec()));
            }
        } else {
            let skipped = std::io::copy(&mut file.by_ref().take(length), &mut std::io::sink()).map_err(io)?;
            if skipped < length {
                return Ok(None);
            }
        }
    }
    Ok(None)
}

/// Name and content of an attachment: two times, name, media type, content, checksum. By hand, as the crate panics where a length is
/// wrong.
fn split(body: &[u8]) -> Option<(&[u8], &[u8])> {
    let short = |at: &[u8]| -> Option<(usize, usize)> {
        let length = u32::from_le_bytes(*at.first_chunk()?);
        Some((4, length as usize))
    };
    let rest = body.get(16..)?;
    let (skip, length) = short(rest)?;
    let (name, rest) = rest.get(skip..)?.split_at_checked(length)?;
    let (skip, length) = short(rest)?;
    let (_, rest) = rest.get(skip..)?.split_at_checked(length)?;
    let length = usize::try_from(u64::from_le_bytes(*rest.first_chunk()?)).ok()?;
    let (data, checksum) = rest.get(8..)?.split_at_checked(length)?;
    (checksum.len() == 4).then_some((name, data))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Attachment, write};
    use haptics::recording::{Channel, Recording};

    #[test]
    fn what_was_attached_comes_back_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.mcap");
        let channel = Channel { name: "q_m".into(), unit: "m".into(), values: vec![0.0, 1.0, 2.0] };
        let recording =
            Recording { channels: vec![channel], time_s: Some(vec![0.0, 0.1, 0.2]), ..Recording::default() };
        let attachment = |name: &str, data: &[u8]| Attachment {
            name: name.to_owned(),
            media_type: "text/plain".to_owned(),
            data: data.to_vec(),
        };
        write(&[recording], &file, &[attachment("a", b"first"), attachment("world.json", b"{}")]).expect("written");
        let read = |name: &str| attached(&file, name).expect("read");
        assert_eq!(read("world.json").as_deref(), Some(&b"{}"[..]));
        assert_eq!(read("a").as_deref(), Some(&b"first"[..]));
        assert_eq!(read("b"), None);
        // Cut at any place it returns nothing, or the whole attachment.
        let bytes = std::fs::read(&file).expect("there");
        for end in (0..bytes.len()).step_by(7) {
            std::fs::write(&file, &bytes[..end]).expect("written");
            assert!(read("world.json").is_none_or(|data| data == b"{}"), "cut at {end}");
        }
        std::fs::write(&file, "t_s,q_m\n").expect("written");
        assert_eq!(read("a"), None);
        assert!(attached(&folder.path().join("none.mcap"), "a").is_err());
    }
}
