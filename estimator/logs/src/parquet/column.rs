//! One column of a Parquet file as numbers or text.

use crate::raw::{Cells, MISSING};
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
    /// Whole numbers, this many times too large: decimals.
    Scaled(f64),
    /// Numbers of two bytes.
    Half,
    /// Points in time: this many of them make a second.
    Time(f64),
    /// Times of the day and durations: this many of them make a second.
    Clock(f64),
    /// Text.
    Text,
}

/// Digits of a decimal that a double can be scaled by without rounding twice.
const MAX_SCALE: i32 = 22;

/// Content of a column, or the reason for not reading it.
pub fn meaning(column: &ColumnDescriptor) -> Result<Meaning, &'static str> {
    let logical = column.logical_type_ref();
    let converted = format!("{:?}", column.converted_type());
    let decimal = matches!(logical, Some(LogicalType::Decimal(_))) || converted == "DECIMAL";
    match (column.physical_type(), logical) {
        (Type::INT32 | Type::INT64 | Type::FIXED_LEN_BYTE_ARRAY, _)
            if decimal && (0..=MAX_SCALE).contains(&column.type_scale()) && column.type_length() <= 16 =>
        {
            Ok(Meaning::Scaled(10_f64.powi(column.type_scale())))
        }
        _ if decimal => Err("it holds decimals of more digits than a number has here"),
        (Type::FIXED_LEN_BYTE_ARRAY, Some(LogicalType::Float16)) if column.type_length() == 2 => Ok(Meaning::Half),
        (Type::INT96, _) => Ok(Meaning::Time(1e9)),
        (Type::INT64, Some(LogicalType::Timestamp(of))) => Ok(Meaning::Time(per_second(of.unit))),
        (Type::INT32 | Type::INT64, Some(LogicalType::Time(of))) => Ok(Meaning::Clock(per_second(of.unit))),
        (Type::INT32, None) if converted == "TIME_MILLIS" => Ok(Meaning::Clock(1e3)),
        (Type::INT64, None) if converted == "TIME_MICROS" => Ok(Meaning::Clock(1e6)),
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

fn per_second(unit: TimeUnit) -> f64 {
    match unit {
        TimeUnit::MILLIS => 1e3,
        TimeUnit::MICROS => 1e6,
        TimeUnit::NANOS => 1e9,
    }
}

/// Receiver of the values of a column, row by row or item by item.
pub trait Sink {
    /// Takes all values of a column of numbers.
    fn numbers<T: DataType>(
        &mut self,
        reader: ColumnReaderImpl<T>,
        convert: impl FnMut(&T::T) -> f64,
    ) -> Result<(), ParquetError>;

    /// Takes all values of a column of text.
    fn texts<T: DataType<T = ByteArray>>(&mut self, reader: ColumnReaderImpl<T>) -> Result<(), ParquetError>;
}

/// Hands the values of a column to `sink`. `base` is the first point in time of the column, from which the others count.
pub fn append(
    reader: ColumnReader,
    meaning: Meaning,
    base: &mut Option<i64>,
    sink: &mut impl Sink,
) -> Result<(), ParquetError> {
    // Seconds since 1970 in a double are good to 0.2 µs only: count from the first one.
    let mut since = |v: i64, per_second: f64| v.wrapping_sub(*base.get_or_insert(v)) as f64 / per_second;
    match (reader, meaning) {
        (ColumnReader::BoolColumnReader(r), _) => sink.numbers(r, |v| f64::from(u8::from(*v))),
        (ColumnReader::Int32ColumnReader(r), Meaning::Unsigned) => sink.numbers(r, |v| f64::from(v.cast_unsigned())),
        (ColumnReader::Int32ColumnReader(r), Meaning::Scaled(by) | Meaning::Clock(by)) => {
            sink.numbers(r, |v| f64::from(*v) / by)
        }
        (ColumnReader::Int32ColumnReader(r), _) => sink.numbers(r, |v| f64::from(*v)),
        (ColumnReader::Int64ColumnReader(r), Meaning::Unsigned) => sink.numbers(r, |v| v.cast_unsigned() as f64),
        (ColumnReader::Int64ColumnReader(r), Meaning::Scaled(by) | Meaning::Clock(by)) => {
            sink.numbers(r, |v| *v as f64 / by)
        }
        (ColumnReader::Int64ColumnReader(r), Meaning::Time(per_second)) => sink.numbers(r, |v| since(*v, per_second)),
        (ColumnReader::Int64ColumnReader(r), _) => sink.numbers(r, |v| *v as f64),
        (ColumnReader::Int96ColumnReader(r), Meaning::Time(per_second)) => {
            sink.numbers(r, |v| since(v.to_nanos(), per_second))
        }
        (ColumnReader::FloatColumnReader(r), _) => sink.numbers(r, |v| f64::from(*v)),
        (ColumnReader::DoubleColumnReader(r), _) => sink.numbers(r, |v| *v),
        (ColumnReader::FixedLenByteArrayColumnReader(r), Meaning::Half) => sink.numbers(r, |v| half(v.data())),
        (ColumnReader::FixedLenByteArrayColumnReader(r), Meaning::Scaled(by)) => {
            sink.numbers(r, |v| whole(v.data()) as f64 / by)
        }
        (ColumnReader::ByteArrayColumnReader(r), Meaning::Text) => sink.texts(r),
        _ => Err(another_kind()),
    }
}

/// A number of two bytes (IEEE 754 binary16, little endian): one bit of sign, five of exponent, ten of fraction.
fn half(bytes: &[u8]) -> f64 {
    let bits = u16::from_le_bytes([bytes.first().copied().unwrap_or(0), bytes.get(1).copied().unwrap_or(0)]);
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    let size = match exponent {
        0 => fraction * 2_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2_f64.powi(exponent - 25),
    };
    if bits >> 15 == 1 { -size } else { size }
}

/// A whole number with a sign, the highest byte first; of at most 16 bytes.
fn whole(bytes: &[u8]) -> i128 {
    let sign = bytes.first().map_or(0, |first| i128::from(first.cast_signed() >> 7));
    bytes.iter().fold(sign, |value, byte| value << 8 | i128::from(*byte))
}

/// A column with one value a row.
pub struct Flat<'a> {
    /// Number of rows to read.
    pub rows: usize,
    /// Level of a value that is there.
    pub level: i16,
    /// The column.
    pub cells: &'a mut Cells,
}

