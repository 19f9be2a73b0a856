//! Writing Parquet: one column of doubles a channel, text for trial and label, units and sidecar in the file's metadata.

use super::metadata::{CREATED_BY, SIDECAR, UNITS, one_line};
use super::sums::{Sum, Sums};
use crate::errors::LogError;
use crate::rows::{Value, cell, columns, not_finite};
use crate::sidecar::written_meta;
use haptics::recording::Recording;
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Rows of a block.
const BLOCK_ROWS: usize = 1 << 17;

/// Writes the recordings of one file as Parquet.
pub fn write(recordings: &[Recording], path: &Path) -> Result<(), LogError> {
    let columns = columns(recordings, path)?;
    if let Some(why) = not_finite(recordings) {
        return Err(LogError::NotWritable { why, path: path.to_path_buf() });
    }
    let failed = |reason: String| LogError::Write { reason, path: path.to_path_buf() };
    let file = File::create(path).map_err(|e| failed(e.to_string()))?;
    table(recordings, &columns, file).map_err(|e| failed(one_line(&e)))
}

fn table(recordings: &[Recording], columns: &[(String, bool)], file: File) -> Result<(), ParquetError> {
    let facts = metadata(recordings);
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_created_by(format!("{CREATED_BY}{}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(facts.clone()))
        .build();
    let mut sums = vec![Sum::default(); columns.len()];
    let mut writer = SerializedFileWriter::new(file, schema(columns)?, Arc::new(properties))?;
    for recording in recordings {
        let mut first = 0;
        while first < recording.len() {
            let end = recording.len().min(first + BLOCK_ROWS);
            let mut group = writer.next_row_group()?;
            for (column, ((_, text), sum)) in columns.iter().zip(&mut sums).enumerate() {
                block(&mut group, recording, (column, *text), first..end, sum)?;
            }
            group.close()?;
            first = end;
        }
    }
    let named = columns.iter().map(|(name, _)| name.as_str()).zip(sums);
    writer.append_key_value_metadata(Sums::new(named, &facts).entry());
    writer.close().map(drop)
}

fn block(
    group: &mut SerializedRowGroupWriter<'_, File>,
    recording: &Recording,
    (column, text): (usize, bool),
    rows: std::ops::Range<usize>,
    sum: &mut Sum,
) -> Result<(), ParquetError> {
    let missing = || ParquetError::General("the schema has fewer columns than the recording".to_owned());
    let mut writer = group.next_column()?.ok_or_else(missing)?;
    if text {
        let value = |row| if let Value::Text(t) = cell(recording, column, row) { t } else { "" };
        sum.texts(rows.clone().map(value));
        let values: Vec<ByteArray> = rows.map(|row| ByteArray::from(value(row))).collect();
        writer.typed::<ByteArrayType>().write_batch(&values, None, None)?;
    } else {
        let value = |row| if let Value::Number(v) = cell(recording, column, row) { v } else { 0.0 };
        let values: Vec<f64> = rows.map(value).collect();
        sum.numbers(&values);
        writer.typed::<DoubleType>().write_batch(&values, None, None)?;
    }
    writer.close()
}

fn schema(columns: &[(String, bool)]) -> Result<TypePtr, ParquetError> {
    let field = |(name, text): &(String, bool)| {
        let kind = if *text { PhysicalType::BYTE_ARRAY } else { PhysicalType::DOUBLE };
        let logical = text.then_some(LogicalType::String);
        let field = Type::primitive_type_builder(name, kind).with_repetition(Repetition::REQUIRED);
        field.with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder("recording").with_fields(fields).build().map(Arc::new)
}

fn metadata(recordings: &[Recording]) -> Vec<KeyValue> {
    let Some(first) = recordings.first() else { return Vec::new() };
    let mut units: BTreeMap<&str, &str> =
        first.channels.iter().filter(|c| !c.unit.is_empty()).map(|c| (c.name.as_str(), c.unit.as_str())).collect();
    if first.time_s.is_some() {
        units.insert("t_s", "s");
    }
    // Maps of texts and the sidecar, which came from JSON, are always JSON.
    let json = |value: Result<String, serde_json::Error>| value.unwrap_or_default();
    vec![
        KeyValue::new(UNITS.to_owned(), json(serde_json::to_string(&units))),
        KeyValue::new(SIDECAR.to_owned(), json(serde_json::to_string(&written_meta(first)))),
    ]
}
