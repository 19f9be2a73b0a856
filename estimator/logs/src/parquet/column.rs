//! One column of a Parquet file as numbers or text.

use crate::raw::{Cells, MISSING};
use haptics::recording::Labels;
use parquet::basic::{LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

/// Rows that are decoded at a time.
const BATCH: usize = 1 << 14;

/// Meaning of the numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meaning {
    /// Numbers as they stand.
    Number,
    /// Whole numbers without a sign.
    Unsigned,
    /// Points in time: this many of them make a second.
    Time(f64),
    /// Text.
    Text,
}

/// Content of a column, or the reason for not reading it.
pub fn meaning(column: &ColumnDescriptor) -> Result<Meaning, &'static str> {
    if column.max_rep_level() > 0 {
        return Err("it holds lists");
    }
    let logical = column.logical_type_ref();
    let converted = format!("{:?}", column.converted_type());
    match (column.physical_type(), logical) {
        (_, Some(LogicalType::Decimal(_))) => Err("it holds decimals"),
        (Type::INT64, Some(LogicalType::Timestamp(of))) => Ok(Meaning::Time(match of.unit {
            TimeUnit::MILLIS => 1e3,
            TimeUnit::MICROS => 1e6,
            TimeUnit::NANOS => 1e9,
        })),
        (Type::INT64, None) if converted == "TIMESTAMP_MILLIS" => Ok(Meaning::Time(1e3)),
        (Type::INT64, None) if converted == "TIMESTAMP_MICROS" => Ok(Meaning::Time(1e6)),
        (Type::INT32 | Type::INT64, Some(LogicalType::Integer(of))) if !of.is_signed => Ok(Meaning::Unsigned),
        (Type::INT32 | Type::INT64, None) if converted.starts_with("UINT") => Ok(Meaning::Unsigned),
        (Type::BOOLEAN | Type::INT32 | Type::INT64 | Type::FLOAT | Type::DOUBLE, _) => Ok(Meaning::Number),
        (Type::BYTE_ARRAY, Some(LogicalType::String | LogicalType::Enum | LogicalType::Json)) => Ok(Meaning::Text),
        (Type::BYTE_ARRAY, None) if converted == "UTF8" => Ok(Meaning::Text),
        _ => Err("it holds bytes or a kind of number that is not known"),
    }
}

/// Appends `rows` values of a column to `cells`. `base` is the first point in time of the column, from which the others count.
pub fn append(
    reader: ColumnReader,
    column: &ColumnDescriptor,
    meaning: Meaning,
    rows: usize,
    base: &mut Option<i64>,
    cells: &mut Cells,
) -> Result<(), ParquetError> {
    let levels = column.max_def_level();
    match (reader, cells) {
        (ColumnReader::BoolColumnReader(r), Cells::Numbers(to)) => {
            numbers(r, levels, rows, to, |v| f64::from(u8::from(*v)))
        }
        (ColumnReader::Int32ColumnReader(r), Cells::Numbers(to)) if meaning == Meaning::Unsigned => {
            numbers(r, levels, rows, to, |v| f64::from(v.cast_unsigned()))
        }
        (ColumnReader::Int32ColumnReader(r), Cells::Numbers(to)) => numbers(r, levels, rows, to, |v| f64::from(*v)),
        (ColumnReader::Int64ColumnReader(r), Cells::Numbers(to)) if meaning == Meaning::Unsigned => {
            numbers(r, levels, rows, to, |v| v.cast_unsigned() as f64)
        }
        (ColumnReader::Int64ColumnReader(r), Cells::Numbers(to)) => match meaning {
            Meaning::Time(per_second) => {
                // Seconds since 1970 in a double are good to 0.2 µs only: count from the first one.
                numbers(r, levels, rows, to, |v| v.wrapping_sub(*base.get_or_insert(*v)) as f64 / per_second)
            }
            _ => numbers(r, levels, rows, to, |v| *v as f64),
        },
        (ColumnReader::FloatColumnReader(r), Cells::Numbers(to)) => numbers(r, levels, rows, to, |v| f64::from(*v)),
        (ColumnReader::DoubleColumnReader(r), Cells::Numbers(to)) => numbers(r, levels, rows, to, |v| *v),
        (ColumnReader::ByteArrayColumnReader(r), Cells::Text(to)) => texts(r, levels, rows, to),
        _ => Err(ParquetError::General("a column is not of the kind that the schema says".to_owned())),
    }
}

/// Reads batch by batch; `take` gets `Some(value)` or `None` for every row.
fn each<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    max_level: i16,
    rows: usize,
    mut take: impl FnMut(Option<&T::T>) -> Result<(), ParquetError>,
) -> Result<(), ParquetError> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let mut left = rows;
    while left > 0 {
        values.clear();
        levels.clear();
        let (records, _, _) = reader.read_records(left.min(BATCH), Some(&mut levels), None, &mut values)?;
        if records == 0 || records > left {
            return Err(ParquetError::General("a column has another number of rows than the file says".to_owned()));
        }
        if max_level == 0 {
            values.iter().try_for_each(|v| take(Some(v)))?;
        } else {
            let mut next = values.iter();
            for &level in &levels {
                take(if level == max_level { next.next() } else { None })?;
            }
        }
        left -= records;
    }
    Ok(())
}

fn numbers<T: DataType>(
    reader: ColumnReaderImpl<T>,
    levels: i16,
    rows: usize,
    to: &mut Vec<f64>,
    mut convert: impl FnMut(&T::T) -> f64,
) -> Result<(), ParquetError> {
    each(reader, levels, rows, |value| {
        to.push(value.map_or(MISSING, &mut convert));
        Ok(())
    })
}

fn texts<T: DataType<T = ByteArray>>(
    reader: ColumnReaderImpl<T>,
    levels: i16,
    rows: usize,
    to: &mut Labels,
) -> Result<(), ParquetError> {
    each(reader, levels, rows, |value| {
        to.push(value.map_or(Ok(""), |v| v.as_utf8())?);
        Ok(())
    })
}
