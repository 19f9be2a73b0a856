//! MATLAB files of levels 4 and 5 (versions 4 to 7): their variables, to one table.

mod bytes;
mod gather;
mod level4;
mod level5;
mod names;
mod table;
mod value;

use super::errors::LogError;
use super::raw::Raw;
use super::watch::Watch;
use crate::room;
use bytes::{Bytes, Stop};
use gather::Gathered;
use haptics::recording::Warning;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _, SeekFrom};
use std::path::Path;
use value::Value;

/// Bytes of a file's start that tell it from others.
pub const START: usize = level5::HEADER;
/// First bytes of the header of level 5, as MATLAB and most others write it.
const MAGIC: &[u8] = b"MATLAB 5.0";

/// True for the start of a file of `size` bytes that is one of MATLAB's.
pub fn is_one(start: &[u8], size: u64) -> bool {
    start.starts_with(MAGIC) || level5::order(start).is_some() || level4::order(start, size).is_some()
}

/// True for the start of a file of version 7.3, whose content is HDF5.
pub fn is_hdf5(start: &[u8]) -> bool {
    matches!(start.get(124..level5::HEADER), Some([0, 2, b'I', b'M'] | [2, 0, b'M', b'I']))
}

/// Reads the table of a file, with notes about the variables that do not belong to it.
pub fn read(path: &Path, size: u64, watch: &Watch<'_>) -> Result<(Raw, Vec<Warning>), LogError> {
    let variables = variables(path, size, watch).map_err(|stop| match stop {
        Stop::Io(error) => LogError::Io { reason: error.to_string(), path: path.to_path_buf() },
        Stop::Damaged(why) => LogError::Damaged { format: "MATLAB", why, path: path.to_path_buf() },
        Stop::Cancelled => LogError::Cancelled { path: path.to_path_buf() },
    })?;
    let none = |why| LogError::NoColumns { format: "MATLAB", why, path: path.to_path_buf() };
    table::of(Gathered::of(variables)).map_err(none)
}

/// Names and values of all variables, in the order of the file.
fn variables(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Vec<(String, Value)>, Stop> {
    let mut file = BufReader::new(File::open(path).map_err(Stop::Io)?);
    let mut start = Vec::new();
    (&mut file).take(START as u64).read_to_end(&mut start).map_err(Stop::Io)?;
    let mut room = room::limit(size);
    let mut found: Vec<(String, Value)> = Vec::new();
    let mut known = HashMap::new();
    let mut take = |name: String, value: Value, left: u64| {
        (watch.progress)(1.0 - left as f64 / size.max(1) as f64);
        // The last one of a name holds, as in MATLAB.
        let at: usize = *known.entry(name.clone()).or_insert(found.len());
        match found.get_mut(at) {
            Some(earlier) => earlier.1 = value,
            None => found.push((name, value)),
        }
    };
    if let Some(order) = level5::order(&start) {
        let left = size.saturating_sub(START as u64);
        level5::variables(&mut Bytes::of_file(&mut file, order, left, &mut room, watch), &mut take)?;
    } else if let Some(order) = level4::order(&start, size) {
        file.seek(SeekFrom::Start(0)).map_err(Stop::Io)?;
        level4::variables(&mut Bytes::of_file(&mut file, order, size, &mut room, watch), &mut take)?;
    } else {
        return Err(bytes::damaged("its header ends early, or has no order of bytes"));
    }
    Ok(found)
}

#[cfg(test)]
mod tests;
