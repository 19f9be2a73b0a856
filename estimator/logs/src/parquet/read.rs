//! Reading Parquet: every flat column of numbers or text.

use super::column::{self, Meaning};
use super::metadata::{SIDECAR, is_index, one_line};
use super::sums::Sums;
use super::{footer, guard};
use crate::errors::LogError;
use crate::raw::{Cells, Raw};
use crate::watch::Watch;
use crate::{pages, units};
use haptics::recording::{Labels, Warning};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::fs::File;
use std::path::Path;

/// The table, the sidecar that the file carries, and warnings about the file.
pub type Columns = (Raw, Option<String>, Vec<Warning>);

/// Memory that the table may take in any case, bytes.
const TABLE_BYTES: u64 = 256 << 20;
/// Memory that the table may take in multiples of the size of the file: real logs stay far below, packed nonsense does
/// not.
const TABLE_TIMES_FILE: u64 = 32;

/// Reads the columns of a Parquet file.
pub fn read(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Columns, LogError> {
    guard::guarded(|| whole(path, size, watch)).unwrap_or_else(|| {
        let why = "a page whose content cannot be".to_owned();
        Err(LogError::Damaged { format: "Parquet", why, path: path.to_path_buf() })
    })
}

fn whole(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Columns, LogError> {
    let damaged = |why: String| LogError::Damaged { format: "Parquet", why, path: path.to_path_buf() };
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut file = File::open(path).map_err(io)?;
    if let Some(why) = footer::fault(&mut file, size).map_err(io)? {
        return Err(damaged(why));
    }
    let reader = SerializedFileReader::new(file).map_err(|e| damaged(one_line(&e)))?;
    let facts = reader.metadata().file_metadata().clone();
    let schema = facts.schema_descr();
    let (mut raw, mut said) = (Raw::default(), Vec::new());
    let mut used = Vec::new();
    for (index, column) in schema.columns().iter().enumerate() {
        let name = column.path().string();
        if is_index(&name) {
            continue;
        }
        match column::meaning(column) {
            Ok(meaning) => {
                used.push((index, meaning));
                raw.headers.push(header(&name, meaning));
                raw.aliases.push(name);
                let text = meaning == Meaning::Text;
                raw.columns.push(if text { Cells::Text(Labels::default()) } else { Cells::Numbers(Vec::new()) });
            }
            Err(why) => said.push(Warning {
                kind: "text-column".to_owned(),
                column: Some(name.clone()),
                spans: Vec::new(),
                text: format!("the column `{name}` is not read: {why}"),
            }),
        }
    }
    if used.is_empty() {
        let why = said.first().map_or_else(|| "it has no columns".to_owned(), |w| w.text.clone());
        return Err(LogError::NoColumns { format: "Parquet", why, path: path.to_path_buf() });
    }
    let rows = u64::try_from(facts.num_rows()).map_err(|_| damaged("a negative number of rows".to_owned()))?;
    let bytes = rows.saturating_mul(8 * used.len() as u64);
    if bytes > TABLE_BYTES.max(TABLE_TIMES_FILE * size) {
        return Err(damaged(format!("it claims {rows} rows, which a file of {size} bytes does not hold")));
    }
    let cancelled = || LogError::Cancelled { path: path.to_path_buf() };
    columns(&reader, &used, rows, &mut raw, watch).map_err(|why| why.map_or_else(cancelled, damaged))?;
    if let Some(why) = Sums::fault(&facts, &raw) {
        return Err(damaged(why));
    }
    let carried = facts.key_value_metadata().and_then(|all| all.iter().find(|kv| kv.key == SIDECAR)?.value.clone());
    Ok((raw, carried, said))
}

/// A point in time without a unit in its name becomes one in seconds.
fn header(name: &str, meaning: Meaning) -> String {
    match meaning {
        Meaning::Time(_) if units::split(name).is_none() => format!("{name}_s"),
        _ => name.to_owned(),
    }
}

/// Reads block by block; an error without words if the reading was cancelled.
fn columns(
    reader: &SerializedFileReader<File>,
    used: &[(usize, Meaning)],
    rows: u64,
    raw: &mut Raw,
    watch: &Watch<'_>,
) -> Result<(), Option<String>> {
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    for cells in &mut raw.columns {
        if let Cells::Numbers(values) = cells {
            pages::reserve_exact(values, rows as usize);
        }
    }
    let mut bases = vec![None; used.len()];
    let mut sum: u64 = 0;
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(|e| Some(one_line(&e)))?;
        let count =
            u64::try_from(group.metadata().num_rows()).map_err(|_| Some("a negative number of rows".to_owned()))?;
        sum = sum.saturating_add(count);
        if sum > rows {
            return Err(Some("its blocks have more rows than the file says".to_owned()));
        }
        for (at, (&(index, meaning), base)) in used.iter().zip(&mut bases).enumerate() {
            let column = schema.column(index);
            let cells = &mut raw.columns[at];
            let done = group
                .get_column_reader(index)
                .and_then(|reader| column::append(reader, &column, meaning, count as usize, base, cells));
            done.map_err(|e| Some(format!("the column `{}`: {}", column.path().string(), one_line(&e))))?;
            if watch.is_cancelled() {
                return Err(None);
            }
            // Many files are one block.
            show(raw, watch);
        }
        (watch.progress)(sum as f64 / rows.max(1) as f64);
    }
    if sum == rows { Ok(()) } else { Err(Some(format!("it says that it has {rows} rows and has {sum}"))) }
}

/// Shows the rows read so far; the first column whose name is that of a time is the clock.
fn show(raw: &Raw, watch: &Watch<'_>) {
    let Some(preview) = watch.preview else { return };
    let numbers = raw.headers.iter().zip(&raw.columns).filter_map(|(name, cells)| match cells {
        Cells::Numbers(values) => Some((name.as_str(), values.as_slice())),
        Cells::Text(_) => None,
    });
    let clock = numbers.clone().find(|(name, _)| *name == "t_s");
    preview.grow("", 0, clock.map_or(&[], |c| c.1), numbers.filter(|n| Some(n.0) != clock.map(|c| c.0)));
}