impl Sink for Flat<'_> {
    fn numbers<T: DataType>(
        &mut self,
        reader: ColumnReaderImpl<T>,
        mut convert: impl FnMut(&T::T) -> f64,
    ) -> Result<(), ParquetError> {
        let Cells::Numbers(to) = &mut *self.cells else { return Err(another_kind()) };
        each(reader, self.level, self.rows, |value| {
            to.push(value.map_or(MISSING, &mut convert));
            Ok(())
        })
    }

    fn texts<T: DataType<T = ByteArray>>(&mut self, reader: ColumnReaderImpl<T>) -> Result<(), ParquetError> {
        let Cells::Text(to) = &mut *self.cells else { return Err(another_kind()) };
        each(reader, self.level, self.rows, |value| {
            to.push(value.map_or(Ok(""), |v| v.as_utf8())?);
            Ok(())
        })
    }
}

/// Error of a column that is not what its schema says.
pub fn another_kind() -> ParquetError {
    ParquetError::General("a column is not of the kind that the schema says".to_owned())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_two_bytes() {
        let of = |bits: u16| half(&bits.to_le_bytes());
        assert_eq!([of(0x3c00), of(0xc000), of(0x3555), of(0x0001)], [1.0, -2.0, 0.333_251_953_125, 2_f64.powi(-24)]);
        assert_eq!([of(0x7bff), of(0xfc00)], [65504.0, f64::NEG_INFINITY]);
        assert!(of(0x7e00).is_nan() && of(0x8000).is_sign_negative());
    }

    #[test]
    fn whole_numbers_keep_their_sign() {
        assert_eq!([whole(&[0x01, 0x00]), whole(&[0xff, 0xfe]), whole(&[0x80]), whole(&[])], [256, -2, -128, 0]);
    }
}
