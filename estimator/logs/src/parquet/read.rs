//! Reading Parquet: every column of numbers or text, and lists of them as one column an item.

use super::column::{self, Flat, Meaning};
use super::list::{self, Items, List};
use super::metadata::{self, SIDECAR, one_line};
use super::shape::{self, Shape};
use super::sums::Sums;
use super::{arrow_schema, footer, guard};
use crate::errors::LogError;
use crate::raw::{Cells, Raw};
use crate::units::Dimension;
use crate::watch::Watch;
use crate::{pages, room, units};
use haptics::recording::{Labels, Warning};
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::SchemaDescriptor;
use std::fs::File;
use std::path::Path;

/// The table, the sidecar that the file carries, and warnings about the file.
pub type Columns = (Raw, Option<String>, Vec<Warning>);

/// Reads the columns of a Parquet file.
pub fn read(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Columns, LogError> {
    guard::guarded(|| whole(path, size, watch)).unwrap_or_else(|| {
        let why = "a page whose content cannot be".to_owned();
        Err(LogError::Damaged { format: "Parquet", why, path: path.to_path_buf() })
    })
}

/// One column of the file that is read.
struct Field {
    /// Number of the column in the file.
    index: usize,
    meaning: Meaning,
    shape: Shape,
    content: Content,
    /// First point in time.
    base: Option<i64>,
}

enum Content {
    Flat(Cells),
    List(List),
}

fn whole(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Columns, LogError> {
    let damaged = |why: String| LogError::Damaged { format: "Parquet", why, path: path.to_path_buf() };
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut file = File::open(path).map_err(io)?;
    if let Some(why) = footer::fault(&mut file, size).map_err(io)? {
        return Err(damaged(why));
    }
    let reader = SerializedFileReader::new(file).map_err(|e| refused(&e, path))?;
    let facts = reader.metadata().file_metadata().clone();
    let arrow = arrow_schema::fields(&facts);
    let (mut fields, mut said) = fields(facts.schema_descr(), &arrow);
    if fields.is_empty() {
        let why = said.first().map_or_else(|| "it has no columns".to_owned(), |w| w.text.clone());
        return Err(LogError::NoColumns { format: "Parquet", why, path: path.to_path_buf() });
    }
    if let Some(codec) = unread_codec(&reader, &fields) {
        return Err(LogError::Packed { format: "Parquet", codec, instead: "zstd or snappy", path: path.to_path_buf() });
    }
    let rows = u64::try_from(facts.num_rows()).map_err(|_| damaged("a negative number of rows".to_owned()))?;
    let (bytes, limit) = (rows.saturating_mul(8 * fields.len() as u64), room::limit(size));
    let Some(mut room) = limit.checked_sub(bytes) else {
        return Err(damaged(format!("it claims {rows} rows, which a file of {size} bytes does not hold")));
    };
    columns(&reader, &mut fields, rows, &mut room, watch).map_err(|why| match why {
        Stop::Cancelled => LogError::Cancelled { path: path.to_path_buf() },
        Stop::Damaged(why) => damaged(why),
    })?;
    let mut raw = table(fields, &mut said);
    let mut units = metadata::units(&facts);
    for field in arrow.into_iter().filter(|field| !field.unit.is_empty()) {
        units.entry(field.name).or_insert(field.unit);
    }
    if !units.is_empty() {
        raw.units = raw.headers.iter().map(|name| units.get(name).cloned().unwrap_or_default()).collect();
    }
    if raw.columns.is_empty() {
        let why = said.first().map_or_else(|| "it has no columns".to_owned(), |w| w.text.clone());
        return Err(LogError::NoColumns { format: "Parquet", why, path: path.to_path_buf() });
    }
    if let Some(why) = Sums::fault(&facts, &raw) {
        return Err(damaged(why));
    }
    let carried = facts.key_value_metadata().and_then(|all| all.iter().find(|kv| kv.key == SIDECAR)?.value.clone());
    Ok((raw, carried, said))
}

/// Error of a file that the library refuses: a packing that it does not know is no damage.
fn refused(error: &ParquetError, path: &Path) -> LogError {
    let (why, path) = (one_line(error), path.to_path_buf());
    match why.split_once("Unexpected CompressionCodec ") {
        Some((_, number)) => {
            let codec = format!("codec {number}");
            LogError::Packed { format: "Parquet", codec, instead: "zstd or snappy", path }
        }
        None => LogError::Damaged { format: "Parquet", why, path },
    }
}

/// The columns that are read, still without content, and notes about the others.
fn fields(schema: &SchemaDescriptor, arrow: &[arrow_schema::Field]) -> (Vec<Field>, Vec<Warning>) {
    let (mut fields, mut said) = (Vec::new(), Vec::new());
    for (index, column) in schema.columns().iter().enumerate() {
        let name = column.path().string();
        let stated = arrow.iter().find(|field| field.name == name).and_then(|field| field.per_second);
        let meaning = column::meaning(column).map(|meaning| match stated {
            Some(per_second) if meaning == Meaning::Number => Meaning::Clock(per_second),
            _ => meaning,
        });
        match meaning.and_then(|meaning| Ok((meaning, shape::of(schema, column)?))) {
            Ok((meaning, shape)) => {
                let text = meaning == Meaning::Text;
                let content = match (&shape.list, text) {
                    (Some(_), _) => Content::List(List::new(text)),
                    (None, true) => Content::Flat(Cells::Text(Labels::default())),
                    (None, false) => Content::Flat(Cells::Numbers(Vec::new())),
                };
                fields.push(Field { index, meaning, shape, content, base: None });
            }
            Err(why) => said.push(note(&name, format!("the column `{name}` is not read: {why}"))),
        }
    }
    (fields, said)
}

fn note(column: &str, text: String) -> Warning {
    Warning {
        kind: "text-column".to_owned(),
        column: Some(column.to_owned()),
        spans: Vec::new(),
        text,
        ..Warning::default()
    }
}

/// The first packing of a wanted column that is not read.
fn unread_codec(reader: &SerializedFileReader<File>, fields: &[Field]) -> Option<String> {
    let chunks = reader.metadata().row_groups().iter().flat_map(|group| {
        let there = |field: &Field| group.columns().get(field.index).map(ColumnChunkMetaData::compression);
        fields.iter().filter_map(there).collect::<Vec<_>>()
    });
    chunks.into_iter().find_map(|codec| match codec {
        Compression::LZO => Some("lzo".to_owned()),
        _ => None,
    })
}

/// The columns by name, with a note for every list that is not whole.
fn table(fields: Vec<Field>, said: &mut Vec<Warning>) -> Raw {
    let mut raw = Raw::default();
    for Field { meaning, shape, content, .. } in fields {
        let columns = match content {
            Content::Flat(cells) => vec![cells],
            Content::List(list) => {
                let name = shape.list.as_ref().map_or(String::new(), |(after, _)| format!("{}{after}", shape.name));
                said.extend(list.said(&name).map(|text| note(&name, text)));
                list.items
            }
        };
        for (place, cells) in columns.into_iter().enumerate() {
            let name = shape.item(place);
            raw.headers.push(header(&name, meaning));
            raw.aliases.push(name);
            raw.columns.push(cells);
        }
    }
    raw
}

/// A time becomes one in seconds, whatever unit its name states.
fn header(name: &str, meaning: Meaning) -> String {
    let name = metadata::index(name).unwrap_or(name);
    match meaning {
        Meaning::Time(_) | Meaning::Clock(_) => match units::split(name) {
            Some((quantity, unit)) if unit.dimension == Dimension::Time => format!("{quantity}_s"),
            Some(_) => name.to_owned(),
            None => format!("{name}_s"),
        },
        _ => name.to_owned(),
    }
}

/// Reason for ending before the last row.
enum Stop {
    Cancelled,
    Damaged(String),
}

/// Reads block by block.
fn columns(
    reader: &SerializedFileReader<File>,
    fields: &mut [Field],
    rows: u64,
    room: &mut u64,
    watch: &Watch<'_>,
) -> Result<(), Stop> {
    let damaged = |why: &str| Stop::Damaged(why.to_owned());
    for field in fields.iter_mut() {
        if let Content::Flat(Cells::Numbers(values)) = &mut field.content {
            pages::reserve_exact(values, rows as usize);
        }
    }
    let mut sum: u64 = 0;
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(|e| Stop::Damaged(one_line(&e)))?;
        let count = u64::try_from(group.metadata().num_rows()).map_err(|_| damaged("a negative number of rows"))?;
        sum = sum.saturating_add(count);
        if sum > rows {
            return Err(damaged("its blocks have more rows than the file says"));
        }
        for at in 0..fields.len() {
            let field = &mut fields[at];
            block(field, &*group, count as usize, rows, room)
                .map_err(|e| Stop::Damaged(format!("the column `{}`: {}", field.shape.item(0), one_line(&e))))?;
            if watch.is_cancelled() {
                return Err(Stop::Cancelled);
            }
            // Many files are one block.
            show(fields, watch);
        }
        (watch.progress)(sum as f64 / rows.max(1) as f64);
    }
    if sum == rows { Ok(()) } else { Err(Stop::Damaged(format!("it says that it has {rows} rows and has {sum}"))) }
}

/// Reads the `count` rows that a column has in a block.
fn block(
    field: &mut Field,
    group: &dyn RowGroupReader,
    count: usize,
    all_rows: u64,
    room: &mut u64,
) -> Result<(), ParquetError> {
    let level = group.metadata().schema_descr().column(field.index).max_def_level();
    let (index, meaning, base) = (field.index, field.meaning, &mut field.base);
    match (&mut field.content, &field.shape.list) {
        (Content::Flat(cells), _) => {
            let reader = group.get_column_reader(index)?;
            column::append(reader, meaning, base, &mut Flat { rows: count, level, cells })
        }
        (Content::List(list), Some((_, item_level))) => {
            // The room is in bytes, of which a value takes eight, and one item more may stand in it unread.
            if !list::fits(group.get_column_page_reader(index)?, *room / 8 + all_rows)? {
                return Err(ParquetError::General("its lists hold more values than a file of this size".to_owned()));
            }
            let reader = group.get_column_reader(index)?;
            let items = &mut Items { list, rows: count, level, item_level: *item_level, room, all_rows };
            column::append(reader, meaning, base, items)
        }
        (Content::List(_), None) => Err(column::another_kind()),
    }
}

/// Shows the rows read so far; the first column whose name is that of a time is the clock.
fn show(fields: &[Field], watch: &Watch<'_>) {
    let Some(preview) = watch.preview else { return };
    let mut shown: Vec<(String, &[f64])> = Vec::new();
    for Field { meaning, shape, content, .. } in fields {
        let columns = match content {
            Content::Flat(cells) => std::slice::from_ref(cells),
            Content::List(list) => &list.items,
        };
        for (place, cells) in columns.iter().enumerate() {
            if let Cells::Numbers(values) = cells {
                shown.push((header(&shape.item(place), *meaning), values));
            }
        }
    }
    let clock = shown.iter().position(|(name, _)| name == "t_s");
    let time = clock.map_or(&[][..], |at| shown[at].1);
    let others = shown.iter().enumerate().filter(|(at, _)| Some(*at) != clock);
    preview.grow("", 0, time, others.map(|(_, (name, values))| (name.as_str(), *values)));
}
